#include "app/cli/compare_scene.h"

#include "app/causes/record_file.h"
#include "app/cli/render_run.h"
#include "app/files/frame_folder.h"
#include "core/error.h"
#include "output/png_reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {
namespace {

std::optional<std::int64_t> frame_number(const std::string& name) { return number_in(name, "frame_", ".png"); }

}  // namespace

NamedFiles frames_among(const NamedFiles& references, const std::filesystem::path& folder) {
    NamedFiles frames;
    for (const auto& [name, file] : references)
        if (frame_number(name)) frames[name] = file;
    if (frames.empty())
        throw InputError({folder.string(), 0, 0},
                         "the folder holds no frames of a scene (frame_000000.png, frame_000001.png, ...)");
    const ImageSize size = read_png_size(frames.begin()->second);
    for (const auto& [name, file] : frames)
        if (const ImageSize other = read_png_size(file); other != size)
            throw InputError(
                {file.string(), 0, 0},
                fmt::format("the reference is {} x {} pixels, but the first one is {} x {}, and a scene is "
                            "drawn in one size",
                            other.width, other.height, size.width, size.height));
    return frames;
}

void draw_frames_of(const CompareCommand& command, const std::filesystem::path& scene, const NamedFiles& references,
                    const std::filesystem::path& to) {
    const ImageSize size = read_png_size(references.begin()->second);
    RenderCommand render;
    render.scenes = {scene};
    render.frames = to;
    render.overrides = command.overrides;
    render.overrides.width = size.width;
    render.overrides.height = size.height;
    render.workers = command.workers;
    render.quiet = command.quiet;
    render.motion_record = to / folder_record_name;
    render_to_files(render);
}

}  // namespace tumble
