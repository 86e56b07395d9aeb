#include "overlay/overlay_builder.h"

#include "core/disjoint_sets.h"
#include "sim/geometry/shapes/shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace tumble {
namespace {

constexpr double shortest_way = 2e-3;  // radii of the body: a trail gets a point when the body has moved that far

Color mixed(Color a, Color b, double share) {
    const auto channel = [&](std::uint8_t x, std::uint8_t y) {
        return std::uint8_t(x + share * (double(y) - x) + 0.5);
    };
    return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}

Color trail_color(const SceneDescription& scene, std::size_t body) {
    return mixed(scene.bodies[body].appearance.color, {255, 255, 255}, style::trail_paleness);
}

/// The tight axis-aligned bounding box in the world.
void add_bounds(const Shape& shape, const Vec3& origin, const Quat& orientation, Bounds& bounds) {
    const Mat3 rotation = orientation.toRotationMatrix();
    visit_extent(shape, [&](const Vec3& center, double radius) {
        const Vec3 place = origin + rotation * center;
        bounds.add(Vec3(place.array() - radius));
        bounds.add(Vec3(place.array() + radius));
    });
}

/// At most style::longest_name characters (UTF-8).
std::string shortened(const std::string& name) {
    std::size_t characters = 0;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool starts_character = (static_cast<unsigned char>(name[i]) & 0xc0u) != 0x80u;
        if (starts_character && ++characters > style::longest_name) return name.substr(0, i) + "…";
    }
    return name;
}

bool near(const BodyState& a, const BodyState& b, double radius) {
    return (a.origin - b.origin).norm() < style::rested * radius &&
           a.orientation.angularDistance(b.orientation) < style::rested;
}

}  // namespace

double radius_about_origin(const Shape& shape) {
    if (endless(shape)) return 0.0;
    const BoundingSphere sphere = bounding_sphere(shape);
    return sphere.center.norm() + sphere.radius;
}

Color arrow_color(const OverlayDescription& overlay, ArrowQuantity quantity) {
    return overlay.color[std::size_t(quantity)].value_or(style::arrows[std::size_t(quantity)].color);
}

Color contact_color(ContactRecord::State state) { return style::contact_states[std::size_t(state)].color; }

MarkerShape contact_shape(ContactFeatures features) {
    const auto& marker = style::contact_features[std::size_t(features)].marker;
    return MarkerShape(std::ranges::find(style::markers, marker) - std::ranges::begin(style::markers));
}

OverlayBuilder::OverlayBuilder(const SceneDescription& scene, const OverlayScales& scales)
    : scene_(&scene), scales_(scales), shown_(shown_bodies(scene)), labels_(scene) {
    for (const BodyDescription& body : scene.bodies) radii_.push_back(radius_about_origin(body.shape));
    if (shows(Overlay::joints)) joints_ = sketch_joints(scene);
    if (shows(Overlay::cracks)) cracks_ = sketch_cracks(scene);
    if (!shows(Overlay::trails)) return;
    for (const TrailPoint& point : scene.overlay.trail_points)
        trails_.push_back({point.body, point.point, false, point.color.value_or(trail_color(scene, point.body)), {}});
    if (trails_.empty())
        for (std::size_t i = 0; i < scene.bodies.size(); ++i)
            if (shown_[i] != 0) trails_.push_back({i, Vec3::Zero(), true, trail_color(scene, i), {}});
}

bool OverlayBuilder::shows(std::size_t body, const Snapshot& snapshot) const {
    return shown_[body] != 0 && !snapshot.bodies[body].absent;
}

const OverlayFrame& OverlayBuilder::next(const Snapshot& snapshot, const ContactRecords* records) {
    const OverlayDescription& overlay = scene_->overlay;
    frame_.clear();
    const std::int64_t frame = frames_++;
    labels_.add(snapshot, frame_.callouts);
    if (snapshot.time < overlay.start || snapshot.time >= overlay.end) return frame_;
    remember(snapshot, records);
    if (shows(Overlay::ghosts)) add_ghosts(snapshot, frame);
    if (shows(Overlay::islands) && records != nullptr) add_islands(snapshot, *records);
    add_trails();
    add_cracks(snapshot);
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i)
        if (shows(i, snapshot)) add_body(i, snapshot.bodies[i]);
    if (records != nullptr) add_contacts(*records);
    if (shows(Overlay::joints) && records != nullptr) add_joints(snapshot, *records);
    if (shows(Overlay::loads)) add_loads(snapshot);
    if (shows(Overlay::impulses)) add_impulses(snapshot.time);
    if (shows(Overlay::damage)) frame_.damage = snapshot.frame;
    frame_.legend = overlay.legend;
    return frame_;
}

void OverlayBuilder::remember(const Snapshot& snapshot, const ContactRecords* records) {
    const OverlayDescription& overlay = scene_->overlay;
    for (Trail& trail : trails_) {
        const BodyState& body = snapshot.bodies[trail.body];
        if (body.absent) continue;
        const Vec3 place = trail.center ? body.center_of_mass : Vec3(body.origin + body.orientation * trail.point);
        while (!trail.places.empty() && trail.places.front().first < snapshot.time - overlay.trail_time)
            trail.places.pop_front();
        const double step = shortest_way * radii_[trail.body];
        if (trail.places.empty() || (place - trail.places.back().second).norm() > step)
            trail.places.emplace_back(snapshot.time, place);
    }
    if (records == nullptr || !shows(Overlay::impulses)) return;
    while (!impacts_.empty() && impacts_.front().when.time < snapshot.time - overlay.impulse_time) impacts_.pop_front();
    for (const ImpactRecord& impact : records->impacts)
        if (const RecordVector v = vector_of(impact, *scene_); shown_[v.body] != 0 && v.total() != Vec3::Zero())
            impacts_.push_back(impact);
}

void OverlayBuilder::add_ghosts(const Snapshot& snapshot, std::int64_t frame) {
    if (frame % scene_->overlay.ghost_every == 0)
        for (std::size_t i = 0; i < snapshot.bodies.size() && ghosts_.size() < style::most_ghosts; ++i) {
            if (!shows(i, snapshot) || radii_[i] == 0.0) continue;
            const BodyState& now = snapshot.bodies[i];
            const auto last =
                std::find_if(ghosts_.rbegin(), ghosts_.rend(), [&](const Ghost& g) { return g.body == i; });
            const bool same = last != ghosts_.rend() && near(last->state, now, radii_[i]);
            if (!same) ghosts_.push_back({i, now});
        }
    for (const Ghost& ghost : ghosts_) {
        const BodyState& now = snapshot.bodies[ghost.body];
        if (near(ghost.state, now, radii_[ghost.body])) continue;  // the body itself stands there
        frame_.surfaces.push_back({ghost.body,
                                   ghost.state.origin,
                                   ghost.state.orientation,
                                   {scene_->bodies[ghost.body].appearance.color, style::ghost_opacity, true},
                                   true});
    }
}

void OverlayBuilder::add_islands(const Snapshot& snapshot, const ContactRecords& records) {
    DisjointSets islands(snapshot.bodies.size());
    const auto dynamic = [&](std::size_t i) { return scene_->bodies[i].type == BodyType::dynamic; };
    for (const ContactRecord& r : records.contacts)
        if (r.a != ContactRecord::nobody && dynamic(r.a) && dynamic(r.b)) islands.join(r.a, r.b);
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i)
        if (shows(i, snapshot) && dynamic(i))
            frame_.surfaces.push_back(
                {i,
                 snapshot.bodies[i].origin,
                 snapshot.bodies[i].orientation,
                 {style::island_colors[islands.root(i) % std::size(style::island_colors)], style::tint_opacity, true},
                 false});
}

void OverlayBuilder::add_trails() {
    for (const Trail& trail : trails_) {
        if (trail.places.size() < 2) continue;
        OverlayLine line;
        for (const auto& [when, place] : trail.places) line.points.push_back(place);
        line.paint = {trail.color, style::trail_opacity, true};
        line.width = style::trail_width;
        frame_.lines.push_back(std::move(line));
    }
}

// A bond is open where its cells have moved apart; the edges of its face then are those of both pieces.
void OverlayBuilder::add_cracks(const Snapshot& snapshot) {
    for (const CrackSketch& crack : cracks_) {
        const auto add = [&](std::size_t body, Color color) {
            const BodyState& state = snapshot.bodies[body];
            OverlayLine line;
            for (const Vec3& p : crack.outline) line.points.push_back(state.origin + state.orientation * p);
            line.paint = {color, style::crack_opacity, true, float(style::crack_allowance * radii_[crack.whole])};
            line.width = style::crack_width;
            frame_.lines.push_back(std::move(line));
        };
        if (!snapshot.bodies[crack.whole].absent) {
            add(crack.whole, style::crack_color);
            continue;
        }
        const BodyState &a = snapshot.bodies[crack.a], &b = snapshot.bodies[crack.b];
        const double apart = style::crack_open * radii_[crack.whole];
        const bool open = std::ranges::any_of(crack.outline, [&](const Vec3& p) {
            return (a.origin + a.orientation * p - b.origin - b.orientation * p).norm() > apart;
        });
        for (const std::size_t piece : {crack.a, crack.b})
            if (!snapshot.bodies[piece].absent && (open || piece == crack.a))
                add(piece, open ? style::open_crack_color : style::crack_color);
    }
}

void OverlayBuilder::add_body(std::size_t i, const BodyState& state) {
    if (shows(Overlay::sleep) && state.asleep)
        frame_.surfaces.push_back(
            {i, state.origin, state.orientation, {style::asleep_color, style::sleep_opacity, true}, false});
    if (shows(Overlay::aabb)) add_box(i, state);
    if (shows(Overlay::axes)) add_axes(i, state);
    const Vec3& center = state.center_of_mass;
    if (shows(Overlay::velocity)) body_arrow(ArrowQuantity::velocity, i, state, state.velocity);
    if (shows(Overlay::omega)) body_arrow(ArrowQuantity::omega, i, state, state.angular_velocity);
    if (shows(Overlay::momentum)) body_arrow(ArrowQuantity::momentum, i, state, state.momentum);
    if (shows(Overlay::angular_momentum)) body_arrow(ArrowQuantity::angular_momentum, i, state, state.angular_momentum);
    if (shows(Overlay::com) && radii_[i] > 0.0)
        frame_.markers.push_back(
            {center, {style::center_color, 1.0f, false}, MarkerShape::center_of_mass, style::center_radius});
    if (shows(Overlay::names))
        frame_.labels.push_back({center, {style::center_color, 1.0f, false}, shortened(scene_->bodies[i].name), 15.0f});
}

void OverlayBuilder::add_box(std::size_t body, const BodyState& state) {
    Bounds bounds;
    add_bounds(scene_->bodies[body].shape, state.origin, state.orientation, bounds);
    if (bounds.empty()) return;
    const auto corner = [&](unsigned bits) {
        return Vec3((bits & 1) != 0 ? bounds.max.x() : bounds.min.x(),
                    (bits & 2) != 0 ? bounds.max.y() : bounds.min.y(),
                    (bits & 4) != 0 ? bounds.max.z() : bounds.min.z());
    };
    // One line through all twelve edges; three are passed twice.
    OverlayLine line;
    for (const unsigned bits : {0u, 1u, 3u, 2u, 0u, 4u, 5u, 1u, 5u, 7u, 3u, 7u, 6u, 2u, 6u, 4u})
        line.points.push_back(corner(bits));
    line.paint = {style::box_color, style::box_opacity, true};
    line.width = style::box_width;
    frame_.lines.push_back(std::move(line));
}

void OverlayBuilder::add_axes(std::size_t body, const BodyState& state) {
    const Mat3 rotation = state.orientation.toRotationMatrix();
    const double length = style::axis_length * radii_[body];
    for (int k = 0; k < 3; ++k)
        frame_.arrows.push_back({state.center_of_mass,
                                 state.center_of_mass + length * rotation.col(k),
                                 {style::axis_colors[k], 1.0f, true, float(2.0 * radii_[body])},
                                 style::axis_width,
                                 false});
}

void OverlayBuilder::add_contacts(const ContactRecords& records) {
    for (const ContactRecord& r : records.contacts) {
        if (r.a == ContactRecord::nobody) continue;  // a correction of the method, not a contact
        const RecordVector v = vector_of(r, *scene_);
        if (shown_[r.b] == 0 && shown_[r.a] == 0) continue;
        if (shows(Overlay::forces)) {
            arrow(ArrowQuantity::force, r.point, v.total());
            if (shows_friction(v.normal, v.tangential)) {
                frame_.arrows.push_back({r.point,
                                         r.point + scales_[std::size_t(ArrowQuantity::force)] * v.tangential,
                                         {style::friction_color, 1.0f, true},
                                         style::friction_width,
                                         false});
            }
        }
        if (shows(Overlay::normals)) {
            const double length = style::normal_length * std::max(radii_[r.a], radii_[r.b]);
            frame_.arrows.push_back(
                {r.point, r.point + length * r.normal, {style::normal_color, 1.0f, true}, style::normal_width, false});
        }
        if (shows(Overlay::contacts))
            frame_.markers.push_back(
                {r.point, {contact_color(r.state), 1.0f, true}, contact_shape(r.features), style::contact_radius});
    }
}

void OverlayBuilder::add_loads(const Snapshot& snapshot) {
    const double scale = scales_[std::size_t(ArrowQuantity::force)];
    const auto add = [&](std::size_t body, const Vec3& from, const Vec3& force) {
        if (shown_[body] == 0 || force == Vec3::Zero()) return;
        frame_.arrows.push_back({from,
                                 from + scale * force,
                                 {style::load_color, 1.0f, true, float(2.0 * radii_[body])},
                                 style::arrow_width,
                                 false});
    };
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i)
        add(i, snapshot.bodies[i].center_of_mass,
            snapshot.bodies[i].mass * scene_->bodies[i].gravity_scale * scene_->simulation.gravity);
    for (const ForceDescription& force : scene_->forces) {
        if (snapshot.time < force.start || snapshot.time >= force.end) continue;
        const BodyState& body = snapshot.bodies[force.body];
        add(force.body, body.origin + body.orientation * force.point,
            force.body_frame ? Vec3(body.orientation * force.force) : force.force);
    }
}

// An impulse fades over the time that it is visible.
void OverlayBuilder::add_impulses(double time) {
    const double visible = scene_->overlay.impulse_time;
    for (const ImpactRecord& impact : impacts_) {
        const double age = visible > 0.0 ? (time - impact.when.time) / visible : 0.0;
        arrow(ArrowQuantity::impulse, impact.point, vector_of(impact, *scene_).total(),
              float(1.0 - style::impulse_fade * std::clamp(age, 0.0, 1.0)));
    }
}

void OverlayBuilder::add_joints(const Snapshot& snapshot, const ContactRecords& records) {
    for (const JointSketch& sketch : joints_) {
        const JointState& state = records.joints[sketch.joint];
        if (!state.active) continue;
        const auto paint = [&](Color color) { return OverlayPaint{color, 1.0f, true, sketch.allowance}; };
        for (const SketchLine& drawn : sketch.lines) {
            OverlayLine line;
            for (const SketchPoint& point : drawn.points) line.points.push_back(point.in_world(snapshot));
            line.paint = paint(!drawn.limit       ? style::joint_color
                               : state.limit != 0 ? style::at_limit_color
                                                  : style::limit_color);
            line.width = drawn.limit ? style::limit_width : style::joint_width;
            frame_.lines.push_back(std::move(line));
        }
        const Vec3 anchor = sketch.anchor.in_world(snapshot);
        frame_.markers.push_back({anchor, paint(style::joint_color), sketch.marker, style::anchor_radius});
        const std::size_t before = frame_.arrows.size();
        arrow(ArrowQuantity::force, anchor, state.mean_force);
        arrow(ArrowQuantity::torque, anchor, state.mean_torque);
        for (std::size_t k = before; k < frame_.arrows.size(); ++k) frame_.arrows[k].paint.allowance = sketch.allowance;
    }
}

// It starts inside of its own body, which must not hide it.
void OverlayBuilder::body_arrow(ArrowQuantity quantity, std::size_t body, const BodyState& state, const Vec3& value) {
    const std::size_t before = frame_.arrows.size();
    arrow(quantity, state.center_of_mass, value);
    if (frame_.arrows.size() > before) frame_.arrows.back().paint.allowance = float(2.0 * radii_[body]);
}

void OverlayBuilder::arrow(ArrowQuantity quantity, const Vec3& from, const Vec3& value, float opacity) {
    const Vec3 way = scales_[std::size_t(quantity)] * value;
    if (way == Vec3::Zero()) return;
    frame_.arrows.push_back({from,
                             from + way,
                             {arrow_color(scene_->overlay, quantity), opacity, true},
                             style::arrow_width,
                             style::arrows[std::size_t(quantity)].axial});
}

}  // namespace tumble
