#include "sim/contact/rolling/rolling_path.h"

#include "sim/dynamics/integrators/extrapolation.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Difference of the results of order 10 and of order 8 of a part of the step, in radii and radians. Not fitted: the
/// better result is far more accurate, and rounding lies below.
constexpr double part_tolerance = 2e-13;

/// Parts are halved this often; a change of the way is found to that part of a step, 1e-6 s at 240 steps a second.
constexpr int most_halvings = 12;

/// Parts of a step. Limits the cost of motions without end, as of a coin that falls flat.
constexpr int most_parts = 1024;

/// A slip below this, in the speeds of a fall through the body's radius, is rounding.
constexpr double slip_rounding = 1e-11;

/// An overlap after a hop within the step, radii, far above rounding. The speed of the landing is below g h.
constexpr double landing_rounding = 1e-9;

/// A velocity of the contact point after a part above this, in the speeds of a fall through the body's radius, is no
/// error: the contact has jumped, as from one rim of a cylinder to the other. Not fitted: the error of a shortest part
/// is its length times an acceleration.
constexpr double jump_speed = 1e-3;

/// A slip that friction may end within this number of parts turns too fast for the method: its direction is held for a
/// part, of at most the step over two to this power. Related test: RollingPath.ASlipBeginsAndEndsAlikeAtAnyStep.
constexpr double slow_slip_parts = 8.0;
constexpr int slow_slip_halvings = 6;

/// Tangents of the angles to a guess at which the direction of a slip is sought, and their number on either side. Not
/// fitted: the guess is the direction for equal masses in all directions, which a body's contact is never far from.
constexpr double slip_range = 3.0;
constexpr int slip_grid = 12;

using State = Eigen::Matrix<double, 13, 1>;  // x, q (x, y, z, w), v, w

class Roller {
public:
    Roller(const Body& body, const RollingPlane& plane, const Vec3& gravity)
        : body_(body),
          shape_(*std::get<std::shared_ptr<const CurvedBody>>(body.collider)),
          plane_(plane),
          gravity_(gravity),
          speed_(std::sqrt(gravity.norm() * body.radius)) {}

    std::optional<RolledStep> run(double span) {
        State y;
        y << body_.position, body_.orientation.coeffs(), body_.velocity, body_.angular_velocity;
        const Vec3 velocity = point_velocity(y);
        const bool sticks = plane_.friction > 0.0 && across(velocity).norm() <= slip_rounding * speed_;
        way_ = sticks ? Way::rolls : Way::slides;
        if (gap(y) > landing_rounding * body_.radius || plane_.normal.dot(velocity) > landing_rounding * speed_)
            way_ = Way::flies;
        else
            stop_contact(y);
        if (!advance(y, span, 0)) return {};
        RolledStep result;
        result.end.position = y.head<3>();
        result.end.orientation = Quat(Eigen::Vector4d(y.segment<4>(3)));
        result.end.momentum = body_.mass * y.segment<3>(7);
        const Mat3 rotation = rotation_of(result.end.orientation);
        result.end.angular_momentum = rotation * (body_.inertia_body * (rotation.transpose() * y.tail<3>()));
        result.slipped = slipped_;
        return result;
    }

private:
    // The contact in a state.
    struct Contact {
        Mat3 inertia, inverse_inertia;  // world
        Vec3 arm, arm_rate;             // m, m/s
    };
    enum class Way { rolls, slides, flies };
    // The cause for which the motion cannot go on in its way.
    enum class Stop { none, load, friction, landing, error };
    struct Rate {
        State y;
        Stop stop = Stop::none;
    };

    Vec3 across(const Vec3& v) const { return v - plane_.normal.dot(v) * plane_.normal; }

    Vec3 arm_of(const State& y) const {
        const Mat3 rotation = rotation_of(Quat(Eigen::Vector4d(y.segment<4>(3))));
        const Vec3 down = -(rotation.transpose() * plane_.normal);
        return rotation * (shape_.support(down) + shape_.rounding * down);
    }
    Vec3 point_velocity(const State& y) const { return y.segment<3>(7) + Vec3(y.tail<3>()).cross(arm_of(y)); }
    double gap(const State& y) const { return plane_.normal.dot(y.head<3>() + arm_of(y)) - plane_.offset; }
    double energy(const State& y) const {
        const Mat3 rotation = rotation_of(Quat(Eigen::Vector4d(y.segment<4>(3))));
        const Vec3 spin = rotation.transpose() * y.tail<3>();
        return 0.5 * (body_.mass * y.segment<3>(7).squaredNorm() + spin.dot(body_.inertia_body * spin)) -
               body_.mass * gravity_.dot(y.head<3>());
    }

    Contact contact(const State& y) const {
        const Mat3 rotation = rotation_of(Quat(Eigen::Vector4d(y.segment<4>(3))));
        const Vec3 omega = y.tail<3>(), down = -(rotation.transpose() * plane_.normal);
        const Vec3 down_rate = -(rotation.transpose() * omega).cross(down);
        Contact c;
        c.inertia = rotation * body_.inertia_body * rotation.transpose();
        c.inverse_inertia = rotation * body_.inverse_inertia_body * rotation.transpose();
        c.arm = rotation * (shape_.support(down) + shape_.rounding * down);
        c.arm_rate = omega.cross(c.arm) + rotation * (shape_.bend(down) * down_rate + shape_.rounding * down_rate);
        return c;
    }

    // The force while the contact sticks, and the angular acceleration.
    Vec3 sticking_force(const Contact& c, const Vec3& omega, Vec3& angular_acceleration) const {
        const double m = body_.mass;
        const Vec3 bend = omega.cross(c.arm_rate);
        const Mat3 about = c.inertia + m * (c.arm.squaredNorm() * Mat3::Identity() - c.arm * c.arm.transpose());
        angular_acceleration =
            about.ldlt().solve(-omega.cross(c.inertia * omega) - m * c.arm.cross(bend) - m * c.arm.cross(gravity_));
        return m * (-angular_acceleration.cross(c.arm) - bend - gravity_);
    }

    Rate rate(const State& y) const {
        const Contact c = contact(y);
        const Vec3 omega = y.tail<3>(), &n = plane_.normal;
        Rate r;
        Vec3 force = Vec3::Zero(), turn = c.inverse_inertia * -omega.cross(c.inertia * omega);
        if (way_ == Way::rolls) {
            force = sticking_force(c, omega, turn);
            const double load = n.dot(force);
            if (across(force).norm() > plane_.friction * load) r.stop = Stop::friction;
            if (!(load > 0.0)) r.stop = Stop::load;
        } else if (way_ == Way::slides) {
            Vec3 direction = n;
            if (plane_.friction > 0.0) {
                const Vec3 slip = holds_slip_ ? slip_ : across(y.segment<3>(7) + omega.cross(c.arm));
                direction -= plane_.friction * slip.normalized();
            }
            const Vec3 lever = c.arm.cross(n), turning = c.inverse_inertia * c.arm.cross(direction);
            const double resistance = 1.0 / body_.mass + lever.dot(turning);
            const double approach = lever.dot(turn) + n.dot(omega.cross(c.arm_rate)) + n.dot(gravity_);
            const double load = -approach / resistance;
            if (!(resistance > 0.0)) r.stop = Stop::error;  // Painleve's paradox
            if (!(load > 0.0)) r.stop = Stop::load;
            force = load * direction;
            turn += load * turning;
        }
        const Quat q(Eigen::Vector4d(y.segment<4>(3)));
        r.y.head<3>() = y.segment<3>(7);
        r.y.segment<4>(3) = 0.5 * (Quat(0.0, omega.x(), omega.y(), omega.z()) * q).coeffs();
        r.y.segment<3>(7) = gravity_ + force / body_.mass;
        r.y.tail<3>() = turn;
        return r;
    }

    // Ends the velocity of the contact point that the way does not have, by an impulse there: it only takes energy.
    void stop_contact(State& y) const {
        const Contact c = contact(y);
        const Vec3 velocity = y.segment<3>(7) + Vec3(y.tail<3>()).cross(c.arm), &n = plane_.normal;
        Vec3 impulse;
        if (way_ == Way::rolls) {
            Mat3 cross;
            cross << 0.0, -c.arm.z(), c.arm.y(), c.arm.z(), 0.0, -c.arm.x(), -c.arm.y(), c.arm.x(), 0.0;
            const Mat3 k = Mat3::Identity() / body_.mass - cross * c.inverse_inertia * cross;
            impulse = -k.ldlt().solve(velocity);
        } else {
            const Vec3 lever = c.arm.cross(n);
            impulse = -n.dot(velocity) / (1.0 / body_.mass + lever.dot(c.inverse_inertia * lever)) * n;
        }
        y.segment<3>(7) += impulse / body_.mass;
        y.tail<3>() += c.inverse_inertia * c.arm.cross(impulse);
    }

    // Removes the error of a part: the body touches the plane, and its contact point has the velocity of the way.
    // Returns false where the contact has jumped: it keeps its velocity, and an impact there has to end it.
    bool settle(State& y) const {
        y.segment<4>(3).normalize();
        if (way_ == Way::flies) return true;
        const Vec3 arm = arm_of(y), omega = y.tail<3>(), &n = plane_.normal;
        y.head<3>() += (plane_.offset - n.dot(y.head<3>() + arm)) * n;
        const Vec3 velocity = y.segment<3>(7) + omega.cross(arm);
        const Vec3 excess = way_ == Way::rolls ? velocity : Vec3(n.dot(velocity) * n);
        if (excess.norm() > jump_speed * speed_) return false;
        y.segment<3>(7) -= excess;
        return true;
    }

    // Stops the point to which the contact has jumped, without a bounce. It sticks there if friction suffices.
    void land(State& y) {
        State landed = y;
        stop_contact(landed);
        const Vec3 impulse = landed.segment<3>(7) - y.segment<3>(7);
        if (way_ == Way::rolls && across(impulse).norm() > plane_.friction * plane_.normal.dot(impulse)) {
            way_ = Way::slides;
            landed = y;
            stop_contact(landed);
        }
        y = landed;
    }

    // One part by extrapolation, if the motion can go on in its way, and with a small error. `last`: no shorter part is
    // tried; the error is taken, and friction that would not suffice until the end.
    Stop part(State& y, double span, bool last) {
        using namespace extrapolation;
        Stop stop = Stop::none;
        bool begun = false;
        const auto f = [&](const State& at) {
            const Rate r = rate(at);
            if (stop == Stop::none && !(begun && last && r.stop == Stop::friction)) stop = r.stop;
            begun = true;
            return r.y;
        };
        const State first = f(y);
        constexpr auto weight = weights(columns), lower = weights(columns - 1);
        State change = State::Zero(), less = State::Zero();
        for (std::size_t k = 0; k < columns && stop == Stop::none; ++k) {
            const State of_count = midpoint_change(y, first, span, counts[k], f);
            change += weight[k] * of_count;
            if (k + 1 < columns) less += lower[k] * of_count;
        }
        if (stop != Stop::none) return stop;
        const State difference = change - less;
        const double fall = std::max(speed_, y.segment<3>(7).norm());
        const double error =
            std::max({difference.head<3>().norm() / body_.radius, difference.segment<4>(3).norm(),
                      difference.segment<3>(7).norm() / fall, difference.tail<3>().norm() * body_.radius / fall});
        if (!change.allFinite() || (!last && !(error <= part_tolerance))) return Stop::error;
        if (way_ == Way::flies && gap(y + change) < -landing_rounding * body_.radius) return Stop::landing;
        State end = y + change;
        const bool jumped = !settle(end);
        if (jumped && (!last || plane_.restitution > 0.0)) return Stop::error;
        if (rubs()) slipped_ += energy(y) - energy(end);
        if (jumped) land(end);
        y = end;
        return Stop::none;
    }

    bool advance(State& y, double span, int halvings) {
        if (++parts_ > most_parts) return false;
        const bool slow = slips_slowly(y, span);
        Stop stop = Stop::error;
        if (!slow || halvings >= slow_slip_halvings) {
            if (slow) hold_slip(y, span);
            stop = part(y, span, halvings == most_halvings);
            if (stop == Stop::none) return true;
        }
        if (halvings < most_halvings)
            return advance(y, 0.5 * span, halvings + 1) && advance(y, 0.5 * span, halvings + 1);
        if (stop == Stop::error) return false;
        way_ = stop == Stop::load ? Way::flies : Way::slides;
        if (stop == Stop::landing) stop_contact(y);
        if (slips_slowly(y, span)) hold_slip(y, span);
        return part(y, span, true) == Stop::none;
    }

    bool rubs() const { return way_ == Way::slides && plane_.friction > 0.0; }
    bool slips_slowly(const State& y, double span) {
        holds_slip_ = false;
        return rubs() && across(point_velocity(y)).norm() < slow_slip_parts * plane_.friction * gravity_.norm() * span;
    }

    // The slip v ends a part of t s in the direction s of v + t a(s): its acceleration depends on s through the
    // friction. Without such a direction friction ends the slip, and the body rolls.
    void hold_slip(State& y, double span) {
        const Contact c = contact(y);
        const Vec3 omega = y.tail<3>(), slip = across(point_velocity(y));
        const auto after = [&](const Vec3& direction) {
            slip_ = direction;
            const State r = rate(y).y;
            const Vec3 turn = r.tail<3>();
            return across(slip + span * (r.segment<3>(7) + turn.cross(c.arm) + omega.cross(c.arm_rate)));
        };
        holds_slip_ = true;
        const Vec3 guess = after(Vec3::Zero()).normalized(), beside = plane_.normal.cross(guess);
        const auto aside = [&](double u) {
            const Vec3 direction = guess + u * beside;
            return plane_.normal.dot(direction.cross(after(direction)));
        };
        double best = infinity;
        for (int k = -slip_grid; k < slip_grid; ++k) {
            double low = slip_range * k / slip_grid, high = slip_range * (k + 1) / slip_grid;
            const bool rises = aside(low) < 0.0;
            if ((aside(high) < 0.0) == rises) continue;
            for (int i = 0; i < 60; ++i) {
                const double middle = 0.5 * (low + high);
                ((aside(middle) < 0.0) == rises ? low : high) = middle;
            }
            const Vec3 direction = guess + low * beside;
            if (after(direction).dot(direction) > 0.0 && std::abs(low) < std::abs(best)) best = low;
        }
        if (best < infinity) {
            slip_ = guess + best * beside;
            return;
        }
        const double before = energy(y);
        way_ = Way::rolls;
        holds_slip_ = false;
        stop_contact(y);
        slipped_ += before - energy(y);
    }

    const Body& body_;
    const CurvedBody& shape_;
    const RollingPlane& plane_;
    const Vec3 gravity_;
    double speed_;  // m/s, of a fall through the radius
    Way way_ = Way::rolls;
    bool holds_slip_ = false;  // friction acts against slip_ throughout a part
    Vec3 slip_ = Vec3::Zero();
    double slipped_ = 0.0;  // J
    int parts_ = 0;
};

}  // namespace

std::optional<RolledStep> roll(const Body& body, const RollingPlane& plane, const Vec3& gravity, double span) {
    return Roller(body, plane, gravity).run(span);
}

}  // namespace tumble
