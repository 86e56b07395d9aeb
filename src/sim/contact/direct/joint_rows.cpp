#include "sim/contact/direct/joint_rows.h"

#include "core/deterministic_math.h"
#include "sim/joints/settings.h"
#include "sim/math/keyframe_track.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Errors below this share of the smaller body are moved out by rigid rows: the displacements stay small near singular
/// positions too. Not fitted: below any visible size.
constexpr double joint_correction_small = 1e-6;

double six_dot(const double* row, const std::vector<double>& u, int body) {
    double sum = 0.0;
    for (int k = 0; k < 6; ++k) sum += row[k] * u[std::size_t(6 * body + k)];
    return sum;
}
void six_add(const double* row, double amount, std::vector<double>& to, int body) {
    for (int k = 0; k < 6; ++k) to[std::size_t(6 * body + k)] += amount * row[k];
}

}  // namespace

double JointRows::dot(const Block& block, const Row& row, const std::vector<double>& u) {
    if (block.gear) return block.gear->row.dot(u);
    return (block.a != none ? six_dot(row.on_a, u, block.a) : 0.0) +
           (block.b != none ? six_dot(row.on_b, u, block.b) : 0.0);
}

void JointRows::add(const Block& block, const Row& row, double amount, std::vector<double>& to) {
    if (block.gear) return block.gear->row.add(amount, to);
    if (block.a != none) six_add(row.on_a, amount, to, block.a);
    if (block.b != none) six_add(row.on_b, amount, to, block.b);
}

// H += weight row row^T, in the blocks of both bodies.
void JointRows::add_square(BlockCholesky& matrix, const Block& block, const Row& row, double weight) {
    if (block.gear) return block.gear->row.add_square(matrix, weight);
    using Eight = BlockCholesky::Row;
    const auto add_outer_of = [](BlockCholesky::Block& to, const double* left, const Eight& right) {
        for (int k = 0; k < 6; ++k) to.row[k] += left[k] * right;
    };
    const double *p = row.on_a, *q = row.on_b;
    const Eight a = weight * Eight{p[0], p[1], p[2], p[3], p[4], p[5], 0.0, 0.0};
    const Eight b = weight * Eight{q[0], q[1], q[2], q[3], q[4], q[5], 0.0, 0.0};
    if (block.a != none) add_outer_of(matrix.diagonal(std::size_t(block.a)), row.on_a, a);
    if (block.b != none) add_outer_of(matrix.diagonal(std::size_t(block.b)), row.on_b, b);
    if (block.a == none || block.b == none) return;
    if (matrix.transposed(block.pair))
        add_outer_of(matrix.coupling(block.pair), row.on_b, a);
    else
        add_outer_of(matrix.coupling(block.pair), row.on_a, b);
}

void JointRows::add_pairs(std::vector<BlockCholesky::Pair>& pairs) {
    for (Block& block : blocks_) {
        if (block.gear) block.gear->row.add_pairs(pairs);
        block.pair = std::uint32_t(pairs.size());
        if (block.a != none && block.b != none) pairs.push_back({std::uint32_t(block.a), std::uint32_t(block.b)});
    }
}

void JointRows::evaluate_speeds(const std::vector<double>& u) {
    for (const Block& block : blocks_)
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            rows_[k].speed = rows_[k].offset + dot(block, rows_[k], u);
            rows_[k].change = 0.0;
        }
}

void JointRows::evaluate_changes(const std::vector<double>& du) {
    for (const Block& block : blocks_)
        for (std::size_t k = block.first; k < block.first + block.count; ++k)
            rows_[k].change = dot(block, rows_[k], du);
}

void JointRows::advance_speeds(double along) {
    for (Row& row : rows_) {
        row.speed += along * row.change;
        row.change = 0.0;
    }
}

// f = y where |y| <= most, otherwise most y / |y|; y = e + (b - J u) / R.
JointRows::BallFriction JointRows::ball_friction(const Row* row, double along) {
    BallFriction ball;
    for (Eigen::Index i = 0; i < 3; ++i)
        ball.wanted[i] = row[i].estimate + (row[i].target - row[i].speed - along * row[i].change) / row[i].compliance;
    const double size = ball.wanted.norm();
    ball.slides = size > row->most;
    ball.scale = ball.slides ? row->most / size : 1.0;
    return ball;
}

void JointRows::evaluate(double along) {
    for (std::size_t k = 0; k < rows_.size(); ++k) {
        Row& row = rows_[k];
        if (row.starts_ball) {
            const BallFriction ball = ball_friction(&row, along);
            for (Eigen::Index i = 0; i < 3; ++i) rows_[k++].impulse = ball.scale * ball.wanted[i];
            --k;
            continue;
        }
        const double y = row.estimate + (row.target - row.speed - along * row.change) / row.compliance;
        row.impulse = std::clamp(y, row.least, row.most);
    }
}

void JointRows::evaluate_with_weights() {
    weights_changed_ = false;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
        Row& row = rows_[k];
        if (row.starts_ball) {
            const BallFriction ball = ball_friction(&row, 0.0);
            // The weights of friction that slides turn with its direction.
            weights_changed_ = weights_changed_ || ball.slides || row.bound != 0;
            for (Eigen::Index i = 0; i < 3; ++i, ++k) {
                rows_[k].impulse = ball.scale * ball.wanted[i];
                rows_[k].bound = std::int8_t(ball.slides);
                rows_[k].weight = ball.scale / rows_[k].compliance;
            }
            --k;
            continue;
        }
        const double y = row.estimate + (row.target - row.speed) / row.compliance;
        row.impulse = std::clamp(y, row.least, row.most);
        const auto bound = std::int8_t(row.least == row.most || y > row.most ? 1 : -(y < row.least));
        weights_changed_ = weights_changed_ || bound != row.bound;
        row.bound = bound;
        row.weight = bound == 0 ? 1.0 / row.compliance : 0.0;
    }
}

double JointRows::slope() const {
    double sum = 0.0;
    for (const Row& row : rows_) sum += row.impulse * row.change;
    return sum;
}

double JointRows::objective(const std::vector<double>& u) const {
    double sum = 0.0;
    for (const Block& block : blocks_)
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            const Row& row = rows_[k];
            double y = row.estimate + (row.target - row.offset - dot(block, row, u)) / row.compliance;
            if (row.starts_ball) {  // Huber's function of the length
                for (std::size_t i = 1; i < 3; ++i) {
                    const Row& next = rows_[++k];
                    y = hypotenuse(y,
                                   next.estimate + (next.target - next.offset - dot(block, next, u)) / next.compliance);
                }
            }
            const double f = std::clamp(y, row.least, row.most);
            sum += row.compliance * f * (y - 0.5 * f);  // Huber's function
        }
    return sum;
}

void JointRows::add_impulses(double factor, std::vector<double>& g) const {
    for (const Block& block : blocks_)
        for (std::size_t k = block.first; k < block.first + block.count; ++k)
            if (rows_[k].impulse != 0.0) add(block, rows_[k], factor * rows_[k].impulse, g);
}

void JointRows::add_estimates(std::vector<double>& g) const {
    for (const Block& block : blocks_)
        for (std::size_t k = block.first; k < block.first + block.count; ++k)
            if (rows_[k].estimate != 0.0) add(block, rows_[k], rows_[k].estimate, g);
}

void JointRows::add_weights(BlockCholesky& matrix, Which which) const {
    for (const Block& block : blocks_)
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            const Row& row = rows_[k];
            const bool unbounded = row.least == -infinity && row.most == infinity;
            if (row.weight == 0.0 || (which != Which::all && unbounded != (which == Which::unbounded))) continue;
            add_square(matrix, block, row, row.weight);
            if (!row.starts_ball || row.bound != 1) continue;
            // Friction that slides is stiff across its direction alone: less the square along it.
            const Vec3 along = ball_friction(&row, 0.0).wanted.normalized();
            Row sum = row;
            for (int i = 0; i < 6; ++i) {
                sum.on_a[i] = along[0] * row.on_a[i] + along[1] * (&row)[1].on_a[i] + along[2] * (&row)[2].on_a[i];
                sum.on_b[i] = along[0] * row.on_b[i] + along[1] * (&row)[1].on_b[i] + along[2] * (&row)[2].on_b[i];
            }
            add_square(matrix, block, sum, -row.weight);
        }
}

double JointRows::demand(const std::vector<double>& u) const {
    double most = 0.0;
    for (const Block& block : blocks_)
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            const Row& row = rows_[k];
            if (row.least == row.most) continue;  // an open limit, or a joint that gives way
            const double missing = row.target - row.offset - dot(block, row, u);
            if (row.law == Joint::lock) most = std::max(most, std::abs(missing));
            if (row.least == 0.0) most = std::max(most, missing);
            if (row.most == 0.0) most = std::max(most, -missing);
            // Drives and friction change the speed by no more than their force allows.
            if (row.law == Joint::motor || row.law == Joint::spring || row.law == Joint::friction)
                most = std::max(most, std::min(std::abs(missing), row.most / total_mass_));
        }
    return most;
}

std::pair<double, double> JointRows::next_round(bool follow) {
    double change = 0.0, largest = 0.0;
    for (Row& row : rows_) {
        largest = std::max(largest, std::abs(row.impulse));
        if (row.soft) continue;
        change = std::max(change, std::abs(row.impulse - row.estimate));
        row.estimate = row.impulse;
    }
    for (const Block& block : blocks_)
        if (follow && !block.breaks) follow_load(block);
    return {change, largest};
}

bool JointRows::any_friction() const {
    return std::any_of(rows_.begin(), rows_.end(), [](const Row& row) { return row.law == Joint::friction; });
}

void JointRows::stiffen(double factor) {
    for (Row& row : rows_)
        if (row.compliance == compliance_) row.compliance *= factor;
    compliance_ *= factor;
}

void JointRows::soften_friction(double factor) {
    for (Row& row : rows_)
        if (row.law == Joint::friction) row.compliance = factor * compliance_;
}

void JointRows::keep_estimates() {
    for (Row& row : rows_)
        if (!row.soft) row.impulse = row.estimate;
}

void JointRows::return_to(const std::vector<double>& u) {
    evaluate_speeds(u);
    keep_estimates();
    for (Row& row : rows_)
        if (row.soft)
            row.impulse = std::clamp(row.estimate + (row.target - row.speed) / row.compliance, row.least, row.most);
}

bool JointRows::estimated() const {
    return std::none_of(blocks_.begin(), blocks_.end(), [&](const Block& block) { return joint(block).jammed; });
}

void JointRows::aim_at_start(const JointIsland& island) {
    for (const Block& block : blocks_) {
        if (block.breaks) continue;
        const Joint& j = joint(block);
        JointGeometry g;
        if (!block.gear) g = measure(j, side_at(island, j.a), side_at(island, j.b));
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            Row& row = rows_[k];
            row.estimate = 0.0;
            if (row.law == Joint::lock) row.target = 0.0;
            if (!is_limit(row) || !row.closes) continue;
            const double value = row.law == Joint::cone ? g.swing.value : g.coordinates[row.coordinate].value;
            row.target = (row.turns() ? length_ : 1.0) * (row.reference - value) / h_;
        }
    }
}

// Pose at the end of the step: a body of the island has it in `ends`, another one moves by its velocity.
JointSide JointRows::end_of(const JointIsland& island, std::uint32_t body, int place,
                            std::span<const JointSide> ends) const {
    if (body == Joint::world) return {};
    if (place != none) return ends[std::size_t(place)];
    const Body& b = island.problem.bodies[body];
    const double time = ahead_ + h_;
    JointSide side{b.position + time * b.velocity, b.orientation};
    if (!b.angular_velocity.isZero(0.0))
        side.orientation = (from_rotation_vector(time * b.angular_velocity) * b.orientation).normalized();
    return side;
}

double JointRows::close(const JointIsland& island, std::span<const JointSide> ends) {
    double worst = 0.0;
    for (const Block& block : blocks_) {
        if (block.breaks) continue;
        const Joint& j = joint(block);
        const JointGeometry g = measure_end(island, block, ends);
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            Row& row = rows_[k];
            if (!row.closes) continue;
            const bool cone = row.law == Joint::cone;
            const double value = cone ? g.swing.value : value_of(island, block, row, g, ends);
            const double reference = cone ? std::max(g.swing_limit, row.reference) : row.reference;
            const double unit = row.turns() ? length_ : 1.0, size = row.turns() ? 1.0 : j.size;
            const double error = value - reference;
            const bool held =
                row.law == Joint::lock || row.impulse != 0.0 || (row.law == Joint::lower ? error < 0.0 : error > 0.0);
            if (held) worst = std::max(worst, std::abs(error) / size);
            row.target = row.speed - unit * error / h_;
        }
    }
    return worst;
}

double JointRows::rounding(double fastest) const {
    return 4.0 * std::numeric_limits<double>::epsilon() * fastest / compliance_;
}

double JointRows::smallest_size() const {
    double size = infinity;
    for (const Block& block : blocks_) size = std::min(size, joint(block).size);
    return size;
}

double JointRows::place_rounding() const {
    double farthest = 0.0;
    for (const Block& block : blocks_) {
        farthest = std::max(farthest, block.point.cwiseAbs().maxCoeff());
        if (block.gear) farthest = std::max(farthest, joint(block).size * block.gear->value);
    }
    return 2.0 * std::numeric_limits<double>::epsilon() * farthest / smallest_size();
}

double JointRows::rounding(const JointIsland& island, double fastest, double lightest) const {
    return place_rounding() + island.problem.settings.h * rounding(fastest) / (lightest * smallest_size());
}

bool JointRows::give_way() {
    bool any = false;
    for (Block& block : blocks_) {
        Joint& j = joint(block);
        if (block.breaks || !j.description.ever_breaks()) continue;
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
        for (std::size_t k = block.first; k < block.first + block.count; ++k)
            (rows_[k].turns() ? torque : force) += rows_[k].impulse / h_ * rows_[k].direction;
        torque *= length_;
        const double over =
            std::max({force.norm() / j.description.break_force, h_ * force.norm() / j.description.break_impulse,
                      torque.norm() / j.description.break_torque});
        if (!(over > 1.0)) continue;
        any = block.breaks = true;
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            Row& row = rows_[k];
            row.least = row.most = row.estimate = row.impulse / over;
            row.closes = row.soft = row.starts_ball = false;
        }
    }
    return any;
}

bool JointRows::start_correction(const JointIsland& island, double share, CorrectionStiffness stiffness) {
    bool any = false;
    for (const Block& block : blocks_)
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            Row& row = rows_[k];
            if (row.law == Joint::spring || row.law == Joint::motor || row.law == Joint::friction) {
                row.weight = row.estimate = 0.0;  // start_fit() asks for the rest
                continue;
            }
            const bool held =
                row.law == Joint::lock || (is_limit(row) && (row.impulse != 0.0 || row.goal != row.reference));
            const double wanted = row.closes ? share * (row.goal - row.reference) : 0.0;
            const double small = joint_correction_small * (row.turns() ? 1.0 : joint(block).size);
            any = any || wanted != 0.0;
            row.soft = std::abs(wanted) > small;
            row.weight = !held ? 0.0 : row.soft ? stiffness.apart : stiffness.closed;
            row.goal = row.reference + wanted;
            row.estimate = 0.0;
            row.target = (row.turns() ? length_ : 1.0) * wanted / island.problem.settings.h;
        }
    return any;
}

void JointRows::add_correction(std::vector<double>& correction) const {
    for (const Block& block : blocks_)
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            const double amount = rows_[k].estimate + rows_[k].weight * rows_[k].target;
            if (amount != 0.0) add(block, rows_[k], amount, correction);
        }
}

double JointRows::close_correction(const JointIsland& island, std::span<const JointSide> ends,
                                   const std::vector<double>& correction) {
    const double h = island.problem.settings.h;  // s: the step, where the rows belong to its last substep
    double worst = 0.0;
    for (const Block& block : blocks_) {
        const Joint& j = joint(block);
        const JointGeometry g = measure_end(island, block, ends);
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            Row& row = rows_[k];
            if (row.law != Joint::lock || row.soft) continue;
            const double speed = dot(block, row, correction), error = value_of(island, block, row, g, ends) - row.goal;
            worst = std::max(worst, std::abs(error) / (row.turns() ? 1.0 : j.size));
            row.estimate += row.weight * (row.target - speed);
            row.target = speed - (row.turns() ? length_ : 1.0) * error / h;
        }
    }
    return worst;
}

void JointRows::store(const JointIsland& island, bool apply, bool settled) {
    if (!apply)
        for (Row& row : rows_) row.impulse = 0.0;
    part_ = h_;
    for (const Block& block : blocks_) {
        Joint& j = joint(block);
        j.impulse = {};
        j.jammed = !settled;
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            const Row& row = rows_[k];
            const double amount = row.turns() ? length_ * row.impulse : row.impulse;
            j.impulse[row.coordinate][row.law] = amount;
            if (row.law == Joint::lock && h_ * tuning::joint_phase_substeps >= step_)  // otherwise it is rounding
                j.curving[row.coordinate] = row.target / ((row.turns() ? length_ : 1.0) * h_);
        }
        const JointReaction reaction = reaction_of(block);
        j.force = reaction.force / h_;
        j.torque = reaction.torque / h_;
        j.point = block.point;
        if (block.breaks) {
            j.broken = true;
            j.broken_at = to_;
        }
    }
    give(island);
}

void JointRows::give(const JointIsland& island) const {
    std::vector<Body>& bodies = island.problem.bodies;
    for (const Block& block : blocks_) {
        if (block.gear) {
            give_gear(island, block);
            continue;
        }
        const JointReaction reaction = reaction_of(block);
        if (reaction.force.isZero(0.0) && reaction.torque.isZero(0.0)) continue;
        const Joint& j = joint(block);
        // Equal and opposite, about one point: momentum and angular momentum are kept to the last bit.
        if (block.a != none) {
            Body& a = bodies[j.a];
            a.momentum -= reaction.force;
            a.angular_momentum -= (block.point - a.position).cross(reaction.force) + reaction.torque;
        }
        if (block.b != none) {
            Body& b = bodies[j.b];
            b.momentum += reaction.force;
            b.angular_momentum += (block.point - b.position).cross(reaction.force) + reaction.torque;
        }
    }
}

JointReaction JointRows::reaction_of(const Block& block) const {
    JointReaction reaction;
    for (const Row& row : rows(block))
        (row.turns() ? reaction.torque : reaction.force) +=
            (row.turns() ? length_ * row.impulse : row.impulse) * row.direction;
    reaction.moment = block.point.cross(reaction.force) + reaction.torque;
    return reaction;
}

}  // namespace tumble
