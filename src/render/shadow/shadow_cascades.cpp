#include "render/shadow/shadow_cascades.h"

#include "render/gl/glm_conversion.h"
#include "render/scene/distance_outliers.h"
#include "render/scene/large_receivers.h"
#include "render/scene/plane_patch.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Bodies roll a little beyond the region of their initial and landing places.
constexpr double near_margin = 1.3;

// A shadow's edge is about three texels wide. Around few bodies the map could be so fine that edges look unnaturally
// sharp, so a texel has at least this part of the bodies' typical AO radius (their half edge).
constexpr double least_texel_of_ao_radius = 0.02;

// and no more than this, pixels: the steps of wider texels are visible along a shadow's edge and where a lit face
// meets its receiver.
constexpr double softest_pixels = 1.0;

// In small frames a texel may be much smaller than a pixel. Texels below the first part of a pixel (at the bodies'
// median distance) are filtered by the pixel's width. Texels are never made smaller than the second part: a pixel seen
// at a low angle would contain more texels than its filter can read.
constexpr double filtered_by_pixel = 0.9, finest_pixels = 0.2;

// If the bodies are so far apart that one map around all has texels wider than the first value (pixels, at the nearest
// eighth of them), their shadows would be lost. Then the near map holds only the nearest bodies, as many as keep texels
// below the second value.
constexpr double lost_pixels = 8.0, fine_pixels = 3.0;

// A ball wider than this part of the near map that extends beyond it has sharp shadows inside and coarse ones outside.
// A smaller one uses the far map as a whole, so that bodies that leave need no other shader.
constexpr double least_span = 0.5;

// Largest ratio of the far map to the near one, so that lost bodies do not blur the other shadows.
constexpr double most_growth = 64.0;

// Smallest ratio of the near map to the extent of all bodies, so that these are within the far map for any place of the
// near one.
constexpr double least_of_all = 2.2 / most_growth;

struct CascadeExtent {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
    void add(double at, double radius) {
        low = std::min(low, at - radius);
        high = std::max(high, at + radius);
    }
    bool empty() const { return low > high; }
    double size() const { return high - low; }
};

/// Place of a body at the start, or after landing.
struct CascadePlace {
    Vec3 center;
    double radius, distance;  // m; of its ball; from the eye
};

struct Held {
    std::size_t count;
    double size_of_all;  // m, across the light
};

/// Number of the places, sorted by distance, that the near map is fitted to.
Held places_to_hold(const std::vector<CascadePlace>& places, const Vec3& x_axis, const Vec3& y_axis, double pixel_size,
                    int texels) {
    CascadeExtent x, y;
    std::size_t fine = 0, finest = 0;
    double blur = 0.0, least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < places.size(); ++i) {
        x.add(x_axis.dot(places[i].center), places[i].radius);
        y.add(y_axis.dot(places[i].center), places[i].radius);
        blur = near_margin * std::max(x.size(), y.size()) / texels / (pixel_size * places[i / 8].distance);  // pixels
        if (blur <= fine_pixels) fine = i + 1;
        if (blur < least) least = blur, finest = i + 1;
    }
    const double size = places.empty() ? 0.0 : std::max(x.size(), y.size());
    if (blur <= lost_pixels) return {places.size(), size};
    return {fine > 0 ? fine : finest, size};
}

double power_of_two_at_least(double value) { return std::exp2(std::ceil(std::log2(value))); }

}  // namespace

double ShadowCascades::far_along() const {
    return filter.by_pixel ? 0.5 * std::max(least_pixel_step, most_pixel_step * near_texel / far_texel) + 1.0
                           : filter.along;
}

bool ShadowCascades::near_holds(const Vec3& center, double radius) const {
    // the filter's margin, and the normal offset
    const double room = 0.5 - radius / (near_texel * texels) - 2.0 * filter.extent / texels;
    for (const glm::vec4& row : {x, y})
        if (std::abs(row.x * center.x() + row.y * center.y() + row.z * center.z() + double(row.w) - 0.5) > room)
            return false;
    return true;
}

bool ShadowCascades::spans_maps(const Vec3& center, double radius) const {
    return 2.0 * radius > least_span * near_texel * texels && !near_holds(center, radius);
}

CascadeFitter::CascadeFitter(const SceneDescription& description, const RenderScene& scene, const Camera& view,
                             int texels)
    : texels_(texels) {
    z_axis_ = description.light.direction.normalized();
    const Vec3 across = std::abs(z_axis_.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitZ();
    x_axis_ = (across - z_axis_ * z_axis_.dot(across)).normalized();
    y_axis_ = z_axis_.cross(x_axis_);

    const double gravity = description.simulation.gravity.norm();
    const Vec3 down = gravity > 0.0 ? Vec3(description.simulation.gravity / gravity) : Vec3::Zero();
    const RestHeightEstimate landing(description, scene);
    std::vector<PlaneShape> planes;
    for (const std::size_t i : scene.planes) {
        BodyState start;
        start.origin = description.bodies[i].position;
        start.orientation = description.bodies[i].rotation;
        planes.push_back(plane_in_world(scene.bodies[i], start));
    }
    std::vector<CascadePlace> places;
    // bodies outside the view may become visible
    const bool camera_turns = !description.camera.keyframes.empty() || description.camera.orbit != 0.0;
    const auto add = [&](const RenderBody& proxy, const Vec3& origin, const Quat& rotation, bool falls) {
        const Vec3 center = origin + rotation * proxy.bound_center;
        if (hidden_behind(planes, view.eye(), proxy, center, rotation)) return;
        const Vec3 landed = center + down * (falls ? landing.fall(center, down) : 0.0);
        for (const Vec3& p : {center, landed})
            if (camera_turns || view.sees_swept(view.relative(p), proxy.bound_radius, z_axis_))
                places.push_back({p, proxy.bound_radius, view.relative(p).norm()});
    };
    // A large receiver does not widen the map: its caster is at the same place of the map as the shadow.
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const RenderBody& proxy = scene.bodies[i];
        if (!proxy.solid() || proxy.large_receiver) continue;
        const BodyDescription& body = description.bodies[i];
        add(proxy, body.position, body.rotation, body.type == BodyType::dynamic);
        for (const Keyframe& key : body.keyframes) add(proxy, key.position, key.rotation, false);
    }

    std::vector<double> distances;
    for (const CascadePlace& p : places) distances.push_back(p.distance);
    const double limit = far_limit(distances);
    std::erase_if(places, [&](const CascadePlace& p) { return p.distance + p.radius > limit; });
    double least = 0.0;  // of the near map: bodies outside it must be within the far one
    if (!camera_turns) {
        std::stable_sort(places.begin(), places.end(),
                         [](const CascadePlace& a, const CascadePlace& b) { return a.distance < b.distance; });
        const Held held = places_to_hold(places, x_axis_, y_axis_, view.pixel_size(), texels);
        places.resize(held.count);
        least = least_of_all * held.size_of_all;
    }
    CascadeExtent x, y, z;
    distances.clear();
    for (const CascadePlace& p : places) {
        x.add(x_axis_.dot(p.center), p.radius);
        y.add(y_axis_.dot(p.center), p.radius);
        z.add(z_axis_.dot(p.center), p.radius);
        distances.push_back(p.distance);
    }
    if (x.empty()) {  // without visible bodies: the camera's target
        const Vec3 target = view.eye() + view.forward() * view.target_distance();
        x.add(x_axis_.dot(target), 0.5 * view.target_distance());
        y.add(y_axis_.dot(target), 0.5 * view.target_distance());
        z.add(z_axis_.dot(target), 0.5 * view.target_distance());
    }
    const double pixel = view.pixel_size() * (distances.empty() ? view.target_distance() : lower_median(distances));
    const double softest =
        texels * std::min(least_texel_of_ao_radius * scene.typical_ao_radius, softest_pixels * pixel);
    size_ = std::max({near_margin * std::max(x.size(), y.size()), softest, least, finest_pixels * pixel * texels});
    // The map has only a part of the texels of a translucent caster (shaders/shadow.frag).
    const bool sieved = std::ranges::any_of(scene.bodies, &RenderBody::translucent) ||
                        std::ranges::any_of(scene.meshes, [](const RenderMesh& mesh) {
                            return mesh.paint != nullptr && mesh.paint->translucent();
                        });
    if (sieved)
        size_ = std::max(size_, filtered_by_pixel * pixel * texels);
    else if (size_ < filtered_by_pixel * pixel * texels)
        filter_ = pixel_filter;
    low_x_ = 0.5 * (x.low + x.high) - 0.5 * size_;
    low_y_ = 0.5 * (y.low + y.high) - 0.5 * size_;
    middle_z_ = 0.5 * (z.low + z.high);
}

ShadowCascades CascadeFitter::fit(const RenderScene& scene, const Snapshot& snapshot, const Camera& view,
                                  const Vec3& carried) const {
    const double texel = size_ / texels_;
    const double low_x = low_x_ + texel * std::round(x_axis_.dot(carried) / texel);
    const double low_y = low_y_ + texel * std::round(y_axis_.dot(carried) / texel);
    std::vector<PlaneShape> planes;
    for (const std::size_t i : scene.planes) planes.push_back(plane_in_world(scene.bodies[i], snapshot.bodies[i]));
    CascadeExtent x, y,
        z;  // bounds of the casters of visible shadows; x and y in widths of the near map, from its corner
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const RenderBody& proxy = scene.bodies[i];
        if (!proxy.solid() || snapshot.bodies[i].absent) continue;
        const BoundingBall ball = bounding_ball(proxy, snapshot.bodies[i], view);
        if (!view.sees_swept(ball.center, ball.radius, z_axis_)) continue;
        const Vec3 center = view.eye() + ball.center;
        if (hidden_behind(planes, view.eye(), proxy, center, snapshot.bodies[i].orientation)) continue;
        // beyond the largest far map: it casts no shadow, and would coarsen the others' texels and depths
        const double beyond = std::max(std::abs(x_axis_.dot(center) - low_x - 0.5 * size_),
                                       std::abs(y_axis_.dot(center) - low_y - 0.5 * size_)) -
                              ball.radius;
        if (beyond > 0.5 * most_growth * size_) continue;
        x.add((x_axis_.dot(center) - low_x) / size_, ball.radius / size_);
        y.add((y_axis_.dot(center) - low_y) / size_, ball.radius / size_);
        z.add(z_axis_.dot(center), ball.radius);
    }
    if (x.empty()) x.add(0.5, 0.5), y.add(0.5, 0.5), z.add(0.0, size_);

    ShadowCascades fit;
    fit.texels = texels_;
    fit.filter = filter_;
    fit.near_texel = size_ / texels_;
    const auto row = [&](const Vec3& axis, double low, double size) {
        return to_glm(axis / size, (axis.dot(view.eye()) - low) / size);
    };
    fit.x = row(x_axis_, low_x, size_);
    fit.y = row(y_axis_, low_y, size_);

    // Bodies far above or below would leave the others few steps of depth: they are drawn at the ends of the range.
    const double middle_z = middle_z_ + z_axis_.dot(carried), reach = most_growth * size_;
    z.low = std::clamp(z.low, middle_z - reach, middle_z + reach);
    z.high = std::clamp(z.high, middle_z - reach, middle_z + reach);
    if (!(z.high > z.low)) z.high = z.low + size_;

    // The depth range is a multiple of a power of two, so that a moving body does not round the others' depths
    // differently.
    const double depth_step = power_of_two_at_least(z.size());
    const double low_z = depth_step * std::floor(z.low / depth_step);
    fit.z = row(z_axis_, low_z, depth_step * (std::floor(z.high / depth_step) + 1.0) - low_z);

    const double farthest =
        std::max({0.5 - x.low, x.high - 0.5, 0.5 - y.low, y.high - 0.5});  // from the near map's center
    fit.has_far = farthest > 0.5 - 8.0 / texels_;                          // the filter's margin
    const double growth =
        fit.has_far ? std::min(most_growth, power_of_two_at_least(std::max(2.0, 2.1 * farthest))) : 1.0;
    fit.far =
        glm::vec4(float(1.0 / growth), float(0.5 - 0.5 / growth), float(0.5 - 0.5 / growth), fit.has_far ? 1.0f : 0.0f);
    fit.far_texel = growth * fit.near_texel;
    return fit;
}

}  // namespace tumble
