// The bodies of a world, and the lists that the stages of a step loop over: the cost of a step scales with the awake
// bodies.
#pragma once

#include "sim/contact/model/sleep.h"
#include "sim/dynamics/body.h"
#include "sim/event_driven/event_time.h"

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace tumble {

struct BodySet {
    /// With the method of the notes the bodies are in the order of the scene. With exact impacts their coordinates and
    /// their order follow from the scene alone: see local_frame.h.
    explicit BodySet(const SceneDescription& scene);

    Vec3 origin = Vec3::Zero();              // m, world: origin of the bodies' coordinates
    std::vector<Body> bodies;                // in their order in memory
    std::vector<std::uint32_t> scene_index;  // by body: its index in the scene
    std::vector<std::uint32_t> of_scene;     // by index in the scene: index in `bodies`
    // Indices of bodies, ascending. awake: dynamic and not asleep; kinematic: with a track; moving: both together.
    std::vector<std::uint32_t> awake, moving, kinematic;
    std::vector<BodyVelocity> old_velocities;  // by body: at the start of the step, before its forces
    std::vector<BodyVelocity> motions;         // by body: velocities that move its pose in this step; zero if it rests

    /// Updates the lists if a body has fallen asleep or woken. Returns whether they changed.
    bool list(const SleepMonitor& sleep);
    /// Bodies have vanished or appeared, at rest relative to the step's start; `changed` ascends.
    void exchange(std::span<const std::uint32_t> changed);
    /// Places the kinematic bodies on their tracks at the start of a step, with the velocities of that step.
    void place_kinematic(const StepClock& clock, std::int64_t step);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [origin, bodies, scene_index, of_scene, awake, moving, kinematic, old_velocities, motions,
               seen_sleep_changes] = self;
        archive.rebuilt(origin, scene_index, of_scene, seen_sleep_changes);
        archive.by_body(old_velocities);
        archive.by_body(motions);
        archive.keep_each(bodies);
        archive.scratch(awake, moving, kinematic);  // follow from the bodies
        if constexpr (!std::is_const_v<Self>) self.list();
    }

private:
    void list();
    void list_kinematic();

    std::uint64_t seen_sleep_changes_ = UINT64_MAX;
};

}  // namespace tumble
