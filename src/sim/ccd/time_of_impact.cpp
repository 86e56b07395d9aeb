#include "sim/ccd/time_of_impact.h"

#include "sim/ccd/separation.h"
#include "sim/ccd/settings.h"
#include "sim/geometry/curved_axis.h"
#include "sim/geometry/separating_axis.h"
#include "sim/geometry/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Gaps below this share of the bodies' sizes are rounding,
constexpr double impact_gap = 1e-13;

/// At gaps below this share of the smaller body, the separating axis is that of the meeting features. It lies
/// between the rounding of the search for the nearest points and the use of its result. Not fitted.
constexpr double impact_near = 1e-7;

/// Points within this share of a feature belong to it. Not fitted: below `impact_near`, above rounding.
constexpr double impact_feature = 1e-8;

/// Poses that a search evaluates before it returns its bound: 4 to 70 are usual (spins up to 100 rad/s). Not
/// fitted: a bound of the cost.
constexpr int impact_evaluations = 400;

using PolyhedronRef = std::shared_ptr<const Polyhedron>;
using MeshRef = std::shared_ptr<const CollisionMesh>;
using CompoundRef = std::shared_ptr<const Compound>;
using CurvedRef = std::shared_ptr<const CurvedBody>;

// Shape that is searched: that of the whole body, or one part of a compound, at its pose in the body.
const CollisionShape& collider_of(const MovingBody& t) { return t.part ? t.part->collider : t.body->collider; }
double size_of(const MovingBody& t) { return t.part ? t.part->reach : t.body->radius; }
Pose pose_of(const MovingBody& t, const Motion& motion) {
    const Pose body{motion.position, motion.rotation};
    return t.part ? part_pose(body, *t.part) : body;
}

// Rounding errors at a pair's present positions.
struct Scale {
    double touch;  // m: gaps below are rounding
    double speed;  // m/s: rates below are rounding
};

Scale scale_of(const MovingBody& a, const MovingBody& b) {
    const auto of = [](const MovingBody& t) {
        const double size = std::isfinite(t.body->radius) ? t.body->radius : 0.0;
        return std::pair{gap_rounding(*t.body, t.path->position(t.since)),
                         t.path->velocity(t.since).cwiseAbs().maxCoeff() + t.path->spin_bound() * size};
    };
    const auto [gap_a, speed_a] = of(a);
    const auto [gap_b, speed_b] = of(b);
    return {gap_a + gap_b, tuning::impact_speed_rounding * (speed_a + speed_b)};
}

// First time at which h + v t + a t^2 / 2 falls to zero, for h > 0; for touching bodies (h within `touch`) the next
// time.
double fall_time(double h, double v, double a, const Scale& scale) {
    if (h <= scale.touch) {
        if (v < -scale.speed) return 0.0;
        if (a >= 0.0) return infinity;
        return v > 0.0 ? -2.0 * v / a : (v + scale.speed) / -a;  // up and back; or as soon as it exceeds rounding
    }
    const double square = v * v - 2.0 * a * h;
    if (square < 0.0) return infinity;
    const double root = std::sqrt(square);
    if (v < 0.0) return 2.0 * h / (root - v);
    return a < 0.0 ? -(v + root) / a : infinity;
}

// First time at which two points in uniform relative motion (d + v t) come within r of each other; infinity if there is
// none up to the horizon.
double approach_time(const Vec3& d, const Vec3& v, double r, double horizon, const MovingBody& a, const MovingBody& b) {
    const double closing = -d.dot(v), square = d.squaredNorm();
    if (!(closing > 0.0)) return infinity;
    if (square - r * r > 2.0 * closing * horizon) return infinity;  // most pairs: too far apart to meet in time
    const double distance = std::sqrt(square), gap = distance - r;
    if (gap <= tuning::touch * r) {
        const Scale scale = scale_of(a, b);
        if (gap <= scale.touch) return closing > scale.speed * distance ? 0.0 : infinity;
    }
    // c = d^2 - r^2 without cancellation of the squares.
    const double c = gap * (distance + r), discriminant = closing * closing - v.squaredNorm() * c;
    return discriminant < 0.0 ? infinity : c / (std::sqrt(discriminant) + closing);
}

TimeOfImpact result(double time, double horizon) {
    if (time <= horizon) return {TimeOfImpact::Kind::impact, time};
    return {};
}

// Sets the constant data of the support points.
void prepare(SupportPoints& points, const MovingBody& t, double horizon) {
    points.spin_bound = t.path->spin_bound();
    points.turning_bound = t.path->turning_bound();
    const RoundedHull hull = rounded_hull(collider_of(t));
    points.radius = hull.radius;
    points.reach = (t.part ? t.part->place.position.norm() : 0.0) + hull.reach;
    points.arms.assign(hull.points.size(), Vec3::Zero());
    points.curved = nullptr;
    // A capsule is a rounded line.
    const auto* curved = std::get_if<CurvedRef>(&collider_of(t));
    if (curved && (*curved)->rounding == 0.0) {
        points.curved = curved->get();
        points.arms.clear();
    }
    points.acceleration_change =
        t.path->parabolic() ? 0.0 : (t.path->acceleration(t.since + horizon) - t.path->acceleration(t.since)).norm();
}

void pose(SupportPoints& points, const MovingBody& t, double time, const Motion& motion) {
    points.center = motion.position;
    points.velocity = motion.velocity;
    points.acceleration = t.path->acceleration(t.since + time);
    points.angular_velocity = motion.angular_velocity;
    if (points.curved) {
        const Pose at = pose_of(t, motion);
        points.place = at.position - motion.position;
        points.rotation = at.rotation;
        return;
    }
    const RoundedHull hull = rounded_hull(collider_of(t));
    if (t.part) {  // arms start at the body's center of mass here too: the points move as the body does
        const Vec3 place = motion.rotation * t.part->place.position;
        const Mat3 turn = motion.rotation * t.part->place.rotation;
        for (std::size_t i = 0; i < points.arms.size(); ++i) points.arms[i] = place + turn * hull.points[i];
    } else {
        for (std::size_t i = 0; i < points.arms.size(); ++i) points.arms[i] = motion.rotation * hull.points[i];
    }
}

// A ball does not need its orientation.
Motion motion_of(const MovingBody& t, double time) {
    const double at = t.since + time;
    if (!std::holds_alternative<Ball>(t.body->collider)) return t.path->at(at);
    Motion motion;
    motion.position = t.path->position(at);
    motion.velocity = t.path->velocity(at);
    return motion;
}

// The searched shape, if it is a ball, a polyhedron or a curved body.
std::optional<ConvexShape> convex_of(const MovingBody& t, const Pose& pose) {
    if (const auto* ball = std::get_if<Ball>(&collider_of(t))) return convex_shape(*ball, pose);
    if (const auto* hull = std::get_if<PolyhedronRef>(&collider_of(t))) return convex_shape(**hull, pose);
    if (const auto* curved = std::get_if<CurvedRef>(&collider_of(t))) return convex_shape(**curved, pose);
    return std::nullopt;
}

// A bounding ball of the searched shape, with bounds of its motion.
struct BoundingBall {
    MovingBody moving_body;
    Vec3 center, velocity, acceleration;
    double acceleration_change, turning_speed, radius;
};

BoundingBall bounding_ball_of(const MovingBody& t, const Motion& motion, double horizon) {
    const Vec3 acceleration = t.path->acceleration(t.since);
    const double change = t.path->parabolic() ? 0.0 : (t.path->acceleration(t.since + horizon) - acceleration).norm();
    const double arm = t.part ? t.part->place.position.norm() : 0.0;
    return {t,      pose_of(t, motion).position, motion.velocity, acceleration,
            change, t.path->spin_bound() * arm,  size_of(t)};
}

// Least time for closing a gap in any direction.
double least_time(double gap, const BoundingBall& a, const BoundingBall& b) {
    if (!(gap > 0.0)) return 0.0;
    const double speed = (b.velocity - a.velocity).norm() + a.turning_speed + b.turning_speed;
    const double acceleration =
        (b.acceleration - a.acceleration).norm() + a.acceleration_change + b.acceleration_change;
    const double root = std::sqrt(speed * speed + 2.0 * acceleration * gap);
    return speed + root > 0.0 ? 2.0 * gap / (speed + root) : infinity;
}

// The parts of a compound, one search each; other shapes unchanged.
std::vector<BoundingBall> parts_of(const MovingBody& whole, double horizon) {
    const Motion motion = motion_of(whole, 0.0);
    std::vector<BoundingBall> parts;
    if (const auto* compound = std::get_if<CompoundRef>(&whole.body->collider))
        for (const Compound::Part& part : (*compound)->parts)
            parts.push_back(bounding_ball_of({whole.body, whole.path, whole.since, &part}, motion, horizon));
    else
        parts.push_back(bounding_ball_of(whole, motion, horizon));
    return parts;
}

// The half-space as the point of its plane below the other's center.
void pose_half_space(SupportPoints& points, const HalfSpace& space, const Motion& motion, const Vec3& other) {
    const Vec3 normal = motion.rotation * space.normal;
    const Vec3 foot = other - (normal.dot(other - motion.position) - space.offset) * normal;
    points.velocity = motion.point_velocity(foot - motion.position);
    points.acceleration_change += points.turning_bound * (foot - motion.position).norm();
    points.center = foot;
}

}  // namespace

double gap_rounding(const Body& body, const Vec3& position) {
    const double size = std::isfinite(body.radius) ? body.radius : 0.0;
    return impact_gap * size + tuning::impact_position_rounding * position.cwiseAbs().maxCoeff();
}

struct ImpactSearch::Pair {
    MovingBody a, b;
    Scale scale;
    double size;                          // m, of the smaller body
    double overlap;                       // m, allowed
    const HalfSpace* plane = nullptr;     // of A
    const CollisionMesh* mesh = nullptr;  // of A, if A is a mesh
    std::uint32_t triangle = 0;           // index of one of its triangles
};

TimeOfImpact ImpactSearch::find(const MovingBody& a, const MovingBody& b, double horizon, double overlap) {
    const CollisionShape &shape_a = a.body->collider, &shape_b = b.body->collider;
    const auto *ball_a = std::get_if<Ball>(&shape_a), *ball_b = std::get_if<Ball>(&shape_b);
    const bool parabolic = a.path->parabolic() && b.path->parabolic();
    const bool evenly = parabolic && a.path->acceleration(0.0) == b.path->acceleration(0.0);
    if (ball_a && ball_b && evenly) {  // first, because there are many such pairs and the test is fast
        return result(approach_time(b.path->position(b.since) - a.path->position(a.since),
                                    b.path->velocity(b.since) - a.path->velocity(a.since),
                                    ball_a->radius + ball_b->radius - overlap, horizon, a, b),
                      horizon);
    }
    // Half-spaces and meshes come first; the search is symmetric otherwise.
    if (std::holds_alternative<HalfSpace>(shape_b) || std::holds_alternative<MeshRef>(shape_b)) {
        if (std::holds_alternative<HalfSpace>(shape_a) || std::holds_alternative<MeshRef>(shape_a)) return {};
        return find(b, a, horizon, overlap);
    }
    if (std::holds_alternative<CompoundRef>(shape_a) || std::holds_alternative<CompoundRef>(shape_b))
        return search_parts(a, b, horizon, overlap);
    if (std::holds_alternative<MeshRef>(shape_a)) return search_mesh(a, b, horizon, overlap);

    Pair pair{
        a,       b, scale_of(a, b), std::min(a.body->radius, b.body->radius), overlap, std::get_if<HalfSpace>(&shape_a),
        nullptr, 0};
    double from = 0.0;
    if (pair.plane && parabolic && !a.path->turns()) {
        // Exact for a ball; for other shapes the time of the bounding ball, before which nothing touches.
        const Vec3 normal = a.path->orientation(a.since) * pair.plane->normal;
        const double height =
            normal.dot(b.path->position(b.since) - a.path->position(a.since)) - pair.plane->offset - b.body->radius;
        const double rate = normal.dot(b.path->velocity(b.since) - a.path->velocity(a.since));
        const double acceleration = normal.dot(b.path->acceleration(b.since) - a.path->acceleration(a.since));
        if (ball_b) return result(fall_time(height + overlap, rate, acceleration, pair.scale), horizon);
        if (height > 0.0) from = fall_time(height, rate, acceleration, pair.scale);
    } else if (!pair.plane && evenly) {
        const Vec3 d = b.path->position(b.since) - a.path->position(a.since);
        const Vec3 v = b.path->velocity(b.since) - a.path->velocity(a.since);
        const double reach = a.body->radius + b.body->radius;
        if (d.squaredNorm() > reach * reach) from = approach_time(d, v, reach, horizon, a, b);
    }
    if (!(from < horizon)) return {};
    return search(pair, from, horizon);
}

TimeOfImpact ImpactSearch::search(const Pair& pair, double from, double horizon) {
    prepare(a_, pair.a, horizon);
    prepare(b_, pair.b, horizon);
    b_.radius -= pair.overlap;
    const double own_change = a_.acceleration_change;
    const double near = impact_near * pair.size;
    double t = from;
    for (int round = 0; round < impact_evaluations; ++round) {
        if (!(t < horizon)) return {};
        const Motion motion_a = motion_of(pair.a, t), motion_b = motion_of(pair.b, t);
        pose(b_, pair.b, t, motion_b);
        if (pair.mesh) {
            const auto& corners = pair.mesh->triangles[pair.triangle].vertices;
            a_.center = motion_a.to_world(pair.mesh->vertices[corners[0]]);
            a_.velocity.setZero();  // meshes are fixed
            a_.acceleration.setZero();
            a_.angular_velocity.setZero();
            a_.arms.resize(3);
            a_.reach = 0.0;
            for (std::size_t i = 0; i < 3; ++i) {
                a_.arms[i] = motion_a.to_world(pair.mesh->vertices[corners[i]]) - a_.center;
                a_.reach = std::max(a_.reach, a_.arms[i].norm());
            }
        } else {
            pose(a_, pair.a, t, motion_a);
            a_.acceleration_change = own_change;
            if (pair.plane) pose_half_space(a_, *pair.plane, motion_a, b_.center);
        }
        propose(pair, motion_a, motion_b, near);

        // The axis with the widest gap, rotating with its features or fixed: both bounds are certain, the longer is
        // taken.
        SeparationBound best;
        TrackedAxis best_axis;
        best.gap = -infinity;
        double safe = 0.0;
        for (const Vec3& normal : normals_) {
            const TrackedAxis axis = pair.plane ? TrackedAxis{normal, a_.angular_velocity.cross(normal)}
                                                : tracking_axis(a_, b_, normal, impact_feature * pair.size);
            const SeparationBound bound = bound_separation(a_, b_, axis, horizon - t, 2.0 * pair.scale.touch);
            if (bound.gap > 0.0) safe = std::max(safe, bound.safe_time);
            if (bound.gap <= best.gap) continue;
            best = bound;
            best_axis = axis;
        }
        last_axis_ = best_axis.normal;
        safe = std::max(safe, best.safe_time);
        if (!best_axis.rate.isZero(0.0))
            safe =
                std::max(safe, bound_separation(a_, b_, {best_axis.normal, Vec3::Zero()}, horizon - t, 0.0).safe_time);
        if (best.gap <= pair.scale.touch) {
            if (best.rate < -pair.scale.speed) return {TimeOfImpact::Kind::impact, t};
            // Touching and not approaching. For a touch that parts more slowly than the bound assumes, the steps would
            // shrink without end: within this one no overlap can exceed rounding.
            safe = std::max(safe, std::sqrt(8.0 * pair.scale.touch / std::max(best.curvature, 1e-300)));
        } else if (safe < tuning::impact_time && best.rate < 0.0) {
            return result(t + safe, horizon);
        }
        t += std::max({safe, tuning::impact_time, 4e-16 * t});
    }
    return t < horizon ? TimeOfImpact{TimeOfImpact::Kind::check, t} : TimeOfImpact{};
}

void ImpactSearch::propose(const Pair& pair, const Motion& a, const Motion& b, double near) {
    normals_.clear();
    if (pair.plane) {
        normals_.push_back(a.rotation * pair.plane->normal);
        return;
    }
    const auto v = closest_vector(a_, b_, last_axis_);
    const double distance = v ? v->norm() : 0.0;
    if (distance > near) {
        normals_.push_back(*v / distance);
        return;
    }
    // At so small a gap only the features themselves give the axis to the last digit.
    if (std::holds_alternative<CurvedRef>(collider_of(pair.a)) ||
        std::holds_alternative<CurvedRef>(collider_of(pair.b))) {
        Pose of_b = pose_of(pair.b, b);
        of_b.position -= a_.center;
        const auto shape_b = convex_of(pair.b, of_b);
        auto shape_a = std::optional<ConvexShape>();
        if (pair.mesh) {
            const Vec3 facing = (a_.arms[1] - a_.arms[0]).cross(a_.arms[2] - a_.arms[0]).normalized();
            shape_a = convex_triangle({a_.arms[0], a_.arms[1], a_.arms[2]},
                                      facing.dot(of_b.position) < 0.0 ? Vec3(-facing) : facing);
        } else {
            Pose of_a = pose_of(pair.a, a);
            of_a.position -= a_.center;
            shape_a = convex_of(pair.a, of_a);
        }
        CurvedAxisSearch search(*shape_a, *shape_b);
        search.find_flat(infinity);
        normals_.push_back(search.find_best().normal);
        if (distance > 0.0) normals_.push_back(*v / distance);
        return;
    }
    if (pair.mesh) {
        if (const auto* shape = std::get_if<PolyhedronRef>(&collider_of(pair.b)))
            propose_triangle_axes(**shape, pose_of(pair.b, b).rotation);
    } else {
        manifolds_.clear();
        scratch_.reduced.clear();
        const Pose pose_a = pose_of(pair.a, a), pose_b = pose_of(pair.b, b);
        collide(collider_of(pair.a), collider_of(pair.b), {pose_a, pose_b, 16.0 * near, scratch_, manifolds_});
        for (const Manifold& m : manifolds_) normals_.push_back(m.normal);
    }
    if (distance > 0.0) normals_.push_back(*v / distance);
    if (!normals_.empty()) return;
    const auto *hull_a = std::get_if<PolyhedronRef>(&collider_of(pair.a)),
               *hull_b = std::get_if<PolyhedronRef>(&collider_of(pair.b));
    if (hull_a && hull_b) {  // an edge along the border of a face: touching, though no contact point lies on the face
        const Pose at = pose_of(pair.a, a), b_in_a = seen_from(at, pose_of(pair.b, b));
        const AxisQuery query{**hull_a, **hull_b, b_in_a, infinity, EdgeSearch::nearby, Vec3::Zero()};
        normals_.push_back(at.rotation * find_separating_axis(query, scratch_).normal);
        return;
    }
    const Vec3 from = pair.a.part ? pose_of(pair.a, a).position : a_.center;
    normals_.push_back(((pair.b.part ? pose_of(pair.b, b).position : b_.center) - from).normalized());
}

// The separating axes of a triangle and a polyhedron: both shapes' face normals and the cross products of their edges.
void ImpactSearch::propose_triangle_axes(const Polyhedron& shape, const Mat3& rotation) {
    Vec3 best = Vec3::Zero();
    double most = -infinity;
    const Vec3 d = b_.center - a_.center;
    const auto consider = [&](Vec3 n) {
        const double length = n.norm();
        if (length < 1e-9) return;
        n /= length;
        for (const double sign : {1.0, -1.0}) {
            double low = infinity, high = -infinity;
            for (const Vec3& arm : b_.arms) low = std::min(low, sign * n.dot(arm));
            for (const Vec3& arm : a_.arms) high = std::max(high, sign * n.dot(arm));
            const double gap = sign * n.dot(d) + low - high;
            if (gap <= most) continue;
            most = gap;
            best = sign * n;
        }
    };
    consider((a_.arms[1] - a_.arms[0]).cross(a_.arms[2] - a_.arms[0]));
    for (const Polyhedron::Face& face : shape.faces) consider(rotation * face.normal);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 own = (a_.arms[(i + 1) % 3] - a_.arms[i]).normalized();
        for (const Polyhedron::Edge& e : shape.edges)
            consider(own.cross((b_.arms[e.head] - b_.arms[e.tail]).normalized()));
    }
    if (most > -infinity) normals_.push_back(best);
}

// Part by part, those with the earliest possible impact first: the first impact found ends the search for later parts.
TimeOfImpact ImpactSearch::search_parts(const MovingBody& a, const MovingBody& b, double horizon, double overlap) {
    const auto* plane = std::get_if<HalfSpace>(&a.body->collider);
    const bool mesh = std::holds_alternative<MeshRef>(a.body->collider);
    const Vec3 normal = plane ? Vec3(a.path->orientation(a.since) * plane->normal) : Vec3(Vec3::Zero());
    const auto time = [&](const BoundingBall& ball_a, const BoundingBall& ball_b) {
        if (plane && a.path->turns()) return 0.0;
        const Vec3 d = ball_b.center - ball_a.center;
        return least_time((plane ? normal.dot(d) - plane->offset : d.norm() - ball_a.radius) - ball_b.radius, ball_a,
                          ball_b);
    };
    if (!(time(bounding_ball_of(a, motion_of(a, 0.0), horizon), bounding_ball_of(b, motion_of(b, 0.0), horizon)) <
          horizon))
        return {};
    const std::vector<BoundingBall> parts_a = parts_of(a, horizon), parts_b = parts_of(b, horizon);
    part_pairs_.clear();
    for (const BoundingBall& part_a : parts_a) {
        for (const BoundingBall& part_b : parts_b) {
            const double from = time(part_a, part_b);
            if (from < horizon) part_pairs_.push_back({from, part_a.moving_body, part_b.moving_body});
        }
    }
    std::stable_sort(part_pairs_.begin(), part_pairs_.end(),
                     [](const PartPair& l, const PartPair& r) { return l.from < r.from; });
    TimeOfImpact first;
    for (const PartPair& p : part_pairs_) {
        if (!(p.from < horizon)) break;
        const Pair pair{p.a, p.b, scale_of(p.a, p.b), std::min(size_of(p.a), size_of(p.b)), overlap, plane, nullptr, 0};
        const TimeOfImpact found = mesh ? search_mesh(p.a, p.b, horizon, overlap) : search(pair, p.from, horizon);
        if (found.kind == TimeOfImpact::Kind::none) continue;
        first = found;
        horizon = found.time;
    }
    return first;
}

TimeOfImpact ImpactSearch::search_mesh(const MovingBody& mesh, const MovingBody& other, double horizon,
                                       double overlap) {
    const CollisionMesh& triangles = *std::get<MeshRef>(mesh.body->collider);
    // The triangles that the other shape can reach, in the frame of the mesh; meshes are fixed.
    const Motion frame = mesh.path->at(mesh.since);
    const Bounds world = other.path->swept(other.since, other.since + horizon).grown(other.body->radius);
    const Vec3 center = frame.rotation.transpose() * (world.center() - frame.position);
    const Vec3 half = frame.rotation.transpose().cwiseAbs() * (0.5 * world.extent());
    candidates_.clear();
    triangles.tree.query({center - half, center + half}, [&](std::uint32_t i) { candidates_.push_back(i); });
    std::sort(candidates_.begin(), candidates_.end());
    const BoundingBall still = bounding_ball_of(mesh, frame, horizon),
                       ball = bounding_ball_of(other, motion_of(other, 0.0), horizon);
    const Vec3 middle = frame.rotation.transpose() * (ball.center - frame.position);
    TimeOfImpact first;
    for (const std::uint32_t triangle : candidates_) {
        const Bounds& box = triangles.tree.item(triangle);
        const double gap = (middle - middle.cwiseMax(box.min).cwiseMin(box.max)).norm() - ball.radius;
        if (other.part && !(least_time(gap, still, ball) < horizon)) continue;
        const Pair pair{mesh, other, scale_of(mesh, other), size_of(other), overlap, nullptr, &triangles, triangle};
        const TimeOfImpact found = search(pair, 0.0, first.kind == TimeOfImpact::Kind::none ? horizon : first.time);
        if (found.kind != TimeOfImpact::Kind::none) first = found;
    }
    return first;
}

}  // namespace tumble
