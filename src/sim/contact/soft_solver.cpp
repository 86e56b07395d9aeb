#include "sim/contact/soft_solver.h"

#include "sim/spin_barrier.h"
#include "sim/tuning.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>

namespace tumble {
namespace {

// Memory aligned for the widest kernel.
class AlignedFloats {
public:
    void resize(std::size_t count) {
        if (memory_.size() < count + 16) memory_.resize(count + 16);
        data_ = memory_.data() + (64 - reinterpret_cast<std::uintptr_t>(memory_.data()) % 64) % 64 / sizeof(float);
    }
    float* data() { return data_; }

private:
    std::vector<float> memory_;
    float* data_ = nullptr;
};

struct Softness {
    double bias_rate, mass_scale, impulse_scale;
};

// For a substep of d seconds (formulas: soft_solver.h).
Softness softness(double frequency, double d) {
    const double w = 2.0 * std::numbers::pi * frequency, z = tuning::soft_damping;
    const double a = 2.0 * z + d * w, c = d * w * a;
    return {w / a, c / (1.0 + c), 1.0 / (1.0 + c)};
}

// Which points of a lane's manifold are its points.
struct Source {
    std::uint8_t count = 0;
    std::uint8_t point[Manifold::capacity] = {};
};

// What packing needs of a body, close together in memory.
struct Place {
    Vec3 position;
    double radius, friction, restitution;
    std::uint32_t slot;
    bool dynamic;
};

void put(float* row, int stride, const Vec3& v) {
    row[0] = float(v.x());
    row[stride] = float(v.y());
    row[2 * stride] = float(v.z());
}

}  // namespace

int substeps_of(double h) {
    // A step of exactly so many substeps must not get one more by rounding.
    const double n = std::ceil(h / tuning::soft_substep - 1e-6);
    return int(std::clamp(n, double(tuning::soft_least_substeps), double(tuning::soft_most_substeps)));
}

// One part's contacts in the kernel's layout.
class SoftSolver::Batch {
public:
    explicit Batch(const soft::Kernel& kernel) : kernel_(kernel) {}

    /// Bodies and colours; then, called by all threads of a team, all the rest.
    void prepare(const ContactProblem& problem, const Part& part, std::vector<std::uint32_t>& slot);
    void run(const ContactProblem& problem, const Part& part, const std::vector<std::uint32_t>& slot, std::size_t thread,
             std::size_t team, SpinBarrier& barrier);

private:
    static constexpr std::uint32_t none = UINT32_MAX;
    static constexpr int colors = 64;   // bits of a mask; what finds none free is solved one by one

    void pack_bodies(const ContactProblem& problem, const Part& part, std::vector<std::uint32_t>& slot);
    Place place_of(const Body& body, std::uint32_t slot) const {
        return {body.position, body.radius, body.friction, body.restitution, slot, body.dynamic()};
    }
    Place find_place(std::uint32_t body, const ContactProblem& problem, const std::vector<std::uint32_t>& slot) const;
    void color(const ContactProblem& problem, const Part& part, const std::vector<std::uint32_t>& slot);
    void pack_lane(const ContactProblem& problem, std::uint32_t manifold, std::size_t lane, const std::vector<std::uint32_t>& slot);
    void pack(const ContactProblem& problem, std::size_t group, const std::vector<std::uint32_t>& slot);
    void unpack(const ContactProblem& problem, std::size_t group);
    void hand_back(const ContactProblem& problem, const Part& part, std::size_t first, std::size_t last);
    template <class Pass>
    void by_color(std::size_t thread, std::size_t team, SpinBarrier& barrier, Pass&& pass);

    float* state(std::size_t s) { return state_.data() + soft::body_floats * s; }
    float* row(std::size_t group, int r) { return rows_.data() + (group * soft::group_rows + std::size_t(r)) * std::size_t(kernel_.lanes); }
    float* point_row(std::size_t group, int point, int r) { return row(group, soft::head_rows + point * soft::point_rows + r); }

    const soft::Kernel& kernel_;
    double d_ = 0.0;                                  // s, a substep
    int substeps_ = 1;
    Softness moving_{}, fixed_{};
    AlignedFloats state_, mass_, before_, forces_, rows_;   // before_, forces_: 8 floats a slot
    std::size_t slots_ = 0;
    std::vector<Place> places_;                       // by slot
    std::vector<std::uint32_t> movers_;               // kinematic bodies, by slot from the first after the dynamic ones
    std::vector<std::vector<std::uint32_t>> by_color_;
    std::vector<std::uint64_t> mask_;                 // by slot: colours taken
    std::vector<std::size_t> first_group_;            // of each colour that is used, and the end
    std::vector<std::uint32_t> lane_bodies_;
    std::vector<std::uint8_t> lane_points_;
    std::vector<std::uint32_t> lane_manifolds_;       // by lane; none in lanes left over
    std::vector<Source> sources_;                     // by lane
    std::vector<std::uint8_t> reached_;               // by slot: whether an impulse has
};

void SoftSolver::Batch::pack_bodies(const ContactProblem& problem, const Part& part, std::vector<std::uint32_t>& slot) {
    // Kinematic bodies among the manifolds get slots of their own: they move, and are never written to.
    movers_.clear();
    for (const std::uint32_t m : part.manifolds)
        for (const std::uint32_t i : {problem.manifolds[m].a, problem.manifolds[m].b})
            if (problem.bodies[i].type == BodyType::kinematic) movers_.push_back(i);
    std::sort(movers_.begin(), movers_.end());
    movers_.erase(std::unique(movers_.begin(), movers_.end()), movers_.end());

    const std::size_t dynamic = part.bodies.size();
    slots_ = 1 + dynamic + movers_.size();
    for (AlignedFloats* array : {&state_, &mass_, &before_, &forces_})
        array->resize(slots_ * (array == &state_ ? soft::body_floats : soft::mass_floats));
    std::fill_n(state_.data(), slots_ * soft::body_floats, 0.0f);
    std::fill_n(mass_.data(), slots_ * soft::mass_floats, 0.0f);
    std::fill_n(forces_.data(), slots_ * 8, 0.0f);
    std::fill_n(before_.data(), slots_ * 8, 0.0f);
    const double share = 1.0 / substeps_;
    places_.resize(dynamic + 1);
    for (std::size_t k = 0; k < dynamic; ++k) {
        const std::uint32_t i = part.bodies[k];
        const Body& body = problem.bodies[i];
        slot[i] = std::uint32_t(k + 1);
        places_[k + 1] = place_of(body, slot[i]);
        float* s = state(k + 1);
        put(s, 1, problem.velocity_before[i]);
        put(s + 3, 1, problem.angular_velocity_before[i]);
        float* f = forces_.data() + 8 * (k + 1);
        put(f, 1, share * (body.velocity - problem.velocity_before[i]));
        put(f + 3, 1, share * (body.angular_velocity - problem.angular_velocity_before[i]));
        float* m = mass_.data() + soft::mass_floats * (k + 1);
        const Mat3& inverse = body.inverse_inertia;
        m[0] = float(body.inverse_mass);
        m[1] = float(inverse(0, 0));
        m[2] = float(inverse(0, 1));
        m[3] = float(inverse(0, 2));
        m[4] = float(inverse(1, 1));
        m[5] = float(inverse(1, 2));
        m[6] = float(inverse(2, 2));
    }
    for (std::size_t k = 0; k < movers_.size(); ++k) {
        const Body& body = problem.bodies[movers_[k]];
        float* s = state(1 + dynamic + k);
        put(s, 1, body.velocity);
        put(s + 3, 1, body.angular_velocity);
    }
}

Place SoftSolver::Batch::find_place(std::uint32_t body, const ContactProblem& problem, const std::vector<std::uint32_t>& slot) const {
    const Body& b = problem.bodies[body];
    if (b.dynamic()) return places_[slot[body]];
    if (b.type != BodyType::kinematic) return place_of(b, soft::unmoved);
    const auto place = std::lower_bound(movers_.begin(), movers_.end(), body) - movers_.begin();
    return place_of(b, soft::unmoved | std::uint32_t(slots_ - movers_.size() + std::size_t(place)));
}

// Greedily in the manifolds' order: the least colour neither body has. What a body gets depends on its island alone.
void SoftSolver::Batch::color(const ContactProblem& problem, const Part& part, const std::vector<std::uint32_t>& slot) {
    by_color_.resize(colors + 1);
    for (auto& list : by_color_) list.clear();
    mask_.assign(slots_, 0);
    for (const std::uint32_t k : part.manifolds) {
        const Manifold& m = problem.manifolds[k];
        const bool moves_a = problem.bodies[m.a].dynamic(), moves_b = problem.bodies[m.b].dynamic();
        std::uint64_t fixed = 0, &of_a = moves_a ? mask_[slot[m.a]] : fixed, &of_b = moves_b ? mask_[slot[m.b]] : fixed;
        const std::uint64_t taken = of_a | of_b;
        const int c = std::countr_one(taken);
        if (c < colors) {
            if (moves_a) of_a |= std::uint64_t(1) << c;
            if (moves_b) of_b |= std::uint64_t(1) << c;
        }
        by_color_[std::size_t(c)].push_back(k);
    }
}

void SoftSolver::Batch::pack_lane(const ContactProblem& problem, std::uint32_t manifold, std::size_t lane,
                                  const std::vector<std::uint32_t>& slot) {
    Manifold& m = problem.manifolds[manifold];
    const Place a = find_place(m.a, problem, slot), b = find_place(m.b, problem, slot);
    const std::size_t lanes = std::size_t(kernel_.lanes), g = lane / lanes, l = lane % lanes;
    const int stride = kernel_.lanes;
    lane_bodies_[2 * lanes * g + l] = a.slot;
    lane_bodies_[2 * lanes * g + lanes + l] = b.slot;
    const double share = 1.0 / substeps_;
    const double size = std::min(a.radius, b.radius);
    const bool bouncy = std::max(a.restitution, b.restitution) > 0.0;
    Source& source = sources_[lane];
    int count = 0;
    for (int i = 0; i < m.count; ++i) {
        const ContactPoint& p = m.points[std::size_t(i)];
        if (bouncy && will_bounce(p, m.normal, problem.bodies[m.a], problem.bodies[m.b], problem.patches)) continue;
        source.point[count] = std::uint8_t(i);
        float* row = point_row(g, count++, 0) + l;
        put(row + soft::arm_a * stride, stride, p.position - a.position);
        put(row + soft::arm_b * stride, stride, p.position - b.position);
        row[soft::normal_mass * stride] = 1.0f;
        row[soft::separation * stride] = float(p.separation);
        row[soft::bounce * stride] = float(p.bounce);
        row[soft::impulse * stride] = float(share * p.impulse);
    }
    if (count == 0) return release(m);   // left to bounce
    source.count = std::uint8_t(count);
    lane_points_[g] = std::max(lane_points_[g], source.count);

    float* head = row(g, 0) + l;
    const auto put_row = [&](int r, double value) { head[r * stride] = float(value); };
    put(head + soft::normal * stride, stride, m.normal);
    put(head + soft::tangent_1 * stride, stride, m.tangent);
    const Softness& soft = a.dynamic && b.dynamic ? moving_ : fixed_;
    put_row(soft::friction_coefficient, a.friction == b.friction ? a.friction : std::sqrt(a.friction * b.friction));
    put_row(soft::bias_rate, soft.bias_rate);
    put_row(soft::mass_scale, soft.mass_scale);
    put_row(soft::impulse_scale, soft.impulse_scale);
    put_row(soft::size, size);
    put_row(soft::friction_1, share * m.friction[0]);
    put_row(soft::friction_2, share * m.friction[1]);
    put_row(soft::twist, share * m.twist);
}

void SoftSolver::Batch::prepare(const ContactProblem& problem, const Part& part, std::vector<std::uint32_t>& slot) {
    substeps_ = substeps_of(problem.patches.h) * part.finer;
    d_ = problem.patches.h / substeps_;
    moving_ = softness(tuning::soft_frequency / d_, d_);
    fixed_ = softness(2.0 * tuning::soft_frequency / d_, d_);
    pack_bodies(problem, part, slot);
    color(problem, part, slot);

    const std::size_t lanes = std::size_t(kernel_.lanes);
    first_group_.assign(1, 0);
    lane_manifolds_.clear();
    const auto end_color = [&] {
        lane_manifolds_.resize((lane_manifolds_.size() + lanes - 1) / lanes * lanes, none);
        first_group_.push_back(lane_manifolds_.size() / lanes);
    };
    for (int c = 0; c < colors; ++c) {
        const auto& list = by_color_[std::size_t(c)];
        if (list.empty()) continue;
        // Manifolds with as many points side by side: no lane waits for another's fourth.
        for (int points = Manifold::capacity; points > 0; --points)
            for (const std::uint32_t k : list)
                if (problem.manifolds[k].count == points) lane_manifolds_.push_back(k);
        end_color();
    }
    // Those beyond the last colour may share bodies: each is a colour of its own.
    for (const std::uint32_t k : by_color_[colors]) {
        lane_manifolds_.push_back(k);
        end_color();
    }
    const std::size_t groups = first_group_.back();
    rows_.resize(groups * soft::group_rows * lanes);
    lane_bodies_.resize(2 * lanes * groups);
    lane_points_.resize(groups);
    sources_.resize(groups * lanes);
    reached_.assign(slots_, 0);
}

void SoftSolver::Batch::pack(const ContactProblem& problem, std::size_t group, const std::vector<std::uint32_t>& slot) {
    const std::size_t lanes = std::size_t(kernel_.lanes);
    const int points = problem.manifolds[lane_manifolds_[lanes * group]].count;   // the most comes first
    std::fill_n(row(group, 0), std::size_t(soft::head_rows + points * soft::point_rows) * lanes, 0.0f);
    std::fill_n(lane_bodies_.begin() + std::ptrdiff_t(2 * lanes * group), 2 * lanes, soft::unmoved);
    lane_points_[group] = 0;
    for (std::size_t lane = lanes * group; lane < lanes * (group + 1); ++lane) {
        sources_[lane] = {};
        if (lane_manifolds_[lane] != none) pack_lane(problem, lane_manifolds_[lane], lane, slot);
    }
}

template <class Pass>
void SoftSolver::Batch::by_color(std::size_t thread, std::size_t team, SpinBarrier& barrier, Pass&& pass) {
    for (std::size_t c = 0; c + 1 < first_group_.size(); ++c) {
        const std::size_t first = first_group_[c], count = first_group_[c + 1] - first;
        pass(first + count * thread / team, first + count * (thread + 1) / team);
        if (team > 1) barrier.wait();
    }
}

void SoftSolver::Batch::run(const ContactProblem& problem, const Part& part, const std::vector<std::uint32_t>& slot,
                            std::size_t thread, std::size_t team, SpinBarrier& barrier) {
    const soft::Groups groups{rows_.data(), lane_bodies_.data(), lane_points_.data()};
    const soft::Bodies bodies{state_.data(), mass_.data(), forces_.data(), before_.data()};
    const float rate = float(1.0 / d_);
    const std::size_t dynamic_end = slots_ - movers_.size();
    const auto share_of = [&](std::size_t begin, std::size_t end, auto&& pass) {
        const std::size_t count = end - begin;
        pass(begin + count * thread / team, begin + count * (thread + 1) / team);
        if (team > 1) barrier.wait();
    };
    share_of(0, first_group_.back(), [&](std::size_t f, std::size_t l) {
        for (std::size_t g = f; g < l; ++g) pack(problem, g, slot);
        kernel_.prepare(groups, f, l, bodies);
    });
    for (int step = 0; step < substeps_; ++step) {
        share_of(1, dynamic_end, [&](std::size_t f, std::size_t l) { kernel_.accelerate(f, l, bodies, step > 0); });
        if (step == 0) by_color(thread, team, barrier, [&](std::size_t f, std::size_t l) { kernel_.warm_start(groups, f, l, bodies); });
        by_color(thread, team, barrier, [&](std::size_t f, std::size_t l) { kernel_.push(groups, f, l, bodies, rate); });
        share_of(1, slots_, [&](std::size_t f, std::size_t l) { kernel_.move(f, l, bodies, float(d_)); });
        by_color(thread, team, barrier, [&](std::size_t f, std::size_t l) { kernel_.relax(groups, f, l, bodies, rate); });
    }
    by_color(thread, team, barrier, [&](std::size_t f, std::size_t l) {
        kernel_.sum(groups, f, l);
        for (std::size_t g = f; g < l; ++g) unpack(problem, g);
    });
    share_of(0, part.bodies.size(), [&](std::size_t f, std::size_t l) { hand_back(problem, part, f, l); });
}

// Impulses to the manifolds, and to the momenta of their bodies.
void SoftSolver::Batch::unpack(const ContactProblem& problem, std::size_t g) {
    const std::size_t lanes = std::size_t(kernel_.lanes);
    for (std::size_t l = 0; l < lanes; ++l) {
        const Source& source = sources_[lanes * g + l];
        if (source.count == 0) continue;
        Manifold& m = problem.manifolds[lane_manifolds_[lanes * g + l]];
        const float* head = row(g, 0) + l;
        const auto three = [&](int r) { return Vec3(head[std::size_t(r) * lanes], head[std::size_t(r + 1) * lanes], head[std::size_t(r + 2) * lanes]); };
        release(m);
        for (int i = 0; i < source.count; ++i)
            m.points[source.point[i]].impulse = substeps_ * double(point_row(g, i, soft::impulse)[l]);
        m.friction[0] = substeps_ * double(head[soft::friction_1 * lanes]);
        m.friction[1] = substeps_ * double(head[soft::friction_2 * lanes]);
        m.twist = substeps_ * double(head[soft::twist * lanes]);
        m.tangent = three(soft::tangent_1);
        const Vec3 force = three(soft::force), moment = three(soft::moment);   // on B; about A's centre
        if (force.isZero(0.0) && moment.isZero(0.0)) continue;
        const std::uint32_t slot_a = lane_bodies_[2 * lanes * g + l], slot_b = lane_bodies_[2 * lanes * g + lanes + l];
        Body &a = problem.bodies[m.a], &b = problem.bodies[m.b];
        if (!(slot_a & soft::unmoved)) {
            reached_[slot_a] = 1;
            a.momentum -= force;
            a.angular_momentum -= moment;
        }
        if (!(slot_b & soft::unmoved)) {
            reached_[slot_b] = 1;
            b.momentum += force;
            b.angular_momentum += moment + (a.position - b.position).cross(force);
        }
    }
}

void SoftSolver::Batch::hand_back(const ContactProblem& problem, const Part& part, std::size_t first, std::size_t last) {
    const double rate = 1.0 / problem.patches.h;
    for (std::size_t k = first; k < last; ++k) {
        if (!reached_[k + 1]) continue;
        Body& body = problem.bodies[part.bodies[k]];
        body.derive_velocities();
        const float* moved = state(k + 1) + 8;
        body.push_velocity = rate * Vec3(moved[0], moved[1], moved[2]) - body.velocity;
        body.push_angular_velocity = rate * Vec3(moved[3], moved[4], moved[5]) - body.angular_velocity;
    }
}

SoftSolver::SoftSolver(std::size_t bodies, const soft::Kernel& kernel) : kernel_(kernel), slot_(bodies, 0) {}
SoftSolver::~SoftSolver() = default;

void SoftSolver::solve(const ContactProblem& problem, std::span<const Part> parts, ThreadPool& pool) {
    while (batches_.size() < parts.size()) batches_.push_back(std::make_unique<Batch>(kernel_));
    if (parts.size() == 1) {   // one island, or too little work to share: the threads share its colours
        Batch& batch = *batches_[0];
        batch.prepare(problem, parts[0], slot_);
        const bool worth_it = parts[0].manifolds.size() >= tuning::soft_team_manifolds;
        const std::size_t team = worth_it ? std::size_t(pool.size()) : 1;
        SpinBarrier barrier(team);
        if (team == 1) batch.run(problem, parts[0], slot_, 0, 1, barrier);
        else pool.together([&](std::size_t thread) { batch.run(problem, parts[0], slot_, thread, team, barrier); });
        return;
    }
    pool.for_each(parts.size(), 2, [&](std::size_t k, std::size_t) {
        SpinBarrier alone(1);
        batches_[k]->prepare(problem, parts[k], slot_);
        batches_[k]->run(problem, parts[k], slot_, 0, 1, alone);
    });
}

}  // namespace tumble
