#include "app/cli/compare_scene.h"

#include "app/causes/record_file.h"
#include "app/cli/render_run.h"
#include "app/files/frame_folder.h"
#include "app/files/frame_set.h"
#include "core/error.h"
#include "output/picture_reader.h"
#include "scene/load.h"

#include <set>

namespace tumble {
namespace {

std::optional<std::int64_t> frame_number(const std::string& name) { return number_in(name, "frame_", ".png"); }

/// The frames of the references that the scene has.
FrameSet frames_of(const NamedFiles& references, const SceneDescription& scene) {
    std::set<std::int64_t> numbers;  // a name may have more digits than its number needs
    for (const auto& [name, file] : references) numbers.insert(*frame_number(name));
    const std::int64_t count = scene.frame_count();
    FrameSet frames;
    for (const std::int64_t number : numbers)
        if (number < count) frames.append(number, number + 1);
    return frames;
}

/// The size of the first reference that can be read: a broken one is a result of the comparison. Throws InputError if
/// all are broken.
ImageSize size_of(const NamedFiles& references) {
    for (const auto& [name, file] : references) try {
            return read_picture_size(file);
        } catch (const InputError&) {
            if (file == references.rbegin()->second) throw;
        }
    return {};
}

}  // namespace

NamedFiles frames_among(const NamedFiles& references, const std::filesystem::path& folder) {
    NamedFiles frames;
    for (const auto& [name, file] : references)
        if (frame_number(name)) frames[name] = file;
    if (frames.empty())
        throw InputError({folder.string(), 0, 0},
                         "the folder holds no frames of a scene (frame_000000.png, frame_000001.png, ...)");
    return frames;
}

void draw_frames_of(const CompareCommand& command, const std::filesystem::path& scene, const NamedFiles& references,
                    const std::filesystem::path& to) {
    const ImageSize size = size_of(references);
    const FrameSet frames = frames_of(references, load_scene(scene, command.overrides));
    if (frames.empty()) return;
    RenderCommand render;
    render.frames_range = frames.text(std::size_t(frames.count()));
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
