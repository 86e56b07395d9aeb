#include "scene/camera/default_camera.h"

#include "sim/geometry/shapes/shape.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr int preview_steps = 600;          // per trajectory: 8 ms each for a throw of 5 s
constexpr int steps_a_point = 12;           // fifty points approximate a smooth curve
constexpr std::size_t most_pairs = 10'000;  // of thrown and other bodies: some 50 ms
constexpr double farthest_of_size = 60.0;   // of the body's diameter: it is then about 20 pixels of 1280
constexpr double farthest_of_all = 2.0;     // of the extent of all moving bodies

struct Plane {
    Vec3 normal;    // unit, world frame
    double offset;  // m
    const BodyDescription* body;
};

/// The bounding box of a body.
struct Block {
    Vec3 center, half_size;  // m
    Quat rotation;
    const BodyDescription* body;
};

struct Obstacles {
    PairRules rules;
    std::vector<Plane> planes;
    std::vector<Block> blocks;
};

Obstacles obstacles_of(const SceneDescription& scene) {
    Obstacles all{scene.contact, {}, {}};
    for (const BodyDescription& body : scene.bodies) {
        if (const auto* plane = std::get_if<PlaneShape>(&body.shape)) {
            const Vec3 normal = body.rotation * plane->normal;
            all.planes.push_back({normal, plane->offset + normal.dot(body.position), &body});
            continue;
        }
        const Bounds local = local_bounds(body.shape);
        all.blocks.push_back(
            {body.position + body.rotation * local.center(), 0.5 * local.extent(), body.rotation, &body});
    }
    return all;
}

bool thrown(const BodyDescription& body) { return body.type == BodyType::dynamic && body.velocity != Vec3::Zero(); }

/// Vector from the block's nearest point to a point.
Vec3 gap_to(const Block& block, const Vec3& point) {
    const Vec3 local = block.rotation.conjugate() * (point - block.center);
    return block.rotation * (local - local.cwiseMin(block.half_size).cwiseMax(-block.half_size));
}

class Flight {
public:
    Flight(const Block& start, const Obstacles& obstacles)
        : body_(*start.body),
          obstacles_(obstacles),
          at_(start.center),
          velocity_(body_.velocity),
          inner_(start.half_size.minCoeff()) {
        for (const Block& block : obstacles.blocks)  // blocks that contain the initial position do not stop the body
            if (block.body != &body_ &&
                (block.body->type == BodyType::fixed || gap_to(block, at_).norm() > 1.01 * inner_))
                met_.push_back(&block);
    }

    /// False at the end of the trajectory.
    bool step(double h, const Vec3& gravity) {
        velocity_ += h * gravity;
        at_ += h * velocity_;
        for (const Plane& plane : obstacles_.planes) {
            const double height = plane.normal.dot(at_) - plane.offset;
            if (height < inner_) bounce(plane.normal, inner_ - height, *plane.body);
        }
        for (const Block* block : met_) {
            const Vec3 gap = gap_to(*block, at_);
            const double distance = gap.norm();
            if (distance >= inner_) continue;
            if (block->body->type != BodyType::fixed || distance == 0.0) return false;
            bounce(gap / distance, inner_ - distance, *block->body);
        }
        return true;
    }

    const Vec3& at() const { return at_; }

private:
    void bounce(const Vec3& normal, double depth, const BodyDescription& other) {
        at_ += depth * normal;
        const double approach = -normal.dot(velocity_);
        if (approach <= 0.0) return;
        const double e =
            pair_value(obstacles_.rules.restitution, body_.restitution_in_pair(), other.restitution_in_pair());
        const double kick = (1.0 + e) * approach;
        velocity_ += kick * normal;
        if (std::holds_alternative<SphereShape>(body_.shape)) return;
        const Vec3 along = velocity_ - normal * normal.dot(velocity_);  // Coulomb friction
        const double speed = along.norm();
        const double loss =
            pair_value(obstacles_.rules.friction, body_.friction_in_pair(), other.friction_in_pair()) * kick;
        velocity_ -= along * (loss < speed ? loss / speed : 1.0);
    }

    const BodyDescription& body_;
    const Obstacles& obstacles_;
    std::vector<const Block*> met_;
    Vec3 at_, velocity_;
    double inner_;  // m: radius of the inscribed ball
};

}  // namespace

std::vector<Vec3> flight_points(const SceneDescription& scene, double seconds) {
    std::vector<Vec3> points;
    const auto count = std::size_t(std::count_if(scene.bodies.begin(), scene.bodies.end(), thrown));
    if (count == 0 || count * scene.bodies.size() > most_pairs || !(seconds > 0.0)) return points;
    const Obstacles obstacles = obstacles_of(scene);
    Bounds moving;
    for (const Block& block : obstacles.blocks)
        if (block.body->type != BodyType::fixed)
            for (const double side : {-1.0, 1.0})
                moving.add(block.center + Vec3::Constant(side * block.half_size.norm()));
    for (const Block& start : obstacles.blocks) {
        if (!thrown(*start.body)) continue;
        const double radius = start.half_size.norm();
        const double farthest = std::max(farthest_of_size * 2.0 * radius, farthest_of_all * moving.extent().norm());
        Flight flight(start, obstacles);
        for (int i = 1; i <= preview_steps && flight.step(seconds / preview_steps, scene.simulation.gravity); ++i) {
            if ((flight.at() - start.center).norm() > farthest) break;
            if (i % steps_a_point != 0) continue;
            for (int corner = 0; corner < 8; ++corner)
                points.push_back(flight.at() +
                                 radius * Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
        }
    }
    return points;
}

}  // namespace tumble
