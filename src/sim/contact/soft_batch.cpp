#include "sim/contact/soft_batch.h"

#include "sim/tuning.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace tumble {
namespace {

constexpr std::uint32_t none = UINT32_MAX;
constexpr std::size_t colors = 64;   // bits of a mask; what finds none free is solved one by one
// Manifolds of a colour side by side by what they cost: with impulses before those without, which may stay idle, and as many
// points together: no lane waits for another's fourth.
constexpr std::size_t costs = 2 * Manifold::capacity;
std::size_t cost_class(const Manifold& m) {
    return std::size_t(Manifold::capacity - m.count) + (normal_impulse(m) > 0.0 ? 0 : Manifold::capacity);
}

void put(float* row, int stride, const Vec3& v) {
    row[0] = float(v.x());
    row[stride] = float(v.y());
    row[2 * stride] = float(v.z());
}

void put_all(float* row, const std::array<double, 8>& values) {
    for (std::size_t i = 0; i < 8; ++i) row[i] = float(values[i]);
}

// What the direct solver holds between masses of 1 : 1e6 would be a blow for soft contacts: of its impulses no more is
// handed over than some weights of the lighter body.
void temper(Manifold& m, const ContactProblem& problem) {
    if (!m.solved_directly) return;
    m.solved_directly = false;
    double mass = std::numeric_limits<double>::infinity(), speed = 0.0;
    for (const std::uint32_t i : {m.a, m.b}) {
        const Body& body = problem.bodies[i];
        if (!body.dynamic()) continue;
        mass = std::min(mass, body.mass);
        speed = std::max(speed, (body.velocity - problem.before[i].velocity).norm());
    }
    const double sum = normal_impulse(m), most = tuning::direct_handover * mass * speed;
    if (sum > most) scale_impulses(m, most / sum);
}

}  // namespace

SoftBatch::SoftBatch(const soft::Kernel& kernel) : kernel_(kernel), blocks_(tuning::soft_block_bodies) {}

void SoftBatch::Floats::resize(std::size_t count) {
    if (memory_.size() < count + 16) memory_.resize(count + 16);
    data_ = memory_.data() + (64 - reinterpret_cast<std::uintptr_t>(memory_.data()) % 64) % 64 / sizeof(float);
}

// For a substep of d seconds (formulas: soft_solver.h).
soft::Softness SoftBatch::softness(double frequency, double d) {
    const double w = 2.0 * std::numbers::pi * frequency, z = tuning::soft_damping;
    const double a = 2.0 * z + d * w, c = d * w * a;
    return {float(w / a), float(c / (1.0 + c)), float(1.0 / (1.0 + c))};
}

void SoftBatch::prepare(const ContactProblem& problem, const SoftSolver::Part& part, double mass_unit, std::vector<std::uint32_t>& slot,
                        std::size_t team) {
    mass_unit_ = mass_unit;
    substeps_ = substeps_of(problem.patches.h) * part.finer;
    d_ = problem.patches.h / substeps_;
    substep_ = {float(1.0 / d_), softness(tuning::soft_frequency / d_, d_), softness(tuning::soft_frequency_of_unlike / d_, d_),
                softness(tuning::soft_frequency_of_fixed / d_, d_)};
    blocks_.clear();
    energies_.clear();
    std::size_t first = 0;
    for (const std::size_t end : part.island_ends) {
        const std::size_t blocks = blocks_.size();
        const auto island = std::span(part.bodies).subspan(first, end - first);
        blocks_.add(island, problem.bodies);
        energies_.open(blocks_, first, end, blocks, problem.bodies);
        first = end;
    }
    const std::size_t dynamic = 1 + part.bodies.size();   // slots
    places_.resize(dynamic);
    block_of_.resize(dynamic);
    reached_.assign(dynamic, 0);
    for (std::size_t b = 0; b < blocks_.size(); ++b)
        for (std::size_t k = blocks_.first(b); k < blocks_.first(b + 1); ++k) {
            slot[blocks_.order()[k]] = std::uint32_t(k + 1);
            block_of_[k + 1] = std::uint32_t(b);
        }
    taken_.assign(dynamic, {});
    class_size_.assign((blocks_.size() + 1) * colors * costs, 0);
    class_.resize(part.manifolds.size());
    found_movers_.clear();
    found_movers_.resize(team);
}

SoftBatch::Mover SoftBatch::mover(std::uint32_t body, std::uint32_t manifold, const ContactProblem& problem) {
    return {body, problem.bodies[body].angular_velocity.isZero(0.0) ? none : manifold};
}

// Greedily in the manifolds' order: the least colour neither body has, inside of the blocks and between them. What a body
// gets depends on its island alone. Each thread colours its own blocks, whose manifolds its core's cache holds, and one what lies
// between them.
void SoftBatch::color(const ContactProblem& problem, const SoftSolver::Part& part, const std::vector<std::uint32_t>& slot,
                      std::size_t thread, std::size_t team) {
    const Share own = blocks_of(thread, team);
    const std::size_t across = blocks_.size();
    for (std::size_t k = 0; k < part.pairs.size(); ++k) {
        const std::uint32_t a = slot[part.pairs[k].a], b = slot[part.pairs[k].b];   // 0: not dynamic
        const bool inside = a == 0 || b == 0 || block_of_[a] == block_of_[b];
        const std::size_t home = inside ? block_of_[a != 0 ? a : b] : across;
        if (inside ? home < own.begin || home >= own.end : thread + 1 < team) continue;
        if (a == 0 || b == 0) {
            const std::uint32_t place = (a != 0 ? a : b) - 1, other = a != 0 ? part.pairs[k].b : part.pairs[k].a;
            if (problem.bodies[other].moves()) energies_.is_driven(place);
            else energies_.leans(place);
            if (problem.bodies[other].type == BodyType::kinematic) found_movers_[thread].push_back(mover(other, part.manifolds[k], problem));
        }
        std::uint64_t fixed = 0;
        std::uint64_t& of_a = a == 0 ? fixed : inside ? taken_[a].inside : taken_[a].across;
        std::uint64_t& of_b = b == 0 ? fixed : inside ? taken_[b].inside : taken_[b].across;
        const auto c = std::size_t(std::countr_one(of_a | of_b));
        if (c == colors) {   // one by one, in the end
            class_[k] = none;
            continue;
        }
        const std::uint64_t bit = std::uint64_t(1) << c;
        of_a |= bit;
        of_b |= bit;
        class_[k] = std::uint32_t((home * colors + c) * costs + cost_class(problem.manifolds[part.manifolds[k]]));
        ++class_size_[class_[k]];
    }
}

// Kinematic bodies among the manifolds get slots of their own: they move, and are never written to.
void SoftBatch::lay_out(const SoftSolver::Part& part) {
    movers_.clear();
    for (const std::vector<Mover>& found : found_movers_) movers_.insert(movers_.end(), found.begin(), found.end());
    std::sort(movers_.begin(), movers_.end());
    movers_.erase(std::unique(movers_.begin(), movers_.end()), movers_.end());
    slots_ = 1 + part.bodies.size() + movers_.size();
    state_.resize(slots_ * soft::body_floats);
    for (Floats* array : {&inertia_, &before_, &forces_}) array->resize(slots_ * soft::inertia_floats);
    deal_lanes(part);
}

void SoftBatch::deal_lanes(const SoftSolver::Part& part) {
    const std::size_t lanes = std::size_t(kernel_.lanes), homes = blocks_.size() + 1;
    std::size_t groups = 0;
    first_group_.clear();
    first_color_.assign(1, 0);
    for (std::size_t home = 0; home < homes; ++home) {
        for (std::size_t c = 0; c < colors; ++c) {
            std::uint32_t lane = std::uint32_t(groups * lanes);
            for (std::size_t p = 0; p < costs; ++p) {   // sizes become places
                std::uint32_t& of_class = class_size_[(home * colors + c) * costs + p];
                const std::uint32_t size = of_class;
                of_class = lane;
                lane += size;
            }
            if (lane == groups * lanes) continue;
            first_group_.push_back(groups);
            groups = (lane + lanes - 1) / lanes;
        }
        if (home + 1 < homes) first_color_.push_back(first_group_.size());
    }
    for (const std::uint32_t c : class_)
        if (c == none) first_group_.push_back(groups++);
    first_color_.push_back(first_group_.size());
    first_group_.push_back(groups);

    lane_manifolds_.assign(groups * lanes, none);
    std::size_t alone = groups * lanes;
    for (std::size_t i = class_.size(); i-- > 0;)
        if (class_[i] == none) lane_manifolds_[alone -= lanes] = part.manifolds[i];
    for (std::size_t i = 0; i < class_.size(); ++i)
        if (class_[i] != none) lane_manifolds_[class_size_[class_[i]]++] = part.manifolds[i];
    rows_.resize(groups * soft::group_rows * lanes);
    lane_bodies_.resize(2 * lanes * groups);
    lane_moved_.resize(2 * groups);
    lane_points_.resize(groups);
    sources_.resize(groups * lanes);
}

SoftBatch::Share SoftBatch::blocks_of(std::size_t thread, std::size_t team) const {
    return {blocks_.size() * thread / team, blocks_.size() * (thread + 1) / team};
}

void SoftBatch::give_bodies(ThreadPool& pool) const {
    const auto team = std::size_t(pool.size());
    for (std::size_t thread = 0; thread < team; ++thread) {
        const Share own = blocks_of(thread, team);
        for (std::size_t k = blocks_.first(own.begin); k < blocks_.first(own.end); ++k) pool.give(blocks_.order()[k], thread);
    }
}

// Of the places first to last in the blocks' order.
void SoftBatch::pack_bodies(const ContactProblem& problem, std::size_t first, std::size_t last) {
    const double share = 1.0 / substeps_;
    for (std::size_t k = first; k < last; ++k) {
        const std::uint32_t i = blocks_.order()[k];
        const Body& body = problem.bodies[i];
        places_[k + 1] = place_of(body, std::uint32_t(k + 1));
        energies_.begin(k, body, problem.before[i]);
        const auto& [v, w] = problem.before[i];
        const Vec3 faster = share * (body.velocity - v), spun_up = share * (body.angular_velocity - w);
        const Mat3 inverse = mass_unit_ * body.inverse_inertia;
        const Vec3 turning = w + body.gyration;
        put_all(state(k + 1), {v.x(), v.y(), v.z(), turning.x(), turning.y(), turning.z(), mass_unit_ * body.inverse_mass});
        put_all(state(k + 1) + 8, {});
        put_all(forces_.data() + 8 * (k + 1), {faster.x(), faster.y(), faster.z(), spun_up.x(), spun_up.y(), spun_up.z()});
        put_all(before_.data() + 8 * (k + 1), {});
        put_all(inertia_.data() + soft::inertia_floats * (k + 1),
                {inverse(0, 0), inverse(0, 1), inverse(0, 2), inverse(1, 1), inverse(1, 2), inverse(2, 2)});
    }
}

// And slot 0, which stands still.
void SoftBatch::pack_movers(const ContactProblem& problem) {
    const std::size_t dynamic = blocks_.order().size();
    for (Floats* array : {&inertia_, &before_, &forces_}) {
        std::fill_n(array->data(), soft::inertia_floats, 0.0f);
        std::fill_n(array->data() + (1 + dynamic) * soft::inertia_floats, movers_.size() * soft::inertia_floats, 0.0f);
    }
    std::fill_n(state(0), soft::body_floats, 0.0f);
    std::fill_n(state(1 + dynamic), movers_.size() * soft::body_floats, 0.0f);
    for (std::size_t k = 0; k < movers_.size(); ++k) {
        const Body& body = problem.bodies[movers_[k].body];
        const BodyVelocity& start = problem.before[movers_[k].body];
        // The way of the whole step, evenly faster from substep to substep as the body's velocity grows or turns: all at once it
        // would ask more of friction than a substep's load allows.
        const Vec3 faster = 2.0 / substeps_ * (body.velocity - start.velocity);
        const Vec3 spun_up = 2.0 / substeps_ * (body.angular_velocity - start.angular_velocity);
        Vec3 turned = Vec3::Zero();
        if (movers_[k].manifold != none) {
            const Manifold& m = problem.manifolds[movers_[k].manifold];
            const std::uint32_t rider = m.a == movers_[k].body ? m.b : m.a;
            turned = d_ * turn_of_carrier(body, problem.before[rider].velocity - start.velocity, m.normal);
        }
        float* s = state(1 + dynamic + k);
        float* f = forces_.data() + soft::inertia_floats * (1 + dynamic + k);
        put(s, 1, start.velocity - 0.5 * (faster + turned));
        put(s + 3, 1, start.angular_velocity - 0.5 * spun_up);
        put(f, 1, faster + turned);
        put(f + 3, 1, spun_up);
    }
}

// `made`: room for a place that is not kept.
const SoftBatch::Place& SoftBatch::find_place(std::uint32_t body, std::uint32_t manifold, const ContactProblem& problem,
                                              const std::vector<std::uint32_t>& slot, Place& made) const {
    const Body& b = problem.bodies[body];
    if (b.dynamic()) return places_[slot[body]];
    if (b.type != BodyType::kinematic) return made = place_of(b, 0);
    const auto place = std::lower_bound(movers_.begin(), movers_.end(), mover(body, manifold, problem)) - movers_.begin();
    return made = place_of(b, std::uint32_t(slots_ - movers_.size() + std::size_t(place)));
}

// For a substep more than the step: the last sweep looks as far ahead.
double SoftBatch::gap_of_curves(const Manifold& m, const ContactProblem& problem) const {
    const auto& [bodies, manifolds, before, patches] = problem;
    return passing_gap(m, bodies[m.a], bodies[m.b], before[m.a], before[m.b], patches.h + d_);
}

// Lane l of group g.
void SoftBatch::pack_lane(const ContactProblem& problem, std::uint32_t manifold, std::size_t g, std::size_t l,
                          const std::vector<std::uint32_t>& slot) {
    Manifold& m = problem.manifolds[manifold];
    temper(m, problem);
    Place made_a, made_b;
    const Place &first = find_place(m.a, manifold, problem, slot, made_a), &second = find_place(m.b, manifold, problem, slot, made_b);
    // Arms go from the body that moves, of two from the smaller: from the other's centre single precision may be too coarse.
    const bool swapped = !first.dynamic || (second.dynamic && second.radius < first.radius);
    const Place &a = swapped ? second : first, &b = swapped ? first : second;
    const std::size_t lanes = std::size_t(kernel_.lanes);
    const int stride = kernel_.lanes;
    lane_bodies_[2 * lanes * g + l] = std::uint32_t(soft::body_floats) * a.slot;
    lane_bodies_[2 * lanes * g + lanes + l] = std::uint32_t(soft::body_floats) * b.slot;
    lane_moved_[2 * g] |= std::uint16_t(a.dynamic << l);
    lane_moved_[2 * g + 1] |= std::uint16_t(b.dynamic << l);
    const double share = 1.0 / (substeps_ * mass_unit_);
    const double size = std::min(a.radius, b.radius);
    const bool bouncy = std::max(a.restitution, b.restitution) > 0.0;
    Source& source = sources_[lanes * g + l];
    float* const head = row(g, 0) + l;
    float* point = head + soft::head_rows * stride;
    int count = 0;
    const bool curved = m.curved();
    for (int i = 0; i < m.count; ++i) {
        const ContactPoint& p = m.points[std::size_t(i)];
        if (bouncy && will_bounce(p, m.normal, problem.bodies[m.a], problem.bodies[m.b], problem.patches)) continue;
        source.point[count++] = std::uint8_t(i);
        if (p.separation < -tuning::soft_energy_deep * size) energies_.lies_deep(a.slot - 1);
        put(point + soft::turn * stride, stride, p.position - a.position);
        point[soft::normal_mass * stride] = 1.0f;
        point[soft::separation * stride] = float(curved ? gap_of_curves(m, problem) : p.separation);
        point[soft::impulse * stride] = float(share * p.impulse);
        point += soft::point_rows * stride;
    }
    if (count == 0) return release(m);   // left to bounce
    source.count = std::uint8_t(count);
    source.swapped = swapped;
    lane_points_[g] = std::max(lane_points_[g], source.count);

    const auto put_row = [&](int r, double value) { head[r * stride] = float(value); };
    put(head + soft::normal * stride, stride, swapped ? Vec3(-m.normal) : m.normal);
    put(head + soft::tangent_1 * stride, stride, m.tangent);
    put(head + soft::between * stride, stride, a.position - b.position);
    put_row(soft::friction_coefficient, a.friction == b.friction ? a.friction : std::sqrt(a.friction * b.friction));
    put_row(soft::size, size);
    // Seen from the other body the second tangent is opposite too, and so is an impulse along the first.
    put_row(soft::friction_1, (swapped ? -share : share) * m.friction[0]);
    put_row(soft::friction_2, share * m.friction[1]);
    put_row(soft::twist, share * m.twist);
}

void SoftBatch::pack(const ContactProblem& problem, std::size_t group, const std::vector<std::uint32_t>& slot) {
    const std::size_t lanes = std::size_t(kernel_.lanes);
    int points = 0;
    for (std::size_t lane = lanes * group; lane < lanes * (group + 1); ++lane)
        if (lane_manifolds_[lane] != none) points = std::max(points, problem.manifolds[lane_manifolds_[lane]].count);
    std::fill_n(row(group, 0), std::size_t(soft::head_rows + points * soft::point_rows) * lanes, 0.0f);
    std::fill_n(lane_bodies_.begin() + std::ptrdiff_t(2 * lanes * group), 2 * lanes, 0u);
    lane_moved_[2 * group] = lane_moved_[2 * group + 1] = 0;
    lane_points_[group] = 0;
    for (std::size_t l = 0; l < lanes; ++l) {
        sources_[lanes * group + l] = {};
        if (const std::uint32_t m = lane_manifolds_[lanes * group + l]; m != none) pack_lane(problem, m, group, l, slot);
    }
}

void SoftBatch::run(const ContactProblem& problem, const SoftSolver::Part& part, const std::vector<std::uint32_t>& slot,
                    std::size_t thread, std::size_t team, SpinBarrier& barrier) {
    const auto meet = [&] {
        if (team > 1) barrier.wait();
    };
    color(problem, part, slot, thread, team);
    meet();
    if (thread == 0) lay_out(part);
    meet();
    const soft::Groups groups{rows_.data(), lane_bodies_.data(), lane_moved_.data(), lane_points_.data()};
    const soft::Bodies bodies{state_.data(), inertia_.data(), forces_.data(), before_.data()};
    const std::size_t across = blocks_.size();
    const Share own = blocks_of(thread, team);
    const std::size_t first_body = blocks_.first(own.begin), end_body = blocks_.first(own.end);
    const auto group_of = [&](std::size_t home) { return first_group_[first_color_[home]]; };
    const std::size_t first_across = group_of(across), all_across = first_group_.back() - first_across;
    // Colour by colour: in this thread's blocks, then between blocks.
    const auto each_color = [&](auto&& pass) {
        for (std::size_t c = first_color_[own.begin]; c < first_color_[own.end]; ++c) pass(first_group_[c], first_group_[c + 1]);
        if (all_across == 0) return;
        meet();
        const bool shared = all_across >= tuning::soft_shared_groups;
        for (std::size_t c = first_color_[across]; c < first_color_[across + 1]; ++c) {
            const std::size_t first = first_group_[c], count = first_group_[c + 1] - first;
            if (shared) {
                pass(first + count * thread / team, first + count * (thread + 1) / team);
                meet();
            } else if (thread == 0) {
                pass(first, first + count);
            }
        }
        if (!shared) meet();
    };

    pack_bodies(problem, first_body, end_body);
    if (thread == 0) pack_movers(problem);
    meet();
    const auto pack_groups = [&](std::size_t first, std::size_t last) {
        for (std::size_t g = first; g < last; ++g) pack(problem, g, slot);
        kernel_.prepare(groups, first, last, bodies);
    };
    pack_groups(group_of(own.begin), group_of(own.end));
    pack_groups(first_across + all_across * thread / team, first_across + all_across * (thread + 1) / team);
    meet();
    for (int step = 0; step < substeps_; ++step) {
        kernel_.accelerate(1 + first_body, 1 + end_body, bodies, step > 0);
        if (!movers_.empty()) {   // which all threads look at
            meet();
            if (thread == 0) kernel_.accelerate(1 + blocks_.order().size(), slots_, bodies, false);
            meet();
        }
        if (step == 0) each_color([&](std::size_t f, std::size_t l) { kernel_.warm_start(groups, f, l, bodies); });
        each_color([&](std::size_t f, std::size_t l) { kernel_.push(groups, f, l, bodies, substep_); });
        kernel_.move(1 + first_body, 1 + end_body, bodies, float(d_));
        if (!movers_.empty()) {
            meet();
            if (thread == 0) kernel_.move(1 + blocks_.order().size(), slots_, bodies, float(d_));
            meet();
        }
        each_color([&](std::size_t f, std::size_t l) { kernel_.relax(groups, f, l, bodies, substep_); });
    }
    each_color([&](std::size_t f, std::size_t l) {
        kernel_.sum(groups, f, l);
        for (std::size_t g = f; g < l; ++g) unpack(problem, g);
    });
    hand_back(problem, first_body, end_body);
    meet();
    energies_.hold(blocks_, first_body, end_body, problem.bodies, problem.before, problem.patches.h);
}

// Impulses to the manifolds, and to the momenta of their bodies.
void SoftBatch::unpack(const ContactProblem& problem, std::size_t g) {
    const std::size_t lanes = std::size_t(kernel_.lanes);
    const double all = substeps_ * mass_unit_;
    for (std::size_t l = 0; l < lanes; ++l) {
        const Source& source = sources_[lanes * g + l];
        if (source.count == 0) continue;
        Manifold& m = problem.manifolds[lane_manifolds_[lanes * g + l]];
        const float* head = row(g, 0) + l;
        const auto three = [&](int r) { return Vec3(head[std::size_t(r) * lanes], head[std::size_t(r + 1) * lanes], head[std::size_t(r + 2) * lanes]); };
        release(m);
        const float* impulse = head + soft::head_rows * lanes + soft::impulse * lanes;
        for (int i = 0; i < source.count; ++i, impulse += soft::point_rows * lanes)
            m.points[source.point[i]].impulse = all * double(*impulse);
        m.friction[0] = (source.swapped ? -all : all) * double(head[soft::friction_1 * lanes]);
        m.friction[1] = all * double(head[soft::friction_2 * lanes]);
        m.twist = all * double(head[soft::twist * lanes]);
        m.tangent = three(soft::tangent_1);
        const Vec3 force = mass_unit_ * three(soft::force), moment = mass_unit_ * three(soft::moment);   // on B; about A's centre
        if (force.isZero(0.0) && moment.isZero(0.0)) continue;
        const std::uint32_t slot_a = lane_bodies_[2 * lanes * g + l] / soft::body_floats;
        const std::uint32_t slot_b = lane_bodies_[2 * lanes * g + lanes + l] / soft::body_floats;
        Body &a = problem.bodies[source.swapped ? m.b : m.a], &b = problem.bodies[source.swapped ? m.a : m.b];
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
    const double rate = 1.0 / problem.patches.h;
    for (std::size_t k = first; k < last; ++k) {
        if (!reached_[k + 1]) continue;
        Body& body = problem.bodies[blocks_.order()[k]];
        body.derive_velocities();
        const float* moved = state(k + 1) + 8;
        body.push_velocity = rate * Vec3(moved[0], moved[1], moved[2]) - body.velocity;
        body.push_angular_velocity = rate * Vec3(moved[3], moved[4], moved[5]) - body.angular_velocity - body.gyration;
        energies_.end(k, body);
    }
}

}  // namespace tumble
