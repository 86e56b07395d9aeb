#include "app/workers/frame_memory.h"

#include "app/files/aov_file.h"
#include "render/camera/lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace tumble {
namespace {

// Bytes per pixel.
constexpr std::uint64_t sample = 8;       // color and depth
constexpr std::uint64_t targets = 2;      // the background and the frame, each with all samples (framebuffer.h)
constexpr std::uint64_t image_bytes = 4;  // RGBA
constexpr std::uint64_t drawing = 10;  // buffers of antialiasing and readback: measured, see docs/explanation/output.md
constexpr std::uint64_t light = 12;    // the sums of a mean of blur samples (image_mean.h)
constexpr std::uint64_t coverage = 4;  // of these sums
constexpr std::uint64_t overlay = 16;  // depths, the image with the shapes, coverage of a line (shape_raster.h)
constexpr std::uint64_t surface = 16;  // visibility buffer: depth, surface, triangle (visibility_buffer.h)

constexpr std::int64_t slots = 4;  // of a worker (render_pool.cpp); a frame takes one

std::uint64_t pixels_of(int width, int height) { return std::uint64_t(width) * std::uint64_t(height); }

std::uint64_t panel_memory(const ClipPanel& panel, const RenderWork& work) {
    const SceneDescription& scene = *panel.scene;
    const std::uint64_t pixels = pixels_of(scene.output.width, scene.output.height);
    const std::uint64_t samples = scene.cords.empty() ? 1 : std::uint64_t(scene.output.samples);  // the renderer's rule
    std::uint64_t bytes = pixels * (targets * samples * sample + image_bytes + drawing);
    if (samples > 1) bytes += pixels * image_bytes;  // their mean
    const std::uint64_t mean = light + (work.outputs.transparent ? coverage : 0) + image_bytes;
    if (work.blur_samples > 1) bytes += pixels * mean;
    if (has_lens(scene.camera)) bytes += pixels * mean;
    if (panel.overlay) bytes += pixels * overlay;
    return bytes;
}

}  // namespace

RenderMemory render_memory(const Composition& composition, const RenderWork& work) {
    const int width = composition.width, height = composition.height;
    RenderMemory memory;
    if (work.outputs.image()) {
        for (const ClipPanel& panel : composition.panels) memory.worker += panel_memory(panel, work);
        for (const ClipInset& inset : composition.insets) memory.worker += panel_memory(inset.as_panel(), work);
        if (!composition.plain()) memory.worker += pixels_of(width, height) * image_bytes;
    }
    if (work.outputs.video) {
        const auto used = std::uint64_t(std::clamp<std::int64_t>(work.frames, 1, slots));
        memory.worker += (used + 1) * frame_bytes(*work.outputs.video, width, height);
    }
    if (!work.outputs.aovs.empty()) {
        const OutputSettings& aov_output = composition.aov_scene->output;
        const std::uint64_t pixels = pixels_of(aov_output.width, aov_output.height);
        memory.worker += pixels * surface;
        for (const Aov aov : all_aovs)
            if (work.outputs.aovs.has(aov))
                memory.worker += 2 * pixels * bytes_of_pixel(aov);  // values, and space for the file
    }
    if (work.clip) memory.encoder = std::uint64_t(work.encoders) * encoder_memory(*work.clip, width, height);
    return memory;
}

std::uint64_t encoder_memory(VideoKind kind, int width, int height) {
    // Bytes per pixel: the increase of ffmpeg 5.1's peak from 1280 x 720 to 4096 x 2304 pixels, 8 plain frames.
    const auto of_pixel = [&]() -> std::uint64_t {
        switch (kind) {
            case VideoKind::h264:
                return 25;
            case VideoKind::vp9:
                return 115;
            case VideoKind::vp9_alpha:
                return 230;
            case VideoKind::prores_4444:
                return 65;
            case VideoKind::gif:
                return 42;
        }
        return 0;
    }();
    return of_pixel * std::uint64_t(width) * std::uint64_t(height);
}

int workers_that_fit(const Composition& composition, const RenderWork& work, int workers, const AvailableMemory& own,
                     const AvailableMemory& shared) {
    const RenderMemory memory = render_memory(composition, work);
    const std::string what = fmt::format("drawing pictures of {} x {} pixels", composition.width, composition.height);
    const std::string_view remedy = "a smaller --size takes less";
    require_memory(memory.worker, own, what, remedy);
    require_memory(memory.total(1), shared, what, remedy);
    int fitting = workers;
    while (fitting > 1 && memory.total(fitting) > shared.bytes) --fitting;
    return fitting;
}

}  // namespace tumble
