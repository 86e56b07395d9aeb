// The kernel's code for TUMBLE_LANES lanes: included by one source file per instruction set, inside an unnamed
// namespace, so that no two share a symbol. Equations: soft_solver.h.

constexpr float friction_near = float(tuning::friction_near), friction_far_weight = float(tuning::friction_far_weight);
constexpr float spin_share = float(tuning::spin_share), disc = float(spin_friction::disc),
                steep = float(spin_friction::steep), bent = float(spin_friction::bent),
                sliding_square = float(spin_friction::sliding_square),
                spinning_square = float(spin_friction::spinning_square),
                spinning_limit = float(spin_friction::spinning_limit);
constexpr float unlike_masses = float(tuning::soft_unlike_masses), twice_as_stiff = float(tuning::soft_twice_as_stiff);
constexpr float slop = float(tuning::soft_slop), correction_limit = float(tuning::correction_limit),
                least_give = float(tuning::soft_least_give);

#include "sim/contact/soft/soft_lanes.h"

struct Motion {
    Vector linear, angular;
    Lanes inverse_mass;  // gathered with the velocities
};

// half 0: velocities, half 1: displacements.
inline Motion load(const Bodies& bodies, const std::uint32_t* lane, int half) {
    const Eights e = gather([&](int i) { return bodies.state + lane[i] + 8 * half; });
    return {{e.low.r[0], e.low.r[1], e.low.r[2]}, {e.low.r[3], e.high.r[0], e.high.r[1]}, e.high.r[2]};
}

inline Tensor load_inertia(const Bodies& bodies, const std::uint32_t* lane) {
    const Eights e = gather([&](int i) { return bodies.inertia + lane[i] / body_floats * inertia_floats; });
    return {e.low.r[0], e.low.r[1], e.low.r[2], e.low.r[3], e.high.r[0], e.high.r[1]};
}

// Stores the velocities of bodies that impulses move.
inline void save(const Bodies& bodies, const std::uint32_t* lane, std::uint32_t moved, const Motion& m) {
    const Eights e{transposed({{m.linear.x, m.linear.y, m.linear.z, m.angular.x}}),
                   transposed({{m.angular.y, m.angular.z, m.inverse_mass, Lanes{}}})};
    if (moved == (1u << TUMBLE_LANES) - 1u)
        write(e, [&](int i) { return bodies.state + lane[i]; });
    else
        write(e, [&](int i) { return moved >> i & 1u ? bodies.state + lane[i] : nullptr; });
}

using Rows = ManifoldRows<Lanes>;

struct Group {
    Rows& rows;
    const std::uint32_t *a, *b;
    std::uint32_t moved_a, moved_b;
    int points;

    Group(const Groups& groups, std::size_t index)
        : rows(reinterpret_cast<Rows*>(groups.rows)[index]),
          a(groups.bodies + 2 * TUMBLE_LANES * index),
          b(a + TUMBLE_LANES),
          moved_a(groups.moved[2 * index]),
          moved_b(groups.moved[2 * index + 1]),
          points(groups.points[index]) {}
};

constexpr int coupled(int i, int k) { return k * (k - 1) / 2 + i; }  // index in `coupling` of points i < k

// An impulse on B, and its moment about A's center.
struct Impulse {
    Vector linear, angular;
};

// Total impulse of a manifold: normal impulses at each point, along both tangents and torsional (`friction`).
template <class AtPoint>
inline Impulse total(const Rows& m, int points, AtPoint&& along_normal_at, const Vector& friction) {
    const Vector n = m.normal, t1 = m.tangent;
    const Vector across = friction.x * t1 + friction.y * cross(n, t1);
    Lanes along_normal{};
    Vector angular = cross(m.friction_arm, across) + friction.z * n;
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i) {
        along_normal += along_normal_at(i);
        angular = angular + along_normal_at(i) * m.point[i].moment_arm;
    }
    return {along_normal * n + across, angular};
}

// Applies the impulse to B and its opposite to A.
inline void apply(const Rows& m, const Impulse& j, Motion& a, Motion& b) {
    a.linear = a.linear - a.inverse_mass * j.linear;
    b.linear = b.linear + b.inverse_mass * j.linear;
    a.angular = a.angular - m.inverse_inertia_a * j.angular;
    b.angular = b.angular + m.inverse_inertia_b * (j.angular + cross(m.between, j.linear));
}

// Motion of B relative to A: the velocity at A's center and the spin. At an arm r from A's center the velocity is
// linear + angular x r, and along the normal n: n . linear + angular . (r x n).
struct Relative {
    Vector linear, angular;
    Relative(const Rows& m, const Motion& a, const Motion& b)
        : linear(b.linear - a.linear + cross(b.angular, m.between)), angular(b.angular - a.angular) {}
};

// Unit vector across the normal: the last step's direction, or, without one, from the axis at the largest angle to the
// normal.
inline Vector tangent(const Vector& n, const Vector& last) {
    const Vector kept = last - dot(n, last) * n;
    const Lanes square = dot(kept, kept);
    const auto along_x = n.x * n.x < 0.36f;
    const Vector axis{along_x ? all(1.0f) : Lanes{}, along_x ? Lanes{} : all(1.0f), Lanes{}};
    const Vector other = axis - dot(n, axis) * n;
    const auto keeps = square > 0.25f;
    const Vector t{keeps ? kept.x : other.x, keeps ? kept.y : other.y, keeps ? kept.z : other.z};
    const Lanes length = root(dot(t, t));
    return (1.0f / length) * t;
}

void prepare(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies) {
    for (std::size_t k = first; k < last; ++k) {
        const Group g(groups, k);
        Rows& m = g.rows;
        const Tensor of_a = load_inertia(bodies, g.a), of_b = load_inertia(bodies, g.b);
        const Vector n = m.normal, t1 = tangent(n, m.tangent), t2 = cross(n, t1), c = m.between;
        // Lanes without a manifold have no normal: their compliances are set to 1, their impulses stay 0.
        const Lanes empty = n.x == 0.0f && n.y == 0.0f && n.z == 0.0f ? all(1.0f) : Lanes{};
        const Lanes both = load(bodies, g.a, 0).inverse_mass + load(bodies, g.b, 0).inverse_mass + empty;
        m.tangent = t1;
        m.inverse_inertia_a = of_a;
        m.inverse_inertia_b = of_b;

        // Friction acts at the centroid of the area where all points touch or nearly do; otherwise at the centroid of
        // the touching points.
        const Lanes near = friction_near * m.size;
        Lanes far{};  // number of points not near
        for (int i = 0; i < g.points; ++i) far += m.point[i].separation < near ? Lanes{} : m.point[i].present;
        const auto whole = far == 0.0f;
        Vector center{};
        Lanes weights = empty;
        for (int i = 0; i < g.points; ++i) {
            const Lanes alike = m.point[i].separation < near ? all(1.0f) : all(friction_far_weight);
            const Lanes weight = m.point[i].present * (whole ? m.point[i].load_share : alike);
            center = center + weight * m.point[i].arm;
            weights += weight;
        }
        const Vector arm = (1.0f / weights) * center, arm_of_b = arm + c;
        const Vector a1 = cross(arm, t1), b1 = cross(arm_of_b, t1), a2 = cross(arm, t2), b2 = cross(arm_of_b, t2);
        const Vector ia1 = of_a * a1, ib1 = of_b * b1, ia2 = of_a * a2, ib2 = of_b * b2, ia3 = of_a * n, ib3 = of_b * n;
        const Lanes k11 = both + dot(a1, ia1) + dot(b1, ib1), k22 = both + dot(a2, ia2) + dot(b2, ib2);
        const Lanes k12 = dot(a2, ia1) + dot(b2, ib1);
        const Lanes inverse = 1.0f / (k11 * k22 - k12 * k12);
        m.friction_arm = arm;
        m.sticking_mass = {k22 * inverse, -k12 * inverse, k11 * inverse};
        m.sliding_mass = 2.0f / (k11 + k22 + root((k11 - k22) * (k11 - k22) + 4.0f * k12 * k12));
        m.torsional_mass = 1.0f / (dot(n, ia3) + dot(n, ib3) + empty);

        const Vector cn = cross(c, n);
        for (int i = 0; i < g.points; ++i) {
            PointRows<Lanes>& p = m.point[i];
            const Vector away = p.arm - arm;
            p.lever = m.spread * root(dot(away, away));
            const Vector an = cross(p.arm, n), bn = an + cn;
            const Vector ian = of_a * an, ibn = of_b * bn;
            for (int earlier = 0; earlier < i; ++earlier) {
                const Vector other = m.point[earlier].moment_arm;
                m.coupling[coupled(earlier, i)] = both + dot(other, ian) + dot(other + cn, ibn);
            }
            p.moment_arm = an;
            p.to_friction = {dot(an, ia1) + dot(bn, ib1), dot(an, ia2) + dot(bn, ib2), dot(an, ia3) + dot(bn, ib3)};
            p.gap = p.separation;
            p.effective_mass = p.present / (both + dot(an, ian) + dot(bn, ibn));
        }
    }
}

void warm_start(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies) {
    for (std::size_t k = first; k < last; ++k) {
        const Group g(groups, k);
        Motion a = load(bodies, g.a, 0), b = load(bodies, g.b, 0);
        const Rows& m = g.rows;
        const auto impulse_at = [&](int i) { return m.point[i].impulse; };
        apply(m, total(m, g.points, impulse_at, m.friction), a, b);
        save(bodies, g.a, g.moved_a, a);
        save(bodies, g.b, g.moved_b, b);
    }
}

void accelerate(std::size_t first, std::size_t last, const Bodies& bodies, bool again) {
    for (std::size_t s = first; s < last; ++s) {
        Eight& v = *reinterpret_cast<Eight*>(bodies.state + body_floats * s);
        Eight& start = *reinterpret_cast<Eight*>(bodies.start + 8 * s);
        const Eight contact = again ? v - start : Eight{};
        start = v + *reinterpret_cast<const Eight*>(bodies.forces + 8 * s);
        v = start + contact;
    }
}

void move(std::size_t first, std::size_t last, const Bodies& bodies, float substep) {
    for (std::size_t s = first; s < last; ++s) {
        Eight* v = reinterpret_cast<Eight*>(bodies.state + body_floats * s);
        v[1] += substep * v[0];
    }
}

// Present distances of the points. Bodies move between the two sweeps of a substep: the gaps of relax hold for the next
// correction.
template <int points>
inline void find_gaps(const Group& g, const Bodies& bodies) {
    Rows& m = g.rows;
    const Relative moved(m, load(bodies, g.a, 1), load(bodies, g.b, 1));
    const Lanes parted = dot(m.normal, moved.linear);
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i)
        m.point[i].gap = m.point[i].separation + parted + dot(moved.angular, m.point[i].moment_arm);
}

// Velocities that a manifold's impulses act on: of its points along the normal; the slips along both tangents and the
// spin at the friction point. Couplings update them as impulses change; the bodies get the sum of the impulses at the
// end.
template <int points>
struct Speeds {
    Lanes parting[points];
    Vector friction;
};
template <int points>
struct Changes {  // of the impulses of a manifold
    Lanes normal[points];
    Vector friction;
};

template <int points>
inline Speeds<points> speeds_of(const Rows& m, const Motion& a, const Motion& b) {
    const Relative relative(m, a, b);
    const Vector n = m.normal, t1 = m.tangent;
    const Vector slip = relative.linear + cross(relative.angular, m.friction_arm);
    const Lanes parting = dot(n, relative.linear);
    Speeds<points> speeds;
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i) speeds.parting[i] = parting + dot(relative.angular, m.point[i].moment_arm);
    speeds.friction = {dot(slip, t1), dot(slip, cross(n, t1)), dot(n, relative.angular)};
    return speeds;
}

// Moment of the load: sum over the points of load times lever (spin_friction.h).
template <int points>
inline Lanes levers_of(const Rows& m, Lanes load_all, Lanes load_levers) {
    Vector turning{};  // load times arm x normal, from A's center
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i) turning = turning + m.point[i].impulse * m.point[i].moment_arm;
    const Vector t1 = m.tangent, t2 = cross(m.normal, t1), arm = m.friction_arm;
    const Lanes aside_1 = dot(turning, t2) + load_all * dot(arm, t1),
                aside_2 = dot(turning, t1) - load_all * dot(arm, t2);
    return load_levers + (1.0f - m.spread) * root(aside_1 * aside_1 + aside_2 * aside_2);
}

// Coulomb's disc at the friction point, and a torsional moment about the normal, both within the limit of the present
// normal impulses; a remaining spin shares the limit (spin_friction.h).
template <int points>
inline void solve_friction(Rows& m, const Speeds<points>& speeds, Changes<points>& changes) {
    Lanes load_all = Lanes{}, load_levers = Lanes{};
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i) {
        load_all += m.point[i].impulse;
        load_levers += m.point[i].impulse * m.point[i].lever;
    }
    Lanes limit = m.friction_coefficient * load_all, torsional_limit = m.friction_coefficient * load_levers;
    const Lanes v1 = speeds.friction.x, v2 = speeds.friction.y, v3 = speeds.friction.z;
    // Impulses that stop slip and spin completely, if within the limit.
    Lanes j1 = m.friction.x - (m.sticking_mass.xx * v1 + m.sticking_mass.xy * v2);
    Lanes j2 = m.friction.y - (m.sticking_mass.xy * v1 + m.sticking_mass.yy * v2);
    const Lanes still = m.friction.z - m.torsional_mass * v3;
    Lanes j3 = larger(-torsional_limit, smaller(torsional_limit, still));
    const auto slips = j1 * j1 + j2 * j2 > limit * limit;
    auto turns = j3 != still;
    if (any(Lanes(slips | turns))) {  // true is a nonzero bit pattern
        load_levers = levers_of<points>(m, load_all, load_levers);
        torsional_limit = m.friction_coefficient * load_levers;
        j3 = larger(-torsional_limit, smaller(torsional_limit, still));
        turns = j3 != still;
        const Lanes reach = load_all > 0.0f ? load_levers / load_all : Lanes{};  // m, mean distance
        const Lanes slip = v1 * v1 + v2 * v2, spin = reach * reach * v3 * v3;
        const auto spins = turns && torsional_limit > 0.0f && spin > spin_share * spin_share * slip;
        const auto slides = spins || slips;
        // Limits for the present ratio of spin to slip (spin_friction.h).
        const Lanes x = spins ? disc * spin / (slip + disc * spin) : Lanes{}, y = 1.0f - x;
        const Lanes square = (sliding_square * y * y + steep * spinning_square * x * x) / (y * y + steep * x * x);
        const Lanes t = (square - sliding_square) * (1.0f / (spinning_square - sliding_square));
        const Lanes arm = spins ? reach * root(square) : Lanes{}, per_arm = spins ? 1.0f / arm : Lanes{};
        limit = spins ? limit * root(1.0f - t * (1.0f - bent + bent * t) * (1.0f - spinning_limit)) : limit;
        // Otherwise one mass for all directions: friction then ends up opposite to the slip; separate masses would turn
        // it aside.
        const Lanes mass = spins ? smaller(m.sliding_mass, m.torsional_mass * per_arm * per_arm) : m.sliding_mass;
        const Lanes s1 = m.friction.x - mass * v1, s2 = m.friction.y - mass * v2,
                    s3 = per_arm * m.friction.z - mass * arm * v3;
        const Lanes size = root(s1 * s1 + s2 * s2 + s3 * s3);
        const Lanes scale = size > limit ? limit / size : all(1.0f);
        j1 = slides ? scale * s1 : j1;
        j2 = slides ? scale * s2 : j2;
        j3 = spins ? scale * s3 * arm : j3;
    }
    changes.friction = {j1 - m.friction.x, j2 - m.friction.y, j3 - m.friction.z};
    m.friction = {j1, j2, j3};
}

// Visits one point after the other.
template <bool correcting, int points>
inline void solve_normals(Rows& m, const Motion& a, const Motion& b, const Substep& substep, Speeds<points>& speeds,
                          Changes<points>& changes) {
    const auto held = a.inverse_mass == 0.0f || b.inverse_mass == 0.0f;
    const auto unlike =
        larger(a.inverse_mass, b.inverse_mass) > unlike_masses * smaller(a.inverse_mass, b.inverse_mass) && !held;
    const auto choose = [&](float Softness::*value) {
        return held ? all(substep.fixed.*value) : unlike ? all(substep.unlike.*value) : all(substep.alike.*value);
    };
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i) {
        PointRows<Lanes>& p = m.point[i];
        const Lanes closing = p.gap * substep.per_second, old = p.impulse;
        Lanes next;
        if constexpr (correcting) {
            const Lanes rate = choose(&Softness::bias_rate);
            const Lanes overlap = smaller(p.gap + slop * m.size, Lanes{});
            const Lanes deep = unlike ? Lanes{} : smaller(overlap / (-twice_as_stiff * m.size), all(1.0f));
            const Lanes spring = rate * overlap * (1.0f + deep), most = -correction_limit * m.size;
            const auto apart = p.gap > 0.0f;
            const Lanes bias = apart ? closing : larger(spring, most);
            const Lanes mass = apart ? all(1.0f) : choose(&Softness::mass_scale);
            Lanes keep = apart ? Lanes{} : choose(&Softness::impulse_scale);
            // Below the depth limit the spring pushes no faster, but between bodies that move it still carries more
            // load.
            const Lanes limited = spring < most && !held ? all(1.0f) : Lanes{};
            if (any(limited)) keep = limited > 0.0f ? keep * larger(most / spring, all(least_give)) : keep;
            next = old - p.effective_mass * mass * (speeds.parting[i] + bias) - keep * old;
        } else {
            next = old - p.effective_mass * (speeds.parting[i] + larger(closing, Lanes{}));
        }
        next = larger(next, Lanes{});
        p.impulse = next;
        changes.normal[i] = next - old;
#pragma GCC unroll 4
        for (int later = i + 1; later < points; ++later)
            speeds.parting[later] += m.coupling[coupled(i, later)] * changes.normal[i];
    }
}

// True if no lane has any impulse: until one has, nothing changes.
template <int points>
inline bool idle(const Rows& m) {
    Lanes sum = m.friction.x * m.friction.x + m.friction.y * m.friction.y + m.friction.z * m.friction.z;
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i) sum += m.point[i].impulse;
    return !any(sum);
}

template <bool correcting, int points>
inline void solve(const Group& g, const Bodies& bodies, const Substep& substep) {
    if constexpr (!correcting) find_gaps<points>(g, bodies);
    Rows& m = g.rows;
    Motion a = load(bodies, g.a, 0), b = load(bodies, g.b, 0);
    Speeds<points> speeds = speeds_of<points>(m, a, b);
    Changes<points> changes;
    const bool was_idle = idle<points>(m);
    if constexpr (correcting) {
        solve_friction(m, speeds, changes);
#pragma GCC unroll 4
        for (int i = 0; i < points; ++i) speeds.parting[i] += dot(m.point[i].to_friction, changes.friction);
    }
    solve_normals<correcting>(m, a, b, substep, speeds, changes);
    if (was_idle && idle<points>(m)) return;
    if constexpr (!correcting) {
        // Friction last, so that it stays within the limit of the new normal impulses.
#pragma GCC unroll 4
        for (int i = 0; i < points; ++i) speeds.friction = speeds.friction + changes.normal[i] * m.point[i].to_friction;
        solve_friction(m, speeds, changes);
#pragma GCC unroll 4
        for (int i = 0; i < points; ++i) m.point[i].impulse_sum += m.point[i].impulse;
        m.friction_sum = m.friction_sum + m.friction;
    }
    const auto change_at = [&](int i) { return changes.normal[i]; };
    apply(m, total(m, points, change_at, changes.friction), a, b);
    save(bodies, g.a, g.moved_a, a);
    save(bodies, g.b, g.moved_b, b);
}

template <bool correcting>
inline void sweep(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies,
                  const Substep& substep) {
    for (std::size_t k = first; k < last; ++k) {
        const Group g(groups, k);
        switch (g.points) {  // each count in registers of its own
            case 1:
                solve<correcting, 1>(g, bodies, substep);
                break;
            case 2:
                solve<correcting, 2>(g, bodies, substep);
                break;
            case 3:
                solve<correcting, 3>(g, bodies, substep);
                break;
            case 4:
                solve<correcting, 4>(g, bodies, substep);
                break;
            default:
                break;  // all points skipped because they will bounce
        }
    }
}

void correct(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies, const Substep& substep) {
    sweep<true>(groups, first, last, bodies, substep);
}
void relax(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies, const Substep& substep) {
    sweep<false>(groups, first, last, bodies, substep);
}

void rub(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies, bool counts) {
    for (std::size_t k = first; k < last; ++k) {
        const Group g(groups, k);
        Rows& m = g.rows;
        Motion a = load(bodies, g.a, 0), b = load(bodies, g.b, 0);
        const Speeds<1> speeds = speeds_of<1>(m, a, b);
        Changes<1> changes;
        solve_friction(m, speeds, changes);
        if (counts) m.friction_sum = m.friction_sum + m.friction;
        apply(m,
              total(
                  m, 0, [&](int i) { return m.point[i].impulse; }, changes.friction),
              a, b);
        save(bodies, g.a, g.moved_a, a);
        save(bodies, g.b, g.moved_b, b);
    }
}

void sum(const Groups& groups, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
        const Group g(groups, k);
        Rows& m = g.rows;
        const auto sum_at = [&](int i) { return m.point[i].impulse_sum; };
        const Impulse sums = total(m, g.points, sum_at, m.friction_sum);
        m.total_impulse = {sums.linear, sums.angular};
    }
}

#include "sim/contact/soft/soft_joint_lanes.h"
