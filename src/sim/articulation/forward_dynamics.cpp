#include "sim/articulation/forward_dynamics.h"

#include "core/deterministic_math.h"

namespace tumble {

namespace {

Quat quaternion_at(const double* q) { return Quat(q[3], q[0], q[1], q[2]).normalized(); }
Vec3 vector_at(const double* v) { return {v[0], v[1], v[2]}; }

// moving - mixed^T turning^-1 mixed: a ball passes forces at its point alone.
Sym3 behind_ball(const SpatialInertia& inertia, const Sym3& inverse) {
    Vec3 solved[3];
    for (int j = 0; j < 3; ++j) solved[j] = inverse * inertia.mixed.col(j);
    const auto part = [&](int i, int j) { return inertia.mixed.col(i).dot(solved[j]); };
    const Sym3& m = inertia.moving;
    return {m.xx - part(0, 0), m.xy - part(0, 1), m.xz - part(0, 2),
            m.yy - part(1, 1), m.yz - part(1, 2), m.zz - part(2, 2)};
}

// The acceleration of a free body with inertia and effort p: I a = -p.
SpatialMotion free_acceleration(const SpatialInertia& inertia, const SpatialForce& p) {
    const Sym3 inverse = inertia.moving.inverse();
    Sym3 turning = inertia.turning;  // less mixed moving^-1 mixed^T
    Vec3 rows[3], solved[3];
    for (int i = 0; i < 3; ++i) {
        rows[i] = inertia.mixed.row(i);
        solved[i] = inverse * rows[i];
    }
    turning.xx -= rows[0].dot(solved[0]);
    turning.xy -= rows[0].dot(solved[1]);
    turning.xz -= rows[0].dot(solved[2]);
    turning.yy -= rows[1].dot(solved[1]);
    turning.yz -= rows[1].dot(solved[2]);
    turning.zz -= rows[2].dot(solved[2]);
    SpatialMotion a;
    a.turn = turning.inverse() * (inertia.mixed * (inverse * p.force) - p.moment);
    a.move = -(inverse * (p.force + inertia.mixed.transpose() * a.turn));
    return a;
}

}  // namespace

void ForwardDynamics::place_node(const TreeNode& node, Link& link, const double* q) const {
    if (node.kind == NodeKind::free) {
        link.orientation = quaternion_at(q + 3);
        link.rotation = link.orientation.toRotationMatrix();
        link.point = vector_at(q);
        link.center = Vec3::Zero();
        return;
    }
    const Link& parent = above(node);
    if (node.kind == NodeKind::ball) {
        link.orientation = parent.orientation * quaternion_at(q);
    } else if (node.kind == NodeKind::revolute) {
        const auto [sine, cosine] = sincos(0.5 * q[0]);
        Quat turn;
        turn.w() = cosine;
        turn.vec() = sine * node.axis;
        link.orientation = parent.orientation * (node.turned * turn);
    } else {
        link.orientation = parent.orientation * node.turned;
    }
    link.rotation = link.orientation.toRotationMatrix();
    if (node.kind == NodeKind::revolute) link.axis = link.rotation * node.axis;
    link.arm = parent.rotation * node.arm;
    if (node.kind == NodeKind::prismatic) {
        link.axis = parent.rotation * node.axis;
        link.arm += q[0] * link.axis;
    }
    link.point = parent.point + link.arm;
    link.center = link.rotation * node.center;
}

void ForwardDynamics::speed_node(const TreeNode& node, Link& link, const double* speed) const {
    if (node.kind == NodeKind::free) {
        link.velocity = {vector_at(speed), vector_at(speed + 3)};
        return;
    }
    const Link& parent = above(node);
    const Vec3& omega = parent.velocity.turn;
    const Vec3 around = omega.cross(link.arm);
    link.velocity = {omega, parent.velocity.move + around};
    link.bias.turn = Vec3::Zero();
    link.bias.move = omega.cross(around);
    if (node.kind == NodeKind::revolute) {
        const Vec3 own = speed[0] * link.axis;
        link.velocity.turn += own;
        link.bias.turn = omega.cross(own);
    } else if (node.kind == NodeKind::prismatic) {
        const Vec3 own = speed[0] * link.axis;
        link.velocity.move += own;
        link.bias.move += 2.0 * omega.cross(own);
    } else if (node.kind == NodeKind::ball) {
        const Vec3 own = parent.rotation * vector_at(speed);
        link.velocity.turn += own;
        link.bias.turn = omega.cross(own);
    }
}

// I_i of a rigid body about its joint.
void ForwardDynamics::load_inertia(const TreeNode& node, Link& link) {
    link.added = node.armature;
    link.about.setZero();
    if (node.body == TreeNode::no_body) {
        link.turning = {};
        link.inertia = {};
        return;
    }
    const double m = node.mass;
    const Vec3 &c = link.center, mc = m * c;
    Sym3 turning = node.inertia_at(link.rotation);
    turning.add_outer(-m, c);
    const double square = mc.dot(c);
    turning.xx += square;
    turning.yy += square;
    turning.zz += square;
    link.turning = turning;
    link.inertia.turning = turning;
    link.inertia.mixed << 0.0, -mc[2], mc[1], mc[2], 0.0, -mc[0], -mc[1], mc[0], 0.0;
    link.inertia.moving = {m, 0.0, 0.0, m, 0.0, m};
}

// b_i = (w x I w; m w x (w x c)).
void ForwardDynamics::load_effort(const TreeNode& node, Link& link) {
    link.drive = 0.0;
    link.twist.setZero();
    if (node.body == TreeNode::no_body) {
        link.effort = {};
        return;
    }
    const Vec3& w = link.velocity.turn;
    link.effort = {w.cross(link.turning * w), node.mass * w.cross(w.cross(link.center))};
}

void ForwardDynamics::start() {
    links_.resize(tree_.nodes().size());
    if (carried_) return;
    ground_ = {};
    carrying_ = {};
    ground_.orientation = tree_.ground();
    ground_.rotation = tree_.ground().toRotationMatrix();
}

void ForwardDynamics::carry(const Quat& orientation, const Vec3& point, const SpatialMotion& velocity,
                            const SpatialMotion& acceleration) {
    carried_ = true;
    ground_.orientation = orientation;
    ground_.rotation = orientation.toRotationMatrix();
    ground_.point = point;
    ground_.velocity = velocity;
    carrying_ = acceleration;
}

void ForwardDynamics::move(const double* coordinates, const double* speeds) {
    start();
    const std::vector<TreeNode>& nodes = tree_.nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const TreeNode& node = nodes[i];
        place_node(node, links_[i], coordinates + node.at);
        speed_node(node, links_[i], speeds + node.speed_at);
        load_inertia(node, links_[i]);
        load_effort(node, links_[i]);
    }
}

void ForwardDynamics::place(const double* coordinates, const double* speeds) {
    start();
    const std::vector<TreeNode>& nodes = tree_.nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        place_node(nodes[i], links_[i], coordinates + nodes[i].at);
        speed_node(nodes[i], links_[i], speeds + nodes[i].speed_at);
    }
}

void ForwardDynamics::set_speeds(const double* speeds) {
    const std::vector<TreeNode>& nodes = tree_.nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        speed_node(nodes[i], links_[i], speeds + nodes[i].speed_at);
        load_effort(nodes[i], links_[i]);
    }
}

void ForwardDynamics::apply(int node, const Wrench& wrench) {
    Link& link = links_[std::size_t(node)];
    link.effort.moment -= wrench.torque + link.center.cross(wrench.force);
    link.effort.force -= wrench.force;
}

// Held about n: with a = D^-1 n and g = 1 / (n . a), C = D^-1 - g a a^T, U = (D; mixed^T) and w' = C (u - U^T A) + g b
// a for the acceleration A without that of the joint. So I - U C U^T passes, which has the turning part g n n^T.
SpatialForce ForwardDynamics::pass_on_ball(Link& link, SpatialInertia& passed) {
    const SpatialInertia& inertia = link.inertia;
    const Vec3 &n = link.about, a = link.inverse * n;
    const double g = 1.0 / n.dot(a);
    link.given = g * link.wanted * a;
    link.inverse.add_outer(-g, a);
    const Vec3 k = link.inverse * link.column.moment + link.given;
    SpatialForce p = link.effort;
    p.moment += inertia.turning * k;
    p.force += inertia.mixed.transpose() * k;
    passed.turning.add_outer(g, n);
    passed.mixed = g * n * (inertia.mixed.transpose() * a).transpose();
    passed.moving = behind_ball(inertia, link.inverse);
    p += passed * link.bias;
    return p;
}

// Articulated inertias and efforts from the leaves to the root (Featherstone 2008, equations 7.37 to 7.43, second loop
// of Table 7.1); or efforts alone, with the inertias of the last sweep.
template <bool factor>
void ForwardDynamics::sweep_in() {
    const std::vector<TreeNode>& nodes = tree_.nodes();
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const TreeNode& node = nodes[i];
        if (node.kind == NodeKind::free) continue;
        Link& link = links_[i];
        SpatialInertia& inertia = link.inertia;
        SpatialForce& p = link.effort;
        const Vec3& s = link.axis;
        const SpatialMotion& c = link.bias;
        if (node.kind == NodeKind::ball) {
            // Passes forces at its point alone, but for a torque of the parent.
            if (factor) link.inverse = inertia.turning.inverse();
            const Vec3& u = link.column.moment = link.twist - p.moment;
            if (!link.about.isZero(0.0)) {
                SpatialInertia passed;
                const SpatialForce effort = pass_on_ball(link, passed);
                if (node.parent == TreeNode::ground) continue;
                links_[std::size_t(node.parent)].effort += shifted(effort, link.arm);
                links_[std::size_t(node.parent)].inertia.add_shifted(passed, link.arm);
                continue;
            }
            p.force += inertia.mixed.transpose() * (link.inverse * u);
            p.moment = link.twist;
            if (factor) inertia.moving = behind_ball(inertia, link.inverse);
            p.force += inertia.moving * c.move;
        } else if (node.kind != NodeKind::fixed) {
            if (node.kind == NodeKind::revolute) {
                if (factor) {
                    link.column = {inertia.turning * s, inertia.mixed.transpose() * s};
                    link.pivot = 1.0 / (s.dot(link.column.moment) + link.added);
                }
                link.drive -= s.dot(p.moment);
            } else {
                if (factor) {
                    link.column = {inertia.mixed * s, inertia.moving * s};
                    link.pivot = 1.0 / (s.dot(link.column.force) + link.added);
                }
                link.drive -= s.dot(p.force);
            }
            if (factor) inertia.subtract_outer(link.column, link.pivot);
            const double k = link.pivot * link.drive;
            p.moment += k * link.column.moment;
            p.force += k * link.column.force;
        }
        if (node.kind != NodeKind::ball) p += inertia * c;
        if (node.parent == TreeNode::ground) continue;
        Link& parent = links_[std::size_t(node.parent)];
        parent.effort += shifted(p, link.arm);
        if (!factor) continue;
        if (node.kind == NodeKind::ball)
            parent.inertia.add_moving(inertia.moving, link.arm);
        else
            parent.inertia.add_shifted(inertia, link.arm);
    }
}

// Accelerations from the root to the leaves (third loop of Table 7.1).
void ForwardDynamics::sweep_out(const Vec3& base, double* rates) {
    const std::vector<TreeNode>& nodes = tree_.nodes();
    ground_.acceleration = {carrying_.turn, carrying_.move + base};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const TreeNode& node = nodes[i];
        Link& link = links_[i];
        double* rate = rates + node.speed_at;
        if (node.kind == NodeKind::free) {
            link.acceleration = free_acceleration(link.inertia, link.effort);
            for (int k = 0; k < 3; ++k) {
                rate[k] = link.acceleration.turn[k];
                rate[3 + k] = link.acceleration.move[k] - base[k];
            }
            continue;
        }
        const SpatialMotion& parent = above(node).acceleration;
        SpatialMotion a{parent.turn + link.bias.turn, parent.move + parent.turn.cross(link.arm) + link.bias.move};
        if (node.kind == NodeKind::ball) {
            Vec3 turn = link.column.moment - link.inertia.mixed * a.move;
            if (link.about.isZero(0.0))
                turn = link.inverse * turn - a.turn;
            else
                turn = link.inverse * (turn - link.inertia.turning * a.turn) + link.given;
            const Vec3 own = above(node).rotation.transpose() * turn;
            for (int k = 0; k < 3; ++k) rate[k] = own[k];
            a.turn += turn;
        } else if (node.kind != NodeKind::fixed) {
            const double along = link.column.moment.dot(a.turn) + link.column.force.dot(a.move);
            rate[0] = link.pivot * (link.drive - along);
            (node.kind == NodeKind::revolute ? a.turn : a.move) += rate[0] * link.axis;
        }
        link.acceleration = a;
    }
}

void ForwardDynamics::accelerate(const Vec3& base, double* rates) {
    sweep_in<true>();
    sweep_out(base, rates);
}

void ForwardDynamics::respond(const Vec3& base, double* rates) {
    sweep_in<false>();
    sweep_out(base, rates);
}

void ForwardDynamics::keep_efforts() {
    efforts_.resize(links_.size());
    for (std::size_t i = 0; i < links_.size(); ++i) efforts_[i] = {links_[i].effort, links_[i].drive, links_[i].twist};
}

void ForwardDynamics::restore_efforts() {
    for (std::size_t i = 0; i < links_.size(); ++i) {
        links_[i].effort = efforts_[i].effort;
        links_[i].drive = efforts_[i].drive;
        links_[i].twist = efforts_[i].twist;
    }
}

void ForwardDynamics::set_aside() {
    aside_ = links_;
    ground_aside_ = ground_.acceleration;
    for (Link& link : links_) link.bias = {};
}

void ForwardDynamics::respond_to(const double* efforts, double* rates) {
    const std::vector<TreeNode>& nodes = tree_.nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const TreeNode& node = nodes[i];
        const double* own = efforts + node.speed_at;
        Link& link = links_[i];
        link.effort = {};
        link.drive = 0.0;
        link.twist.setZero();
        if (node.kind == NodeKind::free) link.effort = {-vector_at(own), -vector_at(own + 3)};
        if (node.kind == NodeKind::ball) link.twist = frame_of(int(i)) * vector_at(own);
        if (node.kind == NodeKind::revolute || node.kind == NodeKind::prismatic) link.drive = own[0];
    }
    respond(Vec3::Zero(), rates);
}

SpatialForce ForwardDynamics::joint_force(int node) const {
    const Link& link = links_[std::size_t(node)];
    const SpatialMotion& parent = above(tree_.nodes()[std::size_t(node)]).acceleration;
    const SpatialMotion a{parent.turn, parent.move + parent.turn.cross(link.arm)};
    SpatialForce f = link.effort;
    if (tree_.nodes()[std::size_t(node)].kind == NodeKind::ball)
        f.force += link.inertia.moving * a.move;
    else
        f += link.inertia * a;
    return f;
}

void ForwardDynamics::coordinate_rates(const double* coordinates, const double* speeds, double* rates) const {
    const std::vector<TreeNode>& nodes = tree_.nodes();
    for (const TreeNode& node : nodes) {
        const double *q = coordinates + node.at, *speed = speeds + node.speed_at;
        double* rate = rates + node.at;
        if (node.kind == NodeKind::revolute || node.kind == NodeKind::prismatic) rate[0] = speed[0];
        if (node.kind == NodeKind::free) {
            for (int k = 0; k < 3; ++k) *rate++ = speed[3 + k];
            q += 3;
        }
        if (node.kind != NodeKind::ball && node.kind != NodeKind::free) continue;
        const Vec3 w = vector_at(speed);  // dq/dt = w q / 2
        const Quat turned = Quat(0.0, w.x(), w.y(), w.z()) * Quat(q[3], q[0], q[1], q[2]);
        for (int k = 0; k < 4; ++k) rate[k] = 0.5 * turned.coeffs()[k];
    }
}

void ForwardDynamics::set_state(const std::vector<Body>& bodies, std::span<const std::uint32_t> island,
                                const double* coordinates) {
    start();
    const std::vector<TreeNode>& nodes = tree_.nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const TreeNode& node = nodes[i];
        Link& link = links_[i];
        if (node.kind == NodeKind::free || node.kind == NodeKind::prismatic || node.body == TreeNode::no_body) {
            place_node(node, link, coordinates + node.at);
            continue;
        }
        const Body& body = bodies[island[std::size_t(node.body)]];
        link.orientation = body.orientation;
        link.rotation = body.rotation;
        link.axis = link.rotation * node.axis;
        link.arm = above(node).rotation * node.arm;
        link.point = above(node).point + link.arm;
        link.center = link.rotation * node.center;
    }
}

// Each node's share of the velocity of the body at the end of its joint, relative to the node before, at the body's
// point.
void ForwardDynamics::find_speeds(std::span<const SpatialMotion> bodies, double* speeds) {
    const std::vector<TreeNode>& nodes = tree_.nodes();
    for (std::size_t i = 0, end = 0; i < nodes.size(); ++i) {
        if (end < i) end = i;
        while (nodes[end].body == TreeNode::no_body) ++end;
        const TreeNode& node = nodes[i];
        Link& link = links_[i];
        const Link &body = links_[end], &parent = above(node);
        const SpatialMotion& given = bodies[std::size_t(nodes[end].body)];
        const SpatialMotion& before = parent.velocity;
        const Vec3 turn = given.turn - before.turn;
        const Vec3 move =
            given.move - given.turn.cross(body.center) - before.move - before.turn.cross(body.point - parent.point);
        double* speed = speeds + node.speed_at;
        link.velocity = {before.turn, before.move + before.turn.cross(link.arm)};
        switch (node.kind) {
            case NodeKind::fixed:
                break;
            case NodeKind::revolute:
                speed[0] = link.axis.dot(turn);
                link.velocity.turn += speed[0] * link.axis;
                break;
            case NodeKind::prismatic:
                speed[0] = link.axis.dot(move);
                link.velocity.move += speed[0] * link.axis;
                break;
            case NodeKind::ball: {
                const Vec3 own = parent.rotation.transpose() * turn;
                for (int k = 0; k < 3; ++k) speed[k] = own[k];
                link.velocity.turn += turn;
                break;
            }
            case NodeKind::free:
                for (int k = 0; k < 3; ++k) {
                    speed[k] = given.turn[k];
                    speed[3 + k] = given.move[k];
                }
                link.velocity = given;
                break;
        }
    }
}

void ForwardDynamics::joint_forces(std::span<const Wrench> wrenches, std::vector<SpatialForce>& forces) const {
    const std::vector<TreeNode>& nodes = tree_.nodes();
    forces.assign(nodes.size(), {});
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const TreeNode& node = nodes[i];
        const Link& link = links_[i];
        if (node.body != TreeNode::no_body) {
            const Vec3 &w = link.velocity.turn, &turning = link.acceleration.turn, &c = link.center;
            const auto inertia_times = [&](const Vec3& v) -> Vec3 {
                return link.rotation * (node.inertia * Vec3(link.rotation.transpose() * v));
            };
            Vec3 force = node.mass * (link.acceleration.move + turning.cross(c) + w.cross(w.cross(c)));
            Vec3 torque = inertia_times(turning) + w.cross(inertia_times(w));
            if (!wrenches.empty()) {
                force -= wrenches[std::size_t(node.body)].force;
                torque -= wrenches[std::size_t(node.body)].torque;
            }
            forces[i] += SpatialForce{torque + c.cross(force), force};
        }
        if (node.parent != TreeNode::ground) forces[std::size_t(node.parent)] += shifted(forces[i], link.arm);
    }
}

}  // namespace tumble
