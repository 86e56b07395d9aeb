// The factorization by blocks against Eigen's of the same matrix, dense.
#include "sim/math/block_cholesky.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace tumble::block_cholesky_test {
using namespace tumble::testing;

namespace {

using Pairs = std::vector<BlockCholesky::Pair>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Matrix6 random_block(Random& random, double size) {
    Matrix6 m;
    for (int r = 0; r < 6; ++r)
        for (int c = 0; c < 6; ++c) m(r, c) = random(-size, size);
    return m;
}

/// M + sum J^T J over the pairs, as in the direct solver. A pair that occurs twice adds to one block.
Eigen::MatrixXd dense_matrix(Random& random, std::size_t bodies, const Pairs& pairs, double stiffness) {
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(Eigen::Index(6 * bodies), Eigen::Index(6 * bodies));
    for (std::size_t i = 0; i < bodies; ++i) {
        const Matrix6 root = random_block(random, 1.0);
        h.block<6, 6>(Eigen::Index(6 * i), Eigen::Index(6 * i)) = root.transpose() * root + Matrix6::Identity();
    }
    for (const auto& p : pairs) {
        const auto i = Eigen::Index(6 * p.i), j = Eigen::Index(6 * p.j);
        const Matrix6 on_i = random_block(random, stiffness), on_j = random_block(random, stiffness);
        h.block<6, 6>(i, i) += on_i.transpose() * on_i;
        h.block<6, 6>(j, j) += on_j.transpose() * on_j;
        h.block<6, 6>(i, j) += on_i.transpose() * on_j;
        h.block<6, 6>(j, i) += on_j.transpose() * on_i;
    }
    return h;
}

void fill(BlockCholesky& blocks, const Eigen::MatrixXd& h, std::size_t bodies, const Pairs& pairs) {
    blocks.set_zero();
    for (std::size_t i = 0; i < bodies; ++i)
        for (int r = 0; r < 6; ++r)
            for (int c = 0; c < 6; ++c)
                blocks.diagonal(i).row[r][c] = h(Eigen::Index(6 * i) + r, Eigen::Index(6 * i) + c);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const auto of_rows = Eigen::Index(6 * (blocks.transposed(k) ? pairs[k].j : pairs[k].i));
        const auto of_columns = Eigen::Index(6 * (blocks.transposed(k) ? pairs[k].i : pairs[k].j));
        for (int r = 0; r < 6; ++r)
            for (int c = 0; c < 6; ++c) blocks.coupling(k).row[r][c] = h(of_rows + r, of_columns + c);
    }
}

void expect_solves(BlockCholesky& blocks, const Eigen::MatrixXd& h, std::size_t bodies, const Pairs& pairs,
                   Random& random) {
    fill(blocks, h, bodies, pairs);
    ASSERT_TRUE(blocks.factor());
    std::vector<double> x(6 * bodies);
    Eigen::VectorXd g(Eigen::Index(6 * bodies));
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = g[Eigen::Index(k)] = random(-1.0, 1.0);
    blocks.solve(x);
    const Eigen::VectorXd expected = h.llt().solve(g);
    const Eigen::VectorXd found = Eigen::Map<const Eigen::VectorXd>(x.data(), g.size());
    EXPECT_LE((found - expected).norm(), 1e-10 * expected.norm()) << bodies << " bodies, " << pairs.size() << " pairs";
    EXPECT_LE((h * found - g).norm(), 1e-10 * g.norm());
}

Pairs random_pairs(Random& random, std::size_t bodies, int count) {
    Pairs pairs;
    while (int(pairs.size()) < count) {
        const auto i = std::uint32_t(random.below(int(bodies))), j = std::uint32_t(random.below(int(bodies)));
        if (i != j) pairs.push_back({i, j});
    }
    return pairs;
}

}  // namespace

TEST(BlockCholesky, AgreesWithADenseFactorization) {
    Random random(1);
    BlockCholesky blocks;  // shared by all graphs: an analysis must not affect the next
    for (int trial = 0; trial < trials(200); ++trial) {
        const std::size_t bodies = 2 + std::size_t(random.below(20));
        const Pairs pairs = random_pairs(random, bodies, random.below(int(3 * bodies)));
        blocks.analyze(bodies, pairs);
        expect_solves(blocks, dense_matrix(random, bodies, pairs, 1.0), bodies, pairs, random);
    }
}

TEST(BlockCholesky, GraphsOfEveryKind) {
    Random random(2);
    constexpr std::uint32_t n = 16;
    Pairs chain, star, all, ring, twice;
    for (std::uint32_t i = 0; i + 1 < n; ++i) chain.push_back({i, i + 1});
    for (std::uint32_t i = 1; i < n; ++i) star.push_back({i, 0});
    for (std::uint32_t i = 0; i < n; ++i) {
        ring.push_back({(i + 1) % n, i});
        for (std::uint32_t j = 0; j < i; ++j) all.push_back({i, j});
    }
    twice = {{3, 5}, {5, 3}, {3, 5}, {0, 3}};
    for (const Pairs& pairs : {Pairs{}, chain, star, ring, all, twice}) {
        BlockCholesky blocks;
        blocks.analyze(n, pairs);
        expect_solves(blocks, dense_matrix(random, n, pairs, 10.0), n, pairs, random);
    }
}

// A tree has no fill: per body one block on the diagonal and one beside it, each eliminated with one product.
TEST(BlockCholesky, ChainsAndStarsHaveNoFill) {
    for (const bool star : {false, true}) {
        constexpr std::uint32_t n = 50;
        Pairs pairs;
        for (std::uint32_t i = 1; i < n; ++i) pairs.push_back({star ? 0 : i - 1, i});
        BlockCholesky blocks;
        blocks.analyze(n, pairs);
        EXPECT_EQ(blocks.work(), n + 2 * (n - 1)) << star;
    }
}

TEST(BlockCholesky, ReportsAMatrixThatIsNotPositive) {
    Random random(3);
    const Pairs pairs = {{0, 1}, {1, 2}};
    Eigen::MatrixXd h = dense_matrix(random, 3, pairs, 1.0);
    BlockCholesky blocks;
    blocks.analyze(3, pairs);
    fill(blocks, h, 3, pairs);
    EXPECT_TRUE(blocks.factor());
    h.diagonal().array() -= 1.01 * h.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
    fill(blocks, h, 3, pairs);
    EXPECT_FALSE(blocks.factor());
    h(4, 4) = std::numeric_limits<double>::quiet_NaN();
    fill(blocks, h, 3, pairs);
    EXPECT_FALSE(blocks.factor());
}

}  // namespace tumble::block_cholesky_test
