#include "sim/step/body_set.h"

#include "sim/detection/spatial_sort.h"
#include "sim/dynamics/body_builder.h"
#include "sim/dynamics/kinematic_body.h"
#include "sim/event_driven/local_frame.h"

#include <numeric>

namespace tumble {

BodySet::BodySet(const SceneDescription& scene) {
    const Vec3 gravity = scene.simulation.gravity;
    if (scene.simulation.impacts == ImpactMode::exact) {
        origin = local_origin(scene);
        if (origin.isZero(0.0))
            bodies = build_bodies(scene);
        else
            bodies = build_bodies(seen_from(scene, origin));
        scene_index = put_in_exact_order(bodies, gravity);
    } else if (scene.simulation.method == SimulationMethod::notes) {
        bodies = build_bodies(scene);
        scene_index.resize(bodies.size());
        std::iota(scene_index.begin(), scene_index.end(), 0u);
    } else {
        bodies = build_bodies(scene);
        scene_index = put_in_memory_order(bodies, gravity);
    }
    of_scene.resize(bodies.size());
    for (std::uint32_t i = 0; i < bodies.size(); ++i) of_scene[scene_index[i]] = i;
    old_velocities.resize(bodies.size());
    motions.resize(bodies.size());
    list_kinematic();
}

void BodySet::list_kinematic() {
    kinematic.clear();
    for (std::uint32_t i = 0; i < bodies.size(); ++i)
        if (bodies[i].track) kinematic.push_back(i);
}

void BodySet::exchange(std::span<const std::uint32_t> changed) {
    list_kinematic();
    for (const std::uint32_t i : changed) {
        old_velocities[i] = {bodies[i].velocity, bodies[i].angular_velocity};
        motions[i] = {};
    }
}

bool BodySet::list(const SleepMonitor& sleep) {
    if (sleep.changes() == seen_sleep_changes_) return false;
    seen_sleep_changes_ = sleep.changes();
    list();
    for (std::uint32_t i = 0; i < bodies.size(); ++i)
        if (!bodies[i].moves() || bodies[i].asleep) motions[i] = {};
    return true;
}

void BodySet::list() {
    list_kinematic();
    awake.clear();
    moving.clear();
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        const Body& body = bodies[i];
        if (body.asleep) continue;
        if (body.dynamic()) awake.push_back(i);
        if (body.moves()) moving.push_back(i);
    }
}

void BodySet::place_kinematic(const StepClock& clock, std::int64_t step) {
    for (const std::uint32_t i : kinematic)
        old_velocities[i] = place_on_track(bodies[i], clock.seconds(step), clock.seconds(step + 1), clock.seconds(1));
}

}  // namespace tumble
