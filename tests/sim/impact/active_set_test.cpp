// The projection onto the cone of nonapproaching velocities, checked by its optimality conditions.
#include "sim/impact/active_set.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::active_set_test {
using namespace tumble::testing;

namespace {

Vec6 random_six(Random& random) {
    Vec6 v;
    v << random.vector(1.0), random.vector(1.0);
    return v;
}

struct Problem {
    std::size_t bodies = 0;
    std::vector<VelocityRow> rows;
    std::vector<ActiveSet::Demand> demands;

    void add(VelocityRow row, double value) {
        const double length = std::sqrt(row.squared_norm());
        row.on_a /= length;
        row.on_b /= length;
        demands.push_back({std::uint32_t(rows.size()), value, 1e-13});
        rows.push_back(row);
    }
};

// Half the rows are sums of earlier ones over the same bodies: dependent.
Problem random_problem(Random& random, int bodies, int count) {
    Problem p;
    p.bodies = std::size_t(bodies);
    Eigen::VectorXd y(6 * bodies);
    for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = random(-1.0, 1.0);
    for (int i = 0; i < count; ++i) {
        VelocityRow row;
        row.a = std::uint32_t(random.below(bodies));
        row.on_a = random_six(random);
        if (random.below(3)) {
            row.b = std::uint32_t(random.below(bodies));
            row.on_b = random_six(random);
            if (row.b == row.a) row.b = VelocityRow::none, row.on_b.setZero();
        }
        if (i > 0 && random.below(2)) row = p.rows[std::size_t(random.below(i))];
        p.add(row, 0.0);
        p.demands.back().value = p.rows.back().dot(y);
    }
    return p;
}

Eigen::VectorXd change(const Problem& p, const std::vector<double>& lambda) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(6 * Eigen::Index(p.bodies));
    for (std::size_t i = 0; i < lambda.size(); ++i) p.rows[p.demands[i].row].add_to(d, lambda[i]);
    return d;
}

// Karush, Kuhn, Tucker: lambda >= 0, every demand met, and with equality where lambda > 0. Necessary and sufficient.
void expect_optimal(const Problem& p, const std::vector<double>& lambda, double tolerance) {
    const Eigen::VectorXd d = change(p, lambda);
    for (std::size_t i = 0; i < lambda.size(); ++i) {
        const double value = p.demands[i].value + p.rows[p.demands[i].row].dot(d);
        EXPECT_GE(lambda[i], 0.0);
        EXPECT_GE(value, -tolerance);
        if (lambda[i] > 1e-12) {
            EXPECT_LE(value, tolerance);
        }
    }
}

}  // namespace

TEST(ActiveSet, MeetsTheOptimalityConditions) {
    Random random(71);
    int met = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const Problem p = random_problem(random, 1 + random.below(8), 1 + random.below(24));
        std::vector<double> lambda;
        ActiveSet projection(p.rows, p.bodies);
        // The demands come from a velocity: standing still meets them all.
        ASSERT_TRUE(projection.solve(p.demands, lambda)) << trial;
        expect_optimal(p, lambda, 1e-11);
        ++met;
    }
    EXPECT_EQ(met, 1000);
}

// One ActiveSet serves for one set after another.
TEST(ActiveSet, KeepsNoStateBetweenSolves) {
    Random random(72);
    const Problem p = random_problem(random, 6, 20);
    ActiveSet used(p.rows, p.bodies);
    std::vector<double> lambda, fresh;
    for (std::size_t first = 0; first < 15; ++first) {
        const std::vector<ActiveSet::Demand> part(p.demands.begin() + std::ptrdiff_t(first),
                                                  p.demands.begin() + std::ptrdiff_t(first) + 5);
        used.solve(part, lambda);
        ActiveSet(p.rows, p.bodies).solve(part, fresh);
        EXPECT_EQ(lambda, fresh);
    }
}

// The four corners of a flat box: rank three, and each carries a quarter.
TEST(ActiveSet, SpreadsOverDependentRows) {
    Problem p;
    p.bodies = 1;
    for (int i = 0; i < 4; ++i) {
        VelocityRow row;
        row.a = 0;
        row.on_a << 0.0, 1.0, 0.0, (i & 1 ? 0.7 : -0.7), 0.0, (i & 2 ? 0.4 : -0.4);
        p.add(row, -1.0);
    }
    std::vector<double> lambda;
    ASSERT_TRUE(ActiveSet(p.rows, p.bodies).solve(p.demands, lambda));
    const double expected = 0.25 * (1.0 + 0.49 + 0.16);  // of rows of length sqrt(1.65): 4 lambda / 1.65 = 1
    for (const double l : lambda) EXPECT_NEAR(l, expected, 1e-15);
    expect_optimal(p, lambda, 1e-15);
}

TEST(ActiveSet, ReportsContradictoryDemands) {
    Problem p;
    p.bodies = 1;
    VelocityRow row;
    row.a = 0;
    row.on_a << 1, 0, 0, 0, 0, 0;
    p.add(row, -1.0);
    row.on_a = -row.on_a;
    p.add(row, -0.5);
    row.on_a << 0, 1, 0, 0, 0, 0;
    p.add(row, -2.0);
    std::vector<double> lambda;
    EXPECT_FALSE(ActiveSet(p.rows, p.bodies).solve(p.demands, lambda));
    EXPECT_NEAR(p.demands[2].value + p.rows[2].dot(change(p, lambda)), 0.0, 1e-15);  // the compatible demand is met
    for (const double l : lambda) EXPECT_LT(l, 10.0);
}

// Heavy and light bodies in a row: rows nearly opposite, 1e-4 apart.
TEST(ActiveSet, NearlyOppositeRows) {
    Problem p;
    p.bodies = 2;
    VelocityRow floor, heavy;
    floor.b = 0;
    floor.on_b << 0, 1, 0, 0, 0, 0;
    heavy.a = 0;
    heavy.b = 1;
    heavy.on_a << 0, -1, 0, 0, 0, 0;
    heavy.on_b << 0, 1e-4, 0, 0, 0, 0;
    p.add(floor, 0.0);
    p.add(heavy, -1.0);
    std::vector<double> lambda;
    ASSERT_TRUE(ActiveSet(p.rows, p.bodies).solve(p.demands, lambda));
    expect_optimal(p, lambda, 1e-12);
    EXPECT_NEAR(lambda[1] * 1e-8, 1.0, 1e-7);
}

// Sets too large for the exact solution: approximately the same.
TEST(ActiveSet, SweepsApproximateTheExactSolution) {
    Random random(73);
    Problem p = random_problem(random, 200, 100);
    std::vector<double> lambda;
    ActiveSet(p.rows, p.bodies, 99).solve(p.demands, lambda);
    expect_optimal(p, lambda, 1e-6);
}

// Components that no body connects are solved apart: the cost is that of the components, and each gets its own
// solution.
TEST(ActiveSet, ComponentsAreSolvedSeparately) {
    Random random(7);
    Problem all;
    std::vector<Problem> parts;
    double squares = 0.0;
    for (int k = 0; k < 60; ++k) {
        // One body each, so that the component is connected.
        Problem part = random_problem(random, 1, 1 + random.below(4));
        squares += double(part.rows.size() * part.rows.size());
        for (std::size_t i = 0; i < part.rows.size(); ++i) {
            VelocityRow row = part.rows[i];
            for (std::uint32_t* body : {&row.a, &row.b})
                if (*body != VelocityRow::none) *body += std::uint32_t(all.bodies);
            all.demands.push_back({std::uint32_t(all.rows.size()), part.demands[i].value, part.demands[i].tolerance});
            all.rows.push_back(row);
        }
        all.bodies += part.bodies;
        parts.push_back(part);
    }
    std::vector<double> lambda, alone;
    ActiveSet together(all.rows, all.bodies, 8);
    together.solve(all.demands, lambda);
    EXPECT_EQ(together.work(), squares);
    std::size_t next = 0;
    for (const Problem& part : parts) {
        ActiveSet(part.rows, part.bodies, 8).solve(part.demands, alone);
        for (const double expected : alone) EXPECT_EQ(lambda[next++], expected);
    }
    expect_optimal(all, lambda, 1e-11);
}

}  // namespace tumble::active_set_test
