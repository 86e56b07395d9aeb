#include "harness/joints.h"

#include <algorithm>

namespace tumble::bench {
namespace {

struct Edge {
    std::size_t other, joint;
};

// The edges of the forest of each body; the last entry holds those of the world.
std::vector<std::vector<Edge>> graph_of(const Scene& scene) {
    const std::size_t n = scene.bodies.size();
    std::vector<std::vector<Edge>> graph(n + 1);
    for (std::size_t j = 0; j < scene.joints.size(); ++j) {
        const Joint& joint = scene.joints[j];
        if (joint.kind == JointKind::distance) continue;
        const std::size_t a = is_fixed(scene, joint.first) ? n : joint.first,
                          b = is_fixed(scene, joint.second) ? n : joint.second;
        graph[a].push_back({b, j});
        graph[b].push_back({a, j});
    }
    return graph;
}

class Search {
public:
    explicit Search(const Scene& scene)
        : scene_(scene), graph_(graph_of(scene)), seen_(scene.bodies.size(), 0), used_(scene.joints.size(), false) {}

    JointForest forest() {
        const std::size_t n = scene_.bodies.size();
        // All bodies with a joint to the world at once, so that their trees meet in the middle.
        for (const Edge& e : graph_[n])
            if (e.other != n && !seen_[e.other]) add({e.other, the_world, e.joint, e.other, 0});
        grow();
        for (std::size_t b = 0; b < n; ++b)
            if (scene_.bodies[b].moves() && !seen_[b]) {
                const std::size_t middle = middle_of(b);
                add({middle, the_world, the_world, middle, 0});
                grow();
            }
        std::stable_sort(forest_.nodes.begin(), forest_.nodes.end(),
                         [](const auto& x, const auto& y) { return x.root < y.root; });
        for (std::size_t j = 0; j < used_.size(); ++j)
            if (!used_[j]) forest_.loops.push_back(j);
        return std::move(forest_);
    }

private:
    void add(const JointForest::Node& node) {
        seen_[node.body] = 1;
        if (node.joint != the_world) used_[node.joint] = true;
        forest_.nodes.push_back(node);
    }

    void grow() {
        for (; grown_ < forest_.nodes.size(); ++grown_) {
            const JointForest::Node node = forest_.nodes[grown_];
            for (const Edge& e : graph_[node.body])
                if (e.other != scene_.bodies.size() && !seen_[e.other])
                    add({e.other, node.body, e.joint, node.root, node.depth + 1});
        }
    }

    // The middle of a longest path: from any body to the farthest, from there to the farthest, and half the way back.
    std::size_t middle_of(std::size_t body) const {
        std::vector<std::size_t> from(scene_.bodies.size(), the_world);
        const std::size_t end = farthest(body, from), other = farthest(end, from);
        std::vector<std::size_t> path{other};
        while (path.back() != end) path.push_back(from[path.back()]);
        return path[path.size() / 2];
    }

    std::size_t farthest(std::size_t body, std::vector<std::size_t>& from) const {
        std::fill(from.begin(), from.end(), the_world);
        std::vector<std::size_t> queue{body};
        from[body] = body;
        for (std::size_t k = 0; k < queue.size(); ++k)
            for (const Edge& e : graph_[queue[k]])
                if (e.other != scene_.bodies.size() && from[e.other] == the_world) {
                    from[e.other] = queue[k];
                    queue.push_back(e.other);
                }
        return queue.back();
    }

    const Scene& scene_;
    std::vector<std::vector<Edge>> graph_;
    std::vector<char> seen_;
    std::vector<bool> used_;
    JointForest forest_;
    std::size_t grown_ = 0;  // nodes whose neighbors have been added
};

Vector turned(const Scene& scene, std::size_t body, const std::vector<Motion>& motions, const Vector& direction) {
    if (is_fixed(scene, body)) return direction;
    return rotate(motions[body].orientation, rotate_back(scene.bodies[body].orientation, direction));
}

Vector place(const Scene& scene, std::size_t body, const std::vector<Motion>& motions, const Vector& point) {
    return is_fixed(scene, body) ? point : moved(scene, body, motions[body], point);
}

double gap_of(const Scene& scene, const Joint& joint, const std::vector<Motion>& motions) {
    const bool distance = joint.kind == JointKind::distance;
    const Vector a = place(scene, joint.first, motions, joint.anchor),
                 b = place(scene, joint.second, motions, distance ? joint.second_anchor : joint.anchor);
    if (distance) return std::fabs(norm(b - a) - norm(joint.second_anchor - joint.anchor));
    double reach = HUGE_VAL;
    for (const std::size_t body : {joint.first, joint.second})
        if (!is_fixed(scene, body)) reach = std::min(reach, scene.bodies[body].reach());
    const auto both = [&](const Vector& d) {
        return norm(cross(turned(scene, joint.first, motions, d), turned(scene, joint.second, motions, d)));
    };
    const Vector axis = 1.0 / norm(joint.axis) * joint.axis;
    double apart = norm(b - a);
    if (joint.kind == JointKind::slider) {
        const Vector along = turned(scene, joint.first, motions, axis);
        apart = norm((b - a) - dot(b - a, along) * along);
    }
    if (joint.kind == JointKind::hinge) apart = std::max(apart, reach * both(axis));
    if (joint.kind == JointKind::fixed || joint.kind == JointKind::slider)
        for (const Vector& d : {Vector{1.0, 0.0, 0.0}, Vector{0.0, 1.0, 0.0}, Vector{0.0, 0.0, 1.0}})
            apart = std::max(apart, reach * both(d));
    return apart;
}

double excess_of(const Scene& scene, const Joint& joint, const std::vector<Motion>& motions) {
    const Vector axis = 1.0 / norm(joint.axis) * joint.axis;
    const auto both = [&](const Vector& d) {
        return std::pair(turned(scene, joint.first, motions, d), turned(scene, joint.second, motions, d));
    };
    if (joint.cone) {
        const auto [a, b] = both(axis);
        return std::atan2(norm(cross(a, b)), dot(a, b)) - *joint.cone;
    }
    if (joint.kind != JointKind::hinge || !joint.limits) return 0.0;
    const Vector across = std::fabs(axis.x) < 0.7 ? cross(axis, {1.0, 0.0, 0.0}) : cross(axis, {0.0, 1.0, 0.0});
    const auto [a, b] = both(1.0 / norm(across) * across);
    const double angle = std::atan2(dot(turned(scene, joint.first, motions, axis), cross(a, b)), dot(a, b));
    return std::max(angle - (*joint.limits)[1], (*joint.limits)[0] - angle);
}

}  // namespace

bool is_fixed(const Scene& scene, std::size_t body) { return body == the_world || !scene.bodies[body].moves(); }

JointForest forest_of(const Scene& scene) { return Search(scene).forest(); }

Vector axis_for(const Joint& joint, std::size_t child) {
    return (child == joint.second ? 1.0 : -1.0) / norm(joint.axis) * joint.axis;
}

Vector velocity_at(const Scene& scene, std::size_t body, const Vector& point) {
    if (is_fixed(scene, body)) return {};
    const Body& b = scene.bodies[body];
    return b.velocity + cross(b.angular_velocity, point - b.position);
}

Vector spin_of(const Scene& scene, std::size_t body) {
    return is_fixed(scene, body) ? Vector{} : scene.bodies[body].angular_velocity;
}

Vector moved(const Scene& scene, std::size_t body, const Motion& motion, const Vector& point) {
    const Body& b = scene.bodies[body];
    return motion.position + rotate(motion.orientation, rotate_back(b.orientation, point - b.position));
}

double largest_gap(const Scene& scene, const std::vector<Motion>& motions) {
    double gap = 0.0;
    for (const Joint& joint : scene.joints) {
        const double open = gap_of(scene, joint, motions);
        if (!(open <= gap)) gap = open;  // not a number too
    }
    return gap;
}

double largest_excess(const Scene& scene, const std::vector<Motion>& motions) {
    double excess = 0.0;
    for (const Joint& joint : scene.joints) excess = std::max(excess, excess_of(scene, joint, motions));
    return excess;
}

bool has_kind(const Scene& scene, JointKind kind) {
    return std::any_of(scene.joints.begin(), scene.joints.end(), [=](const Joint& j) { return j.kind == kind; });
}
bool has_cones(const Scene& scene) {
    return std::any_of(scene.joints.begin(), scene.joints.end(), [](const Joint& j) { return j.cone.has_value(); });
}
bool needs_breaking(const Scene& scene) {
    return !scene.breaks_watched &&
           std::any_of(scene.joints.begin(), scene.joints.end(), [](const Joint& j) { return j.break_force > 0.0; });
}

}  // namespace tumble::bench
