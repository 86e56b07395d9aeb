// Which joined bodies are solved in sweeps (sim/contact/soft), together with all that they touch, if their joints are such
// as the sweeps know: nets, whose joints are so entangled that a direct solution is dear, and crowds of figures.
#pragma once

#include "sim/joints/joint.h"
#include "sim/joints/settings.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class JointSet;
struct JointGroup;

/// Whether sweeps know the joint: it holds two anchors together and locks or limits turns, with dampers or friction of
/// turns, or it holds their distance. Springs, motors, strengths, gears, sliding joints and restitution at limits are
/// left to the direct solver.
bool known_to_sweeps(const Joint& joint);

/// Block products of a factorization per body of the group, without contacts.
double factor_work(const JointGroup& group, const JointSet& joints);

/// Groups that are solved in sweeps, of those whose joints sweeps know: none, those that are dear to factor, or all.
enum class NetRule : std::uint8_t { none, dear, all };

/// Whether a group of joined bodies is solved in sweeps.
bool is_net(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies, NetRule rule);

/// Whether a group is a figure: a tree without an anchor, of joints that hold anchors together and that sweeps know, between
/// masses that are not too unlike.
bool is_figure(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies, NetRule rule);

/// The groups of joined bodies in an island, as far as they decide on its way.
struct IslandGroups {
    bool net = false, other = false;
    std::size_t figures = 0;  // bodies
    bool unknown = false;     // has a joint, or an integrator, that sweeps do not know
    bool entangled = false;   // a net with more joints than bodies: errors then take many sweeps to spread
};

/// Whether an island with joints is solved by rows, or in sweeps. mixed: by rows, although it has a net.
enum class NetWay : std::uint8_t { direct, sweeps, mixed };

/// `touches`: has manifolds within reach; `crowd`: FigureCrowd::swept().
NetWay choose_way(const IslandGroups& groups, bool touches, bool crowd);

/// Whether the figures that touch something are so many that they are solved in sweeps, with a hysteresis: a heap that
/// alternated between the solvers would rock.
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

/// The nets and figures of a world, found anew when joints begin or end to hold.
class Nets {
public:
    void find(const JointSet& joints, const std::vector<Body>& bodies, NetRule rule);
    IslandGroups groups(std::span<const std::uint32_t> island) const;

private:
    enum class Role : std::uint8_t { none, other, figure, loose, entangled, unknown };
    std::vector<Role> role_;                   // by body
    std::uint64_t found_ = ~std::uint64_t(0);  // JointSet::changes() of the roles
};

}  // namespace tumble
