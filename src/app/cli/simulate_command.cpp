#include "api/scene_data.h"
#include "app/checkpoints/checkpoint_folder.h"
#include "app/checkpoints/frame_record.h"
#include "app/cli/command.h"
#include "app/cli/progress.h"
#include "app/cli/render_command.h"
#include "app/cli/run_notes.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/clip/render_scenes.h"
#include "app/files/output_plan.h"
#include "app/files/run_tables.h"
#include "app/pipeline/panel_run.h"
#include "app/threads/interrupt.h"
#include "app/threads/stage_timer.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/temporary_file.h"
#include "presimulation/impact_focus.h"
#include "render/scene/pose_filter.h"
#include "scene/toml/limits.h"
#include "sim/checkpoint/archive.h"
#include "sim/frames/clip_timing.h"
#include "sound/sound_track.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace tumble {
namespace {

struct SimulateCommand {
    std::vector<std::filesystem::path> scenes;  // one, or a panel for each with checkpoints
    TableFiles tables;
    std::optional<std::filesystem::path> sound;  // .wav
    SceneOverrides overrides;
    std::optional<std::filesystem::path> checkpoints;       // folder
    double every = 1.0;                                     // s of the clip between two checkpoints
    std::optional<std::filesystem::path> from_checkpoints;  // folder to go on from
    double start = 0.0;                                     // s, scene time: earlier frames are not in the tables
    bool motion = true;                                     // is in the folder too
    RenderCommand clip;  // that is drawn from the checkpoints: only its panels and times
    int threads = 1;
    bool quiet = false;
};

/// A run of the clip as `render` simulates it, without drawing.
struct ClipRecording {
    Shutter shutter;
    std::int64_t every = 1;  // frames between two checkpoints
    int threads = 1;
    bool records = false;  // of contacts, whether or not the clip shows them
    bool motion = true;    // is written too: parts need no simulation
    /// Called with each frame of the first panel and its world at the frame's first moment.
    std::function<void(std::int64_t frame, const World& world)> each;
};

constexpr std::size_t most_motion = std::size_t(64) << 20;  // bytes of a panel that are kept until they are written

/// A panel, and the memory of drawing from frame to frame.
struct RecordedPanel {
    RecordedPanel(RenderScenes& scenes, std::size_t index, const ClipRecording& recording)
        : world(scenes.world(index, recording.threads)),
          overlay(scenes.overlay(index)),
          run({.world = &world,
               .end = scenes.ends[index],
               .overlay = overlay.get(),
               .steps = scenes.scenes[index].steps},
              recording.shutter),
          poses(*scenes.composition.panels[index].scene),
          observers(scenes.observers(index)),
          needs(needs_of(observers)) {
        if (recording.motion) motion.emplace(overlay ? MotionDetail::states : MotionDetail::poses);
        if (recording.records && !world.records_contacts()) world.record_contacts();
    }

    void take(std::int64_t frame, std::int64_t clip_end);
    PanelState state() const;

    World world;
    std::unique_ptr<OverlayBuilder> overlay;
    PanelRun run;
    std::optional<FrameRecorder> motion;
    PoseFilter poses;
    std::vector<SurveyObserver*> observers;
    SurveyNeeds needs;
    std::optional<PanelState> ended;  // state before its last frame, which later frames repeat
};

void RecordedPanel::take(std::int64_t frame, std::int64_t clip_end) {
    const bool runs = run.runs(frame);
    if (runs && !run.runs(frame + 1) && frame + 1 < clip_end) ended = run.save();
    const Survey survey = runs ? Survey(world, needs) : Survey();
    PanelPoses moments = run.next(frame);
    if (runs)
        for (SurveyObserver* observer : observers) observer->see(moments.front(), survey, run.records());
    if (runs && motion) motion->add(moments, run.records());
    for (Snapshot& moment : drawn_moments(moments)) poses.follow(moment);
}

PanelState RecordedPanel::state() const {
    PanelState state = ended ? *ended : run.save();
    CheckpointWriter writer;
    writer.keep(poses);
    state.poses.assign(writer.bytes().begin(), writer.bytes().end());
    return state;
}

using RecordedPanels = std::vector<std::unique_ptr<RecordedPanel>>;

/// Writes the motion since `first`. A panel that has ended has none.
void add_motion(std::int64_t first, const RecordedPanels& panels, CheckpointWriting& checkpoints) {
    for (std::size_t i = 0; i < panels.size(); ++i)
        if (panels[i]->run.runs(first)) checkpoints.add_motion(first, i, panels[i]->motion->take());
}

/// Writes checkpoints from which the parts of the clip can be drawn, and surveys the scenes on the way. Throws what
/// `each` throws, and RunError if a file cannot be written.
void record_clip(RenderScenes& scenes, const ClipRecording& recording, CheckpointWriting& checkpoints) {
    RecordedPanels panels;
    for (std::size_t i = 0; i < scenes.scenes.size(); ++i)
        panels.push_back(std::make_unique<RecordedPanel>(scenes, i, recording));
    const std::int64_t end = scenes.clip_frames;
    std::int64_t first = 0;  // of the motion that is not written yet
    for (std::int64_t n = 0; n < end; ++n) {
        for (const auto& panel : panels)
            if (panel->run.runs(n)) panel->run.reach_next();
        if (n > 0 && n % recording.every == 0) {
            ClipState state{n, {}};
            for (const auto& panel : panels) state.panels.push_back(panel->state());
            checkpoints.add(state);
        }
        const bool full =
            std::ranges::any_of(panels, [](const auto& p) { return p->motion && p->motion->size() > most_motion; });
        if (recording.motion && n > 0 && (n % recording.every == 0 || full))
            add_motion(std::exchange(first, n), panels, checkpoints);
        recording.each(n, panels.front()->world);
        for (const auto& panel : panels) panel->take(n, end);
    }
    if (recording.motion) {
        // The motion of the last frame's surfaces ends at the frame after it.
        if (panels.size() == 1) panels.front()->motion->add({panels.front()->run.next_start()}, nullptr);
        add_motion(first, panels, checkpoints);
    }
    panels.clear();  // they refer to the scenes of the composition
    scenes.use_survey(recording.threads);
    checkpoints.finish(scenes.survey_bytes());
}

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
    Interrupt& interrupt() { return interrupt_; }

private:
    Interrupt interrupt_;  // before the world makes its threads
    Progress progress_;
    double last_ = wall_seconds();
};

void say_run(const SimulateCommand& command, const SceneDescription& scene, std::int64_t frames, double seconds,
             const std::vector<BrokenJoint>& broken) {
    say_broken(broken);
    for (const std::filesystem::path& file : command.tables.all()) say("wrote {}\n", safe_path(file));
    if (command.sound) say("wrote {}\n", safe_path(*command.sound));
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
    if (command.sound) plan.add("--sound", *command.sound);
    if (command.checkpoints) add_checkpoints(plan, *command.checkpoints);
}

void simulate_tables(const SimulateCommand& command) {
    const double start = wall_seconds();
    FileList inputs;
    const auto shared = std::make_shared<const SceneDescription>(
        focused_on_impacts(load_scene(command.scenes.front(), command.overrides, &inputs)));
    const SceneDescription& description = *shared;
    check_tables(command, inputs);
    const v0::Scene scene = v0::make_scene(shared, std::move(inputs));
    const std::int64_t frames = scene.frame_count();
    std::vector<BrokenJoint> broken;
    {
        RunMonitor monitor(frames, command.quiet);
        World world(description, command.threads);
        if (!command.quiet) say_text(start_notes(description, world));
        RunTables tables(command.tables, scene);
        std::optional<SoundTrack> sound;
        if (command.sound) {
            sound.emplace(description);
            world.record_contacts();
        }
        tables.start_records(world);
        for (std::int64_t n = 0; n < frames; ++n) {
            if (n > 0) world.advance_frame();
            tables.add(n, world);
            if (sound) sound->see(world.snapshot(), world.contact_records());
            monitor.update(n + 1);
        }
        tables.finish();
        if (sound) {
            const std::vector<double> track = sound->pressure({0.0, double(frames) / description.output.fps, 1.0});
            write_file(*command.sound, wav_bytes(mix({&track, 1})));
        }
        broken = broken_joints(description, world);
    }
    if (!command.quiet) say_run(command, description, frames, wall_seconds() - start, broken);
}

/// Tables are of frames that are equally far apart.
void require_even_frames(const SimulateCommand& command, const RenderScenes& scenes) {
    if (scenes.scenes.front().steps.empty() || command.tables.all().empty()) return;
    throw InputError(
        "--checkpoints: a clip whose speed changes ([[speed]]) has no tables; write them by a run without "
        "--checkpoints");
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
    require_even_frames(command, scenes);
    const CheckpointReading checkpoints(*command.from_checkpoints, scenes.identity());
    const std::int64_t first = scenes.frames.first(), end = scenes.ends.front();
    const std::optional<ClipState> state = checkpoints.before(first);
    const std::int64_t begin = state ? state->frame : 0;
    const v0::Scene scene = v0::make_scene(scenes.scenes.front().scene, scenes.inputs);
    std::vector<BrokenJoint> broken;
    {
        RunMonitor monitor(end - begin, command.quiet);
        RunTables tables(command.tables, scene, first);
        World world = scenes.world(0, command.threads);
        tables.start_records(world);
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
    require_even_frames(command, scenes);
    const SceneDescription& first = scenes.first();
    const v0::Scene scene = v0::make_scene(scenes.scenes.front().scene, scenes.inputs);
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
        scenes.find_paths(command.threads, monitor.interrupt());
        record_clip(scenes, recording, checkpoints);
        tables.finish();
        count = checkpoints.count();
        bytes = checkpoints.bytes();
    }
    if (command.quiet) return;
    say("wrote {}: {} checkpoints, {:.1f} MB\n", safe_path(*command.checkpoints), count, double(bytes) / 1e6);
    say_run(command, first, frames, wall_seconds() - start, broken);
}

/// The mode of impacts, or the file of their table.
void read_impacts(const std::string& text, SimulateCommand& c) {
    const std::filesystem::path file = text == "-" ? "/dev/stdout" : text;
    const bool is_file =
        file.extension() == ".csv" || file.extension() == ".npz" || text.find('/') != std::string::npos;
    if (text == "-" || is_file)
        c.tables.impacts = file;
    else if (text == "stepped" || text == "exact")
        c.overrides.impacts = text;
    else
        throw InputError(
            fmt::format("--impacts: must be stepped or exact, or a file that ends with .csv or .npz (was '{}'){}",
                        safe_text(text), did_you_mean(text, {"stepped", "exact"})));
}

/// The folders of checkpoints, and the settings of the clip that is drawn from them.
void add_checkpoints(CLI::App& command, SimulateCommand& c) {
    CLI::Option* const folder =
        command
            .add_option("--checkpoints", c.checkpoints,
                        "Write the state of the simulation to DIR, from which parts of a clip are drawn:\n"
                        "tumble render --from-checkpoints DIR (docs/how-to/long-renders.md)")
            ->check(folder_name())
            ->type_name("DIR");
    command.add_option("--every", c.every, "Seconds of the clip between two checkpoints")
        ->check(number_within(1e-6, limits::duration.max))
        ->needs(folder)
        ->option_text("S [1]");
    command
        .add_flag_callback(
            "--no-motion", [&c] { c.motion = false; },
            "Leave the motion of the frames out: DIR is smaller, but each part simulates its\nframes once more")
        ->needs(folder);
    CLI::Option* const from =
        command
            .add_option("--from-checkpoints", c.from_checkpoints,
                        "Go on from the last checkpoint before --start, in place of the start of the scene")
            ->check(folder_name())
            ->excludes(folder)
            ->type_name("DIR");
    command.add_option("--start", c.start, "Seconds of the scene before the first rows of the tables")
        ->check(number_within(limits::duration.min, limits::duration.max))
        ->needs(from)
        ->option_text("S [0]");
    // Options of the clip: the same as the options of render.
    const std::vector<CLI::Option*> before = command.get_options();
    add_size(command, c.overrides.width, c.overrides.height, "Of the clip: picture size, in place of the scene's");
    add_clip_times(command, c.clip);
    add_panels(command, c.clip, "A panel");
    add_text(command, c.overrides);
    std::vector<CLI::Option*> of_clip = command.get_options();
    std::erase_if(of_clip, [&](CLI::Option* o) { return std::find(before.begin(), before.end(), o) != before.end(); });
    command.parse_complete_callback([of_clip, folder, from] {
        for (const CLI::Option* const option : of_clip)
            if (option->count() > 0 && folder->count() + from->count() == 0)
                throw CLI::RequiresError(option->get_name(), "--checkpoints or --from-checkpoints");
    });
}

void run_simulate(const SimulateCommand& command) {
    if (command.sound && command.sound->extension() != ".wav")
        throw InputError(
            fmt::format("--sound: must be a file that ends with .wav (was '{}')", safe_path(*command.sound)));
    if (command.sound && (command.checkpoints || command.from_checkpoints))
        throw InputError("--sound: is of a whole run, without --checkpoints and --from-checkpoints");
    if (command.checkpoints) return simulate_clip(command);
    if (command.from_checkpoints) return simulate_rest(command);
    if (command.scenes.size() > 1) throw InputError("several scenes are simulated together only with --checkpoints");
    simulate_tables(command);
}

}  // namespace

void add_simulate(Command& command) {
    SimulateCommand& c = command.keep<SimulateCommand>();
    command
        .add_option("scene", c.scenes, "The scene file (TOML); several with --checkpoints of a clip that shows them")
        ->check(file_name("toml"))
        ->required()
        ->type_name("SCENE");
    command
        .add_option("--trajectory", c.tables.trajectory,
                    "CSV: one row per frame and moving body, with its center of mass, orientation\nand velocities; - "
                    "is standard output")
        ->check(csv_name())
        ->transform(or_standard_output())
        ->type_name("T.csv");
    command
        .add_option("--energy", c.tables.energy,
                    "CSV: one row per frame, with energies, momenta and contacts; - is standard output")
        ->check(csv_name())
        ->transform(or_standard_output())
        ->type_name("E.csv");
    CLI::Option* step = command
                            .add_option("--step", c.overrides.step,
                                        "The fixed step in s, in place of the scene's; it must divide 1/fps")
                            ->check(number())
                            ->type_name("H");
    command.add_option("--steps-per-frame", c.overrides.steps_per_frame, "The same as a number of steps per frame")
        ->excludes(step)
        ->check(number())
        ->type_name("N");
    offer(command.add_option("--integrator", c.overrides.integrator,
                             "Method that advances the bodies from step to step, in place of the scene's"),
          "symplectic-euler|explicit-euler|splitting|rk4|exact");
    command
        .add_option_function<std::string>(
            "--impacts", [&c](const std::string& text) { read_impacts(text, c); },
            "stepped: resolved in the steps; exact: each at its own time. Or a table: a row for each\nimpulse, as CSV "
            "or "
            ".npz; - is standard output. Give it twice for both")
        ->take_all()
        ->allow_extra_args(false)
        ->trigger_on_parse()
        ->check(one_of("stepped|exact"))
        ->check(file_name("csv npz"))
        ->option_text("stepped|exact|I.csv");
    CLI::Option* const contacts =
        command
            .add_option("--contacts", c.tables.contacts,
                        "CSV or .npz: one row per frame and contact point, with forces and slip; - is standard\noutput")
            ->check(file_name("csv npz"))
            ->transform(or_standard_output())
            ->type_name("C.csv");
    command
        .add_option("--contacts-every", c.tables.contacts_every,
                    "Rows of --contacts in every N-th frame only: 0, N, 2 N, ...")
        ->check(number_within(1, 1e9))
        ->needs(contacts)
        ->option_text("N [1]");
    command
        .add_option("--loads", c.tables.loads,
                    "CSV or .npz: one row per frame and dynamic body, with the force and moment of gravity,\nwind and "
                    "[[force]]s; - is standard output")
        ->check(file_name("csv npz"))
        ->transform(or_standard_output())
        ->type_name("L.csv");
    command
        .add_option(
            "--joints", c.tables.joints,
            "CSV or .npz: one row per frame and joint, with coordinates, speeds, force and torque,\ngap, limits "
            "and breaking; - is standard output")
        ->check(file_name("csv npz"))
        ->transform(or_standard_output())
        ->type_name("J.csv");
    command
        .add_option(
            "--breaks", c.tables.breaks,
            "CSV or .npz: one row per bond of a breakable body that failed, with its load; - is\nstandard output")
        ->check(file_name("csv npz"))
        ->transform(or_standard_output())
        ->type_name("B.csv");
    command
        .add_option("--sound", c.sound,
                    "The sound of impacts, sliding and rolling: a WAV file, 48000 samples a second. The times of the\n"
                    "impacts are exact")
        ->check(file_name("wav"))
        ->type_name("S.wav");
    offer(command.add_option("--impact-law", c.overrides.impact_law, "Rule for several contacts at once"),
          "propagating|simultaneous");
    add_frames_of_time(command, c.overrides);
    add_checkpoints(command, c);
    c.threads = machine_threads();
    add_run(command, c.threads, std::to_string(c.threads), c.quiet);
    command.examples =
        "  tumble simulate scene.toml --checkpoints states --every 10\n"
        "  tumble simulate scene.toml --from-checkpoints states --start 50 --energy e.csv\n"
        "  tumble simulate scene.toml --trajectory t.csv --energy e.csv\n"
        "  tumble simulate scene.toml --energy e.csv --fps 1000 --steps-per-frame 1   every step is a row";
    command.logs = true;
    command.run = [&c] {
        run_simulate(c);
        return 0;
    };
}

}  // namespace tumble
