// The code for the turns of joints (AngularRows in soft_joint_rows.h): part of soft_kernel_lanes.h, which says how it
// is included.

using Turn = AngularRows<Lanes>;

constexpr float least_turn_gives = float(tuning::soft_least_turn_gives);

struct Spin {  // quaternion
    Lanes w;
    Vector v;
};

// Quaternion of the rotation vector t: (cos|t|/2, sin(|t|/2)/|t| t), as series in |t|^2.
inline Spin spin_of(const Vector& t) {
    const Lanes s = 0.25f * dot(t, t);
    const Lanes cosine = 1.0f - s * (0.5f - s * (1.0f / 24.0f - s * (1.0f / 720.0f - s * (1.0f / 40320.0f))));
    const Lanes sine = 0.5f - s * (1.0f / 12.0f - s * (1.0f / 240.0f - s * (1.0f / 10080.0f)));
    return {cosine, sine * t};
}

inline Vector turned_by(const Spin& q, const Vector& r) {
    const Vector across = cross(q.v, r);
    return r + all(2.0f) * (q.w * across + cross(q.v, across));
}

// Rotation vector of B relative to A, in the frame of A's start: of conj(a) b, as a series in the sine of half its
// angle.
inline Vector turn_between(const Spin& a, const Spin& b) {
    const Vector v = a.w * b.v - b.w * a.v - cross(a.v, b.v);
    const Lanes s = dot(v, v);
    return (2.0f + s * (1.0f / 3.0f + s * (3.0f / 20.0f + s * (5.0f / 56.0f)))) * v;
}

inline Vector along_axes(const Turn& t, const Vector& v) { return {dot(t.now_x, v), dot(t.now_y, v), dot(t.now_z, v)}; }
inline Vector from_axes(const Turn& t, const Vector& f) { return f.x * t.now_x + f.y * t.now_y + f.z * t.now_z; }
inline Vector each(const Vector& a, const Vector& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

// The axes of round cones, and the sine of the angle beyond. Near the middle of a cone its swing has no direction.
inline void find_pendulum_rate(Turn& t, const Spin& a, const Spin& b) {
    const Vector twist_a = turned_by(a, t.twist_a), twist_b = turned_by(b, t.twist_b);
    const Vector across = cross(twist_a, twist_b), both = twist_a + twist_b;
    const Lanes sine = root(dot(across, across)), length = root(dot(both, both));
    const auto clear = t.round > 0.0f && sine > 1e-3f && length > 1e-3f;
    const Vector y = (1.0f / (sine + (1.0f - t.round))) * across, x = (1.0f / (length + (1.0f - t.round))) * both;
    const Vector z = cross(x, y);
    const auto choose = [&](const Vector& own, Vector& now) {
        now = {clear ? own.x : now.x, clear ? own.y : now.y, clear ? own.z : now.z};
    };
    choose(x, t.now_x);
    choose(y, t.now_y);
    choose(z, t.now_z);
    const Lanes beyond = sine * t.limit_cosine - dot(twist_a, twist_b) * t.limit_sine;
    t.turned.y = t.round > 0.0f ? beyond : t.turned.y;
}

// Present axes and coordinates.
inline void find_turns(Turn& t, const Vector& turn_a, const Vector& turn_b) {
    const Spin a = spin_of(turn_a), b = spin_of(turn_b);
    t.now_x = turned_by(a, t.axis_x);
    t.now_y = turned_by(a, t.axis_y);
    t.now_z = turned_by(a, t.axis_z);
    const Vector r = turn_between(a, b);
    const Lanes x = dot(t.axis_x, r), y = dot(t.axis_y, r), z = dot(t.axis_z, r), round = t.circle * z + t.twist * x;
    t.turned = {x + t.bend.x * y * z, y + t.bend.y * z * x + round * round, z + t.bend.z * x * y};
    if (any(t.round)) find_pendulum_rate(t, a, b);
}

inline Tensor inverse_of(const Tensor& k) {
    const Lanes cxx = k.yy * k.zz - k.yz * k.yz, cxy = k.xz * k.yz - k.xy * k.zz, cxz = k.xy * k.yz - k.xz * k.yy;
    const Lanes scale = 1.0f / (k.xx * cxx + k.xy * cxy + k.xz * cxz);
    return {scale * cxx,
            scale * cxy,
            scale * cxz,
            scale * (k.xx * k.zz - k.xz * k.xz),
            scale * (k.xy * k.xz - k.xx * k.yz),
            scale * (k.xx * k.yy - k.xy * k.xy)};
}

// After find_turns(), with the mass at the anchors. With the compliances C about the axes, A at the anchors and B
// between them, an impulse f = -A^-1 (v + B j) that keeps the anchors together leaves C - B^T A^-1 B.
inline void prepare_angular(const Hold& m, Turn& t) {
    const auto pull = [&](const Vector& n, Vector& spin) {
        const Vector of_a = m.inertia_a * n, of_b = m.inertia_b * n;
        spin = of_a + of_b;
        return cross(of_a, m.now_a) + cross(of_b, m.now_b);
    };
    Vector kx, ky, kz;
    t.pull_x = pull(t.now_x, kx);
    t.pull_y = pull(t.now_y, ky);
    t.pull_z = pull(t.now_z, kz);
    const Vector bx = m.mass * t.pull_x, by = m.mass * t.pull_y, bz = m.mass * t.pull_z;
    const Lanes absent = 1.0f - m.present;
    const auto own = [&](Lanes gives, Lanes back) { return larger(gives - back, least_turn_gives * gives) + absent; };
    t.gives = {own(dot(t.now_x, kx), dot(t.pull_x, bx)), dot(t.now_y, kx) - dot(t.pull_y, bx),
               dot(t.now_z, kx) - dot(t.pull_z, bx),     own(dot(t.now_y, ky), dot(t.pull_y, by)),
               dot(t.now_z, ky) - dot(t.pull_z, by),     own(dot(t.now_z, kz), dot(t.pull_z, bz))};
    const auto damps = [&](Lanes soft, Lanes rigid) { return soft > 0.0f ? 1.0f / (rigid + soft) : Lanes{}; };
    t.damps = {damps(t.softness.x, t.gives.xx), damps(t.softness.y, t.gives.yy), damps(t.softness.z, t.gives.zz)};
    t.single = {m.present / t.gives.xx, m.present / t.gives.yy, m.present / t.gives.zz};
    // Locked axes and axes with friction are solved at once; other axes have the compliance 1, coupled with none.
    const Vector l = t.locked, r = t.rubs;
    const auto alone = [&](Lanes locked, Lanes rubs, Lanes gives) {
        return (locked + rubs) * gives + (1.0f - locked - rubs);
    };
    t.mass = inverse_of({alone(l.x, r.x, t.gives.xx), (l.x * l.y + r.x * r.y) * t.gives.xy,
                         (l.x * l.z + r.x * r.z) * t.gives.xz, alone(l.y, r.y, t.gives.yy),
                         (l.y * l.z + r.y * r.z) * t.gives.yz, alone(l.z, r.z, t.gives.zz)});
}

// Impulse about an axis within its limits, as of a distance joint.
template <bool correcting>
inline Lanes limited(Lanes least, Lanes most, Lanes turned, Lanes speed, Lanes mass, Lanes was, Lanes rate,
                     float per_second, float leak) {
    const Lanes room_up = most - turned, room_down = least - turned, closing = correcting ? rate : Lanes{};
    const Lanes up = (room_up > 0.0f ? all(per_second) : closing) * room_up;
    const Lanes down = (room_down < 0.0f ? all(per_second) : closing) * room_down;
    const Lanes old = (1.0f - leak) * was;
    const Lanes pull = smaller(old - mass * (speed - up), Lanes{}), push = larger(old - mass * (speed - down), Lanes{});
    return push > 0.0f ? push : pull;
}

// Dampers, and friction within its limit. Returns the changes.
inline Vector solve_drives(const Hold& m, Turn& t, Vector& speed) {
    const auto damp = [&](Lanes Vector::*k) {
        const Lanes change = -(t.damps.*k * (speed.*k + t.softness.*k * t.damping.*k));
        t.damping.*k += change;
        return change;
    };
    Vector damped{};
    damped.x = damp(&Vector::x);
    speed = {speed.x + t.gives.xx * damped.x, speed.y + t.gives.xy * damped.x, speed.z + t.gives.xz * damped.x};
    damped.y = damp(&Vector::y);
    speed = {speed.x + t.gives.xy * damped.y, speed.y + t.gives.yy * damped.y, speed.z + t.gives.yz * damped.y};
    damped.z = damp(&Vector::z);
    speed = {speed.x + t.gives.xz * damped.z, speed.y + t.gives.yz * damped.z, speed.z + t.gives.zz * damped.z};
    t.damping_sum = t.damping_sum + from_axes(t, damped);
    // Stops the turn, if within the limit; otherwise one mass for all axes, so that friction ends up opposite to the
    // turn.
    Vector held = t.friction - each(t.rubs, t.mass * each(t.rubs, speed));
    const Lanes limit = t.rough + t.bearing * root(dot(m.impulse, m.impulse)), size = root(dot(held, held));
    const auto slides = size > limit;
    if (any(Lanes(slides))) {
        const Vector rubs = t.rubs;
        const Lanes none = rubs.x + rubs.y + rubs.z > 0.0f ? Lanes{} : all(1.0f);
        const Lanes mass = 1.0f / (rubs.x * t.gives.xx + rubs.y * t.gives.yy + rubs.z * t.gives.zz + none);
        const Vector sliding = t.friction - mass * each(rubs, speed);
        const Lanes length = root(dot(sliding, sliding)), scale = length > limit ? limit / length : all(1.0f);
        held = {slides ? scale * sliding.x : held.x, slides ? scale * sliding.y : held.y,
                slides ? scale * sliding.z : held.z};
    }
    const Vector rubbed = held - t.friction;
    t.friction = held;
    t.friction_sum = t.friction_sum + from_axes(t, rubbed);
    speed = speed + t.gives * rubbed;
    return rubbed + damped;
}

// New impulses about the axes; returns the change, world. `spin`: of B relative to A; `force`: the coming change of the
// impulse at the anchors.
template <bool correcting>
inline Vector solve_turns(const Hold& m, Turn& t, bool driven, const Vector& spin, const Vector& force, Lanes rate,
                          float per_second, float leak) {
    Vector speed = along_axes(t, spin) + Vector{dot(t.pull_x, force), dot(t.pull_y, force), dot(t.pull_z, force)};
    Vector change{};
    if (!correcting && driven) change = solve_drives(m, t, speed);
    const auto limit = [&](Lanes Vector::*k, Lanes mass) {
        const Lanes was = t.impulse.*k;
        const Lanes next =
            limited<correcting>(t.least.*k, t.most.*k, t.turned.*k, speed.*k, mass, was, rate, per_second, leak);
        const Lanes by = (1.0f - t.locked.*k) * (next - was);
        t.impulse.*k += by;
        return by;
    };
    Vector by{};
    by.x = limit(&Vector::x, t.single.x);
    speed.y += t.gives.xy * by.x;
    speed.z += t.gives.xz * by.x;
    by.y = limit(&Vector::y, t.single.y);
    speed.x += t.gives.xx * by.x + t.gives.xy * by.y;
    speed.z += t.gives.yz * by.y;
    by.z = limit(&Vector::z, t.single.z);
    speed = {speed.x + t.gives.xz * by.z, speed.y + t.gives.yy * by.y + t.gives.yz * by.z, speed.z + t.gives.zz * by.z};
    const Vector off = each(t.locked, speed + rate * (t.turned - t.most));
    const Vector held = all(-1.0f) * (t.mass * off) - all(leak) * each(t.locked, t.impulse);
    t.impulse = t.impulse + held;
    const Vector torque = from_axes(t, change + by + held);
    if constexpr (!correcting) t.torque_sum = t.torque_sum + torque;
    return torque;
}

inline Vector torque_of(const Turn& t, bool driven) {
    return from_axes(t, driven ? t.impulse + t.damping + t.friction : t.impulse);
}

// Adds to the sums what the impulses do about the present axes.
inline void add_up_turns(Turn& t, bool driven) {
    t.torque_sum = t.torque_sum + torque_of(t, driven);
    if (!driven) return;
    t.damping_sum = t.damping_sum + from_axes(t, t.damping);
    t.friction_sum = t.friction_sum + from_axes(t, t.friction);
}
