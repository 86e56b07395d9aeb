// JointRows: gears. A gear's impulse acts along the coordinates of its two joints, for each equal and opposite on the
// two bodies and at one point.
#include "core/disjoint_sets.h"
#include "sim/contact/direct/joint_rows.h"
#include "sim/joints/gear.h"

#include <algorithm>
#include <cmath>

namespace tumble {
// Without loops of joints all coordinates are independent, and gears whose joints form no ring are, too.
bool JointRows::geared_forest(const JointIsland& island) const {
    const std::vector<std::uint32_t>& active = island.problem.joints->active();
    DisjointSets bodies(island.bodies.size() + 1), joints(island.joints.size());
    const auto node = [&](std::uint32_t body) {
        const int place = contact_rows::place_of(island.bodies, body);
        return place == none ? island.bodies.size() : std::size_t(place);  // all that is fixed is one node
    };
    const auto number = [&](std::size_t joint) {
        const auto at = std::lower_bound(island.joints.begin(), island.joints.end(), joint,
                                         [&](std::uint32_t k, std::size_t other) { return active[k] < other; });
        return std::size_t(at - island.joints.begin());
    };
    for (const std::uint32_t k : island.joints) {
        const Joint& j = (*joints_)[active[k]];
        const bool open = j.gear() ? joints.join(number(j.description.geared[0]), number(j.description.geared[1]))
                                   : bodies.join(node(j.a), node(j.b));
        if (!open) return false;
    }
    return true;
}

// The row is unit_1 (theta_1' + ratio theta_2'), where the unit of an angle is the island's length.
void JointRows::add_gear(const JointIsland& island, std::uint32_t index) {
    const Joint& gear = (*joints_)[index];
    Gear& row_of = gears_.emplace_back();
    Block& block = blocks_.emplace_back();
    block.joint = index;
    block.gear = &row_of;
    block.first = rows_.size();
    block.count = 1;
    Row row;
    const GearGeometry g = place_gear(island, block, row);
    const std::size_t first = row.coordinate;
    const double unit = row.turns() ? length_ : 1.0;
    double square = 0.0;
    for (const GearSide& side : row_of.sides) square += side.factor * side.factor;
    row.law = Joint::lock;
    row.closes = true;
    row.compliance = compliance_ * square;  // as of a row of unit length
    row.least = -infinity;
    row.most = infinity;
    row.reference = std::abs(g.error) <= closed_share() * (row.turns() ? 1.0 : gear.size) ? 0.0 : g.error;
    row.target = unit * ((row.reference - g.error) / h_ + h_ * gear.curving[first]);
    row_of.value = std::max(std::abs(g.value[0]), std::abs(g.value[1] * gear.description.ratio));
    append_row(row);
}

// Where the row acts at the present poses.
GearGeometry JointRows::place_gear(const JointIsland& island, Block& block, Row& row) {
    const Joint& gear = joint(block);
    const GearGeometry g = measure_gear(gear, *joints_, [&](std::uint32_t body) { return side_at(island, body); });
    const auto unit_of = [&](std::size_t coordinate) { return coordinate < 3 ? 1.0 : length_; };
    Gear& row_of = *block.gear;
    row_of.row.clear_numbers();
    block.point = g.joints[0].point;
    const std::size_t first = geared_coordinate((*joints_)[gear.description.geared[0]]);
    const double unit = unit_of(first);
    double offset = 0.0;
    for (std::size_t s = 0; s < 2; ++s) {
        GearSide& side = row_of.sides[s];
        side.joint = std::uint32_t(gear.description.geared[s]);
        const Joint& of = (*joints_)[side.joint];
        const std::size_t k = geared_coordinate(of);
        side.turns = k >= 3;
        side.factor = s == 0 ? 1.0 : gear.description.ratio * unit / unit_of(k);
        Block place;
        place.joint = side.joint;
        place.a = side.a = contact_rows::place_of(island.bodies, of.a);
        place.b = side.b = contact_rows::place_of(island.bodies, of.b);
        place.point = side.point = g.joints[s].point;
        side.direction = g.coordinate(of, s).direction;
        const Row part = make_row(island, place, side.direction, k);
        if (side.a != none) row_of.row.add_side(side.a, part.on_a, side.factor);
        if (side.b != none) row_of.row.add_side(side.b, part.on_b, side.factor);
        offset += side.factor * part.offset;
    }
    row.coordinate = std::uint8_t(first);
    row.direction = row_of.sides[0].direction;
    row.offset = offset;
    return g;
}

JointReaction JointRows::reaction_of(const Block& block, std::size_t which) const {
    const GearSide& side = block.gear->sides[which];
    JointReaction reaction;
    const double amount = side.factor * rows_[block.first].impulse;
    (side.turns ? reaction.torque : reaction.force) = (side.turns ? length_ : 1.0) * amount * side.direction;
    reaction.moment = side.point.cross(reaction.force) + reaction.torque;
    return reaction;
}

double JointRows::gear_error(const JointIsland& island, const Block& block, std::span<const JointSide> ends) const {
    const auto end = [&](std::uint32_t body) {
        return end_of(island, body, contact_rows::place_of(island.bodies, body), ends);
    };
    return measure_gear(joint(block), *joints_, end).error;
}

JointGeometry JointRows::measure_end(const JointIsland& island, const Block& block,
                                     std::span<const JointSide> ends) const {
    if (block.gear) return {};
    const Joint& j = joint(block);
    return measure(j, end_of(island, j.a, block.a, ends), end_of(island, j.b, block.b, ends));
}

double JointRows::value_of(const JointIsland& island, const Block& block, const Row& row, const JointGeometry& g,
                           std::span<const JointSide> ends) const {
    return block.gear ? gear_error(island, block, ends) : g.coordinates[row.coordinate].value;
}

// Equal and opposite, about one point for each of the two joints.
void JointRows::give_gear(const JointIsland& island, const Block& block) const {
    std::vector<Body>& bodies = island.problem.bodies;
    for (std::size_t s = 0; s < 2; ++s) {
        const GearSide& side = block.gear->sides[s];
        const Joint& of = (*joints_)[side.joint];
        const JointReaction reaction = reaction_of(block, s);
        const auto give = [&](std::uint32_t body, int place, double sign) {
            if (place == none) return;
            Body& b = bodies[body];
            b.momentum += sign * reaction.force;
            b.angular_momentum += sign * ((side.point - b.position).cross(reaction.force) + reaction.torque);
        };
        give(of.a, side.a, -1.0);
        give(of.b, side.b, 1.0);
    }
}

void JointRows::account_gear(const JointIsland& island, const Block& block, bool catches, JointAccount::Span& step) {
    double done = 0.0;
    for (std::size_t s = 0; s < 2; ++s) {
        const GearSide& side = block.gear->sides[s];
        const Joint& of = (*joints_)[side.joint];
        const JointReaction reaction = reaction_of(block, s);
        const auto work = [&](std::uint32_t body, int place) {
            const BodyVelocity v = mean_velocity(island, body, place, side.point);
            return reaction.force.dot(v.velocity) + reaction.torque.dot(v.angular_velocity);
        };
        const double on_a = -work(of.a, side.a), on_b = work(of.b, side.b);
        (s == 0 ? step.reaction : step.second_reaction).add(reaction);
        (s == 0 ? step.work_a : step.second_work_a) += on_a;
        (s == 0 ? step.work_b : step.second_work_b) += on_b;
        if (side.a == none) step.work.carriers -= on_a;
        if (side.b == none) step.work.carriers -= on_b;
        done += on_a + on_b;
    }
    if (block.breaks)
        step.work.heat -= done;
    else if (catches)
        step.work.impacts -= done;
    ++step.solves;
}

}  // namespace tumble
