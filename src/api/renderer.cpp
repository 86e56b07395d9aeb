#include "tumble/renderer.h"

#include "render/renderer.h"

#include "api/convert.h"
#include "api/guard.h"
#include "api/scene_data.h"
#include "core/image_mean.h"
#include "render/scene/pose_filter.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble::v0 {
namespace {

tumble::RenderOptions to_internal(const RenderOptions& options) {
    tumble::RenderOptions to;
    to.backend = options.backend == Backend::egl      ? GlBackend::egl
                 : options.backend == Backend::osmesa ? GlBackend::osmesa
                                                      : GlBackend::software;
    to.shader_folder = options.shader_folder;
    to.transparent = options.transparent;
    return to;
}

void copy_pixels(const tumble::Image& from, const std::vector<Rectangle>& parts, Image& to) {
    for (const Rectangle& part : parts)
        for (int y = part.y; y < part.y + part.height; ++y) {
            const std::uint8_t* const row = from.at(part.x, y);
            std::copy_n(row, 4 * part.width, to.pixels.data() + (row - from.pixels.data()));
        }
}

}  // namespace

struct Renderer::State {
    State(const Scene& drawn, const RenderOptions& options)
        : scene(drawn),
          filter(scene.data().drawn()),
          renderer(scene.data().drawn(), to_internal(options)),
          transparent(options.transparent) {}

    Scene scene;  // the renderer reads its data
    PoseFilter filter;
    tumble::Renderer renderer;
    bool transparent;
    Image image;  // a copy of the renderer's, in the interface's type
    Image blurred;

    const tumble::Image& draw(const Snapshot& snapshot, const FrameMoment& moment) {
        tumble::Snapshot drawn = v0::to_internal(snapshot, scene.body_count());
        filter.follow(drawn);
        return renderer.render(drawn, moment);
    }
};

Renderer::Renderer(const Scene& scene, const RenderOptions& options) {
    guarded([&] { state_ = std::make_unique<State>(scene, options); });
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const Image& Renderer::render(const Snapshot& snapshot) {
    return guarded([&]() -> const Image& {
        State& state = state_of(state_, "Renderer");
        const tumble::Image& image = state.draw(snapshot, {});
        if (state.image.pixels.empty())
            state.image = {image.width, image.height, image.pixels};
        else
            copy_pixels(image, state.renderer.changed(), state.image);
        return state.image;
    });
}

const Image& Renderer::render_blurred(const std::vector<Snapshot>& moments) {
    return guarded([&]() -> const Image& {
        State& state = state_of(state_, "Renderer");
        if (moments.empty()) throw InputError("a frame needs at least one moment");
        if (state.transparent && moments.size() > most_images_with_alpha)
            throw InputError(fmt::format("a transparent frame is the mean of at most {} moments (given {})",
                                         most_images_with_alpha, moments.size()));
        if (moments.size() == 1) return render(moments.front());
        state.image.pixels.clear();  // the next render() copies it whole
        ImageMean mean(state.transparent);
        for (std::size_t i = 0; i < moments.size(); ++i)
            mean.add(state.draw(moments[i], {int(i), int(moments.size())}));
        tumble::Image blurred;
        mean.take(blurred);
        state.blurred = take(std::move(blurred));
        return state.blurred;
    });
}

void Renderer::skip(const Snapshot& snapshot) {
    guarded([&] {
        State& state = state_of(state_, "Renderer");
        tumble::Snapshot drawn = v0::to_internal(snapshot, state.scene.body_count());
        state.filter.follow(drawn);
    });
}

std::string Renderer::driver() const {
    return guarded([&] { return state_of(state_, "Renderer").renderer.driver(); });
}

}  // namespace tumble::v0
