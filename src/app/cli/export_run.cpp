#include "app/cli/export_run.h"

#include "app/cli/progress.h"
#include "app/survey/survey.h"
#include "gltf/scene_export.h"
#include "render/camera/camera_animation.h"
#include "sim/frames/clip_timing.h"
#include "sim/world.h"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

constexpr int most_moments = 16;  // a frame

/// Moments in a frame: as many as its steps allow. More would change the step, and with it the motion.
int moments_per_frame(int steps) {
    int moments = std::min(steps, most_moments);
    while (steps % moments != 0) --moments;
    return moments;
}

/// Shows each moment of the run to the recorder.
class ExportObserver : public SurveyObserver {
public:
    ExportObserver(MotionRecorder& motion, const CameraDescription& camera, std::int64_t moments, bool quiet)
        : motion_(motion), camera_(camera), progress_(moments, quiet) {}

    void see(const Snapshot& snapshot, const Survey&, const ContactRecords* records) override {
        const CameraDescription camera = camera_.at(snapshot);
        if (seen_ == 0) start_ = camera;
        motion_.add(snapshot, camera, records);
        progress_.update(++seen_);
    }

    const CameraDescription& start() const { return start_; }

private:
    MotionRecorder& motion_;
    CameraAnimation camera_;
    CameraDescription start_;
    Progress progress_;
    std::int64_t seen_ = 0;
};

}  // namespace

ExportedScene export_scene(const SceneDescription& scene, KeyKind keys, int threads, bool quiet, Interrupt& interrupt) {
    const bool cubic = keys == KeyKind::cubic;
    const int parts = cubic ? moments_per_frame(scene.simulation.steps_per_frame) : 1;
    const FrameTiming timing{scene.output.fps * parts, scene.simulation.steps_per_frame / parts};
    World world(scene, timing, threads);
    if (cubic && scene.simulation.impacts == ImpactMode::exact) world.record_contacts();
    std::vector<BodyReport> reports;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) reports.push_back(world.report(i));
    MotionRecorder motion(scene, std::move(reports), keys);
    const std::int64_t moments = (scene.frame_count() - 1) * parts + 1;
    ExportObserver observer(motion, scene.camera, moments, quiet);
    SurveyObserver* const observers[] = {&observer};
    survey(world, {moments, 1}, observers, interrupt);
    motion.finish();
    return {make_glb({scene, motion, observer.start(), timing.fps, "Tumble " TUMBLE_VERSION}), motion.position_error(),
            motion.rotation_error()};
}

}  // namespace tumble
