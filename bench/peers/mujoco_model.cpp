#include "peers/mujoco_model.h"

#include <algorithm>
#include <numbers>
#include <sstream>

namespace tumble::bench {
namespace {

std::string text(const Vector& v) {
    std::ostringstream out;
    out.precision(17);
    out << v.x << ' ' << v.y << ' ' << v.z;
    return out.str();
}

// (-stiffness, -damping) of a contact, per unit of effective mass. The period is 12 steps (a stiffer spring gains
// energy); e = exp(-zeta pi / sqrt(1 - zeta^2)).
std::string solref(const Scene& scene, double h, bool stiff) {
    double e = 0.0;
    for (const Body& body : scene.bodies)
        if (body.moves()) e = std::max(e, body.restitution);
    if (e == 0.0) return std::to_string(stiff ? 2.0 * h : std::max(0.02, 2.0 * h)) + " 1";
    const double omega = 2.0 * std::numbers::pi / (12.0 * h), decrement = -std::log(e);
    const double zeta = decrement / std::sqrt(std::numbers::pi * std::numbers::pi + decrement * decrement);
    std::ostringstream out;
    out.precision(17);
    out << -omega * omega << ' ' << -2.0 * zeta * omega;
    return out.str();
}

std::string solimp(const Scene& scene, bool stiff) {
    for (const Body& body : scene.bodies)
        if (body.moves() && body.restitution > 0.0) return " solimp='0.9999 0.9999 0.001'";
    return stiff ? " solimp='0.99 0.999 0.001'" : "";  // nearer to 1, CG does not converge
}

std::string flags_of(const Scene& scene) {
    std::string flags;
    if (!scene.contacts) flags += " contact='disable'";
    for (const Joint& joint : scene.joints)
        if (joint.collide) return "<flag filterparent='disable'" + flags + "/>";
    return "<flag" + flags + "/>";
}

std::string head_of(const Scene& scene, double h, const MujocoSettings& settings) {
    bool rough = false;
    for (const Body& body : scene.bodies) rough |= body.friction > 0.0;
    std::size_t shapes = 0;
    for (const Body& body : scene.bodies) shapes += std::max<std::size_t>(1, 2 * body.parts.size());
    // Its memory grows with rows times degrees of freedom.
    const std::size_t each = scene.joints.empty() ? 8 : 3;
    const std::size_t contacts = scene.contacts ? std::max<std::size_t>(100, each * shapes) : 1,
                      rows = (rough ? 3 : 1) * contacts + 6 * scene.joints.size();
    std::ostringstream xml;
    xml.precision(17);
    xml << "<mujoco><compiler angle='radian'/><option timestep='" << h << "' gravity='0 0 " << -scene.gravity
        << "' integrator='" << settings.integrator << "' solver='" << settings.solver
        << "' cone='elliptic' iterations='" << settings.iterations << "'>" << flags_of(scene)
        << "</option><size nconmax='" << contacts << "' njmax='" << rows
        << "' nstack='20000000'/><default><geom condim='" << (rough ? 3 : 1) << "' solref='"
        << solref(scene, h, settings.stiff) << "'" << solimp(scene, settings.stiff) << "/></default><asset>";
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        if (scene.bodies[i].kind != Kind::hexahedron) continue;
        xml << "<mesh name='" << i << "' vertex='";
        for (const Vector& corner : scene.bodies[i].corners) xml << text(corner) << ' ';
        xml << "'/>";
    }
    xml << "</asset>";
    return xml.str();
}

Vector center(const Scene& scene, std::size_t body) {
    return body == the_world ? Vector{} : scene.bodies[body].position;
}
Orientation turn_of(const Scene& scene, std::size_t body) {
    return body == the_world ? Orientation{} : scene.bodies[body].orientation;
}
Orientation back(const Orientation& q) { return {q.w, -q.x, -q.y, -q.z}; }

class ModelWriter {
public:
    ModelWriter(const Scene& scene, const JointForest& forest, double h, const MujocoSettings& settings)
        : scene_(scene), forest_(forest), h_(h), children_(scene.bodies.size()) {
        xml_.precision(17);
        xml_ << head_of(scene, h, settings);
        for (std::size_t k = 0; k < forest.nodes.size(); ++k)
            if (forest.nodes[k].parent != the_world) children_[forest.nodes[k].parent].push_back(k);
    }

    std::string write() {
        xml_ << "<worldbody>";
        for (const Body& body : scene_.bodies)
            if (!body.moves()) fixed(body);
        for (const JointForest::Node& node : forest_.nodes)
            if (node.parent == the_world) nested(node);
        for (const std::size_t j : forest_.loops)
            if (scene_.joints[j].kind == JointKind::distance) sites_of_world(j);
        xml_ << "</worldbody>";
        tendons();
        equalities();
        exclusions();
        motors();
        xml_ << "</mujoco>";
        return xml_.str();
    }

private:
    std::string quat(const Orientation& q) const {
        std::ostringstream out;
        out.precision(17);
        out << " quat='" << q.w << ' ' << q.x << ' ' << q.y << ' ' << q.z << "'";
        return out.str();
    }

    // A pair uses that of the higher priority, or the larger friction.
    std::string material(const Body& body) const {
        std::ostringstream out;
        out << " friction='" << told_friction(scene_, body) << "' priority='" << (body.moves() ? 0 : 1) << "'";
        return out.str();
    }

    std::string geom(const Body& body) const {
        std::string text_of;
        if (body.kind == Kind::sphere) text_of = "type='sphere' size='" + text({body.radius, 0.0, 0.0}) + "'";
        if (body.kind == Kind::box) text_of = "type='box' size='" + text(0.5 * body.size) + "'";
        if (body.kind == Kind::hexahedron)
            text_of = "type='mesh' mesh='" + std::to_string(&body - scene_.bodies.data()) + "'";
        return text_of + material(body);
    }

    void fixed(const Body& body) {
        if (body.kind == Kind::plane)
            xml_ << "<geom type='plane' size='0 0 1' pos='" << text(body.offset * body.normal) << "' zaxis='"
                 << text(body.normal) << "'" << material(body) << "/>";
        else
            xml_ << "<geom " << geom(body) << " pos='" << text(body.position) << "'" << quat(body.orientation) << "/>";
    }

    void nested(const JointForest::Node& node) {
        const Body& body = scene_.bodies[node.body];
        const Orientation above = turn_of(scene_, node.parent);
        xml_ << "<body name='" << node.body << "' pos='"
             << text(rotate_back(above, body.position - center(scene_, node.parent))) << "'"
             << quat(back(above) * body.orientation) << ">";
        node.joint == the_world ? void(xml_ << "<freejoint/>") : joined(node);
        xml_ << "<inertial pos='0 0 0' mass='" << body.mass << "' diaginertia='" << text(body.principal_inertia())
             << "'/>";
        if (body.kind != Kind::compound) xml_ << "<geom " << geom(body) << "/>";
        for (const BoxPart& part : body.parts)
            xml_ << "<geom type='box' size='" << text(0.5 * part.size) << "' pos='" << text(part.position) << "'"
                 << quat(part.orientation) << material(body) << "/>";
        for (const std::size_t j : forest_.loops)
            if (scene_.joints[j].kind == JointKind::distance) sites_of(j, node.body);
        for (const std::size_t child : children_[node.body]) nested(forest_.nodes[child]);
        xml_ << "</body>";
    }

    void joined(const JointForest::Node& node) {
        const Joint& joint = scene_.joints[node.joint];
        const Body& body = scene_.bodies[node.body];
        if (joint.kind == JointKind::fixed) return;  // welded
        const char* type = joint.kind == JointKind::ball ? "ball" : joint.kind == JointKind::hinge ? "hinge" : "slide";
        xml_ << "<joint name='" << node.joint << "' type='" << type << "' pos='" << in(node.body, joint.anchor) << "'";
        if (joint.kind != JointKind::ball)
            xml_ << " axis='" << text(rotate_back(body.orientation, axis_for(joint, node.body))) << "'";
        if (joint.limits) xml_ << " range='" << (*joint.limits)[0] << ' ' << (*joint.limits)[1] << "'";
        if (joint.cone) xml_ << " range='0 " << *joint.cone << "'";  // of the whole angle
        if (joint.limits || joint.cone)
            xml_ << " limited='true' solreflimit='" << 2.0 * h_ << " 1' solimplimit='0.99 0.999 0.001'";
        xml_ << "/>";
    }

    std::string in(std::size_t body, const Vector& point) const {
        return text(rotate_back(turn_of(scene_, body), point - center(scene_, body)));
    }

    void site(std::size_t j, const char* end, std::size_t body, const Vector& point) {
        xml_ << "<site name='" << j << end << "' pos='" << in(body, point) << "'/>";
    }
    void sites_of(std::size_t j, std::size_t body) {
        const Joint& joint = scene_.joints[j];
        if (joint.first == body) site(j, "a", body, joint.anchor);
        if (joint.second == body) site(j, "b", body, joint.second_anchor);
    }
    void sites_of_world(std::size_t j) {
        const Joint& joint = scene_.joints[j];
        if (is_fixed(scene_, joint.first)) site(j, "a", the_world, joint.anchor);
        if (is_fixed(scene_, joint.second)) site(j, "b", the_world, joint.second_anchor);
    }

    void tendons() {
        xml_ << "<tendon>";
        for (const std::size_t j : forest_.loops)
            if (scene_.joints[j].kind == JointKind::distance)
                xml_ << "<spatial name='" << j << "'><site site='" << j << "a'/><site site='" << j << "b'/></spatial>";
        xml_ << "</tendon>";
    }

    // A hinge: two points on its axis, as far apart as the smaller body is long.
    void equalities() {
        xml_ << "<equality>";
        for (const std::size_t j : forest_.loops) {
            const Joint& joint = scene_.joints[j];
            std::size_t a = joint.first, b = joint.second;
            if (is_fixed(scene_, a)) std::swap(a, b);
            std::ostringstream stiff, names;
            stiff.precision(17);
            stiff << " solref='" << 2.0 * h_ << " 1' solimp='0.9999 0.9999 0.001'/>";
            names << "body1='" << a << "'";
            if (!is_fixed(scene_, b)) names << " body2='" << b << "'";
            const auto hold = [&](const Vector& point) {
                xml_ << "<connect " << names.str() << " anchor='" << in(a, point) << "'" << stiff.str();
            };
            double half = scene_.bodies[a].reach();
            if (!is_fixed(scene_, b)) half = std::min(half, scene_.bodies[b].reach());
            const Vector axis = half / norm(joint.axis) * joint.axis;
            if (joint.kind == JointKind::ball) hold(joint.anchor);
            if (joint.kind == JointKind::hinge)
                for (const double side : {-1.0, 1.0}) hold(joint.anchor + side * axis);
            if (joint.kind == JointKind::fixed) xml_ << "<weld " << names.str() << stiff.str();
            if (joint.kind == JointKind::distance) xml_ << "<tendon tendon1='" << j << "'" << stiff.str();
        }
        xml_ << "</equality>";
    }

    void exclusions() {
        xml_ << "<contact>";
        for (const Joint& joint : scene_.joints)
            if (!joint.collide && !is_fixed(scene_, joint.first) && !is_fixed(scene_, joint.second))
                xml_ << "<exclude body1='" << joint.first << "' body2='" << joint.second << "'/>";
        xml_ << "</contact>";
    }

    // The torque is k (speed - rate): k such that half of the difference goes in a step, of the child body alone.
    void motors() {
        xml_ << "<actuator>";
        for (const JointForest::Node& node : forest_.nodes) {
            if (node.joint == the_world || !scene_.joints[node.joint].speed) continue;
            const Joint& joint = scene_.joints[node.joint];
            const Body& body = scene_.bodies[node.body];
            const Vector unit = 1.0 / norm(joint.axis) * joint.axis, local = rotate_back(body.orientation, unit),
                         inertia = body.principal_inertia(), arm = cross(body.position - joint.anchor, unit);
            const double turned = inertia.x * local.x * local.x + inertia.y * local.y * local.y +
                                  inertia.z * local.z * local.z + body.mass * dot(arm, arm);
            const double moved = joint.kind == JointKind::hinge ? turned : body.mass;
            xml_ << "<velocity name='" << node.joint << "' joint='" << node.joint << "' kv='" << 0.5 * moved / h_
                 << "' forcelimited='true' forcerange='" << -joint.strength << ' ' << joint.strength << "'/>";
        }
        xml_ << "</actuator>";
    }

    const Scene& scene_;
    const JointForest& forest_;
    double h_;
    std::vector<std::vector<std::size_t>> children_;  // indices of nodes, by body
    std::ostringstream xml_;
};

}  // namespace

bool mujoco_can_represent(const Scene& scene, const JointForest& forest) {
    constexpr std::size_t deepest = 95;  // the XML reader refuses 100 nested elements
    for (const JointForest::Node& node : forest.nodes)
        if (node.depth > deepest) return false;
    for (const std::size_t j : forest.loops)
        if (scene.joints[j].kind == JointKind::slider) return false;
    return !needs_breaking(scene);
}

std::string mujoco_model(const Scene& scene, const JointForest& forest, double h, const MujocoSettings& settings) {
    return ModelWriter(scene, forest, h, settings).write();
}

}  // namespace tumble::bench
