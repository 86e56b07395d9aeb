#include "api/scene_data.h"
#include "app/cli/commands.h"
#include "app/cli/progress.h"
#include "app/cli/say.h"
#include "app/files/output_plan.h"
#include "app/threads/interrupt.h"
#include "app/threads/stage_timer.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "tumble/output.h"
#include "tumble/world.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

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

}  // namespace

void run_simulate(const SimulateCommand& command) {
    const double start = wall_seconds();
    FileList inputs;
    SceneDescription description = load_scene(command.scene, command.overrides, &inputs);
    OutputPlan plan;
    for (const auto& file : inputs) plan.add_input(file);
    if (command.trajectory) plan.add("--trajectory", *command.trajectory);
    if (command.energy) plan.add("--energy", *command.energy);
    if (command.impacts) plan.add("--impacts", *command.impacts);
    if (command.contacts) plan.add("--contacts", *command.contacts);
    if (command.loads) plan.add("--loads", *command.loads);
    const v0::Scene scene = v0::make_scene(std::move(description), std::move(inputs));
    const std::int64_t frames = scene.frame_count();
    const double fps = scene.output().fps;
    {
        RunMonitor monitor(frames, command.quiet);
        v0::World world(scene, command.threads);
        std::optional<v0::TrajectoryTable> trajectory;
        if (command.trajectory) trajectory.emplace(*command.trajectory, scene);
        std::optional<v0::EnergyTable> energy;
        if (command.energy) energy.emplace(*command.energy);
        std::optional<v0::ImpactTable> impacts;
        if (command.impacts) impacts.emplace(*command.impacts, scene);
        std::optional<v0::ContactTable> contacts;
        if (command.contacts) contacts.emplace(*command.contacts, scene);
        std::optional<v0::LoadTable> loads;
        if (command.loads) loads.emplace(*command.loads, scene);
        if (energy || impacts || contacts || loads) world.record_contacts();

        for (std::int64_t n = 0; n < frames; ++n) {
            if (n > 0) world.advance_frame();
            if (trajectory) trajectory->add(world.snapshot());
            if (energy) energy->add(n, double(n) / fps, world.energies());
            if (impacts) impacts->add(world.contacts());
            if (contacts) contacts->add(n, double(n) / fps, world.contacts());
            if (loads) loads->add(n, double(n) / fps, world.contacts());
            monitor.update(n + 1);
        }
        if (trajectory) trajectory->finish();
        if (energy) energy->finish();
        if (impacts) impacts->finish();
        if (contacts) contacts->finish();
        if (loads) loads->finish();
    }
    if (command.quiet) return;
    const double seconds = wall_seconds() - start;
    for (const auto& file : {command.trajectory, command.energy, command.impacts, command.contacts, command.loads})
        if (file) say("wrote {}\n", safe_path(*file));
    say("{} frames, {} steps of {:.6g} s, in {:.2f} s ({:.4g} times real time)\n", frames,
        (frames - 1) * scene.steps_per_frame(), scene.step(), seconds, double(frames - 1) / fps / seconds);
}

}  // namespace tumble
