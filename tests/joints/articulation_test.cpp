// The articulated-body algorithm against dense equations of motion of the same tree.
#include "tree_scene.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <random>

namespace tumble::articulation_test {
using namespace tumble::testing;

namespace {

constexpr std::array types{JointType::fixed,     JointType::hinge,       JointType::ball,   JointType::slider,
                           JointType::universal, JointType::cylindrical, JointType::planar, JointType::six_dof};

struct Random {
    std::mt19937_64 engine{7};
    double operator()(double least, double most) { return least + (most - least) * (double(engine() >> 11) * 0x1p-53); }
    Vec3 vector() { return {(*this)(-1.0, 1.0), (*this)(-1.0, 1.0), (*this)(-1.0, 1.0)}; }
};

/// A tree of boxes with joints of all types, either body first, hung on the world or free.
SceneDescription random_tree(Random& random, int links, bool hung) {
    SceneDescription scene;
    for (int i = 0; i < links; ++i) {
        const Vec3 size(random(0.1, 0.4), random(0.1, 0.4), random(0.1, 0.4));
        BodyDescription& box = add_box(scene, size, 2.0 * random.vector(), random(0.3, 3.0));
        box.rotation = from_rotation_vector(2.0 * random.vector());
        if (i == 0 && !hung) continue;
        const std::optional<std::size_t> parent =
            i == 0 ? std::nullopt : std::optional<std::size_t>(std::size_t(random(0.0, i)));
        const bool second = random(0.0, 1.0) < 0.5;
        const JointType type = types[std::size_t(random(0.0, double(types.size())))];
        const std::optional<std::size_t> child = std::size_t(i);
        JointDescription& joint = add_joint(scene, type, second ? child : parent, second ? parent : child,
                                            2.0 * random.vector(), random.vector());
        if (type != JointType::six_dof) continue;
        for (JointAxis& axis : joint.move)
            if (random(0.0, 1.0) < 0.5) axis.motion = JointAxis::Motion::free;
        for (JointAxis& axis : joint.turn)
            if (random(0.0, 1.0) < 0.5) axis.motion = JointAxis::Motion::free;
    }
    return scene;
}

/// Velocities of all bodies, center of mass and rotation, six numbers each.
Eigen::VectorXd velocities(const JointTree& tree, const ForwardDynamics& dynamics) {
    Eigen::VectorXd u(6 * Eigen::Index(tree.node_of_body().size()));
    for (std::size_t i = 0; i < tree.node_of_body().size(); ++i) {
        const ForwardDynamics::Link& link = dynamics.link(tree.node_of_body()[i]);
        u.segment<3>(6 * Eigen::Index(i)) = link.center_velocity();
        u.segment<3>(6 * Eigen::Index(i) + 3) = link.velocity.turn;
    }
    return u;
}

struct Tree {
    TreeScene scene;
    JointTree tree;
    ForwardDynamics dynamics{tree};
    std::vector<double> q, speeds, rates;

    explicit Tree(const SceneDescription& description) : scene(description) {
        EXPECT_TRUE(tree.find(scene.set.bodies, scene.island, scene.list));
        q.resize(std::size_t(tree.coordinates()));
        tree.start(q.data());
        speeds.assign(std::size_t(tree.speeds()), 0.0);
        rates = speeds;
    }
    /// Columns: velocities of the bodies for each speed alone.
    Eigen::MatrixXd motions() {
        const std::vector<double> none(speeds.size(), 0.0);
        Eigen::MatrixXd columns(6 * Eigen::Index(scene.set.bodies.size()), Eigen::Index(speeds.size()));
        for (std::size_t k = 0; k < speeds.size(); ++k) {
            std::vector<double> one = none;
            one[k] = 1.0;
            dynamics.move(q.data(), one.data());
            columns.col(Eigen::Index(k)) = velocities(tree, dynamics);
        }
        return columns;
    }
};

TEST(Articulation, PlacesBodiesWhereTheyAre) {
    Random random;
    for (int trial = 0; trial < 20; ++trial) {
        Tree t(random_tree(random, 12, trial % 2 == 0));
        EXPECT_LT(t.tree.gap(), 1e-13);
        t.dynamics.move(t.q.data(), t.speeds.data());
        for (std::size_t i = 0; i < t.scene.set.bodies.size(); ++i) {
            const ForwardDynamics::Link& link = t.dynamics.link(t.tree.node_of_body()[i]);
            const Body& body = t.scene.set.bodies[i];
            EXPECT_LT((t.tree.origin() + link.position() - body.position).norm(), 1e-13);
            EXPECT_LT((link.rotation - body.rotation).norm(), 1e-13);
        }
    }
}

// Velocities that fit the joints give the speeds that they were made from.
TEST(Articulation, SpeedsOfGivenVelocities) {
    Random random;
    for (int trial = 0; trial < 20; ++trial) {
        Tree t(random_tree(random, 12, trial % 2 == 0));
        std::vector<double> wanted(t.speeds.size());
        for (double& speed : wanted) speed = random(-2.0, 2.0);
        t.dynamics.move(t.q.data(), wanted.data());
        const Eigen::VectorXd u = velocities(t.tree, t.dynamics);
        std::vector<SpatialMotion> given;
        for (Eigen::Index i = 0; i < u.size() / 6; ++i) given.push_back({u.segment<3>(6 * i + 3), u.segment<3>(6 * i)});
        t.dynamics.move(t.q.data(), t.speeds.data());
        t.dynamics.find_speeds(given, t.rates.data());
        EXPECT_LT((velocities(t.tree, t.dynamics) - u).norm(), 1e-12 * u.norm());
        for (std::size_t k = 0; k < wanted.size(); ++k) EXPECT_NEAR(t.rates[k], wanted[k], 1e-12 * u.norm());
    }
}

// Newton's and Euler's equations of all bodies, projected on the motions of the tree: A^T (M a + b - F) = 0; and the
// accelerations against differences of the velocities along the motion.
TEST(Articulation, AccelerationsAgainstDenseEquations) {
    Random random;
    for (int trial = 0; trial < 20; ++trial) {
        const bool hung = trial % 2 == 0;
        Tree t(random_tree(random, 12, hung));
        const Eigen::MatrixXd a = t.motions();
        for (double& speed : t.speeds) speed = random(-2.0, 2.0);
        const Vec3 gravity = hung ? Vec3(1.0, -9.81, 2.0) : Vec3(Vec3::Zero());
        std::vector<Wrench> pushes;
        t.dynamics.move(t.q.data(), t.speeds.data());
        for (std::size_t i = 0; i < t.scene.set.bodies.size(); ++i) {
            pushes.push_back({random.vector(), random.vector()});
            t.dynamics.apply(t.tree.node_of_body()[i], pushes[i]);
        }
        t.dynamics.accelerate(-gravity, t.rates.data());
        Eigen::VectorXd rest(a.rows()), acceleration(a.rows());
        for (Eigen::Index i = 0; i < rest.size() / 6; ++i) {
            const ForwardDynamics::Link& link = t.dynamics.link(t.tree.node_of_body()[std::size_t(i)]);
            const Body& body = t.scene.set.bodies[std::size_t(i)];
            const Mat3 inertia = body.rotation * body.inertia_body * body.rotation.transpose();
            const Vec3& w = link.velocity.turn;
            const SpatialMotion& at_joint = link.acceleration;
            const Vec3 center = at_joint.move + at_joint.turn.cross(link.center) + w.cross(w.cross(link.center));
            rest.segment<3>(6 * i) = body.mass * center - pushes[std::size_t(i)].force;
            rest.segment<3>(6 * i + 3) = inertia * at_joint.turn + w.cross(inertia * w) - pushes[std::size_t(i)].torque;
            acceleration.segment<3>(6 * i) = center + gravity;
            acceleration.segment<3>(6 * i + 3) = at_joint.turn;
        }
        EXPECT_LT((a.transpose() * rest).norm(), 1e-11 * (1.0 + rest.norm()));

        std::vector<double> q_rates(t.q.size());
        t.dynamics.coordinate_rates(t.q.data(), t.speeds.data(), q_rates.data());
        const auto along = [&](double e) {
            std::vector<double> q = t.q, speeds = t.speeds;
            for (std::size_t k = 0; k < q.size(); ++k) q[k] += e * q_rates[k];
            for (std::size_t k = 0; k < speeds.size(); ++k) speeds[k] += e * t.rates[k];
            t.dynamics.move(q.data(), speeds.data());
            return velocities(t.tree, t.dynamics);
        };
        constexpr double e = 1e-3;
        const Eigen::VectorXd difference =
            (8.0 * (along(e) - along(-e)) - (along(2.0 * e) - along(-2.0 * e))) / (12.0 * e);
        EXPECT_LT((difference - acceleration).norm(), 1e-7 * acceleration.norm());
    }
}

// The recursion from the leaves gives forces that do no work along the free coordinates.
TEST(Articulation, JointForcesDoNoWork) {
    Random random;
    for (int trial = 0; trial < 20; ++trial) {
        Tree t(random_tree(random, 12, true));
        for (double& speed : t.speeds) speed = random(-2.0, 2.0);
        t.dynamics.move(t.q.data(), t.speeds.data());
        t.dynamics.accelerate({0.0, 9.81, 0.0}, t.rates.data());
        std::vector<SpatialForce> forces;
        t.dynamics.joint_forces({}, forces);
        for (std::size_t k = 0; k < forces.size(); ++k) {
            const TreeNode& node = t.tree.nodes()[k];
            const ForwardDynamics::Link& link = t.dynamics.link(int(k));
            const double scale = 1.0 + forces[k].force.norm() + forces[k].moment.norm();
            if (node.kind == TreeNode::Kind::ball) {
                EXPECT_LT(forces[k].moment.norm(), 5e-11 * scale);
            }
            if (node.kind == TreeNode::Kind::revolute) {
                EXPECT_LT(std::abs(link.axis.dot(forces[k].moment)), 1e-11 * scale);
            }
            if (node.kind == TreeNode::Kind::prismatic) {
                EXPECT_LT(std::abs(link.axis.dot(forces[k].force)), 1e-11 * scale);
            }
        }
    }
}

/// Number of joints that are cut, or -1.
int cuts_of(const SceneDescription& scene) {
    TreeScene parts(scene);
    JointTree tree;
    if (!tree.find(parts.set.bodies, parts.island, parts.list, parts.joints.joints())) return -1;
    return int(tree.cut().size());
}

TEST(Articulation, FindsSpanningTrees) {
    EXPECT_EQ(cuts_of(double_pendulum_scene(1)), 0);
    EXPECT_EQ(cuts_of(free_chain_scene()), 0);
    SceneDescription door = double_pendulum_scene(1);
    add_joint(door, JointType::hinge, std::nullopt, 0, {0.0, 0.0, 0.3}, Vec3::UnitZ());
    EXPECT_EQ(cuts_of(door), 1);
    door.joints[0].turn[0].friction = 1.0;
    EXPECT_EQ(cuts_of(door), 1);
    door.joints[2].turn[0].friction = 1.0;  // of two laws one would be of a joint that is cut
    EXPECT_EQ(cuts_of(door), -1);
    SceneDescription anchored = free_chain_scene();
    add_joint(anchored, JointType::ball, std::nullopt, 0, {-0.5, 0.0, 0.0});
    EXPECT_EQ(cuts_of(anchored), 0);
    add_joint(anchored, JointType::ball, std::nullopt, 7, {7.5, 0.0, 0.0});
    EXPECT_EQ(cuts_of(anchored), 1);
    SceneDescription ring = free_chain_scene();
    add_joint(ring, JointType::ball, 7, 0, {3.5, 0.0, 0.0}).anchor_second = Vec3(-0.5, 0.0, 0.0);
    EXPECT_EQ(cuts_of(ring), 1);
    SceneDescription rod = double_pendulum_scene(1);
    rod.joints[1].type = JointType::distance;
    EXPECT_EQ(cuts_of(rod), 1);
    SceneDescription net = free_chain_scene(12);
    for (std::size_t i = 0; i + 2 < 12; ++i) add_joint(net, JointType::fixed, i, i + 2, {double(i), 0.0, 0.0});
    EXPECT_EQ(cuts_of(net), 10);
    for (std::size_t i = 0; i + 3 < 12; ++i) add_joint(net, JointType::fixed, i, i + 3, {double(i), 0.0, 0.0});
    EXPECT_EQ(cuts_of(net), -1);  // too many rows
}

}  // namespace
}  // namespace tumble::articulation_test
