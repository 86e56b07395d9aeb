#include "app/cli/commands.h"
#include "app/cli/progress.h"
#include "app/cli/say.h"
#include "app/files/output_plan.h"
#include "app/survey/survey.h"
#include "app/threads/interrupt.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "gltf/scene_export.h"
#include "output/temporary_file.h"
#include "render/camera/camera_animation.h"
#include "scene/load.h"
#include "sim/frames/clip_timing.h"
#include "sim/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

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

    void see(const Snapshot& snapshot, const Measurement&, const ContactRecords* records) override {
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

void run_export(const ExportCommand& command) {
    if (command.output.extension() != ".glb")
        throw InputError(fmt::format("-o {}: the name must end with .glb", safe_path(command.output)));
    FileList inputs;
    const SceneDescription scene = load_scene(command.scene, command.overrides, &inputs);
    OutputPlan plan;
    for (const auto& file : inputs) plan.add_input(file);
    plan.add("-o", command.output);

    const bool cubic = command.keys == KeyKind::cubic;
    const int parts = cubic ? moments_per_frame(scene.simulation.steps_per_frame) : 1;
    const FrameTiming timing{scene.output.fps * parts, scene.simulation.steps_per_frame / parts};
    TemporaryFile file(command.output);
    std::size_t size = 0;
    double position_error = 0.0, rotation_error = 0.0;
    {
        Interrupt interrupt;
        World world(scene, timing, command.threads);
        if (cubic && scene.simulation.impacts == ImpactMode::exact) world.record_contacts();
        std::vector<BodyReport> reports;
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) reports.push_back(world.report(i));
        MotionRecorder motion(scene, std::move(reports), command.keys);
        const std::int64_t moments = (scene.frame_count() - 1) * parts + 1;
        ExportObserver observer(motion, scene.camera, moments, command.quiet);
        SurveyObserver* const observers[] = {&observer};
        survey(world, {moments, 1}, observers, interrupt);
        motion.finish();
        const std::vector<std::byte> bytes =
            make_glb({scene, motion, observer.start(), timing.fps, "Tumble " TUMBLE_VERSION});
        file.write(bytes);
        size = bytes.size();
        position_error = motion.position_error();
        rotation_error = motion.rotation_error();
    }
    file.commit();
    if (!command.quiet)
        say("wrote {} ({:.4g} kB; largest error {:.2g} m, {:.2g} rad)\n", safe_path(command.output),
            1e-3 * double(size), position_error, rotation_error);
}

}  // namespace tumble
