#include "api/scene_data.h"
#include "app/checkpoints/checkpoint_folder.h"
#include "app/cli/broken_joints.h"
#include "app/cli/commands.h"
#include "app/cli/overlaps.h"
#include "app/cli/progress.h"
#include "app/cli/record_clip.h"
#include "app/cli/say.h"
#include "app/files/output_plan.h"
#include "app/files/run_tables.h"
#include "app/threads/interrupt.h"
#include "app/threads/wall_clock.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "sim/checkpoint/archive.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace tumble {
namespace {

constexpr double interrupt_period = 0.02;  // s between checks for Ctrl-C, because a frame may take only a microsecond

/// Checks for Ctrl-C and shows the progress, without a system call per frame.
class RunMonitor {
public:
    RunMonitor(std::int64_t frames, bool quiet) : progress_(frames, quiet) {}

    void update(std::int64_t done) {
        const double now = wall_seconds();
        if (now - last_ < interrupt_period) return;
        last_ = now;
        progress_.update(done);
        if (interrupt_.pending()) throw Interrupted();
    }

private:
    Interrupt interrupt_;  // before the world makes its threads
    Progress progress_;
    double last_ = wall_seconds();
};

void say_run(const SimulateCommand& command, const SceneDescription& scene, std::int64_t frames, double seconds,
             const std::vector<BrokenJoint>& broken) {
    say_broken(broken);
    for (const std::filesystem::path& file : command.tables.all()) say("wrote {}\n", safe_path(file));
    const FrameTiming timing = scene.timing();
    say("{} frames, {} steps of {:.6g} s, in {:.2f} s ({:.4g} times real time)\n", frames,
        (frames - 1) * timing.steps_per_frame, 1.0 / (timing.fps * timing.steps_per_frame), seconds,
        double(frames - 1) / timing.fps / seconds);
}

/// Throws InputError if a table would replace another one, an input or a checkpoint.
void check_tables(const SimulateCommand& command, const FileList& inputs) {
    OutputPlan plan;
    plan.add_inputs(inputs);
    if (const auto& folder = command.from_checkpoints) {
        plan.add_inputs(checkpoint_files_in(*folder));
        plan.add_input_folder(*folder, is_checkpoint_name);
    }
    command.tables.add_to(plan);
    if (command.checkpoints) add_checkpoints(plan, *command.checkpoints);
}

void simulate_tables(const SimulateCommand& command) {
    const double start = wall_seconds();
    FileList inputs;
    const SceneDescription description = load_scene(command.scenes.front(), command.overrides, &inputs);
    check_tables(command, inputs);
    const v0::Scene scene = v0::make_scene(description, std::move(inputs));
    const std::int64_t frames = scene.frame_count();
    std::vector<BrokenJoint> broken;
    {
        RunMonitor monitor(frames, command.quiet);
        World world(description, command.threads);
        if (!command.quiet) say_text(overlap_warning(description, world));
        RunTables tables(command.tables, scene);
        if (tables.needs_records()) world.record_contacts();
        for (std::int64_t n = 0; n < frames; ++n) {
            if (n > 0) world.advance_frame();
            tables.add(n, world);
            monitor.update(n + 1);
        }
        tables.finish();
        broken = broken_joints(description, world);
    }
    if (!command.quiet) say_run(command, description, frames, wall_seconds() - start, broken);
}

/// The clip that will be drawn from the checkpoints.
RenderCommand clip_of(const SimulateCommand& command) {
    RenderCommand clip = command.clip;
    clip.scenes = command.scenes;
    clip.overrides = command.overrides;
    const bool own_frames = command.scenes.size() == 1 && clip.vary.empty() && clip.speed == 1.0 && clip.shutter == 0.0;
    if (!own_frames && !command.tables.all().empty())
        throw InputError(
            "--checkpoints: tables are of the frames of one scene; leave out --trajectory, --energy, "
            "--impacts, --contacts, --loads and --joints with several panels, --speed and --shutter");
    return clip;
}

/// The tables of the frames from --start on.
void simulate_rest(const SimulateCommand& command) {
    const double start = wall_seconds();
    RenderCommand clip = clip_of(command);
    clip.start = command.start;
    RenderScenes scenes(clip, Shutter::of(clip.shutter, clip.blur_samples));
    check_tables(command, scenes.inputs);
    const CheckpointReading checkpoints(*command.from_checkpoints, scenes.identity());
    const std::int64_t first = scenes.frames.first(), end = scenes.ends.front();
    const std::optional<ClipState> state = checkpoints.before(first);
    const std::int64_t begin = state ? state->frame : 0;
    const v0::Scene scene = v0::make_scene(scenes.first(), scenes.inputs);
    std::vector<BrokenJoint> broken;
    {
        RunMonitor monitor(end - begin, command.quiet);
        RunTables tables(command.tables, scene, first);
        World world = scenes.world(0, command.threads);
        if (tables.needs_records() && !world.records_contacts()) world.record_contacts();
        if (state) {
            CheckpointReader reader(state->panels.front().simulation);
            world.restore(reader);
        }
        for (std::int64_t n = begin; n < end; ++n) {
            if (n > begin) world.advance_frame();
            if (n >= first) tables.add(n, world);
            monitor.update(n + 1 - begin);
        }
        tables.finish();
        broken = broken_joints(scenes.first(), world);
    }
    if (!command.quiet) say_run(command, scenes.first(), end - begin, wall_seconds() - start, broken);
}

void simulate_clip(const SimulateCommand& command) {
    const double start = wall_seconds();
    const RenderCommand clip = clip_of(command);
    const Shutter shutter = Shutter::of(clip.shutter, clip.blur_samples);
    RenderScenes scenes(clip, shutter);
    check_tables(command, scenes.inputs);
    const SceneDescription& first = scenes.first();
    const v0::Scene scene = v0::make_scene(first, scenes.inputs);
    const std::int64_t frames = scenes.clip_frames;
    std::size_t count = 0;
    std::uintmax_t bytes = 0;
    std::vector<BrokenJoint> broken;
    {
        RunMonitor monitor(frames, command.quiet);
        RunTables tables(command.tables, scene);
        CheckpointWriting checkpoints(*command.checkpoints, scenes.identity());
        ClipRecording recording;
        recording.shutter = shutter;
        recording.every = std::max<std::int64_t>(1, std::llround(command.every * first.output.fps));
        recording.threads = command.threads;
        recording.records = tables.needs_records();
        recording.motion = command.motion;
        recording.each = [&](std::int64_t n, const World& world) {
            tables.add(n, world);
            monitor.update(n + 1);
            if (n + 1 == scenes.ends.front()) broken = broken_joints(first, world);
        };
        record_clip(scenes, recording, checkpoints);
        tables.finish();
        count = checkpoints.count();
        bytes = checkpoints.bytes();
    }
    if (command.quiet) return;
    say("wrote {}: {} checkpoints, {:.1f} MB\n", safe_path(*command.checkpoints), count, double(bytes) / 1e6);
    say_run(command, first, frames, wall_seconds() - start, broken);
}

}  // namespace

void run_simulate(const SimulateCommand& command) {
    if (command.checkpoints) return simulate_clip(command);
    if (command.from_checkpoints) return simulate_rest(command);
    if (command.scenes.size() > 1) throw InputError("several scenes are simulated together only with --checkpoints");
    simulate_tables(command);
}

}  // namespace tumble
