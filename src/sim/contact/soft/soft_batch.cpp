#include "sim/contact/soft/soft_batch.h"

#include "sim/contact/model/predicted_gap.h"
#include "sim/contact/soft/settings.h"
#include "sim/geometry/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tumble {
namespace {

/// Bodies with overlaps above this share of the smaller radius started inside each other or landed fast; their
/// position correction has no energy budget. Related tests: ContactEnergy.DeepLandingsThrowNoBody and
/// ContactHardInput.ACrowdDissolves.
constexpr double soft_energy_deep = 0.25;

/// Damping ratio of a contact. Related: bench_stability "stack".
constexpr double soft_damping = 2.0;

/// Groups of manifolds between blocks from which on threads share them, with a barrier per color. No result depends
/// on it.
constexpr std::size_t soft_shared_groups = 24;

/// Share of a joint's gap that is closed in a substep, and share of its impulse that a correction gives up. Impulses
/// add up from substep to substep: without the second, slow waves of a net grow by a quarter of the first in a substep;
/// with it, a joint under the tension T is left open by about leak / rate T d^2 / m. Trees, whose gaps are closed at
/// the end of each step, have no leak. Related test: Nets.HangsAsTheDirectSolverDoes.
constexpr double soft_joint_rate = 0.05;
constexpr double soft_joint_leak = 0.01;

/// Largest impulse handed over from the direct solver, in impulses of the step's forces on the lighter body.
/// Related test: Towers.HeavyBetweenLight.
constexpr double direct_handover = 20.0;

using Rows = soft::ManifoldRows<float>;
using Point = soft::PointRows<float>;

Vec3 to_double(const soft::Vector3<float>& v) { return {v.x, v.y, v.z}; }

void put(float* row, const Vec3& v) {
    for (int k = 0; k < 3; ++k) row[k] = float(v[k]);
}

void put_all(float* row, const std::array<double, 8>& values) {
    for (std::size_t i = 0; i < 8; ++i) row[i] = float(values[i]);
}

// An impulse that the direct solver holds between masses of 1 : 1e6 would be a violent kick in soft contacts: the warm
// start is limited to a few times the weight of the lighter body.
void limit_warm_start(Manifold& m, const ContactProblem& problem) {
    const bool directly = m.solved_by == SolvedBy::direct;
    m.solved_by = SolvedBy::sweeps;
    if (!directly) return;
    double mass = std::numeric_limits<double>::infinity(), speed = 0.0;
    for (const std::uint32_t i : {m.a, m.b}) {
        const Body& body = problem.bodies[i];
        if (!body.dynamic()) continue;
        mass = std::min(mass, body.mass);
        speed = std::max(speed, (body.velocity - problem.before[i].velocity).norm());
    }
    const double sum = normal_impulse(m), most = direct_handover * mass * speed;
    if (sum > most) scale_impulses(m, most / sum);
}

// A sweep visits point after point, and the last one is satisfied best: the deepest, not the one with the highest
// index, which differs in a mirror image. (With the deepest first, small boxes topple.)
std::array<std::uint8_t, Manifold::capacity> deepest_last(const Manifold& m) {
    constexpr std::size_t n = Manifold::capacity;
    double gap[n];
    std::size_t place[n] = {0, 1, 2, 3};
    for (std::size_t i = 0; i < n; ++i)
        gap[i] = int(i) < m.count ? m.points[i].separation : -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = i + 1; k < n; ++k) {
            const std::size_t before = gap[k] > gap[i];
            place[i] += before;
            place[k] -= before;
        }
    std::array<std::uint8_t, n> order;
    for (std::size_t i = 0; i < n; ++i) order[place[i]] = std::uint8_t(i);
    return order;
}

}  // namespace

SoftBatch::SoftBatch(const soft::Kernel& kernel) : kernel_(kernel) {}

// For a substep of d seconds (formulas: soft_solver.h).
soft::Softness SoftBatch::softness(double frequency, double d) {
    const double w = 2.0 * std::numbers::pi * frequency, z = soft_damping;
    const double a = 2.0 * z + d * w, c = d * w * a;
    return {float(w / a), float(c / (1.0 + c)), float(1.0 / (1.0 + c))};
}

void SoftBatch::prepare(const ContactProblem& problem, const IslandBatch& batch, const SoftLayout& layout,
                        const std::vector<std::uint32_t>& slot, double mass_unit, bool again, bool resists) {
    layout_ = &layout;
    mass_unit_ = mass_unit;
    substeps_ = substeps_of(problem.settings.h) * batch.substep_multiplier;
    d_ = problem.settings.h / substeps_;
    substep_ = {float(1.0 / d_),
                softness(tuning::soft_frequency / d_, d_),
                softness(tuning::soft_frequency_of_unlike / d_, d_),
                softness(tuning::soft_frequency_of_fixed / d_, d_),
                float(soft_joint_rate / d_),
                batch.closes ? 0.0f : float(soft_joint_leak)};
    energies_.open(layout, problem.bodies);
    const std::size_t dynamic = 1 + layout.blocks().order().size();  // number of slots
    packed_.resize(dynamic);
    reached_.assign(dynamic, 0);
    slots_ = dynamic + layout.movers().size();
    state_.resize(slots_ * soft::body_floats);
    for (AlignedFloats* array : {&inertia_, &before_, &forces_}) array->resize(slots_ * soft::inertia_floats);
    const std::size_t groups = layout.groups(), lanes = std::size_t(kernel_.lanes);
    rows_.resize(groups * soft::group_rows * lanes);
    lane_bodies_.resize(2 * lanes * groups);
    lane_moved_.resize(2 * groups);
    lane_points_.resize(groups);
    sources_.resize(groups * lanes);
    resistance_.open(resists ? groups * lanes : 0);
    joints_.open(layout, batch.joints, {lanes, substeps_, mass_unit, d_}, again);
    areas_.open(problem, batch, layout, slot,
                {lanes, rows_.data(), lane_bodies_.data(), lane_moved_.data(), substeps_ * mass_unit, mass_unit});
}

// For the positions first to last in the blocks' order.
void SoftBatch::pack_bodies(const ContactProblem& problem, std::size_t first, std::size_t last) {
    const double share = 1.0 / substeps_, fast_rotation = tuning::fast_rotation_turn / problem.settings.h;
    for (std::size_t k = first; k < last; ++k) {
        const std::uint32_t i = layout_->blocks().order()[k];
        const Body& body = problem.bodies[i];
        packed_[k + 1] = packed(body, std::uint32_t(k + 1));
        packed_[k + 1].rotates_fast = problem.before[i].angular_velocity.squaredNorm() > fast_rotation * fast_rotation;
        energies_.begin(k, body, problem.before[i]);
        const auto& [v, w] = problem.before[i];
        const Vec3 faster = share * (body.velocity - v), spun_up = share * (body.angular_velocity - w);
        const Mat3 inverse = mass_unit_ * body.inverse_inertia;
        const Vec3 turning = w + body.gyration;
        put_all(state(k + 1),
                {v.x(), v.y(), v.z(), turning.x(), turning.y(), turning.z(), mass_unit_ * body.inverse_mass});
        put_all(state(k + 1) + 8, {});
        put_all(forces_.data() + 8 * (k + 1),
                {faster.x(), faster.y(), faster.z(), spun_up.x(), spun_up.y(), spun_up.z()});
        put_all(before_.data() + 8 * (k + 1), {});
        put_all(inertia_.data() + soft::inertia_floats * (k + 1),
                {inverse(0, 0), inverse(0, 1), inverse(0, 2), inverse(1, 1), inverse(1, 2), inverse(2, 2)});
    }
}

// Includes slot 0, which stands still.
void SoftBatch::pack_movers(const ContactProblem& problem) {
    const std::size_t dynamic = layout_->blocks().order().size();
    for (AlignedFloats* array : {&inertia_, &before_, &forces_}) {
        std::fill_n(array->data(), soft::inertia_floats, 0.0f);
        std::fill_n(array->data() + (1 + dynamic) * soft::inertia_floats,
                    layout_->movers().size() * soft::inertia_floats, 0.0f);
    }
    std::fill_n(state(0), soft::body_floats, 0.0f);
    std::fill_n(state(1 + dynamic), layout_->movers().size() * soft::body_floats, 0.0f);
    for (std::size_t k = 0; k < layout_->movers().size(); ++k) {
        const Body& body = problem.bodies[layout_->movers()[k].body];
        const BodyVelocity& start = problem.before[layout_->movers()[k].body];
        // The change of velocity over the whole step is spread evenly over the substeps, as the body's velocity grows
        // or rotates: all at once would ask more of friction than the load of a substep allows.
        const Vec3 faster = 2.0 / substeps_ * (body.velocity - start.velocity);
        const Vec3 spun_up = 2.0 / substeps_ * (body.angular_velocity - start.angular_velocity);
        Vec3 turned = Vec3::Zero();
        if (layout_->movers()[k].manifold != SoftLayout::none) {
            const Manifold& m = problem.manifolds[layout_->movers()[k].manifold];
            const std::uint32_t rider = m.a == layout_->movers()[k].body ? m.b : m.a;
            turned = d_ * turn_of_carrier(body, problem.before[rider].velocity - start.velocity, m.normal);
        }
        float* s = state(1 + dynamic + k);
        float* f = forces_.data() + soft::inertia_floats * (1 + dynamic + k);
        put(s, start.velocity - 0.5 * (faster + turned));
        put(s + 3, start.angular_velocity - 0.5 * spun_up);
        put(f, faster + turned);
        put(f + 3, spun_up);
    }
}

// `made`: storage for an entry that is not kept.
const SoftBatch::PackedBody& SoftBatch::find_packed(std::uint32_t body, std::uint32_t manifold,
                                                    const ContactProblem& problem,
                                                    const std::vector<std::uint32_t>& slot, PackedBody& made) const {
    const Body& b = problem.bodies[body];
    if (b.dynamic()) return packed_[slot[body]];
    if (b.type != BodyType::kinematic) return made = packed(b, 0);
    const auto place = std::lower_bound(layout_->movers().begin(), layout_->movers().end(),
                                        SoftLayout::mover(problem.bodies, body, manifold)) -
                       layout_->movers().begin();
    return made = packed(b, std::uint32_t(slots_ - layout_->movers().size() + std::size_t(place)));
}

// Lane l of group g.
void SoftBatch::pack_lane(const ContactProblem& problem, std::uint32_t manifold, std::size_t g, std::size_t l,
                          const std::vector<std::uint32_t>& slot) {
    Manifold& m = problem.manifolds[manifold];
    limit_warm_start(m, problem);
    PackedBody made_a, made_b;
    const PackedBody &first = find_packed(m.a, manifold, problem, slot, made_a),
                     &second = find_packed(m.b, manifold, problem, slot, made_b);
    // Arms start at the body that moves, of two at the smaller one: from the other's center single precision may be too
    // coarse.
    const bool swapped = !first.dynamic || (second.dynamic && second.radius < first.radius);
    const PackedBody &a = swapped ? second : first, &b = swapped ? first : second;
    const std::size_t lanes = std::size_t(kernel_.lanes);
    lane_bodies_[2 * lanes * g + l] = std::uint32_t(soft::body_floats) * a.slot;
    lane_bodies_[2 * lanes * g + lanes + l] = std::uint32_t(soft::body_floats) * b.slot;
    lane_moved_[2 * g] |= std::uint16_t(a.dynamic << l);
    lane_moved_[2 * g + 1] |= std::uint16_t(b.dynamic << l);
    const double share = 1.0 / (substeps_ * mass_unit_);
    const double size = std::min(a.radius, b.radius);
    const bool bouncy = pair_value(a.pair_rules.restitution, a.restitution, b.restitution) > 0.0;
    Source& source = sources_[lanes * g + l];
    const soft::ManifoldLane lane(rows_of(g) + l, lanes);
    std::size_t count = 0;
    const Body &body_a = problem.bodies[m.a], &body_b = problem.bodies[m.b];
    const BodiesInStep bodies{body_a, body_b, problem.before[m.a], problem.before[m.b]};
    const bool predicts_gaps = a.rotates_fast || b.rotates_fast || m.has_curved_gap();
    const auto order = deepest_last(m);
    for (int k = 0; k < m.count; ++k) {
        const int i = order[std::size_t(k)];
        const ContactPoint& p = m.points[std::size_t(i)];
        PredictedGap seen{p.position, p.separation, 0.0};
        // For one substep more than the step: the last sweep looks that far ahead.
        if (predicts_gaps) seen = predicted_gap(m, i, bodies, problem.settings.h + d_);
        // The stage of impacts leaves large nets as they are: their contacts stop at the surface.
        if ((bouncy || m.has_curved_gap()) && joints_.size() == 0 &&
            will_bounce(m, i, body_a, body_b, seen.slower, problem.settings))
            continue;
        const soft::PointLane point = lane.point(count);
        source.point[count++] = std::uint8_t(i);
        if (p.separation < -soft_energy_deep * size) energies_.mark_deep(a.slot - 1);
        const Vec3 place = acting_point(seen.position, p.separation, m.normal, first.dynamic, second.dynamic);
        point.set(&Point::arm, place - a.position);
        point[&Point::present] = 1.0f;
        point[&Point::load_share] = m.share[std::size_t(i)];
        point[&Point::separation] = float(seen.gap);
        point[&Point::impulse] = float(share * p.impulse);
    }
    if (count == 0) return release(m);  // skipped, because it will bounce
    source.count = std::uint8_t(count);
    source.swapped = swapped;
    lane_points_[g] = std::max(lane_points_[g], source.count);
    lane.set(&Rows::normal, swapped ? Vec3(-m.normal) : m.normal);
    lane.set(&Rows::tangent, m.tangent);
    lane.set(&Rows::between, a.position - b.position);
    lane[&Rows::friction_coefficient] = float(pair_value(a.pair_rules.friction, a.friction, b.friction));
    lane[&Rows::size] = float(size);
    lane[&Rows::spread] = m.spread;
    if (!resistance_.empty())
        if (const RotationalFriction levers = rotational_friction(m, body_a, body_b); !levers.none())
            resistance_.put(lanes * g + l, levers, count,
                            share * Vec3(swapped ? -m.rolling[0] : m.rolling[0], m.rolling[1], 0.0));
    // A manifold with points that bounce keeps friction of its own.
    if (problem.areas && problem.areas->holds(manifold) && int(count) == m.count) {
        areas_.put(problem, manifold, lanes * g + l, count, swapped);
        lane[&Rows::friction_coefficient] = 0.0f;
        return;
    }
    // Seen from the other body the second tangent is reversed too, and so is an impulse along the first.
    lane.set(&Rows::friction,
             Vec3((swapped ? -share : share) * m.friction[0], share * m.friction[1], share * m.torsion));
}

void SoftBatch::pack(const ContactProblem& problem, std::size_t group, const std::vector<std::uint32_t>& slot) {
    const std::size_t lanes = std::size_t(kernel_.lanes);
    int points = 0;
    for (std::size_t lane = lanes * group; lane < lanes * (group + 1); ++lane)
        if (const std::uint32_t m = layout_->manifold(lane); m != SoftLayout::none)
            points = std::max(points, int(problem.manifolds[m].count));
    std::fill_n(rows_of(group), (soft::manifold_rows + std::size_t(points) * soft::point_rows) * lanes, 0.0f);
    std::fill_n(lane_bodies_.begin() + std::ptrdiff_t(2 * lanes * group), 2 * lanes, 0u);
    lane_moved_[2 * group] = lane_moved_[2 * group + 1] = 0;
    lane_points_[group] = 0;
    for (std::size_t l = 0; l < lanes; ++l) {
        sources_[lanes * group + l] = {};
        if (const std::uint32_t m = layout_->manifold(lanes * group + l); m != SoftLayout::none)
            pack_lane(problem, m, group, l, slot);
    }
}

void SoftBatch::run(const ContactProblem& problem, IslandBatch& batch, const std::vector<std::uint32_t>& slot,
                    std::vector<Vec3>& carried, std::size_t thread, std::size_t team, SpinBarrier& barrier) {
    const auto meet = [&] {
        if (team > 1) barrier.wait();
    };
    const soft::Groups groups{rows_.data(), lane_bodies_.data(), lane_moved_.data(), lane_points_.data()};
    const soft::Bodies bodies{state_.data(), inertia_.data(), forces_.data(), before_.data()};
    const SoftLayout& layout = *layout_;
    const BodyBlocks& blocks = layout.blocks();
    const std::size_t across = blocks.size();
    const auto own = layout.blocks_of(thread, team);
    const std::size_t first_body = blocks.first(own.begin), end_body = blocks.first(own.end);
    // Color by color: in this thread's blocks, then between blocks.
    const auto each_color_of = [&](const auto& colors, auto&& pass) {
        for (std::size_t c = colors.first_color(own.begin); c < colors.first_color(own.end); ++c)
            pass(colors.first_group(c), colors.first_group(c + 1));
        const std::size_t all_across = colors.groups() - colors.first_group(colors.first_color(across));
        if (all_across == 0) return;
        meet();
        const bool shared = all_across >= soft_shared_groups;
        for (std::size_t c = colors.first_color(across); c < colors.first_color(across + 1); ++c) {
            const std::size_t first = colors.first_group(c), count = colors.first_group(c + 1) - first;
            if (shared) {
                pass(first + count * thread / team, first + count * (thread + 1) / team);
                meet();
            } else if (thread == 0) {
                pass(first, first + count);
            }
        }
        if (!shared) meet();
    };
    const auto each_color = [&](auto&& pass) { each_color_of(layout, pass); };
    const auto width = std::size_t(kernel_.lanes);
    const auto each_resistance = [&](std::size_t first, std::size_t last, auto&& visit) {
        for (std::size_t g = first; g < last && !resistance_.empty(); ++g) visit(g);
    };
    const bool joined = joints_.size() > 0;
    const soft::JointGroups holds = joined ? joints_.groups() : soft::JointGroups{};
    const auto each_joint_color = [&](auto&& pass) {
        if (joined) each_color_of(layout.joints(), pass);
    };
    const auto each_own = [&](const auto& colors, auto&& pass) {
        const auto group_of = [&](std::size_t home) { return colors.first_group(colors.first_color(home)); };
        const std::size_t first = group_of(across), count = colors.groups() - first;
        pass(group_of(own.begin), group_of(own.end));
        pass(first + count * thread / team, first + count * (thread + 1) / team);
    };

    pack_bodies(problem, first_body, end_body);
    if (thread == 0) pack_movers(problem);
    meet();
    each_own(layout, [&](std::size_t first, std::size_t last) {
        for (std::size_t g = first; g < last; ++g) pack(problem, g, slot);
        kernel_.prepare(groups, first, last, bodies);
    });
    if (joined)
        each_own(layout.joints(), [&](std::size_t first, std::size_t last) {
            for (std::size_t g = first; g < last; ++g) joints_.pack(problem, g);
            kernel_.prepare_joints(holds, first, last, bodies);
        });
    meet();
    const bool shared = !areas_.empty();
    const auto each_area_color = [&](auto&& pass) {
        if (shared) each_color_of(areas_.layout(), pass);
    };
    if (shared) {
        each_own(areas_.layout(), [&](std::size_t first, std::size_t last) {
            for (std::size_t g = first; g < last; ++g) areas_.pack(problem, g);
            kernel_.prepare(areas_.groups(), first, last, bodies);
            for (std::size_t g = first; g < last; ++g) areas_.finish(problem, g);
        });
        meet();
    }
    const auto rub = [&](bool counts) {
        each_area_color([&](std::size_t f, std::size_t l) {
            for (std::size_t g = f; g < l; ++g) areas_.gather(g);
            kernel_.rub(areas_.groups(), f, l, bodies, counts);
        });
    };
    for (int step = 0; step < substeps_; ++step) {
        // The arms of joints turn: their impulses are applied anew in each substep.
        kernel_.accelerate(1 + first_body, 1 + end_body, bodies, step > 0 && !joined);
        if (!layout_->movers().empty()) {  // read by all threads
            meet();
            if (thread == 0) kernel_.accelerate(1 + layout_->blocks().order().size(), slots_, bodies, false);
            meet();
        }
        if (step == 0 || joined) {
            each_color([&](std::size_t f, std::size_t l) {
                kernel_.warm_start(groups, f, l, bodies);
                each_resistance(f, l, [&](std::size_t g) { resistance_.warm_start(groups, g, width, bodies); });
            });
            each_area_color([&](std::size_t f, std::size_t l) { kernel_.warm_start(areas_.friction(), f, l, bodies); });
        }
        each_joint_color([&](std::size_t f, std::size_t l) { kernel_.warm_start_joints(holds, f, l, bodies); });
        rub(false);
        each_color([&](std::size_t f, std::size_t l) {
            kernel_.correct(groups, f, l, bodies, substep_);
            each_resistance(f, l, [&](std::size_t g) { resistance_.resist(groups, g, width, bodies, false); });
        });
        each_joint_color([&](std::size_t f, std::size_t l) { kernel_.correct_joints(holds, f, l, bodies, substep_); });
        kernel_.move(1 + first_body, 1 + end_body, bodies, float(d_));
        if (!layout_->movers().empty()) {
            meet();
            if (thread == 0) kernel_.move(1 + layout_->blocks().order().size(), slots_, bodies, float(d_));
            meet();
        }
        each_color([&](std::size_t f, std::size_t l) {
            kernel_.relax(groups, f, l, bodies, substep_);
            each_resistance(f, l, [&](std::size_t g) { resistance_.resist(groups, g, width, bodies, true); });
        });
        rub(true);
        each_joint_color([&](std::size_t f, std::size_t l) { kernel_.relax_joints(holds, f, l, bodies, substep_); });
    }
    each_color([&](std::size_t f, std::size_t l) {
        kernel_.sum(groups, f, l);
        for (std::size_t g = f; g < l; ++g) unpack(problem, g);
    });
    each_area_color([&](std::size_t f, std::size_t l) {
        kernel_.sum(areas_.friction(), f, l);
        for (std::size_t g = f; g < l; ++g) areas_.unpack(problem, g, reached_);
    });
    each_joint_color([&](std::size_t f, std::size_t l) {
        for (std::size_t g = f; g < l; ++g) joints_.unpack(problem, g, reached_, carried);
    });
    hand_back(problem, first_body, end_body);
    meet();
    energies_.hold(blocks, first_body, end_body, problem.bodies, problem.before, problem.settings.h, batch.lost);
    if (!joined) return;
    meet();
    if (thread == 0) energies_.find_lost(batch.lost);
    each_own(layout.joints(), [&](std::size_t first, std::size_t last) {
        for (std::size_t g = first; g < last; ++g) joints_.account(problem, g);
    });
}

// Transfers impulses to the manifolds and to the momenta of their bodies.
void SoftBatch::unpack(const ContactProblem& problem, std::size_t g) {
    const std::size_t lanes = std::size_t(kernel_.lanes);
    const double all = substeps_ * mass_unit_;
    for (std::size_t l = 0; l < lanes; ++l) {
        const Source& source = sources_[lanes * g + l];
        if (source.count == 0) continue;
        Manifold& m = problem.manifolds[layout_->manifold(lanes * g + l)];
        const soft::ManifoldLane lane(rows_of(g) + l, lanes);
        release(m);
        for (std::size_t i = 0; i < source.count; ++i)
            m.points[source.point[i]].impulse = all * double(lane.point(i)[&Point::impulse]);
        const Vec3 friction = to_double(lane.vector(&Rows::friction));
        m.friction[0] = (source.swapped ? -all : all) * friction.x();
        m.friction[1] = all * friction.y();
        m.torsion = all * friction.z();
        const Vec3 rolling = all * resistance_.impulse(lanes * g + l);
        m.rolling[0] = float(source.swapped ? -rolling.x() : rolling.x());
        m.rolling[1] = float(rolling.y());
        m.tangent = to_double(lane.vector(&Rows::tangent));
        const auto total = lane.total_impulse();
        const Vec3 force = mass_unit_ * to_double(total.linear);
        Vec3 moment = mass_unit_ * to_double(total.angular);  // about A's center
        if (!resistance_.empty()) moment += mass_unit_ * resistance_.sum(lanes * g + l);
        if (force.isZero(0.0) && moment.isZero(0.0)) continue;
        const std::uint32_t slot_a = lane_bodies_[2 * lanes * g + l] / soft::body_floats;
        const std::uint32_t slot_b = lane_bodies_[2 * lanes * g + lanes + l] / soft::body_floats;
        Body &a = problem.bodies[source.swapped ? m.b : m.a], &b = problem.bodies[source.swapped ? m.a : m.b];
        if (problem.totals) {
            ManifoldImpulse& sum = (*problem.totals)[layout_->manifold(lanes * g + l)];
            if (source.swapped)
                sum.add(-force, -(moment + (a.position - b.position).cross(force)), b, a);
            else
                sum.add(force, moment, a, b);
        }
        if (lane_moved_[2 * g] >> l & 1) {
            reached_[slot_a] = 1;
            a.momentum -= force;
            a.angular_momentum -= moment;
        }
        if (lane_moved_[2 * g + 1] >> l & 1) {
            reached_[slot_b] = 1;
            b.momentum += force;
            b.angular_momentum += moment + (a.position - b.position).cross(force);
        }
    }
}

void SoftBatch::hand_back(const ContactProblem& problem, std::size_t first, std::size_t last) {
    const double rate = 1.0 / problem.settings.h;
    for (std::size_t k = first; k < last; ++k) {
        if (!reached_[k + 1]) continue;
        Body& body = problem.bodies[layout_->blocks().order()[k]];
        body.derive_velocities();
        const float* moved = state(k + 1) + 8;
        body.correction_velocity = rate * Vec3(moved[0], moved[1], moved[2]) - body.velocity;
        body.correction_angular_velocity =
            rate * Vec3(moved[3], moved[4], moved[5]) - body.angular_velocity - body.gyration;
        energies_.end(k, body);
    }
}

}  // namespace tumble
