#include "scene/keys/readers.h"

#include "core/safe_text.h"
#include "scene/fields/body_fields.h"
#include "scene/keys/body_index.h"
#include "scene/keys/joints.h"
#include "scene/keys/read_fields.h"
#include "sim/geometry/shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

namespace tumble {

namespace {

constexpr double pin_thickness = 0.15;  // radius of a pin over the thinnest extent of the smaller body
constexpr double beyond = 1.5;          // length of a pin outside that body, over the radius of the pin

/// A side of a joint with a body of finite size.
struct PinSide {
    std::size_t body;
    Vec3 anchor;  // m, body frame
    Quat frame;   // of the joint, to the body frame
    Bounds bounds;

    double size() const { return bounds.extent().maxCoeff(); }
    /// The body along a direction of its frame, from the anchor.
    std::array<double, 2> span(const Vec3& direction) const {
        std::array<double, 2> span{infinity, -infinity};
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 share(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
            const Vec3 point = bounds.center() + (share - Vec3::Constant(0.5)).cwiseProduct(bounds.extent());
            const double along = direction.dot(point - anchor);
            span = {std::min(span[0], along), std::max(span[1], along)};
        }
        return span;
    }
};

std::optional<PinSide> side_of_pin(const SceneDescription& scene, const std::optional<std::size_t>& body,
                                   const Vec3& anchor, const Quat& frame) {
    if (!body) return std::nullopt;
    const Bounds bounds = local_bounds(scene.bodies[*body].shape);
    if (bounds.empty()) return std::nullopt;
    return PinSide{*body, anchor, frame, bounds};
}

class PinMaker {
public:
    PinMaker(std::size_t joint, const PinSide& holder, const PinSide& smaller)
        : joint_(joint),
          holder_(holder),
          smaller_(smaller),
          radius_(pin_thickness * smaller.bounds.extent().minCoeff()) {}

    /// Through the smaller body along an axis of the joint, and by `further` (m) more at both ends, up to the body that
    /// holds it.
    void add_through(const Vec3& axis, const std::array<double, 2>& further = {0.0, 0.0}, double thicker = 1.0) {
        const std::array<double, 2> span = smaller_.span(smaller_.frame * axis);
        const Vec3 direction = holder_.frame * axis;
        const std::array<double, 2> own = holder_.span(direction);
        const double radius = thicker * radius_;
        const double from = std::min(span[0] + further[0] - beyond * radius_, own[1]);
        const double to = std::max(span[1] + further[1] + beyond * radius_, own[0]);
        CordDescription cord;
        cord.joint = joint_;
        cord.body = holder_.body;
        cord.anchor_body = holder_.body;
        cord.anchor = holder_.anchor + from * direction;
        cord.point = holder_.anchor + to * direction;
        cord.radius = radius;
        made.push_back(cord);
    }

    std::vector<CordDescription> made;

private:
    std::size_t joint_;
    const PinSide &holder_, &smaller_;
    double radius_;
};

/// The drawing of a joint other than a distance joint: cylinders fixed in one of its bodies. A hinge has its axle, a
/// universal joint its cross, and a ball a thick pin along its first axis. A slider has a rod over the way of its
/// limits, in its first body where that is one.
std::vector<CordDescription> pins_of(const SceneDescription& scene, std::size_t index) {
    const JointDescription& joint = scene.joints[index];
    const auto first = side_of_pin(scene, joint.first, joint.anchor_first, joint.frame_first);
    const auto second = side_of_pin(scene, joint.second, joint.anchor_second, joint.frame_second);
    if (!first && !second) return {};
    const PinSide& smaller = !first || (second && second->size() <= first->size()) ? *second : *first;
    const bool slides = joint.type == JointType::slider || joint.type == JointType::cylindrical;
    PinMaker pins(index, slides ? (first ? *first : *second) : (second ? *second : *first), smaller);
    const Vec3 x = Vec3::UnitX();
    switch (joint.type) {
        case JointType::hinge:
            pins.add_through(x);
            break;
        case JointType::universal:
            pins.add_through(x);
            pins.add_through(Vec3::UnitY());
            break;
        case JointType::ball:
            pins.add_through(x, {0.0, 0.0}, 2.0);
            break;
        case JointType::slider:
        case JointType::cylindrical: {
            const JointAxis& way = joint.move[0];
            const bool limited = way.motion == JointAxis::Motion::limited && first;
            pins.add_through(x, limited ? std::array{way.lower, way.upper} : std::array{0.0, 0.0});
            break;
        }
        default:
            break;
    }
    return pins.made;
}

void read_place_of_cord(const TomlTable& table, const BodyIndex& bodies, CordDescription& cord) {
    cord.body = bodies.find(table.require("body"));
    table.require("anchor");
}

/// From the anchor of the one side to that of the other; the first end is a body.
void place_between_anchors(const JointDescription& joint, const std::vector<JointDescription>& joints,
                           CordDescription& cord) {
    cord.joint = std::size_t(&joint - joints.data());
    const bool from_second = joint.second.has_value();
    cord.body = from_second ? *joint.second : *joint.first;
    cord.point = from_second ? joint.anchor_second : joint.anchor_first;
    cord.anchor_body = from_second ? joint.first : joint.second;
    cord.anchor = from_second ? joint.anchor_first : joint.anchor_second;
}

void read_place_from_joint(const TomlTable& table, const TomlValue& value, const std::vector<JointDescription>& joints,
                           CordDescription& cord) {
    for (const char* key : {"body", "point", "anchor"})
        if (const auto given = table.find(key))
            given->origin().fail("and joint exclude each other: the joint gives the place");
    const JointDescription& joint = find_joint(value, joints);
    if (joint.type == JointType::gear) value.fail("is a gear, which has no anchors: give one of its joints");
    place_between_anchors(joint, joints, cord);
}

}  // namespace

void read_forces(const TomlTable& root, SceneDescription& scene) {
    const auto list = root.find("force");
    if (!list) return;
    const BodyIndex bodies(scene.bodies);
    for (TomlTable& table : list->tables("; write [[force]] for each")) {
        table.set_title("[[force]]");
        ForceDescription initial;
        initial.end = infinity;
        ForceDescription force = read_all_fields(table, initial);
        const TomlValue body = table.require("body");
        force.body = bodies.find(body);
        if (scene.bodies[force.body].type != BodyType::dynamic) {
            body.fail("must be a dynamic body: no force moves another");
        }
        if (force.end <= force.start) {
            table.find(table.has("end") ? "end" : "start")
                ->fail(fmt::format("makes the force end before it starts, at {} s", number_text(force.start)));
        }
        scene.forces.push_back(force);
    }
}

void add_cords_of_joints(SceneDescription& scene) {
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
        const JointDescription& joint = scene.joints[i];
        if (!joint.visible) continue;
        if (joint.type != JointType::distance) {
            const std::vector<CordDescription> pins = pins_of(scene, i);
            scene.cords.insert(scene.cords.end(), pins.begin(), pins.end());
            continue;
        }
        CordDescription cord;
        place_between_anchors(joint, scene.joints, cord);
        scene.cords.push_back(cord);
    }
}

void read_cords(const TomlTable& root, SceneDescription& scene) {
    const auto list = root.find("cord");
    if (!list) return;
    const BodyIndex bodies(scene.bodies);
    for (TomlTable& table : list->tables("; write [[cord]] for each")) {
        table.set_title("[[cord]]");
        CordDescription cord = read_all_fields<CordDescription>(table);
        if (const auto joint = table.find("joint"))
            read_place_from_joint(table, *joint, scene.joints, cord);
        else
            read_place_of_cord(table, bodies, cord);
        scene.cords.push_back(cord);
    }
}

}  // namespace tumble
