#include "app/cli/commands.h"
#include "app/threads/interrupt.h"
#include "app/files/output_plan.h"
#include "app/cli/progress.h"
#include "app/cli/say.h"
#include "app/threads/stage_timer.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/table_writer.h"
#include "sim/world.h"

#include <fmt/format.h>

#include <optional>

namespace tumble {
namespace {

constexpr double interrupt_period = 0.02;   // s between checks for Ctrl-C, because a frame may take only a microsecond

void write_vector(TableWriter& table, const Vec3& v) { table.number(v.x()).number(v.y()).number(v.z()); }

/// One row per frame and movable body, in scene order.
class TrajectoryTable {
public:
    TrajectoryTable(const std::filesystem::path& path, const SceneDescription& scene)
        : scene_(scene), table_(path, "frame,time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz") {}

    void add(const Snapshot& snapshot) {
        for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
            if (scene_.bodies[i].type == BodyType::fixed) continue;
            const BodyState& body = snapshot.bodies[i];
            table_.integer(snapshot.frame).number(snapshot.time).text(scene_.bodies[i].name);
            write_vector(table_, body.center_of_mass);
            const Quat& q = body.orientation;
            table_.number(q.w()).number(q.x()).number(q.y()).number(q.z());
            write_vector(table_, body.velocity);
            write_vector(table_, body.angular_velocity);
            table_.end_row();
        }
    }

    void finish() { table_.finish(); }

private:
    const SceneDescription& scene_;
    TableWriter table_;
};

/// One row per frame, over all dynamic bodies.
class EnergyTable {
public:
    explicit EnergyTable(const std::filesystem::path& path)
        : table_(path, "frame,time,kinetic,potential,total,px,py,pz,lx,ly,lz,contacts,max_penetration") {}

    void add(std::int64_t frame, double time, const Measurement& m) {
        table_.integer(frame).number(time).number(m.kinetic).number(m.potential).number(m.kinetic + m.potential);
        write_vector(table_, m.momentum);
        write_vector(table_, m.angular_momentum);
        table_.integer(m.contacts).number(m.max_penetration);
        table_.end_row();
    }

    void finish() { table_.finish(); }

private:
    TableWriter table_;
};

/// Checks for Ctrl-C and shows the progress, without a system call per frame.
class Watch {
public:
    Watch(std::int64_t frames, bool quiet) : progress_(frames, quiet) {}

    void look(std::int64_t done) {
        const double now = wall_seconds();
        if (now - last_ < interrupt_period) return;
        last_ = now;
        progress_.update(done);
        if (interrupt_.pending()) throw RunError("interrupted");
    }

private:
    Interrupt interrupt_;   // before the world makes its threads
    Progress progress_;
    double last_ = wall_seconds();
};

}  // namespace

void run_simulate(const SimulateCommand& command) {
    const double start = wall_seconds();
    FileList inputs;
    const SceneDescription scene = load_scene(command.scene, command.overrides, &inputs);
    OutputPlan plan;
    for (const auto& file : inputs) plan.add_input(file);
    if (command.trajectory) plan.add("--trajectory", *command.trajectory);
    if (command.energy) plan.add("--energy", *command.energy);
    const std::int64_t frames = scene.frame_count();
    {
        Watch watch(frames, command.quiet);
        World world(scene, command.threads);
        std::optional<TrajectoryTable> trajectory;
        if (command.trajectory) trajectory.emplace(*command.trajectory, scene);
        std::optional<EnergyTable> energy;
        if (command.energy) energy.emplace(*command.energy);

        for (std::int64_t n = 0; n < frames; ++n) {
            if (n > 0) world.advance_frame();
            if (trajectory) trajectory->add(world.snapshot());
            if (energy) energy->add(n, double(n) / scene.output.fps, world.measure());
            watch.look(n + 1);
        }
        if (trajectory) trajectory->finish();
        if (energy) energy->finish();
    }
    if (command.quiet) return;
    const double seconds = wall_seconds() - start;
    for (const auto& file : {command.trajectory, command.energy})
        if (file) say("wrote {}\n", safe_path(*file));
    say("{} frames, {} steps of {:.6g} s, in {:.2f} s ({:.4g} times real time)\n", frames,
               (frames - 1) * scene.simulation.steps_per_frame, scene.step(), seconds,
               double(frames - 1) / scene.output.fps / seconds);
}

}  // namespace tumble
