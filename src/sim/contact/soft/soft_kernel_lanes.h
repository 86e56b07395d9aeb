// The kernel's code for TUMBLE_LANES lanes: included by one source file per instruction set, inside an unnamed
// namespace, so that no two share a symbol. Equations: soft_solver.h.

constexpr float friction_near = float(tuning::friction_near), friction_far_weight = float(tuning::friction_far_weight);
constexpr float spin_share = float(tuning::spin_share), disc = float(spin_friction::disc),
                steep = float(spin_friction::steep), bent = float(spin_friction::bent),
                sliding_square = float(spin_friction::sliding_square),
                spinning_square = float(spin_friction::spinning_square),
                spinning_limit = float(spin_friction::spinning_limit);
constexpr float unlike_masses = float(tuning::soft_unlike_masses), twice_as_stiff = float(tuning::soft_twice_as_stiff);
constexpr float slop = float(tuning::soft_slop), push_limit = float(tuning::push_limit),
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

struct Group {
    Lanes* rows;
    const std::uint32_t *a, *b;
    std::uint32_t moved_a, moved_b;
    int points;

    Group(const Groups& groups, std::size_t index)
        : rows(reinterpret_cast<Lanes*>(groups.rows) + index * group_rows),
          a(groups.bodies + 2 * TUMBLE_LANES * index),
          b(a + TUMBLE_LANES),
          moved_a(groups.moved[2 * index]),
          moved_b(groups.moved[2 * index + 1]),
          points(groups.points[index]) {}

    Lanes& operator[](int row) const { return rows[row]; }
    Lanes& at(int point, int row) const { return rows[head_rows + point * point_rows + row]; }
    Vector vector(int row) const { return {rows[row], rows[row + 1], rows[row + 2]}; }
    Vector vector(int point, int row) const { return vector(head_rows + point * point_rows + row); }
    Tensor tensor(int row) const {
        return {rows[row], rows[row + 1], rows[row + 2], rows[row + 3], rows[row + 4], rows[row + 5]};
    }
    void set(int row, const Vector& v) const {
        rows[row] = v.x;
        rows[row + 1] = v.y;
        rows[row + 2] = v.z;
    }
    void set(int point, int row, const Vector& v) const { set(head_rows + point * point_rows + row, v); }
    void set(int row, const Tensor& t) const {
        set(row, Vector{t.xx, t.xy, t.xz});
        set(row + 3, Vector{t.yy, t.yz, t.zz});
    }
};

constexpr int coupled(int i, int k) { return coupling + k * (k - 1) / 2 + i; }  // of points i < k

// An impulse on B, and its moment about A's center.
struct Impulse {
    Vector linear, angular;
};

// Of a manifold: normal impulses at each point, along both tangents and torsional (`friction`).
template <class AtPoint>
inline Impulse total(const Group& g, int points, AtPoint&& along_normal_at, const Vector& friction) {
    const Vector n = g.vector(normal), t1 = g.vector(tangent_1);
    const Vector across = friction.x * t1 + friction.y * cross(n, t1);
    Lanes along_normal{};
    Vector angular = cross(g.vector(friction_arm), across) + friction.z * n;
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i) {
        along_normal += along_normal_at(i);
        angular = angular + along_normal_at(i) * g.vector(i, turn);
    }
    return {along_normal * n + across, angular};
}

// Applies the impulse to B and its opposite to A.
inline void apply(const Group& g, const Impulse& j, Motion& a, Motion& b) {
    a.linear = a.linear - a.inverse_mass * j.linear;
    b.linear = b.linear + b.inverse_mass * j.linear;
    a.angular = a.angular - g.tensor(inertia_a) * j.angular;
    b.angular = b.angular + g.tensor(inertia_b) * (j.angular + cross(g.vector(between), j.linear));
}

// Motion of B relative to A: the velocity at A's center and the spin. At an arm r from A's center the velocity is
// linear + angular x r, and along the normal n: n . linear + angular . (r x n).
struct Relative {
    Vector linear, angular;
    Relative(const Group& g, const Motion& a, const Motion& b)
        : linear(b.linear - a.linear + cross(b.angular, g.vector(between))), angular(b.angular - a.angular) {}
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
        const Tensor of_a = load_inertia(bodies, g.a), of_b = load_inertia(bodies, g.b);
        const Vector n = g.vector(normal), t1 = tangent(n, g.vector(tangent_1)), t2 = cross(n, t1),
                     c = g.vector(between);
        // Lanes without a manifold have no normal: their compliances are set to 1, their impulses stay 0.
        const Lanes empty = n.x == 0.0f && n.y == 0.0f && n.z == 0.0f ? all(1.0f) : Lanes{};
        const Lanes both = load(bodies, g.a, 0).inverse_mass + load(bodies, g.b, 0).inverse_mass + empty;
        g.set(tangent_1, t1);
        g.set(inertia_a, of_a);
        g.set(inertia_b, of_b);

        // Friction acts at the centroid of the area where all points touch or nearly do; else at the centroid of the
        // touching points.
        const Lanes near = friction_near * g[size];
        Lanes far{};  // number of points not near
        for (int i = 0; i < g.points; ++i) far += g.at(i, separation) < near ? Lanes{} : g.at(i, normal_mass);
        const auto whole = far == 0.0f;
        Vector center{};
        Lanes weights = empty;
        for (int i = 0; i < g.points; ++i) {
            const Lanes alike = g.at(i, separation) < near ? all(1.0f) : all(friction_far_weight);
            const Lanes weight = g.at(i, normal_mass) * (whole ? g.at(i, lever) : alike);
            center = center + weight * g.vector(i, turn);
            weights += weight;
        }
        const Vector arm = (1.0f / weights) * center, arm_of_b = arm + c;
        const Vector a1 = cross(arm, t1), b1 = cross(arm_of_b, t1), a2 = cross(arm, t2), b2 = cross(arm_of_b, t2);
        const Vector ia1 = of_a * a1, ib1 = of_b * b1, ia2 = of_a * a2, ib2 = of_b * b2, ia3 = of_a * n, ib3 = of_b * n;
        const Lanes k11 = both + dot(a1, ia1) + dot(b1, ib1), k22 = both + dot(a2, ia2) + dot(b2, ib2);
        const Lanes k12 = dot(a2, ia1) + dot(b2, ib1);
        const Lanes inverse = 1.0f / (k11 * k22 - k12 * k12);
        g.set(friction_arm, arm);
        g[stick_mass] = k22 * inverse;
        g[stick_mass + 1] = -k12 * inverse;
        g[stick_mass + 2] = k11 * inverse;
        g[slide_mass] = 2.0f / (k11 + k22 + root((k11 - k22) * (k11 - k22) + 4.0f * k12 * k12));
        g[twist_mass] = 1.0f / (dot(n, ia3) + dot(n, ib3) + empty);

        const Vector cn = cross(c, n);
        for (int i = 0; i < g.points; ++i) {
            const Vector away = g.vector(i, turn) - arm;
            g.at(i, lever) = g[spread] * root(dot(away, away));
            const Vector an = cross(g.vector(i, turn), n), bn = an + cn;
            const Vector ian = of_a * an, ibn = of_b * bn;
            for (int earlier = 0; earlier < i; ++earlier) {
                const Vector other = g.vector(earlier, turn);
                g[coupled(earlier, i)] = both + dot(other, ian) + dot(other + cn, ibn);
            }
            g.set(i, turn, an);
            g.set(i, to_friction,
                  {dot(an, ia1) + dot(bn, ib1), dot(an, ia2) + dot(bn, ib2), dot(an, ia3) + dot(bn, ib3)});
            g.at(i, gap) = g.at(i, separation);
            g.at(i, normal_mass) = g.at(i, normal_mass) / (both + dot(an, ian) + dot(bn, ibn));
        }
    }
}

void warm_start(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies) {
    for (std::size_t k = first; k < last; ++k) {
        const Group g(groups, k);
        Motion a = load(bodies, g.a, 0), b = load(bodies, g.b, 0);
        apply(g,
              total(
                  g, g.points, [&](int i) { return g.at(i, impulse); }, g.vector(friction_1)),
              a, b);
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
// push.
template <int points>
inline void find_gaps(const Group& g, const Bodies& bodies) {
    const Relative moved(g, load(bodies, g.a, 1), load(bodies, g.b, 1));
    const Lanes parted = dot(g.vector(normal), moved.linear);
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i)
        g.at(i, gap) = g.at(i, separation) + parted + dot(moved.angular, g.vector(i, turn));
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
inline Speeds<points> speeds_of(const Group& g, const Motion& a, const Motion& b) {
    const Relative relative(g, a, b);
    const Vector n = g.vector(normal), t1 = g.vector(tangent_1);
    const Vector slip = relative.linear + cross(relative.angular, g.vector(friction_arm));
    const Lanes parting = dot(n, relative.linear);
    Speeds<points> speeds;
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i) speeds.parting[i] = parting + dot(relative.angular, g.vector(i, turn));
    speeds.friction = {dot(slip, t1), dot(slip, cross(n, t1)), dot(n, relative.angular)};
    return speeds;
}

// Moment of the load: sum over the points of load times lever (spin_friction.h).
template <int points>
inline Lanes levers_of(const Group& g, Lanes load_all, Lanes load_levers) {
    Vector turning{};  // load times arm x normal, from A's center
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i) turning = turning + g.at(i, impulse) * g.vector(i, turn);
    const Vector t1 = g.vector(tangent_1), t2 = cross(g.vector(normal), t1), arm = g.vector(friction_arm);
    const Lanes aside_1 = dot(turning, t2) + load_all * dot(arm, t1),
                aside_2 = dot(turning, t1) - load_all * dot(arm, t2);
    return load_levers + (1.0f - g[spread]) * root(aside_1 * aside_1 + aside_2 * aside_2);
}

// Coulomb's disc at the friction point, and a torsional moment about the normal, both within the limit of the present
// normal impulses; a remaining spin shares the limit (spin_friction.h).
template <int points>
inline void solve_friction(const Group& g, const Speeds<points>& speeds, Changes<points>& changes) {
    Lanes load_all = Lanes{}, load_levers = Lanes{};
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i) {
        load_all += g.at(i, impulse);
        load_levers += g.at(i, impulse) * g.at(i, lever);
    }
    Lanes limit = g[friction_coefficient] * load_all, twist_limit = g[friction_coefficient] * load_levers;
    const Lanes v1 = speeds.friction.x, v2 = speeds.friction.y, v3 = speeds.friction.z;
    // Impulses that stop slip and spin completely, if within the limit.
    Lanes j1 = g[friction_1] - (g[stick_mass] * v1 + g[stick_mass + 1] * v2);
    Lanes j2 = g[friction_2] - (g[stick_mass + 1] * v1 + g[stick_mass + 2] * v2);
    const Lanes still = g[twist] - g[twist_mass] * v3;
    Lanes j3 = larger(-twist_limit, smaller(twist_limit, still));
    const auto slips = j1 * j1 + j2 * j2 > limit * limit;
    auto turns = j3 != still;
    if (any(Lanes(slips | turns))) {  // true is a nonzero bit pattern
        load_levers = levers_of<points>(g, load_all, load_levers);
        twist_limit = g[friction_coefficient] * load_levers;
        j3 = larger(-twist_limit, smaller(twist_limit, still));
        turns = j3 != still;
        const Lanes reach = load_all > 0.0f ? load_levers / load_all : Lanes{};  // m, mean distance
        const Lanes slip = v1 * v1 + v2 * v2, spin = reach * reach * v3 * v3;
        const auto spins = turns && twist_limit > 0.0f && spin > spin_share * spin_share * slip;
        const auto slides = spins || slips;
        // Limits for the present ratio of spin to slip (spin_friction.h).
        const Lanes x = spins ? disc * spin / (slip + disc * spin) : Lanes{}, y = 1.0f - x;
        const Lanes square = (sliding_square * y * y + steep * spinning_square * x * x) / (y * y + steep * x * x);
        const Lanes t = (square - sliding_square) * (1.0f / (spinning_square - sliding_square));
        const Lanes arm = spins ? reach * root(square) : Lanes{}, per_arm = spins ? 1.0f / arm : Lanes{};
        limit = spins ? limit * root(1.0f - t * (1.0f - bent + bent * t) * (1.0f - spinning_limit)) : limit;
        // Else one mass for all directions: friction then ends up opposite to the slip; separate masses would turn it
        // aside.
        const Lanes mass = spins ? smaller(g[slide_mass], g[twist_mass] * per_arm * per_arm) : g[slide_mass];
        const Lanes s1 = g[friction_1] - mass * v1, s2 = g[friction_2] - mass * v2,
                    s3 = per_arm * g[twist] - mass * arm * v3;
        const Lanes size = root(s1 * s1 + s2 * s2 + s3 * s3);
        const Lanes scale = size > limit ? limit / size : all(1.0f);
        j1 = slides ? scale * s1 : j1;
        j2 = slides ? scale * s2 : j2;
        j3 = spins ? scale * s3 * arm : j3;
    }
    changes.friction = {j1 - g[friction_1], j2 - g[friction_2], j3 - g[twist]};
    g[friction_1] = j1;
    g[friction_2] = j2;
    g[twist] = j3;
}

// Visits one point after the other.
template <bool pushing, int points>
inline void solve_normals(const Group& g, const Motion& a, const Motion& b, const Substep& substep,
                          Speeds<points>& speeds, Changes<points>& changes) {
    const auto held = a.inverse_mass == 0.0f || b.inverse_mass == 0.0f;
    const auto unlike =
        larger(a.inverse_mass, b.inverse_mass) > unlike_masses * smaller(a.inverse_mass, b.inverse_mass) && !held;
    const auto choose = [&](float Softness::*value) {
        return held ? all(substep.fixed.*value) : unlike ? all(substep.unlike.*value) : all(substep.alike.*value);
    };
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i) {
        const Lanes closing = g.at(i, gap) * substep.per_second, old = g.at(i, impulse);
        Lanes next;
        if constexpr (pushing) {
            const Lanes rate = choose(&Softness::bias_rate);
            const Lanes overlap = smaller(g.at(i, gap) + slop * g[size], Lanes{});
            const Lanes deep = unlike ? Lanes{} : smaller(overlap / (-twice_as_stiff * g[size]), all(1.0f));
            const Lanes spring = rate * overlap * (1.0f + deep), most = -push_limit * g[size];
            const auto apart = g.at(i, gap) > 0.0f;
            const Lanes bias = apart ? closing : larger(spring, most);
            const Lanes mass = apart ? all(1.0f) : choose(&Softness::mass_scale);
            Lanes keep = apart ? Lanes{} : choose(&Softness::impulse_scale);
            // Below the depth limit the spring pushes no faster, but between bodies that move it still carries more
            // load.
            const Lanes limited = spring < most && !held ? all(1.0f) : Lanes{};
            if (any(limited)) keep = limited > 0.0f ? keep * larger(most / spring, all(least_give)) : keep;
            next = old - g.at(i, normal_mass) * mass * (speeds.parting[i] + bias) - keep * old;
        } else {
            next = old - g.at(i, normal_mass) * (speeds.parting[i] + larger(closing, Lanes{}));
        }
        next = larger(next, Lanes{});
        g.at(i, impulse) = next;
        changes.normal[i] = next - old;
#pragma GCC unroll 4
        for (int later = i + 1; later < points; ++later)
            speeds.parting[later] += g[coupled(i, later)] * changes.normal[i];
    }
}

// Whether no lane has any impulse: until one has, nothing changes.
template <int points>
inline bool idle(const Group& g) {
    Lanes sum = g[friction_1] * g[friction_1] + g[friction_2] * g[friction_2] + g[twist] * g[twist];
#pragma GCC unroll 4
    for (int i = 0; i < points; ++i) sum += g.at(i, impulse);
    return !any(sum);
}

template <bool pushing, int points>
inline void solve(const Group& g, const Bodies& bodies, const Substep& substep) {
    if constexpr (!pushing) find_gaps<points>(g, bodies);
    Motion a = load(bodies, g.a, 0), b = load(bodies, g.b, 0);
    Speeds<points> speeds = speeds_of<points>(g, a, b);
    Changes<points> changes;
    const bool was_idle = idle<points>(g);
    if constexpr (pushing) {
        solve_friction(g, speeds, changes);
#pragma GCC unroll 4
        for (int i = 0; i < points; ++i) speeds.parting[i] += dot(g.vector(i, to_friction), changes.friction);
    }
    solve_normals<pushing>(g, a, b, substep, speeds, changes);
    if (was_idle && idle<points>(g)) return;
    if constexpr (!pushing) {
        // Friction last, so that it stays within the limit of the new normal impulses.
#pragma GCC unroll 4
        for (int i = 0; i < points; ++i)
            speeds.friction = speeds.friction + changes.normal[i] * g.vector(i, to_friction);
        solve_friction(g, speeds, changes);
#pragma GCC unroll 4
        for (int i = 0; i < points; ++i) g.at(i, impulse_sum) += g.at(i, impulse);
        g[friction_1_sum] += g[friction_1];
        g[friction_2_sum] += g[friction_2];
        g[twist_sum] += g[twist];
    }
    apply(g,
          total(
              g, points, [&](int i) { return changes.normal[i]; }, changes.friction),
          a, b);
    save(bodies, g.a, g.moved_a, a);
    save(bodies, g.b, g.moved_b, b);
}

template <bool pushing>
inline void sweep(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies,
                  const Substep& substep) {
    for (std::size_t k = first; k < last; ++k) {
        const Group g(groups, k);
        switch (g.points) {  // each count in registers of its own
            case 1:
                solve<pushing, 1>(g, bodies, substep);
                break;
            case 2:
                solve<pushing, 2>(g, bodies, substep);
                break;
            case 3:
                solve<pushing, 3>(g, bodies, substep);
                break;
            case 4:
                solve<pushing, 4>(g, bodies, substep);
                break;
            default:
                break;  // all points skipped because they will bounce
        }
    }
}

void push(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies, const Substep& substep) {
    sweep<true>(groups, first, last, bodies, substep);
}
void relax(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies, const Substep& substep) {
    sweep<false>(groups, first, last, bodies, substep);
}

void sum(const Groups& groups, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
        const Group g(groups, k);
        const Impulse sums = total(
            g, g.points, [&](int i) { return g.at(i, impulse_sum); }, g.vector(friction_1_sum));
        g.set(force, sums.linear);
        g.set(moment, sums.angular);
    }
}
