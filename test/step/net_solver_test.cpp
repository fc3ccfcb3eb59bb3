// SPDX-License-Identifier: BSD-3-Clause
//
// The weft's links and the solve over all taut ones: what the conjugate gradients give is what a dense solve gives,
// strings only pull, slack cloth is not touched.
#include "step/net_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "parts/rail/rail.h"
#include "step/node_inertia.h"
#include "step/warp_solver.h"
#include "step/weft_links.h"
#include "testing.h"

namespace curtain {
namespace {

Scene sceneOf(int rows, int columns, PinKind pins, bool closed) {
  Scene scene;
  scene.cloth.rows = rows;
  scene.cloth.columns = columns;
  scene.cloth.closed = closed;
  scene.pins.kind = pins;
  return scene;
}

struct Net {
  explicit Net(const Scene& scene, int threads = 1)
      : pattern(makePattern(scene)),
        state(makeInitialState(scene, pattern)),
        workers(threads),
        inertia(pattern),
        rail(scene, pattern),
        guided(rail.any() ? &rail : nullptr),
        solver(pattern, workers) {
    force.assign(pattern.grid.size(), 0.0);
    warp.assign(pattern.grid);
    weft.assign(pattern.grid);
    violation.assign(pattern.grid.size(), 0.0);
    active = compliance = change = violation;
    setDirections();
  }
  void setDirections() {
    setWarpDirections(pattern.grid, state.position, warp.direction);
    for (int i = 0; i < pattern.grid.rows; ++i) setWeftDirections(pattern.grid, i, state.position, weft.direction);
    if (rail.any()) rail.begin({state, force, nullptr, nullptr, 1.0, 1.0}, state, inertia.masses());
    solver.begin(state.position, inertia.masses(), guided);
  }
  void shake(double size, unsigned seed) { curtain_test::shake(pattern, size, seed, state.position); }
  LineSolve line() { return {pattern, inertia.masses(), weft, state.position}; }
  // a^T W b at a node.
  double through(std::size_t n, const Vec3& a, const Vec3& b) const {
    const auto stride = static_cast<std::size_t>(pattern.grid.stride);
    const GuidedNode* const node =
        guided == nullptr ? nullptr : guided->at(static_cast<int>(n / stride), static_cast<int>(n % stride));
    return inertia.masses()[n] * (node == nullptr ? a.dot(b) : a.dot(node->freedom * b));
  }
  double measure() {
    double worst = 0.0;
    for (int i = 0; i < pattern.grid.rows; ++i)
      worst = std::max(worst, measureWeft(line(), i, {violation, active, compliance}));
    return worst;
  }
  void take() {
    for (int i = 0; i < pattern.grid.rows; ++i) {
      applyWeftChange(weft, pattern.grid, i, change);
      pullWeft(line(), i, change);
    }
  }
  std::size_t left(int i, int j) const { return pattern.grid.index(i, j > 0 ? j - 1 : pattern.grid.columns - 1); }

  ClothPattern pattern;
  ClothState state;
  Workers workers;
  NodeInertia inertia;
  Rail rail;
  Field3 force;
  const GuidedNodes* guided;
  NetSolver solver;
  LinkSet warp, weft;
  Field violation, active, compliance, change;
  Rows rows;  // beside rods and strings
};

// A t = g of all links that take part by a dense matrix: strings first, then the rods.
struct Dense {
  std::vector<std::size_t> strings;
  Eigen::MatrixXd matrix;
  Eigen::VectorXd rhs;
};

Dense denseSystem(const Net& net) {
  std::vector<Row> all;
  Dense dense;
  const Grid& grid = net.pattern.grid;
  const auto addLink = [&](std::size_t a, std::size_t b, const Vec3& direction, double violation) {
    Row link;
    link.node = {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)};
    link.weight = {1.0, -1.0};
    link.nodes = 2;
    link.direction = direction;
    link.violation = violation;
    all.push_back(link);
  };
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      if (net.active[n] == 0.0) continue;
      addLink(net.left(i, j), n, net.weft.direction.at(n), net.violation[n]);
      dense.strings.push_back(n);
    }
  }
  all.insert(all.end(), net.rows.begin(), net.rows.end());
  for (int i = 1; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      addLink(n - static_cast<std::size_t>(grid.stride), n, net.warp.direction.at(n), 0.0);
    }
  }
  const auto count = static_cast<Eigen::Index>(all.size());
  dense.matrix.setZero(count, count);
  dense.rhs.resize(count);
  for (Eigen::Index p = 0; p < count; ++p) {
    const Row& one = all[static_cast<std::size_t>(p)];
    dense.rhs[p] = one.violation;
    dense.matrix(p, p) += one.compliance;
    for (Eigen::Index q = 0; q < count; ++q) {
      const Row& other = all[static_cast<std::size_t>(q)];
      for (std::size_t k = 0; k < static_cast<std::size_t>(one.nodes); ++k) {
        for (std::size_t l = 0; l < static_cast<std::size_t>(other.nodes); ++l) {
          if (one.node[k] != other.node[l]) continue;
          dense.matrix(p, q) +=
              one.weight[k] * other.weight[l] * net.through(one.node[k], one.direction, other.direction);
        }
      }
    }
  }
  return dense;
}

// Single precision, 1e-7, times the matrix's condition number, some 1e3 on this crumpled cloth.
void expectWhatADenseSolveGives(Net& net) {
  net.shake(0.02, 8);
  net.setDirections();
  const double worst = net.measure();
  ASSERT_GT(worst, 1e-3);
  const Dense dense = denseSystem(net);
  const std::vector<std::size_t>& strings = dense.strings;
  const Eigen::VectorXd expected = dense.matrix.fullPivLu().solve(dense.rhs);
  ASSERT_GT(strings.size(), 10U);
  ASSERT_LT(strings.size(), net.pattern.grid.nodeCount() - 7);
  const double rest = net.pattern.weft_rest[1];
  const NetSolver::Outcome outcome =
      net.solver.solve(net.violation, net.active, net.rows, {worst * rest, 0.0, 1e-7, 200}, net.change);
  EXPECT_LT(outcome.reduction, 1e-5);
  const double size = expected.head(static_cast<Eigen::Index>(strings.size())).cwiseAbs().maxCoeff();
  for (std::size_t p = 0; p < strings.size(); ++p) {
    EXPECT_NEAR(net.change[strings[p]], expected[static_cast<Eigen::Index>(p)], 1e-3 * size) << "string " << p;
  }
  for (std::size_t r = 0; r < net.rows.size(); ++r) {
    const double row = expected[static_cast<Eigen::Index>(strings.size() + r)];
    EXPECT_NEAR(net.rows[r].change, row, 1e-3 * std::max(size * rest, std::abs(row))) << "row " << r;
  }
}

class NetSolverOf : public ::testing::TestWithParam<bool> {};

TEST_P(NetSolverOf, GivesWhatADenseSolveGives) {
  Net net(sceneOf(7, 9, PinKind::kTop, GetParam()));
  expectWhatADenseSolveGives(net);
}

// Nodes that slide on lines and on surfaces, anywhere, side by side and one below the other; one that stays.
class Sliding : public GuidedNodes {
 public:
  Sliding(const Grid& grid, const std::vector<std::size_t>& nodes) : GuidedNodes(grid, nodes) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (std::size_t k = 1; k < nodes.size(); ++k) {
      const Vec3 along = Vec3(any(random), any(random), any(random)).normalized();
      const Eigen::Matrix3d line = along * along.transpose();
      guided(k).freedom = k % 2 == 0 ? line : Eigen::Matrix3d(Eigen::Matrix3d::Identity() - line);
    }
  }
  void settlePositions(int, int, Field3&) noexcept override {}
  void settleVelocities(int, int, Field3&) noexcept override {}
};

TEST_P(NetSolverOf, SolvesForGuidedNodes) {
  Net net(sceneOf(7, 9, PinKind::kTop, GetParam()));
  const Grid& grid = net.pattern.grid;
  const Sliding sliding(grid, {grid.index(2, 4), grid.index(3, 0), grid.index(3, 1), grid.index(4, 1), grid.index(4, 2),
                               grid.index(4, 8), grid.index(6, 5)});
  net.guided = &sliding;
  expectWhatADenseSolveGives(net);
}

// Rows of one to four nodes, some of which give: what is asked of them is met together with the links.
TEST_P(NetSolverOf, SolvesForFurtherRowsToo) {
  Net net(sceneOf(7, 9, PinKind::kTop, GetParam()));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int count = 1; count <= 4; ++count) {
    Row row;
    row.nodes = count;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      row.node[k] = static_cast<std::uint32_t>(net.pattern.grid.index(1 + count, static_cast<int>(2 * k) + 1));
      row.weight[k] = any(random);
    }
    row.direction = Vec3(any(random), any(random), any(random)).normalized();
    row.violation = 1e-3 * any(random);
    if (count > 2) row.compliance = 0.5 * net.pattern.inverse_mass[row.node[0]];
    net.rows.push_back(row);
  }
  expectWhatADenseSolveGives(net);
}

// Around a corner and down a slope: neighbours slide in different directions, some of them in adjacent columns.
TEST(NetSolverOnARail, GivesWhatADenseSolveGives) {
  Scene scene = sceneOf(7, 9, PinKind::kTop, false);
  scene.rail.path = {{{0.0, 0.0, 2.2}, {}}, {{0.4, 0.0, 2.1}, {}}, {{0.6, 0.4, 2.2}, {}}, {{0.6, 0.9, 2.2}, {}}};
  scene.rail.carriers.columns = {0, 3, 4, 8};
  Net net(scene);
  expectWhatADenseSolveGives(net);
}

// The linear complementarity problem that one-sided strings pose: none ends pushing, none too long, and those that are
// left short pull no more. To what was asked of the residual: 1e-4 of the longest.
TEST_P(NetSolverOf, FindsWhichStringsPull) {
  Net net(sceneOf(7, 9, PinKind::kTop, GetParam()));
  net.shake(0.02, 8);
  net.setDirections();
  const double worst = net.measure();
  const double reduction = 1e-4;
  const double rest = net.pattern.weft_rest[1];
  const NetSolver::Outcome outcome = net.solver.solve(
      net.violation, net.active, net.rows, {worst * rest, 0.0, reduction, 400, &net.weft.multiplier}, net.change);
  ASSERT_LE(outcome.reduction, reduction);
  // What is left of all violations when the rods answer, by the dense matrix.
  std::fill(net.active.begin(), net.active.end(), 1.0);
  const Dense dense = denseSystem(net);
  const auto count = static_cast<Eigen::Index>(dense.strings.size()), rods = dense.rhs.size() - count;
  Eigen::VectorXd change(count);
  for (Eigen::Index p = 0; p < count; ++p) change[p] = net.change[dense.strings[static_cast<std::size_t>(p)]];
  const Eigen::VectorXd answer =
      dense.matrix.bottomRightCorner(rods, rods).fullPivLu().solve(dense.matrix.bottomLeftCorner(rods, count) * change);
  const Eigen::VectorXd left = dense.rhs.head(count) - dense.matrix.topLeftCorner(count, count) * change +
                               dense.matrix.topRightCorner(count, rods) * answer;
  const double allowed = 2.0 * reduction * worst * rest * rest;
  int pull = 0;
  for (std::size_t p = 0; p < dense.strings.size(); ++p) {
    const std::size_t n = dense.strings[p];
    const double end = net.weft.multiplier[n] + net.change[n];
    EXPECT_GE(end, -1e-6 * std::abs(net.change[n])) << "string " << p << " pushes";
    EXPECT_LE(left[static_cast<Eigen::Index>(p)], allowed) << "string " << p << " is too long";
    if (end > 0.0) {
      EXPECT_GE(left[static_cast<Eigen::Index>(p)], -allowed) << "string " << p << " is short and pulls";
      ++pull;
    }
  }
  EXPECT_GT(pull, 10);
}

// What is asked to give way, and pulls little, gives up that little to the last bit: a rest of it would count as a
// pull.
TEST_P(NetSolverOf, LetsRowsGoAtTheirBounds) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    Net net(sceneOf(7, 9, PinKind::kTop, GetParam()));
    Row row;
    row.nodes = 1;
    row.node[0] = static_cast<std::uint32_t>(net.pattern.grid.index(5, 3));
    row.weight[0] = 1.0;
    row.direction = Vec3(any(random), any(random), any(random)).normalized();
    row.violation = -1e-3;
    row.least = -1e-9 * std::abs(any(random)) / net.pattern.inverse_mass[row.node[0]];
    net.rows.push_back(row);
    net.solver.solve(net.violation, net.active, net.rows, {1e-3, 0.0, 1e-2, 50, &net.weft.multiplier}, net.change);
    EXPECT_EQ(net.rows[0].change, row.least);
  }
}

TEST_P(NetSolverOf, GivesTheSameBitsWithAnyNumberOfThreads) {
  const Scene scene = sceneOf(60, 50, PinKind::kTop, GetParam());
  Field first;
  for (const int threads : {1, 2, 3}) {
    Net net(scene, threads);
    net.shake(0.004, 9);
    net.setDirections();
    const double worst = net.measure();
    net.solver.solve(net.violation, net.active, net.rows, {worst * net.pattern.weft_rest[1], 1e-3, 1e-3, 20},
                     net.change);
    if (first.empty()) first = net.change;
    EXPECT_EQ(net.change, first) << threads << " threads";
  }
}

// Strings and rods in turn, along the present directions: Gauss-Newton, which ends quadratically once the set of taut
// strings is found.
TEST_P(NetSolverOf, ShortensLongLinksAndOnlyPulls) {
  Net net(sceneOf(6, 24, PinKind::kNone, GetParam()));
  net.shake(0.004, 8);
  EXPECT_GT(weftStretch(net.pattern, net.state.position), 1e-2);
  LineScratch scratch;
  scratch.assign(net.pattern.grid);
  const Field3 before = net.state.position;
  const LineSolve rods{net.pattern, net.pattern.inverse_mass, net.warp, net.state.position};
  for (int sweep = 0; sweep < 40; ++sweep) {
    net.setDirections();
    for (int block = 0; block < warpBlockCount(net.pattern.grid); ++block) warpNewton(rods, scratch, block);
    const double worst = net.measure();
    if (worst < 1e-9) break;
    net.solver.solve(net.violation, net.active, net.rows, {worst * net.pattern.weft_rest[1], 0.05 * worst, 0.1, 20},
                     net.change);
    net.take();
  }
  EXPECT_LT(weftStretch(net.pattern, net.state.position), 1e-6);
  EXPECT_LT(warpStretch(net.pattern, net.state.position).longer, 1e-6);
  Vec3 momentum = Vec3::Zero();
  int slack = 0;
  for (std::size_t n = 0; n < net.pattern.grid.size(); ++n) {
    momentum += net.pattern.mass[n] * (net.state.position.at(n) - before.at(n));
    EXPECT_GE(net.weft.multiplier[n], 0.0);
    if (net.weft.multiplier[n] == 0.0) ++slack;
  }
  EXPECT_LT(momentum.norm(), 1e-14);  // forces come in pairs: rounding of 144 nodes and 40 sweeps
  EXPECT_GT(slack, 0);
}

TEST_P(NetSolverOf, FindsNothingToDoInSlackCloth) {
  Scene scene = sceneOf(6, 24, PinKind::kNone, GetParam());
  scene.hang.to = Vec3(0.6, 0.0, 2.2);
  scene.hang.radius = 0.1;
  Net net(scene);
  EXPECT_EQ(net.measure(), 0.0);
  EXPECT_EQ(*std::max_element(net.active.begin(), net.active.end()), 0.0);
}

TEST_P(NetSolverOf, NoticesAPositionThatIsNotFinite) {
  Net net(sceneOf(3, 5, PinKind::kNone, GetParam()));
  net.state.position.y[net.pattern.grid.index(1, 4)] = std::nan("");
  EXPECT_TRUE(std::isinf(net.measure()));
}

INSTANTIATE_TEST_SUITE_P(OpenAndClosed, NetSolverOf, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "Closed" : "Open"; });

// A string that pulled and has become too short lets go, and what it pulled is given back.
TEST(WeftLinks, TakeBackAPullThatIsNotNeeded) {
  Net net(sceneOf(2, 4, PinKind::kNone, false));
  const Field3 before = net.state.position;
  net.weft.multiplier[net.pattern.grid.index(0, 2)] = 0.01;
  for (int i = 0; i < 2; ++i) pullWeft(net.line(), i, net.weft.multiplier);
  for (int sweep = 0; sweep < 20; ++sweep) {
    const double worst = net.measure();
    if (worst == 0.0) break;
    net.solver.solve(net.violation, net.active, net.rows, {worst * net.pattern.weft_rest[1], 0.0, 1e-6, 20},
                     net.change);
    net.take();
  }
  EXPECT_NEAR(net.weft.multiplier[net.pattern.grid.index(0, 2)], 0.0, 1e-9);
  for (int j = 0; j < 4; ++j) {
    const std::size_t n = net.pattern.grid.index(0, j);
    EXPECT_LT((net.state.position.at(n) - before.at(n)).norm(), 1e-8);
  }
}

}  // namespace
}  // namespace curtain
