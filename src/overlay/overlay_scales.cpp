#include "overlay/overlay_scales.h"

#include "core/deterministic_math.h"
#include "overlay/overlay_style.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Parts of the visible height at the camera's target.
constexpr double common_length = 1.0 / 10.0, longest_length = 0.8;
constexpr double noise = 1e-3;         // of the largest size: smaller ones are not counted
constexpr double rounding = 1e-9;      // of the largest force times the visible height: smaller torques are zero
constexpr double least_size = 1e-100;  // SI units: smaller ones are zero but for rounding, and have no finite scale

constexpr std::array<Overlay, arrow_quantity_count> shown_by{
    Overlay::forces,   Overlay::impulses,         Overlay::velocity, Overlay::omega,
    Overlay::momentum, Overlay::angular_momentum, Overlay::joints};

double visible_height(const CameraDescription& camera) {
    const SinCos half = sincos(0.5 * camera.vertical_fov * pi / 180.0);
    return 2.0 * (camera.target - camera.eye).norm() * half.sin / half.cos;
}

/// The largest of 1, 2 and 5 times a power of ten that is not above the value.
double rounded_down(double value) {
    double power = 1.0;
    while (power > value) power /= 10.0;
    while (10.0 * power <= value) power *= 10.0;
    for (const double step : {5.0, 2.0})
        if (value >= step * power) return step * power;
    return power;
}

// Eight bins in each factor of two, without logarithms: glibc's logarithms depend on the processor.
int bin_of(double size) {
    int exponent = 0;
    const double mantissa = std::frexp(size, &exponent);
    return 8 * exponent + int(16.0 * (mantissa - 0.5));
}

double upper_end(int bin) {
    const int part = ((bin % 8) + 8) % 8;
    return std::ldexp(0.5 + (part + 1) / 16.0, (bin - part) / 8);
}

bool holds_shown(const JointDescription& joint, const std::vector<char>& shown) {
    return joint.type != JointType::gear &&
           ((joint.first && shown[*joint.first] != 0) || (joint.second && shown[*joint.second] != 0));
}

}  // namespace

void OverlayMarks::add(const OverlayMarks& others) {
    states |= others.states;
    features |= others.features;
    friction = friction || others.friction;
}

bool shows_friction(const Vec3& normal, const Vec3& tangential) {
    return tangential.norm() > style::least_friction * normal.norm();
}

bool shows(const OverlayDescription& overlay, ArrowQuantity quantity) {
    return overlay.show.has(shown_by[std::size_t(quantity)]) ||
           (quantity == ArrowQuantity::force &&
            (overlay.show.has(Overlay::loads) || overlay.show.has(Overlay::joints)));
}

bool draws_shapes(const OverlayDescription& overlay) {
    OverlaySet shapes = overlay.show;
    for (const Overlay text : {Overlay::title, Overlay::clock, Overlay::mode}) shapes.remove(text);
    return !shapes.empty() || !overlay.labels.empty();
}

// The marks of contacts are found in the same run.
bool needs_survey(const OverlayDescription& overlay) {
    if (overlay.legend && (overlay.show.has(Overlay::contacts) || overlay.show.has(Overlay::forces))) return true;
    for (std::size_t q = 0; q < arrow_quantity_count; ++q)
        if (shows(overlay, ArrowQuantity(q)) && !overlay.scale[q]) return true;
    return false;
}

bool needs_records(const OverlayDescription& overlay) {
    return std::ranges::any_of(std::array{Overlay::contacts, Overlay::normals, Overlay::impulses, Overlay::forces,
                                          Overlay::islands, Overlay::joints},
                               [&](Overlay one) { return overlay.show.has(one); });
}

std::vector<char> shown_bodies(const SceneDescription& scene) {
    std::vector<char> shown(scene.bodies.size(), 0);
    for (const std::size_t chosen : scene.overlay.bodies) shown[chosen] = 1;
    if (!scene.overlay.bodies.empty()) return shown;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const BodyDescription& body = scene.bodies[i];
        const bool moves = body.type == BodyType::dynamic || !body.keyframes.empty();
        if (moves && body.appearance.visible) shown[i] = 1;
    }
    return shown;
}

RecordVector vector_of(const ContactRecord& r, const SceneDescription& scene) {
    const bool on_b = r.a == ContactRecord::nobody || scene.bodies[r.b].type == BodyType::dynamic;
    const double sign = on_b ? 1.0 : -1.0;
    return {on_b ? r.b : r.a, sign * r.normal_force * r.normal, sign * r.tangential_force};
}

RecordVector vector_of(const ImpactRecord& r, const SceneDescription& scene) {
    const bool on_b = scene.bodies[r.b].type == BodyType::dynamic;
    const double sign = on_b ? 1.0 : -1.0;
    return {on_b ? r.b : r.a, sign * r.impulse * r.normal, sign * r.friction};
}

ScaleSurvey::ScaleSurvey(const SceneDescription& scene) : scene_(&scene), shown_(shown_bodies(scene)) {}

void ScaleSurvey::add(ArrowQuantity quantity, double size) {
    if (!(size >= least_size)) return;
    Sizes& sizes = sizes_[std::size_t(quantity)];
    sizes.most = std::max(sizes.most, size);
    ++sizes.counts[bin_of(size)];
}

void ScaleSurvey::add(const Snapshot& snapshot, const ContactRecords* records) {
    const OverlayDescription& overlay = scene_->overlay;
    if (snapshot.time < overlay.start || snapshot.time >= overlay.end) return;
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
        if (shown_[i] == 0 || snapshot.bodies[i].absent) continue;
        const BodyState& body = snapshot.bodies[i];
        add(ArrowQuantity::velocity, body.velocity.norm());
        add(ArrowQuantity::omega, body.angular_velocity.norm());
        add(ArrowQuantity::momentum, body.momentum.norm());
        add(ArrowQuantity::angular_momentum, body.angular_momentum.norm());
    }
    if (overlay.show.has(Overlay::loads)) {
        for (std::size_t i = 0; i < snapshot.bodies.size(); ++i)
            if (shown_[i] != 0 && !snapshot.bodies[i].absent)
                add(ArrowQuantity::force, snapshot.bodies[i].mass * std::abs(scene_->bodies[i].gravity_scale) *
                                              scene_->simulation.gravity.norm());
        for (const ForceDescription& force : scene_->forces)
            if (shown_[force.body] != 0) add(ArrowQuantity::force, force.force.norm());
    }
    if (records == nullptr) return;
    for (const ContactRecord& r : records->contacts) {
        if (r.a == ContactRecord::nobody) continue;  // a correction of the method
        if (shown_[r.a] == 0 && shown_[r.b] == 0) continue;
        const RecordVector v = vector_of(r, *scene_);
        if (overlay.show.has(Overlay::forces)) add(ArrowQuantity::force, v.total().norm());
        marks_.states |= 1u << unsigned(r.state);
        marks_.features |= 1u << unsigned(r.features);
        marks_.friction = marks_.friction || shows_friction(v.normal, v.tangential);
    }
    if (overlay.show.has(Overlay::joints))
        for (std::size_t k = 0; k < records->joints.size(); ++k) {
            if (!records->joints[k].active || !holds_shown(scene_->joints[k], shown_)) continue;
            add(ArrowQuantity::force, records->joints[k].mean_force.norm());
            add(ArrowQuantity::torque, records->joints[k].mean_torque.norm());
        }
    for (const ImpactRecord& r : records->impacts)
        if (const RecordVector v = vector_of(r, *scene_); shown_[v.body] != 0)
            add(ArrowQuantity::impulse, v.total().norm());
}

void ScaleSurvey::add(const ScaleSurvey& other) {
    for (std::size_t q = 0; q < arrow_quantity_count; ++q) {
        sizes_[q].most = std::max(sizes_[q].most, other.sizes_[q].most);
        for (const auto& [bin, count] : other.sizes_[q].counts) sizes_[q].counts[bin] += count;
    }
    marks_.add(other.marks_);
}

OverlayScales ScaleSurvey::scales(const CameraDescription& camera) const {
    OverlayScales scales{};
    const double height = visible_height(camera);
    for (std::size_t q = 0; q < arrow_quantity_count; ++q) {
        if (scene_->overlay.scale[q]) {
            scales[q] = *scene_->overlay.scale[q];
            continue;
        }
        const Sizes& sizes = sizes_[q];
        if (sizes.most <= 0.0) continue;
        // Joints without a torque: rounding of their forces.
        if (ArrowQuantity(q) == ArrowQuantity::torque &&
            sizes.most < rounding * height * sizes_[std::size_t(ArrowQuantity::force)].most)
            continue;
        const int least = bin_of(noise * sizes.most);
        std::int64_t all = 0, smaller = 0;
        for (const auto& [bin, count] : sizes.counts)
            if (bin >= least) all += count;
        double common = sizes.most;
        for (const auto& [bin, count] : sizes.counts) {
            if (bin < least) continue;
            smaller += count;
            if (2 * smaller < all) continue;
            common = upper_end(bin);
            break;
        }
        scales[q] = rounded_down(height * std::min(common_length / common, longest_length / sizes.most));
    }
    return scales;
}

}  // namespace tumble
