// The way in which joined bodies move in a step, decided once per island before the forces.
//
// free     nothing is touched: flight in joint coordinates (sim/articulation)
// sweeps   in single precision (sim/contact/soft): nets, whose joints are so entangled that a direct solution is dear,
// and
//          crowds of figures, with all that they touch
// direct   contacts and joints in one solution (sim/contact/direct)
#pragma once

#include "scene/description/description.h"
#include "sim/joints/joint.h"
#include "sim/joints/settings.h"
#include "sim/snapshot/joint_report.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class JointSet;
struct JointGroup;

/// The joined bodies of an island, as long as their joints hold.
struct MechanismFacts {
    bool flies = true;            // in joint coordinates: its joints and integrators are known to flight
    bool known_to_sweeps = true;  // the same for sweeps
    bool net = false;
    bool entangled = false;   // a net with more joints than bodies: errors then take many sweeps to spread
    bool other = false;       // has a group that is neither a net nor a figure
    std::size_t figures = 0;  // bodies
};

/// The contacts of an island.
struct ContactFacts {
    bool within_reach = false;  // has manifolds
    bool touching = false;      // within the tolerance, or the bodies meet in the step
    bool crowd = false;         // FigureCrowd::swept()
};

struct IslandWay {
    JointWay way = JointWay::direct;
    bool net = false, entangled = false;
};

/// The decision:
/// - nets are solved in sweeps; where one touches joined bodies that sweeps do not know, directly
/// - figures within reach of contacts are solved in sweeps while they are a crowd
/// - bodies that touch nothing are free, if flight knows their joints
/// - all others are solved directly
JointWay choose_way(const MechanismFacts& mechanism, const ContactFacts& contacts);

/// Groups that are solved in sweeps, if sweeps know their joints: none, groups that are costly to factor, or all.
enum class SweepRule : std::uint8_t { none, dear, all };
SweepRule sweep_rule(const SimulationSettings& settings);

/// True if sweeps know the joint: it holds two anchors together and locks or limits turns, with dampers or friction of
/// turns, or it holds their distance. Springs, motors, strengths, gears, sliding joints and restitution at limits are
/// left to the direct solver.
bool known_to_sweeps(const Joint& joint);

/// Block products of a factorization per body of the group, without contacts.
double factor_work(const JointGroup& group, const JointSet& joints);

MechanismFacts facts_of(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies,
                        SweepRule rule);

/// Decides if the figures that touch something are so many that they are solved in sweeps, with a hysteresis: a heap
/// that alternated between the solvers would rock.
class FigureCrowd {
public:
    /// Once a step: bodies of the figures that touch something.
    void count(std::size_t bodies);
    bool swept() const { return left_ > 0; }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [left] = self;
        archive.between(0, left, tuning::figure_wait);
    }

private:
    int left_ = 0;  // steps for which they stay in sweeps
};

/// The mechanisms of a world, found anew when joints begin or end to hold.
class Mechanisms {
public:
    void find(const JointSet& joints, const std::vector<Body>& bodies, SweepRule rule);
    /// Facts of an island with joints.
    MechanismFacts facts(std::span<const std::uint32_t> island) const;

private:
    std::vector<MechanismFacts> groups_;
    std::vector<std::uint32_t> group_;         // by body; none for a body of no group
    std::uint64_t found_ = ~std::uint64_t(0);  // JointSet::changes() of the groups
};

// How joined bodies move that touch nothing: the rules, by their joints and integrators.

bool has_springs(const Joint& joint);
bool has_motors(const Joint& joint);
bool has_friction(const Joint& joint);  // of a constant bound
/// True if each spring, motor and friction of the joint acts along one coordinate of a tree: laws of balls do not.
bool acts_along_coordinates(const Joint& joint);
/// True if a side of the joint is a body with a prescribed motion.
bool on_moving_carrier(const Joint& joint, const std::vector<Body>& bodies);
/// True if the laws of these joints are laws of trees in flight: locks, limits, springs, dampers, friction, and motors
/// with one target or with a speed and a bound. One joint may hang on a body with a prescribed motion, if no other
/// joint is anchored.
bool tree_laws(std::span<const Joint* const> joints, const std::vector<Body>& bodies);

/// The integrator of bodies that are joined: the finest of theirs, and splitting before that of Runge and Kutta.
IntegratorKind joined_integrator(const std::vector<Body>& bodies, std::span<const std::uint32_t> joined);
/// True if the integrator's steps end at the times of events.
inline bool fine_integrator(IntegratorKind kind) {
    return kind == IntegratorKind::exact || kind == IntegratorKind::runge_kutta_4;
}

}  // namespace tumble
