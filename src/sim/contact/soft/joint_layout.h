// Layout of a batch's joints in the soft kernel's groups (soft_joint_rows.h), lane by lane: as the layout of manifolds
// (soft_layout.h), in the same blocks of bodies. Joints of a block are colored so that none of one color share a body
// that impulses move, and so are those between blocks; a group has joints of one kind.
#pragma once

#include "sim/contact/soft/soft_joint_rows.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

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
    /// By group: its place among those that turn; of others meaningless.
    const std::uint32_t* turn_places() const { return turn_places_.data(); }
    std::size_t turning_groups() const { return turning_; }
    /// By lane of all groups: index among the places; none in unused lanes.
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
    std::vector<std::uint32_t> turn_places_;
    std::size_t turning_ = 0;
    std::vector<std::uint32_t> lane_joints_;
};

}  // namespace tumble
