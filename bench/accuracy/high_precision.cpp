#include "accuracy/high_precision.h"

namespace tumble::bench {
namespace {

constexpr int columns = 12;  // columns of the extrapolation: order 24

QuadState plus(const QuadState& a, Quad s, const QuadState& b) {
    QuadState sum;
    for (std::size_t i = 0; i < a.size(); ++i) sum[i] = a[i] + s * b[i];
    return sum;
}

// R v for the quaternion at q: v + 2 w u x v + 2 u x (u x v).
std::array<Quad, 3> rotated(const Quad* q, const std::array<Quad, 3>& v) {
    const Quad w = q[0], x = q[1], y = q[2], z = q[3];
    const Quad a = 2 * (y * v[2] - z * v[1]), b = 2 * (z * v[0] - x * v[2]), c = 2 * (x * v[1] - y * v[0]);
    return {v[0] + w * a + y * c - z * b, v[1] + w * b + z * a - x * c, v[2] + w * c + x * b - y * a};
}

}  // namespace

// Newton's iteration from the double's root: two rounds reach 113 bits.
Quad square_root(Quad x) {
    if (x <= 0) return 0;
    Quad r = std::sqrt(double(x));
    for (int i = 0; i < 3; ++i) r = (r + x / r) / 2;
    return r;
}

ReferenceFlight::ReferenceFlight(const Scene& scene) : scene_(scene) {
    const Body& b = scene.bodies[0];
    // The inertia from the sizes, not from their rounded sum of squares.
    const Quad x = b.size.x, y = b.size.y, z = b.size.z, m = Quad(b.mass) / 12;
    inertia_ = {m * (y * y + z * z), m * (x * x + z * z), m * (x * x + y * y)};
    const Vector w = rotate_back(b.orientation, b.angular_velocity);
    state_ = {
        b.position.x,    b.position.y,    b.position.z,    b.velocity.x, b.velocity.y, b.velocity.z, b.orientation.w,
        b.orientation.x, b.orientation.y, b.orientation.z, w.x,          w.y,          w.z};
}

QuadState ReferenceFlight::rate(const QuadState& y) const {
    const Body& body = scene_.bodies[0];
    std::array<Quad, 3> force{0, 0, -Quad(body.mass) * scene_.gravity}, torque{0, 0, 0};
    if (scene_.air) {
        const Vector& wind = scene_.air->velocity;
        const std::array<Quad, 3> u{wind.x - y[3], wind.y - y[4], wind.z - y[5]};
        const Quad speed = square_root(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
        const Quad area =
            (Quad(body.size.x) * body.size.y + Quad(body.size.y) * body.size.z + Quad(body.size.z) * body.size.x) / 2;
        const Quad k = Quad(scene_.air->density) * scene_.air->drag * area * speed / 2;
        for (int i = 0; i < 3; ++i) force[i] += k * u[i];
    }
    if (scene_.push) {
        const std::array<Quad, 3> f{scene_.push->force.x, scene_.push->force.y, scene_.push->force.z};
        const std::array<Quad, 3> r{scene_.push->point.x, scene_.push->point.y, scene_.push->point.z};
        const auto world = rotated(&y[6], f);
        for (int i = 0; i < 3; ++i) force[i] += world[i];
        torque = {r[1] * f[2] - r[2] * f[1], r[2] * f[0] - r[0] * f[2], r[0] * f[1] - r[1] * f[0]};  // body frame
    }
    const Quad *q = &y[6], *w = &y[10];
    const auto& I = inertia_;
    QuadState d;
    for (int i = 0; i < 3; ++i) {
        d[i] = y[3 + i];
        d[3 + i] = force[i] / body.mass;
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        d[10 + i] = (torque[i] - (I[k] - I[j]) * w[j] * w[k]) / I[i];  // Euler's equations, body frame
    }
    // dq/dt = 1/2 q (0, w)
    d[6] = (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]) / 2;
    d[7] = (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]) / 2;
    d[8] = (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]) / 2;
    d[9] = (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]) / 2;
    return d;
}

void ReferenceFlight::advance(Quad h) {
    std::array<QuadState, columns> row;  // row[k]: k-th extrapolation of the latest number of midpoint steps
    for (int j = 0; j < columns; ++j) {
        const int n = 2 * (j + 1);
        const Quad step = h / n;
        QuadState before = state_, now = plus(state_, step, rate(state_));
        for (int i = 1; i < n; ++i) {
            const QuadState next = plus(before, 2 * step, rate(now));
            before = now;
            now = next;
        }
        // Gragg's smoothing, then Aitken and Neville's scheme in (h / n)^2.
        QuadState value = plus(plus(now, 1, before), step, rate(now));
        for (Quad& x : value) x /= 2;
        for (int k = 0; k < j; ++k) {
            const Quad ratio = Quad(n) / (2 * (j - k)), factor = 1 / (ratio * ratio - 1);
            const QuadState coarser = row[k];
            row[k] = value;
            value = plus(plus(value, factor, value), -factor, coarser);
        }
        row[j] = value;
    }
    state_ = row[columns - 1];
}

double ReferenceFlight::position_error(const Motion& motion) const {
    const Quad x = motion.position.x - state_[0], y = motion.position.y - state_[1], z = motion.position.z - state_[2];
    return double(square_root(x * x + y * y + z * z));
}

double ReferenceFlight::orientation_error(const Motion& motion) const {
    const Quad w = motion.orientation.w, x = motion.orientation.x, y = motion.orientation.y, z = motion.orientation.z;
    const Quad* q = &state_[6];
    // The vector part of q^-1 p; its length is the sine of half the angle.
    const Quad a = q[0] * x - q[1] * w - q[2] * z + q[3] * y, b = q[0] * y + q[1] * z - q[2] * w - q[3] * x,
               c = q[0] * z - q[1] * y + q[2] * x - q[3] * w, s = q[0] * w + q[1] * x + q[2] * y + q[3] * z;
    return 2.0 * std::atan2(double(square_root(a * a + b * b + c * c)), std::abs(double(s)));
}

}  // namespace tumble::bench
