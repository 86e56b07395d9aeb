#include "scene/camera/camera_visibility.h"

#include "sim/geometry/shapes/box.h"
#include "sim/geometry/shapes/shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

constexpr std::size_t max_rest_positions = 24;  // a third of them is as informative as all of a thousand
constexpr std::size_t most_triangles =
    200'000;  // of fixed meshes: a tenth of a second; above this number the test is skipped,
constexpr std::size_t most_pieces = 20'000;  // as above this number of fixed shapes

std::size_t triangles_of(const Shape& shape) {
    const auto* mesh = std::get_if<MeshShape>(&shape);
    return mesh ? mesh->asset->mesh.triangles.size() : 0;
}

}  // namespace

CameraVisibility::CameraVisibility(const SceneDescription& scene) {
    if (find_pieces(scene)) find_rest_positions(scene);
}

CameraVisibility::CameraVisibility(const SceneDescription& scene, std::vector<Vec3> places) {
    if (find_pieces(scene)) places_ = std::move(places);
}

bool CameraVisibility::find_pieces(const SceneDescription& scene) {
    std::size_t triangles = 0;
    for (const BodyDescription& body : scene.bodies)
        if (body.type == BodyType::fixed && body.appearance.visible) add(body.shape, body.position, body.rotation);
    for (const Piece& piece : pieces_) triangles += triangles_of(*piece.shape);
    return !pieces_.empty() && pieces_.size() <= most_pieces && triangles <= most_triangles;
}

void CameraVisibility::add(const Shape& shape, const Vec3& position, const Quat& rotation) {
    if (endless(shape)) return;
    if (const auto* compound = std::get_if<CompoundShape>(&shape)) {
        for (const CompoundPart& part : *compound->parts)
            if (part.visible) add(part.shape, position + rotation * part.position, rotation * part.rotation);
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
        const double on_box = box_entry(piece.half_size, back * (from - piece.center), local_direction);
        if (!(on_box < nearest)) continue;
        nearest = std::min(nearest, tumble::first_hit(*piece.shape, back * (from - piece.origin), local_direction));
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
        places_.push_back(middle + down * rests);
    }
}

double CameraVisibility::visible_share(const Vec3& eye) const {
    if (places_.empty()) return 1.0;
    const auto seen = std::count_if(places_.begin(), places_.end(),
                                    [&](const Vec3& place) { return first_hit(eye, place - eye) > 0.999; });
    return double(seen) / double(places_.size());
}

}  // namespace tumble
