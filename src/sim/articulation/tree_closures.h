// Closure rows of a spanning tree: cut joints, distances and gears as forms G u = 0 of its speeds. Their forces follow
// from M u' = f + G^T l and G u' = -G' u (Featherstone 2008, section 8.4): G M^-1 G^T is dense, and its columns are
// sweeps. Springs of distance joints are forces between the same points.
#pragma once

#include "sim/articulation/forward_dynamics.h"
#include "sim/articulation/tree_account.h"

#include <span>
#include <vector>

namespace tumble {

class TreeClosures {
public:
    /// Finds the closure rows at the present poses. Returns false where joints are too wide open, where a rope is taut,
    /// or where steps of `stage` s do not resolve a spring (0: steps of any length).
    bool find(const JointTree& tree, const TreeStep& step, double stage);
    bool empty() const { return parts_.empty(); }
    bool any_rows() const { return !rows_.empty(); }
    std::size_t rows() const { return rows_.size(); }
    std::size_t parts() const { return parts_.size(); }
    double fastest() const { return fastest_; }  // 1/s, of springs
    /// Numbers of the sums of a part: impulse, angular impulse, moment about the origin of the bodies' coordinates and
    /// about that of the falling frame, works on both bodies, heat of a damper.
    static constexpr int sums = 15;

    /// Rows, and forces of springs, at the positions and speeds of the dynamics and coordinates q.
    void linearize(const ForwardDynamics& dynamics, const double* q);
    /// The same with the forms G.
    void linearize_forms(const ForwardDynamics& dynamics, const double* q) {
        linearize(dynamics, q);
        fill(dynamics);
    }
    /// Adds the forces of the springs.
    void drive(ForwardDynamics& dynamics);
    /// Instead of ForwardDynamics::accelerate(), and with `same_places` of respond(): with forces that keep the rows.
    void accelerate(ForwardDynamics& dynamics, const Vec3& base, const double* q, double* rates,
                    bool same_places = false);
    /// The matrices at the positions of the dynamics, after ForwardDynamics::accelerate().
    void prepare(ForwardDynamics& dynamics, const double* q);
    /// Compliance of the rows, as a share of the largest, where that is more than rounding demands.
    void set_compliance(double share) { compliance_ = share; }

    /// Largest error of the rows of linearize(), in sizes of their joints; of a cut joint, rad or sizes.
    double error() const;
    /// The error that is rounding, in the same unit.
    double place_rounding() const;
    /// G u, and errors, as sides of the equations; in the length's unit.
    std::vector<double> speeds_of(const double* u) const;
    std::vector<double> errors() const;
    /// Impulses l with G M^-1 G^T l = side, by the matrices of prepare(); or with G of the other's linearize_forms().
    std::vector<double> solve(const std::vector<double>& side) const { return solve_by(matrix_, side); }
    std::vector<double> solve(const std::vector<double>& side, const TreeClosures& forms) const;
    /// The same impulses with equal loads on redundant rows.
    std::vector<double> shared(const std::vector<double>& l) const;
    /// l^T G M^-1 G^T l / 2, J.
    double energy_of(const std::vector<double>& l) const;
    /// Adds M^-1 G^T l, by the matrices of prepare().
    void add_response(const std::vector<double>& l, double* u) const;
    /// True if the step began near a singular position: a row depends on others but for this share.
    bool nearly_dependent(double share) const;

    /// Forces of the rows are those of l; `springs`: those of springs stay, otherwise there are none.
    void give(const std::vector<double>& l, bool springs);
    void apply(ForwardDynamics& dynamics) const;
    /// Adds the forces of all parts to those on the bodies.
    void add_to(const ForwardDynamics& dynamics, std::span<Wrench> wrenches) const;
    /// Adds the forces of all parts, times h, to their sums; at time t (s, in the step) and the velocities of the
    /// dynamics.
    void add_sums(const ForwardDynamics& dynamics, const FallingFrame& frame, double t, double h, double* to) const;
    /// Adds the sums to the impulses by body.
    void add_impulses(const double* sums, std::vector<AppliedImpulse>& list) const;

    /// Load of a cut joint over its strength.
    double load_of(int joint) const;
    /// Gives the cut joints their forces, impulses and accounts, at the positions of the bodies. Returns false where a
    /// limit is violated or a joint is loaded well beyond its strength.
    bool finish(const TreeStep& step, const double* sums) const;

private:
    struct Side {
        int node = TreeNode::ground, body = TreeNode::no_body;
        JointSide pose;            // of the ground, from the tree's origin
        Vec3 anchor, point, rate;  // in the body frame; m; m/s
        Quat frame;                // joint frame to body frame
        std::vector<int> path;     // nodes up to the common one
    };
    struct Part {  // of a cut joint, or one of the two joints of a gear
        int joint = 0, of = 0;
        bool gear = false, second = false, spring = false;
        double factor = 1.0;                                // of a gear
        int node = 0;                                       // of its coordinate
        double stiffness = 0.0, damping = 0.0, rest = 0.0;  // N/m, N s/m, m: of a spring along a distance
        double heat = 0.0;                                  // W
        double stored = 0.0;                                // J, of the spring at the start
        bool turns = false;                                 // of a gear
        Vec3 axis = Vec3::Zero();
        Side a, b;
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // on B, at its anchor
    };
    struct Row {
        int part = 0;
        std::uint8_t coordinate = 0;
        bool turns = false;
        double unit = 1.0, size = 1.0, start = 0.0;  // m or 1; m or rad; of a gear: error at q = 0
        Vec3 direction = Vec3::Zero(), x = Vec3::Zero(), y = Vec3::Zero();
        double sign = 0.0;  // of x . y; 0: another row
        double error = 0.0;
    };
    JointSide pose_of(const Side& side, const ForwardDynamics& dynamics) const;
    Side side_at(std::uint32_t body, const Vec3& anchor, const Quat& frame, const TreeStep& step) const;
    bool add_joint(int index, const TreeStep& step, double stage);
    void add_gear(int index, const TreeStep& step);
    void find_paths(Part& part) const;
    void linearize_part(Part& part, const ForwardDynamics& dynamics);
    double acceleration_of(const Row& row, const ForwardDynamics& dynamics, const double* rates) const;
    void add_side(const Side& side, const Row& row, const ForwardDynamics& dynamics, double sign, double* form) const;
    void fill(const ForwardDynamics& dynamics);
    void choose();
    void factor();
    std::vector<double> solve_by(const std::vector<double>& matrix, const std::vector<double>& side) const;
    std::vector<double> solve_once(std::vector<double> side) const;

    const JointTree* tree_ = nullptr;
    std::span<Joint* const> joints_;
    double length_ = 1.0, fastest_ = 0.0, compliance_ = 0.0;
    std::size_t speeds_ = 0;
    std::vector<Part> parts_;
    std::vector<Row> rows_;
    // G, M^-1 G^T, G M^-1 G^T, its factor; by row, its part that does not depend on others.
    std::vector<double> forms_, columns_, matrix_, factor_, pivots_;
    std::vector<char> used_;  // by row: does not depend on others
};

}  // namespace tumble
