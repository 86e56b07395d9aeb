// Resting contact and friction of one island to the last digit, for islands that sweeps converge too slowly on: tall
// stacks, heavy on light, and the few bodies of a simple scene.
//
// With u the velocities at the step's end, u* those with the forces alone, and M the masses, contact asks for
//     M (u - u*) = J^T f,   0 <= f_n  perp  J_n u >= b,   friction against the slip within Coulomb's disc mu f_n,
// b = -s/h for points s > 0 apart, 0 at the surface, the speed after a collision. Solved as an augmented Lagrangian: with
// an estimate e of the impulses and a compliance R, u is the minimum of the convex function
//     (u - u*)^T M (u - u*)/2 + sum R/2 [e + (b - J u)/R]^2  over the contacts where the bracket is positive
// with, for friction, the bracket's distance kept inside the disc; f = bracket is the next estimate, and friction's limits
// follow f_n from round to round (Alart and Curnier 1991). Each minimum is found by Newton's method with line search
// (semismooth; its matrix M + J^T J/R over the active rows is factored by block_cholesky.h). The estimates of the last
// step make most solves of a resting island one evaluation.
//
// Lengths are measured in the island's mean radius, so that turning and moving weigh alike.
#pragma once

#include "sim/contact/block_cholesky.h"
#include "sim/contact/soft_solver.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class DirectSolver {
public:
    /// Solves the island and changes bodies and manifolds as ContactProblem says. False, and nothing changed, when no
    /// solution was found.
    bool solve(const ContactProblem& problem, std::span<const std::uint32_t> bodies, std::span<const std::uint32_t> manifolds);

    /// Block operations of a factorisation for this island.
    std::size_t factor_work(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                            std::span<const std::uint32_t> manifolds);
    /// Factorisations that the last solve took.
    int factorisations() const { return factorisations_; }

private:
    static constexpr int none = -1;
    struct Row {                        // of J, and what is known along it
        double on_a[6] = {}, on_b[6] = {};
        double offset = 0.0;            // m/s, of bodies whose velocity is given
        double target = 0.0;            // m/s: b
        double estimate = 0.0, impulse = 0.0;   // N s: e and f
        double speed = 0.0, change = 0.0;       // J u + offset, J du
    };
    struct Patch {
        int a = none, b = none, pair = none, count = 0;
        std::uint32_t manifold = 0;
        Row normal[4], friction[2], twist;
        double lever[4] = {}, overlap[4] = {};  // m
        double coefficient = 0.0, limit = 0.0, twist_limit = 0.0, size = 0.0;
        Vec3 tangent_1 = Vec3::Zero();
        std::uint8_t source[4] = {};
        ContactPatch geometry;
    };
    struct Weights {                    // second derivatives of a patch's terms
        double normal[4] = {}, f11 = 0.0, f12 = 0.0, f22 = 0.0, twist = 0.0;
    };

    void load_bodies(const ContactProblem& problem, std::span<const std::uint32_t> bodies);
    void load_patches(const ContactProblem& problem, std::span<const std::uint32_t> bodies, std::span<const std::uint32_t> manifolds);
    void structure(const ContactProblem& problem, std::span<const std::uint32_t> bodies, std::span<const std::uint32_t> manifolds);
    void set_row(Row& row, const Vec3& direction, const Vec3& arm_a, const Vec3& arm_b, const Patch& patch, const Body& a, const Body& b) const;
    void set_twist(Row& row, const Vec3& normal, const Patch& patch, const Body& a, const Body& b) const;
    void start();
    void set_limits(Patch& patch);
    bool minimise(int most_steps);
    void evaluate_speeds();
    void evaluate(Patch& patch, double along, Weights* weights) const;
    double gradient(std::vector<double>& g);
    double slope(double along, double mass_slope, double mass_curvature);
    double line_search(double slope_0, double mass_slope, double mass_curvature);
    bool factor(bool pushing);
    double objective(const std::vector<double>& u);
    double dot(const Patch& patch, const Row& row, const std::vector<double>& u) const;
    void add(const Patch& patch, const Row& row, double amount, std::vector<double>& to) const;
    double kinetic_energy(const std::vector<double>& u) const;
    void mass_times(const std::vector<double>& u, std::vector<double>& result) const;
    bool admissible() const;
    bool push_out(double h);
    void store(const ContactProblem& problem, std::span<const std::uint32_t> bodies, bool pushed);

    template <class Visit>
    static void each_row(Patch& patch, Visit&& visit) {
        for (int i = 0; i < patch.count; ++i) visit(patch.normal[i]);
        visit(patch.friction[0]);
        visit(patch.friction[1]);
        if (patch.count > 1) visit(patch.twist);
    }

    struct Mass {
        double mass = 0.0;      // kg
        Mat3 inertia = Mat3::Zero(), inverse_inertia = Mat3::Zero();   // over the squared length
    };
    double length_ = 1.0, total_mass_ = 0.0, speed_scale_ = 0.0, fastest_ = 0.0;   // m, kg, m/s, m/s
    double compliance_ = 0.0, friction_compliance_ = 0.0;          // 1/kg: R
    bool driven_ = false;            // something given moves: energy may come in
    int factorisations_ = 0;
    std::vector<Mass> masses_;
    std::vector<double> free_, velocity_, step_, gradient_, scratch_, push_, kept_;   // u*, u, du, ...; six a body
    std::vector<Patch> patches_;
    std::vector<BlockCholesky::Pair> pairs_;
    BlockCholesky matrix_;
};

}  // namespace tumble
