#include "scene/camera/camera_visibility.h"

#include "scene/description/shape_bounds.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr std::size_t max_rest_positions = 24;  // a third of them is as informative as all of a thousand
constexpr std::size_t most_triangles =
    200'000;  // of fixed meshes: a tenth of a second; above this number the test is skipped,
constexpr std::size_t most_pieces = 20'000;  // as above this number of fixed shapes

/// Entry of a line into a box at the origin (the slabs of Kay and Kajiya 1986), as a multiple of `direction`; infinity
/// without a hit.
double hit_box(const Vec3& half, const Vec3& from, const Vec3& direction) {
    double enter = -infinity, leave = infinity;
    for (int k = 0; k < 3; ++k) {
        if (direction[k] == 0.0) {
            if (std::fabs(from[k]) > half[k]) return infinity;
            continue;
        }
        const double a = (-half[k] - from[k]) / direction[k], b = (half[k] - from[k]) / direction[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave && leave > 0.0 ? std::max(enter, 0.0) : infinity;
}

double hit_ball(double radius, const Vec3& from, const Vec3& direction) {
    const double a = direction.squaredNorm(), b = from.dot(direction), c = from.squaredNorm() - radius * radius;
    const double root = b * b - a * c;
    if (root < 0.0) return infinity;
    const double enter = (-b - std::sqrt(root)) / a;
    return enter > 0.0 ? enter : infinity;
}

/// Moeller and Trumbore 1997, Fast, Minimum Storage Ray/Triangle Intersection.
double hit_mesh(const TriangleMesh& mesh, const Vec3& from, const Vec3& direction) {
    double nearest = infinity;
    for (const auto& t : mesh.triangles) {
        const Vec3 &a = mesh.vertices[t[0]], ab = mesh.vertices[t[1]] - a, ac = mesh.vertices[t[2]] - a;
        const Vec3 p = direction.cross(ac), to = from - a;
        const double determinant = ab.dot(p);
        if (determinant == 0.0) continue;
        const double u = to.dot(p) / determinant;
        if (u < 0.0 || u > 1.0) continue;
        const Vec3 q = to.cross(ab);
        const double v = direction.dot(q) / determinant;
        if (v < 0.0 || u + v > 1.0) continue;
        const double at = ac.dot(q) / determinant;
        if (at > 0.0) nearest = std::min(nearest, at);
    }
    return nearest;
}

std::size_t triangles_of(const Shape& shape) {
    const auto* mesh = std::get_if<MeshShape>(&shape);
    return mesh ? mesh->asset->mesh.triangles.size() : 0;
}

}  // namespace

CameraVisibility::CameraVisibility(const SceneDescription& scene) {
    std::size_t triangles = 0;
    for (const BodyDescription& body : scene.bodies)
        if (body.type == BodyType::fixed && body.appearance.visible) add(body.shape, body.position, body.rotation);
    for (const Piece& piece : pieces_) triangles += triangles_of(*piece.shape);
    if (!pieces_.empty() && pieces_.size() <= most_pieces && triangles <= most_triangles) find_rest_positions(scene);
}

void CameraVisibility::add(const Shape& shape, const Vec3& position, const Quat& rotation) {
    if (std::holds_alternative<PlaneShape>(shape)) return;
    if (const auto* compound = std::get_if<CompoundShape>(&shape)) {
        for (const CompoundPart& part : *compound->parts)
            add(part.shape, position + rotation * part.position, rotation * part.rotation);
        return;
    }
    const Bounds bounds = local_bounds(shape);
    pieces_.push_back({position + rotation * bounds.center(), 0.5 * bounds.extent(), position, rotation, &shape});
}

double CameraVisibility::first_hit(const Vec3& from, const Vec3& direction) const {
    double nearest = infinity;
    for (const Piece& piece : pieces_) {
        const Quat back = piece.rotation.conjugate();
        const Vec3 local_direction = back * direction;
        const double on_box = hit_box(piece.half_size, back * (from - piece.center), local_direction);
        if (!(on_box < nearest)) continue;
        if (std::holds_alternative<BoxShape>(*piece.shape)) nearest = on_box;
        if (const auto* ball = std::get_if<SphereShape>(piece.shape))
            nearest = std::min(nearest, hit_ball(ball->radius, back * (from - piece.origin), local_direction));
        if (const auto* mesh = std::get_if<MeshShape>(piece.shape))
            nearest = std::min(nearest, hit_mesh(mesh->asset->mesh, back * (from - piece.origin), local_direction));
    }
    return nearest;
}

void CameraVisibility::find_rest_positions(const SceneDescription& scene) {
    const Vec3& gravity = scene.simulation.gravity;
    const Vec3 down = gravity.norm() > 0.0 ? gravity.normalized() : Vec3(0.0, -1.0, 0.0);
    std::vector<const BodyDescription*> moving;
    for (const BodyDescription& body : scene.bodies)
        if (body.type == BodyType::dynamic && body.appearance.visible) moving.push_back(&body);
    const std::size_t count = std::min(moving.size(), max_rest_positions);
    for (std::size_t i = 0; i < count; ++i) {
        const BodyDescription& body = *moving[i * moving.size() / count];
        const Bounds bounds = local_bounds(body.shape);
        const Vec3 middle = body.position + body.rotation * bounds.center();
        double fall = first_hit(middle, down);
        for (const BodyDescription& other : scene.bodies)
            if (const auto* plane = std::get_if<PlaneShape>(&other.shape)) {
                const Vec3 normal = other.rotation * plane->normal;
                const double height = normal.dot(middle - other.position) - plane->offset, approach = -normal.dot(down);
                if (height > 0.0 && approach > 0.0) fall = std::min(fall, height / approach);
            }
        const double rests = fall < infinity ? std::max(fall - 0.5 * bounds.extent().minCoeff(), 0.0) : 0.0;
        rest_positions_.push_back(middle + down * rests);
    }
}

double CameraVisibility::visible_share(const Vec3& eye) const {
    if (rest_positions_.empty()) return 1.0;
    const auto seen = std::count_if(rest_positions_.begin(), rest_positions_.end(),
                                    [&](const Vec3& place) { return first_hit(eye, place - eye) > 0.999; });
    return double(seen) / double(rest_positions_.size());
}

}  // namespace tumble
