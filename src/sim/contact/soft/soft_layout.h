// Layout of a batch's manifolds in the soft kernel's groups (soft_kernel.h), lane by lane. Bodies are in blocks of
// neighbors (BodyBlocks); the manifolds inside a block are colored on their own so that none of one color share a
// body, and so are those between blocks.
//
// A layout is valid while the same pairs touch: that of small islands is kept from step to step.
#pragma once

#include "sim/contact/soft/soft_joint_rows.h"
#include "sim/dynamics/body.h"
#include "sim/geometry/body_pair.h"
#include "sim/geometry/manifold.h"
#include "sim/math/bounds_tree.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

// Layout of a batch's joints in the soft kernel's groups (soft_joint_rows.h), lane by lane: as the layout of manifolds
// (soft_layout.h), in the same blocks of bodies. Joints of a block are colored so that none of one color share a body
// that impulses move, and so are those between blocks; a group has joints of one kind.

class JointLayout {
public:
    static constexpr std::uint32_t none = UINT32_MAX;

    struct Place {
        std::uint32_t slot_a = 0, slot_b = 0;  // 0: a body that impulses do not move
        std::uint32_t home = 0;                // block, or the number of blocks for a joint between two
        soft::JointKind kind = soft::JointKind::point;
    };

    /// `slots`: their number; `homes`: number of blocks plus one.
    void color(std::span<const Place> places, std::size_t slots, std::size_t homes, std::size_t lanes);

    std::size_t groups() const { return first_group_.back(); }
    /// First color of a block, or of the joints between blocks; first group of a color.
    std::size_t first_color(std::size_t home) const { return first_color_[home]; }
    std::size_t first_group(std::size_t color) const { return first_group_[color]; }
    soft::JointKind kind(std::size_t group) const { return kinds_[group]; }
    const soft::JointKind* kinds() const { return kinds_.data(); }
    /// By group: its index among groups that turn; meaningless for other groups.
    const std::uint32_t* angular_indices() const { return angular_indices_.data(); }
    std::size_t turning_groups() const { return turning_; }
    /// By lane of all groups: index among the entries; none in unused lanes.
    std::uint32_t joint(std::size_t lane) const { return lane_joints_[lane]; }

private:
    struct Taken {
        std::uint64_t inside = 0, across = 0;
    };
    std::vector<Taken> taken_;          // by slot: colors, inside the block and between blocks
    std::vector<std::uint32_t> class_;  // by joint: home, color, kind
    std::vector<std::uint32_t> at_;     // by class: number, then the next lane
    std::vector<std::size_t> first_group_{0}, first_color_{0};
    std::vector<soft::JointKind> kinds_;  // by group
    std::vector<std::uint32_t> angular_indices_;
    std::size_t turning_ = 0;
    std::vector<std::uint32_t> lane_joints_;
};

}  // namespace tumble

namespace tumble::tuning {

/// Bodies in a block that one thread owns: their states (64 bytes each) fill the first-level cache of a core. Not
/// fitted: follows from the size of the cache.
inline constexpr std::size_t soft_block_bodies = 512;

/// Steps for which manifolds keep their slots in the batches. No result depends on it.
inline constexpr int soft_layout_steps = 32;

}  // namespace tumble::tuning

namespace tumble {

// Splits the bodies of islands into blocks of neighbors, one thread each: large islands are cut at the median along the
// longest side of their box, recursively, until each block is small enough (k-d tree, Bentley 1975); small islands
// share a block. The cuts of an island depend on its own bodies alone.
class BodyBlocks {
public:
    /// `most`: largest number of bodies of a block.
    explicit BodyBlocks(std::size_t most) : most_(most) {}

    void clear();
    /// Adds an island. Precondition: its bodies are ascending.
    void add(std::span<const std::uint32_t> island, const std::vector<Body>& bodies);

    /// All bodies, block by block.
    const std::vector<std::uint32_t>& order() const { return order_; }
    std::size_t size() const { return first_.size() - 1; }
    /// Position in the order where a block begins; for size(), the end.
    std::size_t first(std::size_t block) const { return first_[block]; }

private:
    void cut(std::span<PlacedBody> items);

    std::size_t most_;
    std::vector<std::uint32_t> order_;
    std::vector<std::size_t> first_{0};
    bool open_ = false;  // the last block accepts further small islands
    std::vector<PlacedBody> items_, halves_;
};

/// A batch: manifolds (ascending) and dynamic bodies of one island or several, solved together.
struct IslandBatch {
    std::vector<std::uint32_t> bodies, manifolds;
    std::vector<BodyPair> pairs;           // body pairs of the manifolds, in their order
    std::vector<std::size_t> island_ends;  // positions in `bodies`
    std::vector<std::uint32_t> joints;     // of nets: indices into JointSet::joints(), net by net
    std::vector<double> lost;    // J, of each net: IslandEnergies::hold(); updated by the solve. Empty without joints
    int substep_multiplier = 1;  // substep multiplier
    bool closes = false;         // gaps of joints are closed at the end of each step
};

struct Joint;

class SoftLayout {
public:
    static constexpr std::uint32_t none = UINT32_MAX;

    /// A kinematic body, as seen by all its manifolds, or a rotating one as seen by one of them: carried bodies differ
    /// in where they are carried to. It has a slot of its own: it moves, and is never written.
    struct Mover {
        std::uint32_t body = 0, manifold = 0;
        auto operator<=>(const Mover&) const = default;
    };
    static Mover mover(const std::vector<Body>& bodies, std::uint32_t body, std::uint32_t manifold);

    struct Island {
        std::size_t first, end;              // positions in the blocks' order
        std::size_t first_block, end_block;  // of a large island, its own blocks
        std::uint8_t touches_static = 0;     // touches a body that stands
        std::uint8_t driven = 0;             // touches a moving kinematic body
    };
    struct Share {
        std::size_t begin, end;
    };

    /// Called in this order: open() by one thread; the next by each thread of a team; close() by one. slot: by body,
    /// set for the batch's own bodies to the position in the blocks' order plus one; 0 for touching bodies that do not
    /// move.
    void open(const IslandBatch& batch, const std::vector<Body>& bodies, std::vector<std::uint32_t>& slot,
              std::size_t team);
    void color(const IslandBatch& batch, const std::vector<Body>& bodies, const std::vector<Manifold>& manifolds,
               const std::vector<std::uint32_t>& slot, std::size_t thread, std::size_t team);
    struct AllJoints {
        const std::vector<Joint>& joints;
        const std::vector<soft::JointKind>& kinds;  // by joint
    };
    /// Adds the joints of a batch that has some, before close().
    void add_joints(const IslandBatch& batch, const AllJoints& all, const std::vector<Body>& bodies,
                    const std::vector<std::uint32_t>& slot, std::size_t lanes);
    void close(const IslandBatch& batch, const std::vector<std::uint32_t>& slot, std::size_t lanes);

    /// True if the layout is valid for one more step with the same pairs: the cuts of large islands depend on the
    /// bodies' positions, and the costs of manifolds change slowly.
    bool lasts() { return lasts_ && ++steps_ < tuning::soft_layout_steps; }

    const BodyBlocks& blocks() const { return blocks_; }
    /// The block of two slots, of which one may be 0, or the number of blocks for slots of two blocks.
    std::size_t home(std::uint32_t a, std::uint32_t b) const {
        if (a != 0 && b != 0 && block_of_[a] != block_of_[b]) return blocks_.size();
        return block_of_[a != 0 ? a : b];
    }
    /// The blocks that belong to a thread.
    Share blocks_of(std::size_t thread, std::size_t team) const {
        return {blocks_.size() * thread / team, blocks_.size() * (thread + 1) / team};
    }
    std::span<const std::uint32_t> bodies_of(std::size_t thread, std::size_t team) const {
        const auto [begin, end] = blocks_of(thread, team);
        return std::span(blocks_.order()).subspan(blocks_.first(begin), blocks_.first(end) - blocks_.first(begin));
    }
    const std::vector<Island>& islands() const { return islands_; }
    const std::vector<Mover>& movers() const { return movers_; }  // ascending

    /// Slots of a joint's bodies, and whether impulses move them.
    struct JointEnds {
        std::uint32_t slot_a = 0, slot_b = 0;
        bool moved_a = false, moved_b = false;
    };
    const JointLayout& joints() const { return joints_; }
    const JointEnds& joint_ends(std::uint32_t place) const { return joint_ends_[place]; }

    std::size_t groups() const { return first_group_.back(); }
    /// Colors of a block, or, for the number of blocks, of the manifolds between blocks; and the first group of a
    /// color.
    std::size_t first_color(std::size_t home) const { return first_color_[home]; }
    std::size_t first_group(std::size_t color) const { return first_group_[color]; }
    /// By lane of all groups; none in unused lanes.
    std::uint32_t manifold(std::size_t lane) const { return lane_manifolds_[lane]; }

private:
    void add_rest(const IslandBatch& batch, const std::vector<std::uint32_t>& slot, std::size_t lanes);

    BodyBlocks blocks_{tuning::soft_block_bodies};
    std::vector<Island> islands_;
    std::vector<std::uint32_t> block_of_, island_of_;  // by slot
    std::vector<Mover> movers_;
    std::vector<std::vector<Mover>> found_movers_;  // by thread
    struct Taken {
        std::uint64_t inside = 0, across = 0;
    };
    std::vector<Taken> taken_;          // by slot: colors, inside the block and between blocks
    std::vector<std::uint32_t> class_;  // by manifold of the batch: home, color, cost
    std::vector<std::uint32_t> class_size_;
    std::vector<std::size_t> first_group_;  // of each color in use, and the end
    std::vector<std::size_t> first_color_;  // of each block, then of the manifolds between blocks, and the end
    std::vector<std::uint32_t> lane_manifolds_;
    JointLayout joints_;
    std::vector<JointLayout::Place> joint_places_;
    std::vector<JointEnds> joint_ends_;
    struct JointMover {
        std::uint32_t place = 0, body = 0;
        bool second = false;
    };
    std::vector<JointMover> joint_movers_;  // kinematic bodies of joints
    bool lasts_ = false;
    int steps_ = 0;  // since the layout was made
};

}  // namespace tumble
