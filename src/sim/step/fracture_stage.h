// Breakable bodies in a step: blows that part them, with the impulses of the blow; and loads of contacts and joints
// that last.
#pragma once

#include "sim/fracture/blow.h"
#include "sim/fracture/breakable_bodies.h"
#include "sim/joints/joint_set.h"
#include "sim/snapshot/break_record.h"
#include "sim/snapshot/contact_records.h"
#include "sim/step/body_set.h"
#include "sim/step/load_watch.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

class ContactDetection;
class MotionStage;
struct StepContext;

class FractureStage {
public:
    FractureStage(const SceneDescription& scene, BodySet& set, JointSet& joints)
        : bodies_(scene, set.scene_index, joints.joints(), set.bodies), last_(bodies_.size()) {}

    bool empty() const { return bodies_.empty(); }
    const BreakableBodies& bodies() const { return bodies_; }

    /// Parts the bodies that the explosions of the step break. Returns whether any does: then the explosions act on the
    /// pieces.
    bool blast(const StepContext& step, ContactDetection& detection, MotionStage& motion);

    /// Resolves the blows of the step that break a body; others are left to the impacts.
    void strike(const StepContext& step, ContactDetection& detection, MotionStage& motion);

    /// The same for an impact at its own time; null where nothing breaks. The event-driven motion knows the pieces
    /// then, and the rest of the world after finish_events().
    const BlowResult* strike(const Island& island, const std::vector<Contact>& contacts, const ImpactSettings& settings,
                             const ImpactTime& when, const StepContext& step);
    void finish_events(const StepContext& step, ContactDetection& detection, MotionStage& motion);

    /// `step`: the coming one. Parts the bodies that the contacts and joints of the last step, and their own rotation,
    /// load beyond their strength. They go on as they moved.
    void yield(const StepContext& step, ContactDetection& detection, MotionStage& motion);

    /// The bonds that failed in the frame.
    void begin_frame() { breaks_.clear(); }
    const std::vector<BreakRecord>& breaks() const { return breaks_; }

    /// After the bonds of a checkpoint have been read, and after all of it.
    void restored(const StepContext& step, MotionStage& motion) const;
    void rebuild(BodySet& set, JointSet& joints) { bodies_.rebuild(set.bodies, joints.joints()); }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [bodies, last, breaks, loads, now, event, exchanged, watch, margins] = self;
        archive.keep(bodies, breaks);
        archive.scratch(loads, now, event, exchanged);
        archive.scratch(watch, margins);  // it saves work alone
        for (auto& load : last) archive.keep(load);
    }

private:
    /// A force on a piece, in the frame of the body.
    struct Load {
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero(), point = Vec3::Zero();  // N, N m about the point, m
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [force, torque, point] = self;
            archive.keep(force, torque, point);
        }
    };
    /// The loads of a body when its bonds were last examined, and how near the weakest was to failing. An impulse is no
    /// lasting load: the cells bear the mean of their loads over the time of a blow.
    struct Examined {
        std::vector<Load> loads;
        std::vector<Wrench> cells, means;  // N and N m, by cell: of the loads, and their means
        int settling = 0;                  // steps until these are equal
        double utilization = 0.0;
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [loads, cells, means, settling, utilization] = self;
            archive.keep(loads, cells, means, utilization);
            archive.count(settling);
        }
    };
    static constexpr std::uint32_t no_manifold = UINT32_MAX;
    struct PieceLoad {
        std::uint32_t entry, piece;
        std::uint32_t manifold;  // or no_manifold
        Load load;
    };
    static Load load_on(const Body& body, const Vec3& force, const Vec3& torque, const Vec3& point);
    void find_loads(const StepContext& step, ContactDetection& detection);
    /// Compares two lists of equally many loads. `size`: m, arm that turns torques into forces.
    struct Difference {
        double change = 0.0, sum = 0.0;  // N, the sum of the second list
        double moved = 0.0;              // the largest distance of two points, over the size
    };
    static Difference difference(const std::vector<Load>& then, const std::vector<Load>& now, double size);
    /// The bonds of an entry that remain under loads on its cells (N, N m); nothing if all of them hold.
    std::optional<BondGraph> cut(std::uint32_t entry, std::span<const Wrench> loads, const StepContext& step,
                                 std::vector<BreakRecord>& breaks, double& utilization);
    /// Takes the bonds over; the pieces go on as the body moved.
    void part(std::uint32_t entry, BondGraph graph, std::vector<BreakRecord>& breaks, const StepContext& step,
              std::vector<BreakableBody::Parting>& partings);
    void finish(std::span<const BreakableBody::Parting> partings, const StepContext& step, ContactDetection& detection,
                MotionStage& motion);
    std::vector<Wrench> loads_of_cells(std::uint32_t entry, std::span<const PieceLoad> loads,
                                       const StepContext& step) const;
    std::optional<BondGraph> examine(std::uint32_t entry, std::span<const PieceLoad> loads, const StepContext& step,
                                     std::vector<BreakRecord>& breaks);
    bool strike_one(const StepContext& step, ContactDetection& detection, MotionStage& motion);
    bool struck(std::span<const std::uint32_t> manifolds, const StepContext& step, ContactDetection& detection) const;
    void move_forces(const StepContext& step) const;
    std::vector<BodyInPieces> in_pieces() const;
    void take(const BlowResult& result, const StepContext& step, const ImpactTime& when);
    void exchange(std::span<const std::uint32_t> changed, const StepContext& step, ContactDetection& detection);

    BreakableBodies bodies_;
    std::vector<Examined> last_;  // by entry
    std::vector<BreakRecord> breaks_;
    std::vector<PieceLoad> loads_;          // of the step, by entry
    std::vector<Load> now_;                 // of the body at hand
    BlowResult event_;                      // of the last event
    std::vector<std::uint32_t> exchanged_;  // by events
    LoadWatch watch_;
    std::vector<LoadWatch::Margin> margins_;  // of the step, by entry
};

}  // namespace tumble
