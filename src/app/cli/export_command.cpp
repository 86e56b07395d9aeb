#include "app/cli/export_command.h"

#include "app/cli/command.h"
#include "app/cli/progress.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/files/output_plan.h"
#include "app/survey/survey.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "gltf/scene_export.h"
#include "output/temporary_file.h"
#include "presimulation/impact_focus.h"
#include "presimulation/motion_camera.h"
#include "render/camera/camera_animation.h"
#include "scene/load.h"
#include "sim/frames/clip_timing.h"
#include "sim/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

struct ExportCommand {
    std::filesystem::path scene;
    std::filesystem::path output;  // .glb
    KeyKind keys = KeyKind::cubic;
    SceneOverrides overrides;
    int threads = 1;
    bool quiet = false;
};

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

ExportedScene export_scene(const SceneDescription& unframed, KeyKind keys, int threads, bool quiet,
                           Interrupt& interrupt) {
    const SceneDescription scene = framed(unframed, threads, [&] {
        if (interrupt.pending()) throw Interrupted();
    });
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

namespace {

void run_export(const ExportCommand& command) {
    if (command.output.extension() != ".glb")
        throw InputError(fmt::format("-o {}: the name must end with .glb", safe_path(command.output)));
    FileList inputs;
    const SceneDescription scene = focused_on_impacts(load_scene(command.scene, command.overrides, &inputs));
    OutputPlan plan;
    plan.add_inputs(inputs);
    plan.add("-o", command.output);

    TemporaryFile file(command.output);
    ExportedScene exported;
    {
        Interrupt interrupt;
        exported = export_scene(scene, command.keys, command.threads, command.quiet, interrupt);
        file.write(exported.bytes);
    }
    file.commit();
    if (!command.quiet)
        say("wrote {} ({:.4g} kB; largest error {:.2g} m, {:.2g} rad)\n", safe_path(command.output),
            1e-3 * double(exported.bytes.size()), exported.position_error, exported.rotation_error);
}

}  // namespace

void add_export(Command& command) {
    ExportCommand& c = command.keep<ExportCommand>();
    add_scene(command, c.scene);
    command.add_option("-o,--output", c.output, "The glTF 2.0 file to write: .glb")
        ->required()
        ->check(file_name("glb"))
        ->type_name("FILE.glb");
    add_choice<KeyKind>(
        command, "--keys", c.keys, {{"cubic", KeyKind::cubic}, {"frames", KeyKind::linear}},
        "cubic: few keys, exact in flight; frames: one a frame, interpolated linearly, for programs that "
        "leave out the tangents of cubics, as Blender");
    add_frames_of_time(command, c.overrides);
    add_run(command, c.threads, std::to_string(c.threads), c.quiet);
    command.notes =
        "Planes become finite squares; patterns of two colors become their mean, cords and overlays are left out.";
    command.examples =
        "  tumble export scene.toml -o scene.glb\n"
        "  tumble export scene.toml -o scene.glb --set simulation.impacts=exact   exact between frames too\n"
        "  tumble export scene.toml -o scene.glb --keys frames                    for Blender";
    command.logs = true;
    command.run = [&c] {
        run_export(c);
        return 0;
    };
}

}  // namespace tumble
