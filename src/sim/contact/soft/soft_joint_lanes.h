// The code for joints (soft_joint_rows.h): part of soft_kernel_lanes.h, which says how it is included.

using Hold = JointRows<Lanes>;

#include "sim/contact/soft/soft_angular_lanes.h"

struct JointGroup {
    Hold& rows;
    const std::uint32_t *a, *b;
    std::uint32_t moved_a, moved_b;
    JointKind kind;
    Turn* turn;  // of joints that turn

    JointGroup(const JointGroups& groups, std::size_t index)
        : rows(reinterpret_cast<Hold*>(groups.rows)[index]),
          a(groups.bodies + 2 * TUMBLE_LANES * index),
          b(a + TUMBLE_LANES),
          moved_a(groups.moved[2 * index]),
          moved_b(groups.moved[2 * index + 1]),
          kind(groups.kinds[index]),
          turn(turns(kind) ? reinterpret_cast<Turn*>(groups.turns) + groups.angular_indices[index] : nullptr) {}
    bool driven() const { return kind == JointKind::driven; }
};

// Change of an arm r by the rotation vector t: sin|t|/|t| t x r + (1 - cos|t|)/|t|^2 t x (t x r), as series in |t|^2.
inline Vector turned(const Vector& t, const Vector& r) {
    const Lanes s = dot(t, t);
    const Lanes sine = 1.0f - s * (1.0f / 6.0f - s * (1.0f / 120.0f - s * (1.0f / 5040.0f)));
    const Lanes cosine = 0.5f - s * (1.0f / 24.0f - s * (1.0f / 720.0f - s * (1.0f / 40320.0f)));
    const Vector across = cross(t, r);
    return sine * across + cosine * cross(t, across);
}

inline void apply(const Hold& m, const Vector& f, Motion& a, Motion& b) {
    a.linear = a.linear - a.inverse_mass * f;
    b.linear = b.linear + b.inverse_mass * f;
    a.angular = a.angular - m.inertia_a * cross(m.now_a, f);
    b.angular = b.angular + m.inertia_b * cross(m.now_b, f);
}

inline void apply_torque(const Hold& m, const Vector& torque, Motion& a, Motion& b) {
    a.angular = a.angular - m.inertia_a * torque;
    b.angular = b.angular + m.inertia_b * torque;
}

// Velocity of B's anchor relative to the point of A there.
inline Vector parting(const Hold& m, const Motion& a, const Motion& b) {
    return b.linear - a.linear + cross(b.angular, m.now_b) - cross(a.angular, m.now_a);
}

// Present arms and gap.
inline void find_ends(const JointGroup& g, const Bodies& bodies) {
    Hold& m = g.rows;
    const Motion a = load(bodies, g.a, 1), b = load(bodies, g.b, 1);
    const Vector turned_a = turned(a.angular, m.arm_a), turned_b = turned(b.angular, m.arm_b);
    m.parted = a.linear - b.linear;
    m.gap = m.apart - m.parted + (turned_b - turned_a);
    m.now_b = m.arm_b + turned_b;
    m.now_a = m.arm_a + turned_a + m.gap;
    if (g.turn) find_turns(*g.turn, a.angular, b.angular);
    if (g.kind != JointKind::distance) return;
    const Lanes length = root(dot(m.gap, m.gap));
    const auto some = length > 0.0f;
    const Lanes inverse = some ? 1.0f / length : Lanes{};
    const Vector n = inverse * m.gap;
    m.direction = {some ? n.x : m.direction.x, some ? n.y : m.direction.y, some ? n.z : m.direction.z};
}

inline Lanes mass_along(const Hold& m, const Vector& n, Lanes both) {
    const Vector ra = cross(m.now_a, n), rb = cross(m.now_b, n);
    return m.present / (both + dot(ra, m.inertia_a * ra) + dot(rb, m.inertia_b * rb) + (1.0f - m.present));
}

// The compliance at the anchors: (1/M_a + 1/M_b) 1 and for both bodies (I^-1 (r x e_k)) x r in column k.
inline Tensor mass_at(const Hold& m, Lanes both) {
    const Lanes one = all(1.0f), none = Lanes{}, diagonal = both + (1.0f - m.present);
    const auto column = [&](const Vector& e) {
        const Vector a = cross(m.inertia_a * cross(m.now_a, e), m.now_a);
        const Vector b = cross(m.inertia_b * cross(m.now_b, e), m.now_b);
        return a + b;
    };
    const Vector x = column({one, none, none}), y = column({none, one, none}), z = column({none, none, one});
    const Lanes xx = diagonal + x.x, yy = diagonal + y.y, zz = diagonal + z.z, xy = y.x, xz = z.x, yz = z.y;
    const Lanes cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
    const Lanes scale = m.present / (xx * cxx + xy * cxy + xz * cxz);
    return {scale * cxx,
            scale * cxy,
            scale * cxz,
            scale * (xx * zz - xz * xz),
            scale * (xy * xz - xx * yz),
            scale * (xx * yy - xy * xy)};
}

void prepare_joints(const JointGroups& groups, std::size_t first, std::size_t last, const Bodies& bodies) {
    for (std::size_t k = first; k < last; ++k) {
        const JointGroup g(groups, k);
        Hold& m = g.rows;
        m.inertia_a = load_inertia(bodies, g.a);
        m.inertia_b = load_inertia(bodies, g.b);
        find_ends(g, bodies);
        const Lanes both = load(bodies, g.a, 0).inverse_mass + load(bodies, g.b, 0).inverse_mass;
        if (g.kind != JointKind::distance)
            m.mass = mass_at(m, both);
        else
            m.mass.xx = mass_along(m, m.direction, both);
        if (g.turn) prepare_angular(m, *g.turn);
    }
}

inline Vector impulse_of(const Hold& m, JointKind kind) {
    return kind != JointKind::distance ? m.impulse : m.impulse.x * m.direction;
}

void warm_start_joints(const JointGroups& groups, std::size_t first, std::size_t last, const Bodies& bodies) {
    for (std::size_t k = first; k < last; ++k) {
        const JointGroup g(groups, k);
        Motion a = load(bodies, g.a, 0), b = load(bodies, g.b, 0);
        apply(g.rows, impulse_of(g.rows, g.kind), a, b);
        if (g.turn) apply_torque(g.rows, torque_of(*g.turn, g.driven()), a, b);
        save(bodies, g.a, g.moved_a, a);
        save(bodies, g.b, g.moved_b, b);
    }
}

// Adds to the sums what an impulse does at the present positions.
inline void add_up(Hold& m, const Vector& f) {
    m.impulse_sum = m.impulse_sum + f;
    m.moment_sum = m.moment_sum + cross(m.now_a, f);
    m.carried_sum = m.carried_sum + cross(m.parted, f);
}

// Change of the impulse of a point joint. `rate` (1/s): share of the gap that is closed, by time.
inline Vector change_of_point(const Hold& m, const Vector& speed, Lanes rate, float leak) {
    return all(-1.0f) * (m.mass * (speed + rate * m.gap)) - all(leak) * m.impulse;
}
inline Vector solve_point(Hold& m, const Vector& speed, Lanes rate, float leak) {
    const Vector change = change_of_point(m, speed, rate, leak);
    m.impulse = m.impulse + change;
    return change;
}

// The new impulse of a distance joint: positive pushes apart at `shortest`, negative pulls together at `longest`. A
// distance that is not at its bound may reach it in a substep.
template <bool correcting>
inline Vector solve_distance(Hold& m, const Vector& speed, Lanes rate, float per_second, float leak) {
    const Lanes length = dot(m.direction, m.gap), along = dot(m.direction, speed);
    const Lanes room_up = m.longest - length, room_down = m.shortest - length;
    const auto rod = m.longest == m.shortest;
    const Lanes closing = correcting ? rate : Lanes{};
    const Lanes up = room_up > 0.0f && !rod ? per_second * room_up : closing * room_up;
    const Lanes down = room_down < 0.0f && !rod ? per_second * room_down : closing * room_down;
    const Lanes mass = m.mass.xx, was = m.impulse.x, old = (1.0f - leak) * was;
    const Lanes pull = smaller(old - mass * (along - up), Lanes{}), push = larger(old - mass * (along - down), Lanes{});
    const Lanes next = rod ? old - mass * (along - up) : push > 0.0f ? push : pull;
    m.impulse.x = next;
    return (next - was) * m.direction;
}

template <bool correcting>
inline void sweep_joints(const JointGroups& groups, std::size_t first, std::size_t last, const Bodies& bodies,
                         const Substep& substep) {
    for (std::size_t k = first; k < last; ++k) {
        const JointGroup g(groups, k);
        Hold& m = g.rows;
        Motion a = load(bodies, g.a, 0), b = load(bodies, g.b, 0);
        if constexpr (!correcting) {
            add_up(m, impulse_of(m, g.kind));
            if (g.turn) add_up_turns(*g.turn, g.driven());
            find_ends(g, bodies);
            const Lanes both = a.inverse_mass + b.inverse_mass;
            if (g.kind == JointKind::distance) m.mass.xx = mass_along(m, m.direction, both);
            if (g.turn) {  // axes and limbs turn by large angles in a step
                m.mass = mass_at(m, both);
                prepare_angular(m, *g.turn);
            }
        }
        const Lanes rate = correcting ? all(substep.joint_rate) : Lanes{};
        const float leak = correcting ? substep.joint_leak : 0.0f;
        if (g.turn) {
            const Vector force = change_of_point(m, parting(m, a, b), rate, leak);
            const Vector torque = solve_turns<correcting>(m, *g.turn, g.driven(), b.angular - a.angular, force, rate,
                                                          substep.per_second, leak);
            apply_torque(m, torque, a, b);
        }
        const Vector speed = parting(m, a, b);
        const Vector change = g.kind != JointKind::distance
                                  ? solve_point(m, speed, rate, leak)
                                  : solve_distance<correcting>(m, speed, rate, substep.per_second, leak);
        if constexpr (!correcting) add_up(m, change);
        apply(m, change, a, b);
        save(bodies, g.a, g.moved_a, a);
        save(bodies, g.b, g.moved_b, b);
    }
}

void correct_joints(const JointGroups& groups, std::size_t first, std::size_t last, const Bodies& bodies,
                    const Substep& substep) {
    sweep_joints<true>(groups, first, last, bodies, substep);
}
void relax_joints(const JointGroups& groups, std::size_t first, std::size_t last, const Bodies& bodies,
                  const Substep& substep) {
    sweep_joints<false>(groups, first, last, bodies, substep);
}
