#include "tumble/tumble_simulator.h"

#include "scene/keys/fracture.h"
#include "sim/world.h"

#include <numbers>

namespace tumble::bench {
namespace {

Vec3 vec(const Vector& v) { return {v.x, v.y, v.z}; }
Vector vector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

std::shared_ptr<const MeshAsset> mesh_of(const Body& body) {
    auto asset = std::make_shared<MeshAsset>();
    for (const Vector& corner : body.corners) asset->mesh.vertices.push_back(vec(corner));
    for (const auto& s : sides) {
        const auto corner = [&](int i) { return std::uint32_t(s[i]); };
        asset->mesh.triangles.push_back({corner(0), corner(1), corner(2)});
        asset->mesh.triangles.push_back({corner(0), corner(2), corner(3)});
    }
    return asset;
}

CompoundShape compound_of(const Body& body) {
    auto parts = std::make_shared<std::vector<CompoundPart>>();
    for (const BoxPart& part : body.parts) {
        const Orientation& q = part.orientation;
        CompoundPart p;
        p.shape = BoxShape{vec(part.size)};
        p.position = vec(part.position);
        p.rotation = Quat(q.w, q.x, q.y, q.z);
        parts->push_back(p);
    }
    return {parts};
}

std::shared_ptr<const FractureDescription> cut_of(const Breakage& breakage) {
    auto cut = std::make_shared<FractureDescription>();
    cut->cells = breakage.cells;
    cut->strength = breakage.strength;
    cut->shear_strength = 1.6 * breakage.strength;
    cut->stiffness = breakage.stiffness;
    cut->toughness = breakage.toughness;
    cut->blow_time = breakage.blow_time;
    return cut;
}

BodyDescription described(const Body& body, std::size_t index) {
    BodyDescription d;
    d.name = std::to_string(index);
    if (!body.moves()) d.type = BodyType::fixed;
    switch (body.kind) {
        case Kind::plane:
            d.shape = PlaneShape{vec(body.normal), body.offset};
            break;
        case Kind::box:
            d.shape = BoxShape{vec(body.size)};
            break;
        case Kind::sphere:
            d.shape = SphereShape{body.radius};
            break;
        case Kind::hexahedron:
            d.shape = MeshShape{mesh_of(body)};
            break;
        case Kind::compound:
            d.shape = compound_of(body);
            break;
    }
    if (body.moves()) d.mass = body.mass;
    d.restitution = body.restitution;
    d.friction = body.friction;
    d.position = vec(body.position);
    d.rotation = Quat(body.orientation.w, body.orientation.x, body.orientation.y, body.orientation.z);
    d.velocity = vec(body.velocity);
    d.angular_velocity = vec(body.angular_velocity);
    if (body.breakage) d.fracture = cut_of(*body.breakage);
    return d;
}

JointType type_of(JointKind kind) {
    switch (kind) {
        case JointKind::ball:
            return JointType::ball;
        case JointKind::hinge:
            return JointType::hinge;
        case JointKind::slider:
            return JointType::slider;
        case JointKind::distance:
            return JointType::distance;
        default:
            return JointType::fixed;
    }
}

void set_side(const Scene& scene, std::size_t body, const Vector& anchor, const Quat& frame,
              std::optional<std::size_t>& index, Vec3& at, Quat& in) {
    at = vec(anchor);
    in = frame;
    if (body == the_world) return;
    const Body& b = scene.bodies[body];
    index = body;
    at = vec(rotate_back(b.orientation, anchor - b.position));
    const Orientation& q = b.orientation;
    in = Quat(q.w, q.x, q.y, q.z).conjugate() * frame;
}

JointDescription described(const Scene& scene, const Joint& joint, std::size_t index) {
    JointDescription d;
    d.name = std::to_string(index);
    d.type = type_of(joint.kind);
    d.collide = joint.collide;
    const Quat frame = Quat::FromTwoVectors(Vec3::UnitX(), vec(joint.axis));
    const bool distance = joint.kind == JointKind::distance;
    set_side(scene, joint.first, joint.anchor, frame, d.first, d.anchor_first, d.frame_first);
    set_side(scene, joint.second, distance ? joint.second_anchor : joint.anchor, frame, d.second, d.anchor_second,
             d.frame_second);
    if (distance) d.length = norm(joint.second_anchor - joint.anchor);
    if (joint.kind == JointKind::ball)
        for (JointAxis& turn : d.turn) turn.motion = JointAxis::Motion::free;
    if (joint.cone) d.swing = {*joint.cone, *joint.cone};
    if (joint.kind == JointKind::hinge || joint.kind == JointKind::slider) {
        JointAxis& axis = joint.kind == JointKind::hinge ? d.turn[0] : d.move[0];
        axis.motion = joint.limits ? JointAxis::Motion::limited : JointAxis::Motion::free;
        if (joint.limits) {
            axis.lower = (*joint.limits)[0];
            axis.upper = (*joint.limits)[1];
        }
        if (joint.speed) {
            axis.motor.emplace();
            axis.motor->speed = *joint.speed;
            axis.motor->max_force = joint.strength;
        }
    }
    if (joint.break_force > 0.0) d.break_force = joint.break_force;
    return d;
}

// A couple of two forces.
void add_torque(SceneDescription& d, const Torque& turning) {
    const Vec3 torque = vec(turning.torque), arm = 0.5 * torque.unitOrthogonal();
    const double infinite = std::numeric_limits<double>::infinity();
    for (const double side : {-1.0, 1.0})
        d.forces.push_back({turning.body, side * arm, side * 2.0 * torque.cross(arm), true, 0.0, infinite});
}

void add_spring(SceneDescription& d, const Spring& spring) {
    JointDescription joint;
    joint.name = "spring " + std::to_string(d.joints.size());
    joint.type = JointType::distance;
    joint.second = spring.body;
    joint.anchor_first = vec(spring.from);
    joint.anchor_second = vec(spring.point);
    joint.collide = true;
    for (JointAxis& axis : joint.turn) axis.motion = JointAxis::Motion::free;
    for (JointAxis& axis : joint.move) axis.motion = JointAxis::Motion::free;
    joint.move[0].spring = JointSpring{.stiffness = spring.stiffness, .damping = 0.0, .rest = spring.length};
    d.joints.push_back(joint);
}

// Tumble's water is below a y: its world lies on its side there.
Vec3 lie(const Vec3& v) { return {v.x(), v.z(), -v.y()}; }
Vec3 stand(const Vec3& v) { return {v.x(), -v.z(), v.y()}; }
const Quat lying(0.5 * std::numbers::sqrt2, -0.5 * std::numbers::sqrt2, 0.0, 0.0);

void add_water(SceneDescription& d, const Water& water) {
    d.simulation.gravity = lie(d.simulation.gravity);
    for (BodyDescription& body : d.bodies) {
        body.position = lie(body.position);
        body.rotation = lying * body.rotation;
        body.velocity = lie(body.velocity);
        body.angular_velocity = lie(body.angular_velocity);
    }
    d.water.emplace();
    d.water->density = water.density;
    d.water->drag = water.drag;
    d.water->viscosity = water.viscosity;
    if (water.wave_height > 0.0) d.water->waves = {{.height = water.wave_height, .length = water.wave_length}};
}

SceneDescription described(const Scene& scene, double rate, const TumbleSettings& settings) {
    SceneDescription d;
    d.output.fps = rate;  // one frame per step, so that step-free ways gain no more from frames than from steps
    d.simulation.steps_per_frame = 1;
    d.simulation.gravity = Vec3(0.0, 0.0, -scene.gravity);
    d.simulation.integrator = settings.integrator;
    d.simulation.impacts = settings.impacts;
    d.simulation.impact_law = settings.law;
    d.simulation.contact_solver = settings.contact_solver;
    d.simulation.sleep = settings.sleep;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) d.bodies.push_back(described(scene.bodies[i], i));
    for (std::size_t j = 0; j < scene.joints.size(); ++j) d.joints.push_back(described(scene, scene.joints[j], j));
    if (scene.air) d.wind = WindDescription{vec(scene.air->velocity), scene.air->density, scene.air->drag};
    if (scene.push)
        d.forces.push_back(
            {0, vec(scene.push->point), vec(scene.push->force), true, 0.0, std::numeric_limits<double>::infinity()});
    for (const Torque& turning : scene.torques) add_torque(d, turning);
    for (const Spring& spring : scene.springs) add_spring(d, spring);
    if (scene.water) add_water(d, *scene.water);
    append_pieces(d);
    return d;
}

class TumbleSimulator : public Simulator {
public:
    TumbleSimulator(const Scene& scene, double rate, const TumbleSettings& settings)
        : world_(described(scene, rate, settings), settings.threads), lies_(bool(scene.water)) {}

    void step() override {
        world_.advance_frame();
        fresh_ = false;
    }

    Motion motion(std::size_t body) const override {
        const BodyState& s = snapshot().bodies[body];
        if (lies_) {
            const Quat q = lying.conjugate() * s.orientation;
            return {vector(stand(s.center_of_mass)),
                    {q.w(), q.x(), q.y(), q.z()},
                    vector(stand(s.velocity)),
                    vector(stand(s.angular_velocity))};
        }
        const Quat& q = s.orientation;
        return {vector(s.center_of_mass), {q.w(), q.x(), q.y(), q.z()}, vector(s.velocity), vector(s.angular_velocity)};
    }

    std::optional<double> broken_at(std::size_t joint) const override { return world_.joint_states()[joint].broken_at; }

    std::optional<Totals> totals() const override {
        const Measurement sums = world_.measure();
        Totals all{vector(sums.momentum), vector(sums.angular_momentum), sums.kinetic, 0};
        for (const BodyState& s : snapshot().bodies) all.bodies += s.mass > 0.0 && !s.absent;
        return all;
    }

    std::optional<Vector> joint_force(std::size_t joint) const override {
        return vector(world_.joint_states()[joint].force);
    }

private:
    const Snapshot& snapshot() const {
        if (!fresh_) snapshot_ = world_.snapshot();
        fresh_ = true;
        return snapshot_;
    }

    World world_;
    bool lies_ = false;  // see add_water()
    mutable Snapshot snapshot_;
    mutable bool fresh_ = false;
};

}  // namespace

std::unique_ptr<Simulator> make_tumble(const Scene& scene, double rate, const TumbleSettings& settings) {
    return std::make_unique<TumbleSimulator>(scene, rate, settings);
}

}  // namespace tumble::bench
