#include "scene/camera/default_camera.h"

#include "core/deterministic_math.h"
#include "scene/camera/camera_visibility.h"
#include "sim/geometry/shapes/shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace tumble {
namespace {

// Composition, chosen by eye on the demo scenes.
constexpr double azimuth = 28.0;    // degrees to the right of the front
constexpr double elevation = 17.0;  // degrees above the horizon: the ground fills the lower two thirds
constexpr std::array higher = {30.0, 45.0, 60.0, 75.0};  // degrees; tried where fixed bodies hide the bodies in them
constexpr double enough = 0.6;                           // share of the rest positions that must be visible
constexpr double used_fraction = 0.86;                   // of the image's half width and height; the rest is a margin
constexpr double used_by_motion = 0.8;                   // the same where the motion is known, and needs no reserve
constexpr double from_above = 35.0;                      // degrees; of a motion that spreads over the ground
constexpr double flat = 0.2;                // such a motion's height, of the smaller of its two other sides
constexpr double side_on = 0.6;             // part of the paths' length that the image shows at least
constexpr double ground_near_motion = 2.0;  // as ground_factor; more than that of a wall would make bodies small
constexpr double ground_factor = 8.0;       // a fixed body this many times larger than all moving bodies is ground

constexpr double least_distance = 0.2;  // of the scene's diagonal, between the eye and the nearest point
constexpr int centering_passes =
    4;  // each leaves a small part of the error, because near points move more than far ones

constexpr double degrees = pi / 180.0;

struct Axes {
    Vec3 right, up, forward;  // unit, right-handed as seen by the camera (forward into the image)
};

/// Directions of the ground as the default camera sees it: to the right, and toward it.
std::pair<Vec3, Vec3> level_axes(const Vec3& up) {
    const Vec3 front = std::fabs(up.z()) < 0.9 ? Vec3(0.0, 0.0, 1.0) : Vec3(0.0, -1.0, 0.0);
    const Vec3 level_front = (front - up * up.dot(front)).normalized();
    return {up.cross(level_front), level_front};
}

Axes view_axes(const Vec3& up, double above, double to_the_right = azimuth) {
    const auto [level_right, level_front] = level_axes(up);
    const SinCos a = sincos(to_the_right * degrees), e = sincos(above * degrees);
    Axes axes;
    axes.forward = -(e.cos * (a.cos * level_front + a.sin * level_right) + e.sin * up);
    axes.right = axes.forward.cross(up).normalized();
    axes.up = axes.right.cross(axes.forward);
    return axes;
}

/// Appends the corners of the shape's bounds, in the world frame.
void add_corners(const Bounds& local, const Vec3& position, const Quat& rotation, std::vector<Vec3>& points) {
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p(corner & 1 ? local.max.x() : local.min.x(), corner & 2 ? local.max.y() : local.min.y(),
                     corner & 4 ? local.max.z() : local.min.z());
        points.push_back(position + rotation * p);
    }
}

Bounds bounds_of(const std::vector<Vec3>& points) {
    Bounds bounds;
    for (const Vec3& p : points) bounds.add(p);
    return bounds;
}

/// A fixed plane that bodies can land on.
struct Ground {
    Vec3 normal;    // unit, world frame
    double offset;  // m, along the normal
};

std::vector<Ground> grounds_below(const SceneDescription& scene, const Vec3& down) {
    std::vector<Ground> grounds;
    for (const BodyDescription& body : scene.bodies) {
        const auto* plane = std::get_if<PlaneShape>(&body.shape);
        if (!plane) continue;
        const Vec3 normal = body.rotation * plane->normal;
        if (-normal.dot(down) < 0.5) continue;  // steeper than 60 degrees: a wall
        grounds.push_back({normal, plane->offset + normal.dot(body.position)});
    }
    return grounds;
}

/// Distance along `down` to the nearest ground below the point; 0 without one.
double drop_height(const std::vector<Ground>& grounds, const Vec3& point, const Vec3& down) {
    double drop = 0.0;
    for (const Ground& ground : grounds) {
        const double distance = (ground.normal.dot(point) - ground.offset) / -ground.normal.dot(down);
        if (distance > 0.0 && (drop == 0.0 || distance < drop)) drop = distance;
    }
    return drop;
}

/// Local bounds; bounds of a mesh or compound are computed once for all bodies that share it.
class BoundsOfShapes {
public:
    Bounds operator()(const Shape& shape) {
        const void* shared = shared_data(shape);
        if (!shared) return local_bounds(shape);
        const auto [entry, is_new] = known_.try_emplace(shared);
        if (is_new) entry->second = local_bounds(shape);
        return entry->second;
    }

private:
    std::map<const void*, Bounds> known_;  // only for lookups, never iterated over
};

std::vector<Vec3> moving_points(const SceneDescription& scene, double seconds) {
    const Vec3& gravity = scene.simulation.gravity;
    const Vec3 down = gravity.norm() > 0.0 ? gravity.normalized() : Vec3(0.0, -1.0, 0.0);
    const std::vector<Ground> grounds = grounds_below(scene, down);
    BoundsOfShapes bounds_of_shape;
    std::vector<Vec3> points = flight_points(scene, seconds);
    for (const BodyDescription& body : scene.bodies) {
        if (body.type == BodyType::fixed || endless(body.shape)) continue;
        const Bounds local = bounds_of_shape(body.shape);
        add_corners(local, body.position, body.rotation, points);
        for (const Keyframe& key : body.keyframes) add_corners(local, key.position, key.rotation, points);
        if (body.type != BodyType::dynamic) continue;
        const Vec3 middle = body.position + body.rotation * local.center();
        if (const double drop = drop_height(grounds, middle, down); drop > 0.0) points.push_back(middle + down * drop);
    }
    return points;
}

/// How the fixed and standing bodies around the moving points are framed.
struct Surroundings {
    double ground_factor;           // a body this many times larger than the motion is ground
    bool near_only = false;         // bodies that are not near the motion are left out
    std::vector<char> stands = {};  // by body: it stands still; empty: none does
};

/// The moving points and those of their surroundings; of the ground only the part near them.
std::vector<Vec3> with_surroundings(const SceneDescription& scene, std::vector<Vec3> points,
                                    const Surroundings& beside) {
    const Bounds moving = bounds_of(points);
    const double reach = points.empty() ? 0.0 : moving.extent().norm();
    const Bounds near = points.empty() ? moving : moving.grown(0.25 * reach);
    BoundsOfShapes bounds_of_shape;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const BodyDescription& body = scene.bodies[i];
        const bool stands = body.type == BodyType::fixed || (!beside.stands.empty() && beside.stands[i]);
        if (!stands || endless(body.shape)) continue;
        std::vector<Vec3> corners;
        add_corners(bounds_of_shape(body.shape), body.position, body.rotation, corners);
        const Bounds bounds = bounds_of(corners);
        const bool overlaps = moving.empty() || bounds.overlaps(near);
        if (moving.empty() || bounds.extent().norm() < beside.ground_factor * reach) {
            if (overlaps || !beside.near_only) points.insert(points.end(), corners.begin(), corners.end());
        } else if (overlaps) {
            const Bounds part{bounds.min.cwiseMax(near.min), bounds.max.cwiseMin(near.max)};
            add_corners(part, Vec3::Zero(), Quat::Identity(), points);
        }
    }
    return points;
}

/// The center of the points' extent in the image, as tangents to the right and up.
Vec3 off_center(const std::vector<Vec3>& points, const Vec3& eye, const Axes& axes) {
    Bounds seen;
    for (const Vec3& p : points) {
        const Vec3 d = p - eye;
        seen.add(Vec3(d.dot(axes.right), d.dot(axes.up), 0.0) / d.dot(axes.forward));
    }
    return seen.center();
}

/// The camera along the axes that has all points in its image.
CameraDescription fitted(const SceneDescription& scene, const CameraDescription& lens, const std::vector<Vec3>& points,
                         const Axes& axes, double used) {
    CameraDescription camera = lens;
    const SinCos half = sincos(0.5 * lens.vertical_fov * degrees);
    const double tangent_y = used * half.sin / half.cos;
    const double tangent_x = tangent_y * scene.output.width / scene.output.height;

    // A point p is in view of the eye e if |(p - e).right| <= tangent_x (p - e).forward, and likewise for up: four
    // half- spaces for e. Their extreme offsets over all points bound the eye's depth along `forward` and center it.
    double right = -1e300, left = -1e300, top = -1e300, bottom = -1e300;
    double nearest = 1e300, farthest = -1e300;
    for (const Vec3& p : points) {
        const double x = p.dot(axes.right), y = p.dot(axes.up), z = p.dot(axes.forward);
        right = std::max(right, x - tangent_x * z);
        left = std::max(left, -x - tangent_x * z);
        top = std::max(top, y - tangent_y * z);
        bottom = std::max(bottom, -y - tangent_y * z);
        nearest = std::min(nearest, z);
        farthest = std::max(farthest, z);
    }
    const double depth = std::min({-(right + left) / (2.0 * tangent_x), -(top + bottom) / (2.0 * tangent_y),
                                   nearest - least_distance * bounds_of(points).extent().norm()});
    const double middle = 0.5 * (nearest + farthest) - depth;
    camera.eye = axes.right * (0.5 * (right - left)) + axes.up * (0.5 * (top - bottom)) + axes.forward * depth;
    // In the direction that is not tight, move until both margins are equal.
    for (int pass = 0; pass < centering_passes; ++pass) {
        const Vec3 shift = off_center(points, camera.eye, axes) * middle;
        camera.eye += shift.x() * axes.right + shift.y() * axes.up;
    }
    camera.target = camera.eye + axes.forward * middle;
    return camera;
}

/// The side, as degrees to the right of the front, from which the motion is seen.
double side_of(const Mat3& paths, const Vec3& up) {
    const auto level = level_axes(up);  // clang 14 has no structured bindings in lambdas
    const double whole = level.first.dot(paths * level.first) + level.second.dot(paths * level.second);
    const auto seen = [&](double to_the_right) {  // part of the level paths' length, squared
        const SinCos a = sincos(to_the_right * degrees);
        const Vec3 right = a.cos * level.first - a.sin * level.second;
        return right.dot(paths * right) / whole;
    };
    if (!(whole > 0.0) || seen(azimuth) >= side_on * side_on) return azimuth;
    double best = azimuth;
    for (const double other : {90.0 - azimuth, -azimuth, azimuth - 90.0})
        if (seen(other) > seen(best)) best = other;
    return best;
}

/// Degrees above the horizon.
double height_of(const Bounds& level, std::size_t axis) {
    const Vec3 sides = level.extent();
    double least = infinity;
    for (std::size_t c = 0; c < 3; ++c)
        if (c != axis) least = std::min(least, sides[Eigen::Index(c)]);
    return sides[Eigen::Index(axis)] < flat * least ? from_above : elevation;
}

/// The camera at that height, or higher up where fixed bodies hide too much.
template <class Place>
CameraDescription unhidden(const CameraVisibility& visibility, double first, const Place& place) {
    CameraDescription best = place(first);
    double share = visibility.visible_share(best.eye);
    for (const double above : higher) {
        if (share >= enough) break;
        if (above <= first) continue;
        const CameraDescription camera = place(above);
        const double now = visibility.visible_share(camera.eye);
        if (now > share) best = camera, share = now;
    }
    return best;
}

}  // namespace

CameraDescription default_camera(const SceneDescription& scene, const CameraDescription& lens, double seconds) {
    std::vector<Vec3> points = with_surroundings(scene, moving_points(scene, seconds), {ground_factor});
    if (points.empty()) {  // default extent, at the origin
        add_corners({Vec3(-2.0, 0.0, -2.0), Vec3(2.0, 2.0, 2.0)}, Vec3::Zero(), Quat::Identity(), points);
    }
    const Vec3 up = lens.up.normalized();
    return unhidden(CameraVisibility(scene), elevation,
                    [&](double above) { return fitted(scene, lens, points, view_axes(up, above), used_fraction); });
}

CameraDescription camera_of_motion(const SceneDescription& scene, const CameraDescription& lens,
                                   const ShownMotion& motion) {
    const Vec3 up = lens.up.normalized();
    const double side = side_of(motion.paths, up);
    Eigen::Index axis = 0;
    up.cwiseAbs().maxCoeff(&axis);
    const double height = height_of(bounds_of(motion.points), std::size_t(axis));
    const std::vector<Vec3> points = with_surroundings(scene, motion.points, {ground_near_motion, true, motion.stands});
    return unhidden(CameraVisibility(scene, motion.places), height, [&](double above) {
        return fitted(scene, lens, points, view_axes(up, above, side), used_by_motion);
    });
}

CameraDescription with_own_place(CameraDescription chosen, const CameraDescription& own) {
    const Vec3 offset = chosen.eye - chosen.target;
    if (own.own_target) chosen.target = own.target, chosen.eye = own.target + offset;
    if (own.own_eye) chosen.eye = own.eye;
    const Vec3 view = chosen.target - chosen.eye;
    if (view.norm() == 0.0 || view.normalized().cross(own.up.normalized()).norm() < least_roll_angle) return own;
    CameraDescription placed = own;
    placed.eye = chosen.eye;
    placed.target = chosen.target;
    return placed;
}

}  // namespace tumble
