// Sleep: islands at rest are excluded from the simulation until something touches them.
// A body is at rest when, in one of several time spans, its surface has stayed near its position and its velocity does
// not change steadily. A slow slide gains speed from sample to sample and a body that turns back on a slope is slowed
// as evenly, at any scale; trembling and settling bodies show neither. Dampers in joints bring bodies to rest over
// seconds, with a change that decreases in proportion to the velocity: they are at rest once the way that is left is as
// short. An island sleeps when all its bodies are at rest and it touches a support that stands, fixed or kinematic.
// Still water is a support, too; waves keep what they wet awake.
// Bodies in free flight never sleep, however slow.
#pragma once

#include "sim/contact/model/contact_islands.h"
#include "sim/contact/model/settings.h"
#include "sim/geometry/manifold.h"

#include <array>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace tumble {

class ForceField;
class JointSet;

class SleepMonitor {
public:
    explicit SleepMonitor(std::size_t bodies) : watches_(bodies), trends_(bodies), groups_(bodies) {}

    /// Wakes bodies that an awake or moving kinematic body touches, or will before the end of the step of h seconds
    /// (speeds change by up to `speed_change`, m/s), each with the whole group that it fell asleep with. Precondition:
    /// the narrow phase has run. Returns whether any body woke.
    bool wake_touched(const std::vector<Manifold>& manifolds, std::vector<Body>& bodies, double h, double speed_change);

    /// Wakes one body and its group.
    void wake(std::uint32_t body, std::vector<Body>& bodies);

    /// Bodies have vanished or appeared.
    void exchange(std::span<const std::uint32_t> changed);

    /// Observes the awake bodies over a step of h seconds and puts islands at rest to sleep. `speed_change` (m/s): by
    /// gravity in the step. `water`: the forces of a scene with water at `time` (s), otherwise null.
    void observe(const ContactIslands& islands, const std::vector<Manifold>& manifolds, std::vector<Body>& bodies,
                 double h, double speed_change = 0.0, const JointSet* joints = nullptr,
                 const ForceField* water = nullptr, double time = 0.0);

    /// True if the sleeping bodies are just the members of the groups that they fell asleep with.
    bool sound(const std::vector<Body>& bodies) const;

    /// Increases whenever a body falls asleep or wakes.
    std::uint64_t changes() const { return changes_; }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [watches, trends, groups, changes, sleepers] = self;
        archive.by_body(watches);
        archive.by_body(trends);
        archive.by_body(groups);
        archive.rebuilt(changes);
        archive.scratch(sleepers);  // follows from the groups
        if constexpr (!std::is_const_v<Self>) self.count_sleepers();
    }

private:
    struct Span {
        Vec3 position = Vec3::Constant(1e300);  // m, world, at the start of the span
        Quat orientation = Quat::Identity();
        double still = 0.0;  // s
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [position, orientation, still] = self;
            archive.keep(position, orientation, still);
        }
    };
    using Spans = std::array<Span, tuning::sleep_times.size()>;
    struct Trend {
        using Velocity = Eigen::Matrix<double, 6, 1>;  // m/s, of the center, and of the surface relative to it
        Velocity velocity = Velocity::Zero(),
                 change = Velocity::Zero();    // at the last sample; change since the one before
        double damped = 0.0, left = infinity;  // s and m: time for which it has decayed, and way that is left to it
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [velocity, change, damped, left] = self;
            archive.keep(velocity, change, damped);
            archive.unbounded(left);
        }
    };
    /// Read and written for each awake body in each step; the rest of a body's state is at its samples only.
    struct Watch {
        Spans spans;
        double since = 0.0;  // s, since the last sample
        int steady = 0;      // consecutive samples without rest
        bool ends = false;   // true if the way that is left to a motion that decays is short enough
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [spans, since, steady, ends] = self;
            archive.keep(spans, since, ends);
            archive.count(steady);
        }
    };
    void count_sleepers();
    static bool follow(Spans& spans, const Body& body, double h);
    static void sample(Watch& watch, Trend& trend, const Body& body, double speed_change);
    static double way_left(const Trend& before, const Trend& now, double since);
    /// Observes a body over h seconds. Returns true if it is at rest.
    bool rests(std::uint32_t i, const Body& body, double h, double speed_change);
    void lay_down(std::vector<std::uint32_t> members, std::vector<Body>& bodies);
    /// Bodies that float and touch nothing are in no island.
    void observe_afloat(const ContactIslands& islands, std::vector<Body>& bodies, double h, double speed_change,
                        const ForceField& water, double time);

    std::vector<Watch> watches_;  // by body
    std::vector<Trend> trends_;
    // Bodies that fell asleep together; set while asleep.
    std::vector<std::shared_ptr<const std::vector<std::uint32_t>>> groups_;
    std::uint64_t changes_ = 0;
    std::size_t sleepers_ = 0;
};

}  // namespace tumble
