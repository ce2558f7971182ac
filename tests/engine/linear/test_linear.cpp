#include "engine/linear/coloring.h"
#include "engine/linear/conjugate_gradient.h"
#include "engine/linear/ordering.h"
#include "engine/parallel/thread_limit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <cstring>
#include <numeric>
#include <random>
#include <set>

using namespace toile;

namespace {

/// Triangles of a grid of squares, each cut by a diagonal.
std::vector<Triangle> grid(int side) {
  std::vector<Triangle> triangles;
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      const int a = r * (side + 1) + c, b = a + 1, d = a + side + 1, e = d + 1;
      triangles.push_back({a, b, d});
      triangles.push_back({b, e, d});
    }
  return triangles;
}

std::vector<int> flattened(const std::vector<Triangle>& triangles) {
  std::vector<int> nodes;
  for (const Triangle& t : triangles) nodes.insert(nodes.end(), t.begin(), t.end());
  return nodes;
}

/// A random positive definite system over the grid, with contacts, as sparse matrices and as one dense matrix.
struct RandomSystem {
  explicit RandomSystem(int side, int contacts = 40) : rows((side + 1) * (side + 1)) {
    std::mt19937 random(11);
    std::normal_distribution<float> normal;
    const std::vector<Triangle> triangles = grid(side);
    const std::vector<int> nodes = flattened(triangles);
    const std::array<BlockMatrix::Stencils, 1> stencils = {{{std::span<const int>(nodes), 3}}};
    matrix = BlockMatrix(rows, stencils);
    dense = Eigen::MatrixXd::Zero(3 * rows, 3 * rows);
    const auto add = [&](int i, int j, const Eigen::Matrix3f& b) {
      matrix.add(matrix.slot(i, j), b);
      dense.block<3, 3>(3 * i, 3 * j) += b.cast<double>();
    };
    for (int i = 0; i < rows; ++i) add(i, i, 0.5f * Eigen::Matrix3f::Identity());
    for (const Triangle& t : triangles) {
      Eigen::Matrix<float, 9, 2> g;
      for (float& value : g.reshaped()) value = normal(random);
      const Eigen::Matrix<float, 9, 9> k = g * g.transpose();
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) add(t[i], t[j], k.block<3, 3>(3 * i, 3 * j));
    }
    std::uniform_int_distribution<int> node(0, rows - 1);
    std::vector<ContactMatrix::Coupling> couplings;
    std::vector<Eigen::Matrix3f> blocks;
    for (int k = 0; k < contacts; ++k) {
      std::set<int> four;
      while (four.size() < 4) four.insert(node(random));
      ContactMatrix::Coupling c;
      c.count = 4;
      std::copy(four.begin(), four.end(), c.nodes.begin());
      c.weights = {1, -0.2f, -0.5f, -0.3f};
      const Eigen::Vector3f n = Eigen::Vector3f(normal(random), normal(random), normal(random));
      couplings.push_back(c);
      blocks.push_back(n * n.transpose());
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
          dense.block<3, 3>(3 * c.nodes[i], 3 * c.nodes[j]) +=
              double(c.weights[i]) * double(c.weights[j]) * blocks.back().cast<double>();
    }
    contact.rebuild(rows, couplings);
    for (int k = 0; k < contacts; ++k) contact.set_block(k, blocks[k]);
    preconditioner = BlockJacobi(rows);
    for (int i = 0; i < rows; ++i)
      preconditioner.set(i, Eigen::Map<const Eigen::Matrix3f>(matrix.values(i)) + contact.diagonal(i));
    right.resize(rows);
    for (Float4& b : right) b = {normal(random), normal(random), normal(random), 0};
  }
  int rows;
  BlockMatrix matrix;
  ContactMatrix contact;
  BlockJacobi preconditioner;
  Eigen::MatrixXd dense;
  NodeVector right;
};

Eigen::VectorXd as_vector(const NodeVector& v) {
  Eigen::VectorXd out(3 * v.size());
  for (std::size_t i = 0; i < v.size(); ++i) out.segment<3>(3 * i) << v[i].x, v[i].y, v[i].z;
  return out;
}

}  // namespace

TEST(BlockMatrix, ProductIsTheDenseOne) {
  RandomSystem s(7);
  NodeVector y(s.rows);
  s.contact.gather(0, s.contact.size(), s.right);
  s.matrix.multiply_rows(0, s.rows, s.right, y);
  s.contact.multiply_add_rows(0, s.rows, y);
  const Eigen::VectorXd expected = s.dense * as_vector(s.right);
  EXPECT_LT((as_vector(y) - expected).norm(), 1e-5 * expected.norm());
  for (const Float4& f : y) EXPECT_EQ(f.w, 0);
}

TEST(BlockMatrix, DiagonalOfContactsIsTheDenseOne) {
  RandomSystem s(4);
  for (int i = 0; i < s.rows; ++i) {
    const Mat3 sum = (Eigen::Map<const Eigen::Matrix3f>(s.matrix.values(i)) + s.contact.diagonal(i)).cast<double>();
    EXPECT_LT((sum - s.dense.block<3, 3>(3 * i, 3 * i)).norm(), 1e-5 * sum.norm());
  }
}

TEST(BlockMatrix, ProductsOfRowsAreAdded) {
  const std::vector<int> nodes = {0, 1, 2, 3, 4, 5};
  const std::array<BlockMatrix::Stencils, 1> stencils = {{{std::span<const int>(nodes), 6}}};
  BlockMatrix matrix(6, stencils);
  std::array<Eigen::Matrix3f, 6> rows;
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 9; ++k) rows[i](k / 3, k % 3) = static_cast<float>((7 * i + 5 * k) % 11 - 4);
  std::array<int, 36> slots;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) slots[6 * i + j] = matrix.slot(i, j);
  matrix.add_products(slots, rows);
  matrix.add_products(slots, rows);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      EXPECT_EQ(Eigen::Matrix3f(Eigen::Map<const Eigen::Matrix3f>(matrix.values(slots[6 * i + j]))),
                2 * rows[i].transpose() * rows[j]);
}

TEST(BlockMatrix, SlotOutsideTheTopologyThrows) {
  RandomSystem s(4);
  EXPECT_THROW(s.matrix.slot(0, s.rows - 1), std::out_of_range);
}

TEST(ConjugateGradient, AgreesWithDenseSolve) {
  RandomSystem s(8);
  NodeVector x;
  ConjugateGradient cg;
  const CgOutcome outcome = cg.solve(s.matrix, s.contact, s.preconditioner, s.right, 1e-6, 2000, x);
  const Eigen::VectorXd expected = s.dense.ldlt().solve(as_vector(s.right));
  EXPECT_LT(outcome.relative_residual, 1e-6);
  EXPECT_LT((as_vector(x) - expected).norm(), 1e-4 * expected.norm());
}

TEST(RankOneMatrix, JoinsTheSystemAsItsDenseSelf) {
  RandomSystem s(6);
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  RankOneMatrix wide;
  const std::vector<std::vector<int>> nodes = {{0, 3, 9, 20, 41, 48}, {40, 41, 5}};
  wide.rebuild(s.rows, nodes);
  ASSERT_EQ(wide.size(), 2);
  for (int k = 0; k < 2; ++k) {
    std::vector<Eigen::Vector3f> parts;
    Eigen::VectorXd g = Eigen::VectorXd::Zero(3 * s.rows);
    for (int node : nodes[k]) {
      parts.emplace_back(3 * normal(random), 3 * normal(random), 3 * normal(random));
      g.segment<3>(3 * node) = parts.back().cast<double>();
    }
    wide.set(k, parts);
    s.dense += g * g.transpose();
  }
  for (int i = 0; i < s.rows; ++i) {
    const Eigen::Matrix3f diagonal =
        Eigen::Map<const Eigen::Matrix3f>(s.matrix.values(i)) + s.contact.diagonal(i) + wide.diagonal(i);
    EXPECT_LT((diagonal.cast<double>() - s.dense.block<3, 3>(3 * i, 3 * i)).norm(), 1e-4);
    s.preconditioner.set(i, diagonal);
  }
  NodeVector x;
  const std::array<RankOneMatrix*, 1> parts = {&wide};
  const CgOutcome outcome =
      ConjugateGradient().solve(s.matrix, s.contact, s.preconditioner, s.right, 1e-6, 2000, x, parts);
  EXPECT_LT(outcome.relative_residual, 1e-6);
  const Eigen::VectorXd expected = s.dense.ldlt().solve(as_vector(s.right));
  EXPECT_LT((as_vector(x) - expected).norm(), 1e-3 * expected.norm());
}

TEST(ConjugateGradient, HeldNodesStayAndTheRestIsTheReducedSystem) {
  RandomSystem s(6);
  std::vector<int> free;
  for (int i = 0; i < s.rows; ++i) {
    if (i % 5 == 0)
      s.preconditioner.hold(i);
    else
      for (int k = 0; k < 3; ++k) free.push_back(3 * i + k);
  }
  NodeVector x;
  ConjugateGradient().solve(s.matrix, s.contact, s.preconditioner, s.right, 1e-6, 2000, x);
  const Eigen::VectorXd expected = s.dense(free, free).ldlt().solve(Eigen::VectorXd(as_vector(s.right)(free)));
  EXPECT_LT((as_vector(x)(free) - expected).norm(), 1e-4 * expected.norm());
  for (int i = 0; i < s.rows; i += 5) EXPECT_EQ(as_vector(x).segment<3>(3 * i).norm(), 0);
}

TEST(ConjugateGradient, StopsAtItsLimitsAndOnZero) {
  RandomSystem s(8);
  NodeVector x;
  ConjugateGradient cg;
  EXPECT_EQ(cg.solve(s.matrix, s.contact, s.preconditioner, s.right, 1e-12, 3, x).iterations, 3);
  const NodeVector zero(s.rows);
  EXPECT_EQ(cg.solve(s.matrix, s.contact, s.preconditioner, zero, 1e-2, 100, x).iterations, 0);
  EXPECT_EQ(as_vector(x).norm(), 0);
}

TEST(ConjugateGradient, AGoodGuessSavesIterationsAndABadOneIsForgotten) {
  RandomSystem s(8);
  ConjugateGradient cg;
  const auto solve = [&](NodeVector x, double tolerance) {
    return std::pair(cg.solve(s.matrix, s.contact, s.preconditioner, s.right, tolerance, 2000, x), x);
  };
  const auto [cold, solution] = solve({}, 1e-5);
  NodeVector near = solution, far = solution;
  for (Float4& f : near) f.x *= 1.001f;
  for (Float4& f : far) f = {100 * f.x + 50, -80 * f.y, 3, 0};
  const auto [warm, warm_solution] = solve(near, 1e-5);
  EXPECT_LT(warm.iterations, cold.iterations);
  EXPECT_LT((as_vector(warm_solution) - as_vector(solution)).norm(), 1e-3 * as_vector(solution).norm());
  const auto [forgotten, same] = solve(far, 1e-5);
  EXPECT_EQ(forgotten.iterations, cold.iterations);
  EXPECT_EQ(as_vector(same), as_vector(solution));
  EXPECT_EQ(solve(solution, 1e-4).first.iterations, 0);
}

TEST(ConjugateGradient, SameBitsOnAnyNumberOfThreads) {
  RandomSystem s(60, 5000);
  ConjugateGradient cg;
  NodeVector reference;
  {
    ThreadLimit one(1);
    cg.solve(s.matrix, s.contact, s.preconditioner, s.right, 1e-5, 200, reference);
  }
  for (int threads : {2, 3, 4}) {
    ThreadLimit limit(threads);
    NodeVector x;
    cg.solve(s.matrix, s.contact, s.preconditioner, s.right, 1e-5, 200, x);
    EXPECT_EQ(std::memcmp(x.data(), reference.data(), x.size() * sizeof(Float4)), 0) << threads;
  }
}

TEST(Coloring, ClustersOfAColourShareNoNode) {
  const std::vector<int> nodes = flattened(grid(20));
  for (int cluster : {1, 7, 32}) {
    const ColoredStencils colored = color_stencils(21 * 21, nodes, 3, cluster);
    std::vector<int> seen(nodes.size() / 3, 0);
    for (int stencil : colored.order) ++seen[stencil];
    EXPECT_EQ(seen, std::vector<int>(nodes.size() / 3, 1));
    for (int color = 0; color < colored.colors(); ++color) {
      std::vector<int> owner(21 * 21, -1);
      for (int c = colored.color_start[color]; c < colored.color_start[color + 1]; ++c)
        for (int k = colored.cluster_start[c]; k < colored.cluster_start[c + 1]; ++k)
          for (int i = 0; i < 3; ++i) {
            int& who = owner[nodes[3 * colored.order[k] + i]];
            EXPECT_TRUE(who < 0 || who == c);
            who = c;
          }
    }
    EXPECT_LT(colored.colors(), 20);
  }
}

TEST(Ordering, IsAPermutationThatNarrowsTheBand) {
  // A grid whose vertices were numbered at random.
  const int side = 20, count = (side + 1) * (side + 1);
  std::vector<int> shuffled(count);
  std::iota(shuffled.begin(), shuffled.end(), 0);
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(5));
  std::vector<Triangle> triangles = grid(side);
  for (Triangle& t : triangles)
    for (int& v : t) v = shuffled[v];
  const auto bandwidth = [&](const std::vector<int>& place) {
    int widest = 0;
    for (const Triangle& t : triangles)
      for (int c = 0; c < 3; ++c) widest = std::max(widest, std::abs(place[t[c]] - place[t[(c + 1) % 3]]));
    return widest;
  };
  const std::vector<int> order = reverse_cuthill_mckee(count, triangles), place = inverse_permutation(order);
  std::set<int> all(order.begin(), order.end());
  EXPECT_EQ(static_cast<int>(all.size()), count);
  for (int i = 0; i < count; ++i) EXPECT_EQ(order[place[i]], i);
  std::vector<int> identity(count);
  std::iota(identity.begin(), identity.end(), 0);
  EXPECT_GT(bandwidth(identity), 200);
  EXPECT_LT(bandwidth(place), 60);
}

TEST(Ordering, CountsLooseVertices) {
  EXPECT_EQ(reverse_cuthill_mckee(5, {{0, 1, 2}}).size(), 5u);
  EXPECT_TRUE(reverse_cuthill_mckee(0, {}).empty());
}
