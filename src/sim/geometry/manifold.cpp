#include "sim/geometry/manifold.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Hysteresis: two candidates that are nearly as good must not alternate from step to step. A later one must be better
// by this factor.
constexpr double clearly = 1.02;
// Points within this fraction of the manifold's size from touching carry the load or soon will: they are preferred to
// points farther off, the deepest first (compared with the second constant, also a fraction of the size). If a
// load-carrying point is dropped, the body sinks there until the point is restored, and is then kicked out.
constexpr double near_touching = 1e-3;
constexpr double deeper = 1e-5;
// A gain below this fraction of the size, or of its square, counts as none.
constexpr double negligible_size = 1e-6;

// Points that span the area may lie above points that touch: the upper corners of a thin plate above its lower ones.
// Then the lower one counts if it is nearer along the normal by more than twice its lateral distance.
constexpr double steep = 0.5;

Vec3 across(const Vec3& normal, const Vec3& v) { return v - normal.dot(v) * normal; }

// Gain of a point over those chosen, seen along the normal: its squared distance from one, the area of the triangle
// with two, its distance outside the triangle of three.
double gain(const Manifold& chosen, const Vec3& p) {
    const auto at = [&](int i) -> const Vec3& { return chosen.points[std::size_t(i)].position; };
    const auto area = [&](int i, int k) { return chosen.normal.dot((at(k) - at(i)).cross(p - at(i))); };
    if (chosen.count == 1) return across(chosen.normal, p - at(0)).squaredNorm();
    if (chosen.count == 2) return std::abs(area(0, 1));
    const double turn = chosen.normal.dot((at(1) - at(0)).cross(at(2) - at(0))) > 0.0 ? 1.0 : -1.0;
    return -std::min({turn * area(0, 1), turn * area(1, 2), turn * area(2, 0)});
}

struct Swap {
    PointGeometry operator()(const NoCurve&) const { return NoCurve{}; }
    PointGeometry operator()(const BallOverFace& ball) const { return BallOverFace{!ball.ball_of_a, ball.center}; }
    PointGeometry operator()(const CurvedGap& gap) const {
        return CurvedGap{gap.distance, gap.line, gap.on_b, gap.on_a};
    }
    PointGeometry operator()(const CrossingEdges& edges) const { return CrossingEdges{edges.of_b, edges.of_a}; }
};

}  // namespace

PointGeometry swapped(const PointGeometry& geometry) { return std::visit(Swap{}, geometry); }

PointGeometry Manifold::geometry(int point) const {
    switch (kind) {
        case GeometryKind::ball_of_a:
            return BallOverFace{true, points[std::size_t(2 + point)].position};
        case GeometryKind::ball_of_b:
            return BallOverFace{false, points[std::size_t(2 + point)].position};
        case GeometryKind::curved_gap:
            return CurvedGap{points[1].separation, points[1].position, points[2].position, points[3].position};
        case GeometryKind::crossing_edges:
            if (count == 1) return CrossingEdges{points[1].position, points[2].position};
            break;  // further points have taken their slots
        case GeometryKind::none:
            break;
    }
    return NoCurve{};
}

void Manifold::set_geometry(const PointGeometry& geometry) {
    kind = GeometryKind::none;
    if (const auto* ball = std::get_if<BallOverFace>(&geometry)) {
        kind = ball->ball_of_a ? GeometryKind::ball_of_a : GeometryKind::ball_of_b;
        points[2].position = ball->center;
    } else if (const auto* gap = std::get_if<CurvedGap>(&geometry)) {
        kind = GeometryKind::curved_gap;
        points[1].position = gap->line;
        points[1].separation = gap->distance;
        points[2].position = gap->on_a;
        points[3].position = gap->on_b;
    } else if (const auto* edges = std::get_if<CrossingEdges>(&geometry)) {
        kind = GeometryKind::crossing_edges;
        points[1].position = edges->of_a;
        points[2].position = edges->of_b;
    }
}

std::vector<BodyPair> body_pairs(const std::vector<Manifold>& manifolds) {
    std::vector<BodyPair> pairs;
    for (const Manifold& m : manifolds) pairs.push_back({m.a, m.b});
    return pairs;
}

void keep_best_points(const std::vector<ContactPoint>& candidates, Manifold& manifold,
                      std::vector<ContactPoint>& reduced) {
    if (candidates.size() <= Manifold::capacity) {
        manifold.count = std::int16_t(candidates.size());
        std::copy(candidates.begin(), candidates.end(), manifold.points.begin());
        return;
    }
    Bounds box;
    for (const ContactPoint& p : candidates) box.add(p.position);
    const double size = box.extent().norm();

    std::size_t deepest = 0;
    for (std::size_t i = 1; i < candidates.size(); ++i)
        if (candidates[i].separation < candidates[deepest].separation - deeper * size) deepest = i;
    const double touching = std::max(0.0, candidates[deepest].separation) + near_touching * size;
    manifold.count = 1;
    manifold.points[0] = candidates[deepest];
    for (const bool far : {false, true}) {
        while (manifold.count < int(Manifold::capacity)) {
            const ContactPoint* best = nullptr;
            double most = negligible_size * size * size;
            for (const ContactPoint& p : candidates) {
                if (!far && p.separation > touching) continue;
                const double g = gain(manifold, p.position);
                if (g <= (best ? clearly : 1.0) * most) continue;
                most = g;
                best = &p;
            }
            if (!best) break;
            manifold.points[std::size_t(manifold.count++)] = *best;
        }
    }
    for (int i = 0; i < manifold.count; ++i) {
        ContactPoint& upper = manifold.points[std::size_t(i)];
        for (const ContactPoint& lower : candidates) {
            const double nearer = upper.separation - lower.separation;
            if (!(nearer > negligible_size * size)) continue;
            if (manifold.has(lower.feature)) continue;
            if (across(manifold.normal, lower.position - upper.position).norm() < steep * nearer) upper = lower;
        }
    }
    manifold.first_reduced = std::uint32_t(reduced.size());
    for (const ContactPoint& p : candidates)
        if (!manifold.has(p.feature)) reduced.push_back(p);
    manifold.reduced = std::uint16_t(reduced.size() - manifold.first_reduced);
}

}  // namespace tumble
