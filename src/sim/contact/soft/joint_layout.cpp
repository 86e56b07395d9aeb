#include "sim/contact/soft/joint_layout.h"

#include <algorithm>
#include <bit>

namespace tumble {
namespace {

constexpr std::size_t joint_colors = 64;  // bits of a mask; a joint without a free color is solved one by one
using soft::joint_kinds;

}  // namespace

// Greedy coloring in the joints' order, as SoftLayout::color().
void JointLayout::color(std::span<const Place> places, std::size_t slots, std::size_t homes, std::size_t lanes) {
    taken_.assign(slots, {});
    class_.resize(places.size());
    at_.assign(homes * joint_colors * joint_kinds, 0);
    for (std::size_t k = 0; k < places.size(); ++k) {
        const Place& place = places[k];
        const bool across = place.home + 1 == homes;
        std::uint64_t fixed_a = 0, fixed_b = 0;
        const auto colors_of = [&](std::uint32_t slot, std::uint64_t& fixed) -> std::uint64_t& {
            return slot == 0 ? fixed : across ? taken_[slot].across : taken_[slot].inside;
        };
        std::uint64_t &of_a = colors_of(place.slot_a, fixed_a), &of_b = colors_of(place.slot_b, fixed_b);
        const auto c = std::size_t(std::countr_one(of_a | of_b));
        if (c == joint_colors) {
            class_[k] = none;
            continue;
        }
        of_a |= std::uint64_t(1) << c;
        of_b |= std::uint64_t(1) << c;
        class_[k] = std::uint32_t((place.home * joint_colors + c) * joint_kinds + std::size_t(place.kind));
        ++at_[class_[k]];
    }
    std::size_t groups = 0;
    first_group_.clear();
    first_color_.assign(1, 0);
    kinds_.clear();
    for (std::size_t home = 0; home < homes; ++home) {
        for (std::size_t c = 0; c < joint_colors; ++c) {
            const std::size_t first = groups;
            for (std::size_t kind = 0; kind < joint_kinds; ++kind) {
                std::uint32_t& of_class = at_[(home * joint_colors + c) * joint_kinds + kind];
                const std::size_t needed = (of_class + lanes - 1) / lanes;
                of_class = std::uint32_t(groups * lanes);
                groups += needed;
                kinds_.resize(groups, soft::JointKind(kind));
            }
            if (groups > first) first_group_.push_back(first);
        }
        if (home + 1 < homes) first_color_.push_back(first_group_.size());
    }
    for (std::size_t k = 0; k < places.size(); ++k)
        if (class_[k] == none) {
            first_group_.push_back(groups++);
            kinds_.push_back(places[k].kind);
        }
    first_color_.push_back(first_group_.size());
    first_group_.push_back(groups);

    turn_places_.resize(groups);
    turning_ = 0;
    for (std::size_t g = 0; g < groups; ++g) {
        turn_places_[g] = std::uint32_t(turning_);
        turning_ += soft::turns(kinds_[g]);
    }

    lane_joints_.assign(groups * lanes, none);
    std::size_t alone = groups * lanes;
    for (std::size_t k = places.size(); k-- > 0;)
        if (class_[k] == none) lane_joints_[alone -= lanes] = std::uint32_t(k);
    for (std::size_t k = 0; k < places.size(); ++k)
        if (class_[k] != none) lane_joints_[at_[class_[k]]++] = std::uint32_t(k);
}

}  // namespace tumble
