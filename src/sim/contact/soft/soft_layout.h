// Where the manifolds of a part go in the soft kernel's groups (soft_kernel.h), lane by lane: bodies in blocks of neighbours
// (body_blocks.h), the manifolds inside of a block coloured by themselves so that none of a colour share a body, those between
// blocks apart.
//
// A layout holds as long as the same pairs touch: that of small islands is kept from step to step.
#pragma once

#include "sim/contact/soft/settings.h"
#include "sim/geometry/body_pair.h"
#include "sim/geometry/manifold.h"
#include "sim/contact/soft/body_blocks.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// What is solved together: manifolds (ascending) and dynamic bodies of one island or several.
struct SoftPart {
    std::vector<std::uint32_t> bodies, manifolds;
    std::vector<BodyPair> pairs;              // whose the manifolds are, one by one
    std::vector<std::size_t> island_ends;     // in `bodies`
    int finer = 1;                            // substeps in place of one
};

class SoftLayout {
public:
    static constexpr std::uint32_t none = UINT32_MAX;

    /// A kinematic body, as all its manifolds see it, or one that turns as one of them does: riders differ in where they are
    /// carried to. It has a slot of its own: it moves, and is never written to.
    struct Mover {
        std::uint32_t body = 0, manifold = 0;
        auto operator<=>(const Mover&) const = default;
    };
    static Mover mover(const std::vector<Body>& bodies, std::uint32_t body, std::uint32_t manifold);

    struct Island {
        std::size_t first, end;               // places in the blocks' order
        std::size_t first_block, end_block;   // its own if they are several
        std::uint8_t leans = 0;               // on what stands
        std::uint8_t driven = 0;              // by a kinematic body
    };
    struct Share {
        std::size_t begin, end;
    };

    /// In turn: by one thread; by each of a team of so many; by one. slot: by body, the part's own are set, to its place in the
    /// blocks' order plus one; what touches them and does not move has 0.
    void open(const SoftPart& part, const std::vector<Body>& bodies, std::vector<std::uint32_t>& slot, std::size_t team);
    void color(const SoftPart& part, const std::vector<Body>& bodies, const std::vector<Manifold>& manifolds,
               const std::vector<std::uint32_t>& slot, std::size_t thread, std::size_t team);
    void close(const SoftPart& part, std::size_t lanes);

    /// Whether it is good for one more step with the same pairs: where large islands are cut depends on where their bodies are, and
    /// what manifolds cost changes slowly.
    bool lasts() { return lasts_ && ++steps_ < tuning::soft_layout_steps; }

    const BodyBlocks& blocks() const { return blocks_; }
    /// The blocks that belong to a thread.
    Share blocks_of(std::size_t thread, std::size_t team) const {
        return {blocks_.size() * thread / team, blocks_.size() * (thread + 1) / team};
    }
    std::span<const std::uint32_t> bodies_of(std::size_t thread, std::size_t team) const {
        const auto [begin, end] = blocks_of(thread, team);
        return std::span(blocks_.order()).subspan(blocks_.first(begin), blocks_.first(end) - blocks_.first(begin));
    }
    const std::vector<Island>& islands() const { return islands_; }
    const std::vector<Mover>& movers() const { return movers_; }   // ascending

    std::size_t groups() const { return first_group_.back(); }
    /// The colours of a block, or, for the number of blocks, of what lies between them; and where a colour's groups begin.
    std::size_t first_color(std::size_t home) const { return first_color_[home]; }
    std::size_t first_group(std::size_t color) const { return first_group_[color]; }
    /// By lane of all groups; none in lanes left over.
    std::uint32_t manifold(std::size_t lane) const { return lane_manifolds_[lane]; }

private:
    BodyBlocks blocks_{tuning::soft_block_bodies};
    std::vector<Island> islands_;
    std::vector<std::uint32_t> block_of_, island_of_;   // by slot
    std::vector<Mover> movers_;
    std::vector<std::vector<Mover>> found_movers_;      // by thread
    struct Taken {
        std::uint64_t inside = 0, across = 0;
    };
    std::vector<Taken> taken_;                          // by slot: colours, inside of the block and between blocks
    std::vector<std::uint32_t> class_;                  // by manifold of the part: home, colour, cost
    std::vector<std::uint32_t> class_size_;
    std::vector<std::size_t> first_group_;              // of each colour that is used, and the end
    std::vector<std::size_t> first_color_;              // of each block, then of what lies between them, and the end
    std::vector<std::uint32_t> lane_manifolds_;
    bool lasts_ = false;
    int steps_ = 0;   // since it was made
};

}  // namespace tumble
