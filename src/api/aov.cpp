#include "tumble/aov.h"

#include "render/aov/aov_renderer.h"

#include "api/convert.h"
#include "api/guard.h"
#include "api/scene_data.h"

namespace tumble::v0 {
namespace {

AovSet to_internal(const AovSelection& selection) {
    AovSet set;
    if (selection.depth) set.add(Aov::depth);
    if (selection.normal) set.add(Aov::normal);
    if (selection.segmentation) set.add(Aov::segmentation);
    if (selection.motion) set.add(Aov::motion);
    if (selection.albedo) set.add(Aov::albedo);
    return set;
}

}  // namespace

struct AovRenderer::State {
    State(const Scene& drawn, const AovSelection& selection)
        : scene(drawn), motion(selection.motion), renderer(scene.data().drawn(), to_internal(selection)) {}

    AovFrame render(const AovPoses& poses) {
        const tumble::AovFrame& made = renderer.make(poses);
        return {made.camera.width, made.camera.height, made.depth, made.normal,
                made.segmentation, made.motion,        made.albedo};
    }

    Scene scene;  // the renderer reads its data
    bool motion;
    tumble::AovRenderer renderer;
};

AovRenderer::AovRenderer(const Scene& scene, const AovSelection& selection) {
    guarded([&] { state_ = std::make_unique<State>(scene, selection); });
}
AovRenderer::~AovRenderer() = default;
AovRenderer::AovRenderer(AovRenderer&&) noexcept = default;
AovRenderer& AovRenderer::operator=(AovRenderer&&) noexcept = default;

AovFrame AovRenderer::render(const Snapshot& snapshot) {
    return guarded([&] {
        State& state = state_of(state_, "AovRenderer");
        if (state.motion) throw InputError("motion needs the snapshot of the next frame");
        return state.render({v0::to_internal(snapshot, state.scene.body_count()), std::nullopt});
    });
}

AovFrame AovRenderer::render(const Snapshot& snapshot, const Snapshot& next) {
    return guarded([&] {
        State& state = state_of(state_, "AovRenderer");
        const std::size_t bodies = state.scene.body_count();
        return state.render({v0::to_internal(snapshot, bodies), v0::to_internal(next, bodies)});
    });
}

}  // namespace tumble::v0
