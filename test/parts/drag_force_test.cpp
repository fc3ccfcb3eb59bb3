// SPDX-License-Identifier: BSD-3-Clause
//
// A user force is shared by the neighbourhood of the grasped node and adds up to the force given; pulling towards a
// target never overshoots a free node, never exceeds its cap, and is stable at any stiffness.
#include "parts/drag/drag_force.h"

#include <gtest/gtest.h>

#include <cmath>

#include "step/substep.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kEps;
using curtain_test::Random;
using curtain_test::randomPositions;
using curtain_test::ringScene;

struct Cloth {
  explicit Cloth(Scene scene) {
    scene.pins.kind = PinKind::kNone;
    pattern = makePattern(scene);
    position = makeInitialState(scene, pattern).position;
    velocity.assign(pattern.grid.size(), 0.0);
  }
  Field3 pull(DragForce& drag, double dt = 0.01) {
    Field3 force;
    force.assign(pattern.grid.size(), 0.0);
    damping.assign(pattern.grid.size(), 0.0);
    drag.addForces(pattern, position, 0.0, dt, force, damping);
    return force;
  }
  ClothPattern pattern;
  Field3 position, velocity;
  Field damping;
};

DragParams dragOf(NodeIndex node, double radius = 0.0) {
  DragParams drag;
  drag.id = "hand";
  drag.node = node;
  drag.radius = radius;
  drag.force = {1.0, -2.0, 3.0};
  return drag;
}

TEST(DragForce, WithoutRadiusActsOnItsNodeAlone) {
  Cloth cloth(flatScene(4, 5));
  DragForce drag(dragOf({2, 3}), cloth.pattern);
  const Field3 force = cloth.pull(drag);
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) {
    EXPECT_EQ(force.at(n), n == cloth.pattern.grid.index(2, 3) ? Vec3(1.0, -2.0, 3.0) : Vec3(0.0, 0.0, 0.0));
  }
}

// The square of such a radius is 0, and 0 / 0 is no share of a force.
TEST(DragForce, WithARadiusBeyondNumbersActsOnItsNodeAlone) {
  Cloth cloth(flatScene(4, 5));
  for (const double radius : {1e-300, 1e-200, 4.9406564584124654e-324}) {
    DragParams params = dragOf({2, 3});
    params.radius = radius;
    DragForce drag(params, cloth.pattern);
    EXPECT_EQ(cloth.pull(drag).at(cloth.pattern.grid.index(2, 3)), Vec3(1.0, -2.0, 3.0));
  }
}

TEST(DragForce, SharedByTheNeighbourhoodAddsUpToTheForce) {
  for (const bool closed : {false, true}) {
    Cloth cloth(closed ? ringScene(12, 14) : flatScene(12, 14));
    const Grid& grid = cloth.pattern.grid;
    for (const NodeIndex node : {NodeIndex{0, 0}, NodeIndex{6, 7}, NodeIndex{11, 13}, NodeIndex{5, 0}}) {
      for (const double radius : {1e-6, 0.11, 0.3, 10.0}) {
        DragForce drag(dragOf(node, radius), cloth.pattern);
        const Field3 force = cloth.pull(drag);
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < grid.rows; ++i) {
          for (int j = 0; j < grid.columns; ++j) {
            const Vec3 share = force.at(grid.index(i, j));
            sum += share;
            EXPECT_GE(share.dot(Vec3(1.0, -2.0, 3.0)), 0.0);
            const double dv = (i - node.row) / 11.0;
            double du = std::abs(j - node.column) / (closed ? 14.0 : 13.0);
            if (closed) du = std::min(du, 1.0 - du);
            const double away = std::hypot(dv, du);
            if (std::abs(away - radius) > 1e-9) {
              EXPECT_EQ(share.norm() > 0.0, away < radius) << i << ", " << j;
            }
            EXPECT_LE(share.norm(), force.at(grid.index(node)).norm()) << "the grasped node gets the most";
          }
        }
        // 168 shares, each rounded twice, in a sum of at most the force.
        EXPECT_LE((sum - Vec3(1.0, -2.0, 3.0)).norm(), 2.0 * 168 * kEps * 4.0);
        for (std::size_t n = 0; n < grid.size(); ++n) {
          if (cloth.pattern.mass[n] == 0.0) {
            EXPECT_EQ(force.at(n), Vec3(0.0, 0.0, 0.0)) << "padding";
          }
        }
      }
    }
  }
}

TEST(DragForce, NeighbourhoodGoesAroundARingEvenly) {
  Cloth cloth(ringScene(5, 10));
  DragForce drag(dragOf({2, 0}, 0.35), cloth.pattern);
  const Field3 force = cloth.pull(drag);
  for (int i = 0; i < 5; ++i) {
    for (int j = 1; j < 10; ++j) {
      const Vec3 right = force.at(cloth.pattern.grid.index(i, j));
      const Vec3 left = force.at(cloth.pattern.grid.index(i, 10 - j));
      EXPECT_LE((right - left).norm(), 32 * kEps) << i << ", " << j;
    }
  }
  EXPECT_GT(force.at(cloth.pattern.grid.index(2, 9)).norm(), 0.0);
}

TEST(DragForce, ActsFromStartUntilBeforeEnd) {
  Cloth cloth(flatScene(3, 3));
  DragParams params = dragOf({1, 1});
  params.start = 1.0;
  params.end = 2.0;
  const DragForce drag(params, cloth.pattern);
  EXPECT_FALSE(drag.actsAt(std::nextafter(1.0, 0.0)));
  EXPECT_TRUE(drag.actsAt(1.0));
  EXPECT_TRUE(drag.actsAt(std::nextafter(2.0, 0.0)));
  EXPECT_FALSE(drag.actsAt(2.0));
}

TEST(DragForce, ByPointGraspsTheNearestNodeWhenItFirstActsAndKeepsIt) {
  Random random(31);
  Cloth cloth(flatScene(7, 9));
  const Grid& grid = cloth.pattern.grid;
  for (int trial = 0; trial < 100; ++trial) {
    cloth.position = randomPositions(grid, random, 1.0);
    for (int i = 0; i < grid.rows; ++i) {  // padding is no node, however near
      for (int j = grid.columns; j < grid.stride; ++j) cloth.position.set(grid.index(i, j), Vec3(0.0, 0.0, 0.0));
    }
    DragParams params;
    params.id = "hand";
    params.point = random.inBox(1.2);
    params.force = Vec3::UnitX();
    DragForce drag(params, cloth.pattern);
    EXPECT_FALSE(drag.node().has_value()) << "nothing is grasped before it acts";
    cloth.pull(drag);
    ASSERT_TRUE(drag.node().has_value());
    const double taken = (cloth.position.at(grid.index(*drag.node())) - *params.point).norm();
    for (int i = 0; i < grid.rows; ++i) {
      for (int j = 0; j < grid.columns; ++j) {
        ASSERT_LE(taken, (cloth.position.at(grid.index(i, j)) - *params.point).norm() * (1.0 + 4.0 * kEps));
      }
    }
    const NodeIndex first = *drag.node();
    cloth.position = randomPositions(grid, random, 1.0);
    const Field3 force = cloth.pull(drag);
    EXPECT_EQ(force.x[grid.index(first)], 1.0) << "it holds its node wherever that goes";
  }
}

// ---- the spring ----------------------------------------------------------------------------------------------------

// One node of a 2 x 2 cloth, free of its links: it has a quarter of the mass, the share the spring is damped for.
struct FreeNode {
  explicit FreeNode(const DragParams& params, double mass_share = 1.0)
      : cloth(flatScene(2, 2)), drag(params, cloth.pattern), n(cloth.pattern.grid.index(0, 0)) {
    inverse_mass = cloth.pattern.inverse_mass[n] / mass_share;
  }
  Vec3 offset() const { return cloth.position.at(n) - *drag.params().target; }
  void step(double dt) {
    const Vec3 force = cloth.pull(drag, dt).at(n);
    // As the solver moves it: the damping is part of the node's inertia.
    const DampedStep factors = dampedStep(cloth.damping[n], inverse_mass, dt);
    cloth.velocity.set(n, factors.keep * cloth.velocity.at(n) + dt * factors.gain * inverse_mass * force);
    cloth.position.add(n, dt * cloth.velocity.at(n));
  }
  Cloth cloth;
  DragForce drag;
  std::size_t n;
  double inverse_mass;
};

DragParams springOf(double stiffness, double max_force) {
  DragParams params;
  params.id = "hand";
  params.node = NodeIndex{0, 0};
  params.target = Vec3(0.3, 0.4, 1.0);  // 0.5 m from the node at (0, 0, 1)
  params.stiffness = stiffness;
  params.max_force = max_force;
  return params;
}

TEST(DragSpring, PullsAFreeNodeToItsTargetWithoutOvershoot) {
  const Vec3 way = Vec3(0.3, 0.4, 0.0) / 0.5;
  for (const double stiffness : {0.01, 20.0, 1e3, 1e6, 1e9}) {
    for (const double dt : {1e-4, 1.0 / 480.0, 1.0 / 60.0, 0.1}) {
      FreeNode node(springOf(stiffness, 1e30));
      const double omega = std::sqrt(stiffness * node.inverse_mass);
      // Critically damped: (1 + omega t) e^(-omega t) < 1e-6 at omega t = 20. The implicit step only slows this down,
      // to
      // 1/(1 + omega dt) a step where omega dt is large.
      const auto steps = static_cast<int>(std::ceil(20.0 / std::min(omega * dt, 1.0))) * 2;
      double last = 0.5;
      for (int n = 0; n < std::min(steps, 200000); ++n) {
        node.step(dt);
        const double left = -node.offset().dot(way);
        // Positions are rounded at 1 m; the velocity they give is rounded too: some eps a step.
        ASSERT_GE(left, -16.0 * kEps) << "overshoot at stiffness " << stiffness << " dt " << dt << " step " << n;
        ASSERT_LE(left, last + 16.0 * kEps) << "turned back";
        last = left;
      }
      if (steps <= 200000) {
        EXPECT_LE(node.offset().norm(), 0.5e-4) << "stiffness " << stiffness << " dt " << dt;
      }
    }
  }
}

TEST(DragSpring, IsCriticallyDampedAndNoMore) {
  // As dt -> 0: 0.5 (1 + omega t) e^(-omega t); at omega t = 2 that is 0.203. Order 1: error below omega dt of the way.
  const double stiffness = 20.0;
  FreeNode node(springOf(stiffness, 1e30));
  const double omega = std::sqrt(stiffness * node.inverse_mass);
  const double dt = 1e-3 / omega;
  for (int n = 0; n < 2000; ++n) node.step(dt);
  EXPECT_NEAR(node.offset().norm(), 0.5 * 3.0 * std::exp(-2.0), 1e-3 * 0.5 * 2.0);
}

TEST(DragSpring, NeverPullsHarderThanItsCap) {
  Random random(32);
  for (const double stiffness : {1.0, 20.0, 1e9}) {
    for (int trial = 0; trial < 100; ++trial) {
      FreeNode node(springOf(stiffness, 7.0));
      node.cloth.position.set(node.n, random.inBox(2.0));
      node.cloth.velocity.set(node.n, random.inBox(20.0));
      const Vec3 force = node.cloth.pull(node.drag, 1.0 / 60.0).at(node.n);
      EXPECT_LE(force.norm(), 7.0 * (1.0 + 4.0 * kEps));
    }
  }
  FreeNode far(springOf(1e9, 7.0));
  const Vec3 force = far.cloth.pull(far.drag, 1e-3).at(far.n);
  EXPECT_LE((force - 7.0 * Vec3(0.6, 0.8, 0.0)).norm(), 7.0 * 16.0 * kEps) << "and then straight at the target";
}

TEST(DragSpring, StiffAndCappedGainsNoEnergy) {
  // A capped spring is a constant force towards the target, at the worst: the node comes back no further than it
  // started. Discrete steps may be late by one: dt v, v <= sqrt(2 w F 0.5 m), and by the step's own w F dt^2.
  for (const double stiffness : {20.0, 1e4, 1e9}) {
    for (const double dt : {1e-3, 1.0 / 60.0}) {
      FreeNode node(springOf(stiffness, 10.0));
      const double late = dt * std::sqrt(2.0 * node.inverse_mass * 10.0 * 0.5) + node.inverse_mass * 10.0 * dt * dt;
      for (int n = 0; n < 20000; ++n) {
        node.step(dt);
        ASSERT_TRUE(node.cloth.position.at(node.n).allFinite());
        ASSERT_LE(node.offset().norm(), 0.5 + late) << "stiffness " << stiffness << " dt " << dt << " step " << n;
      }
    }
  }
}

TEST(DragSpring, NeighbourhoodMovesAsOneAndSharesTheCap) {
  Cloth cloth(flatScene(9, 9));
  DragParams params = springOf(1e9, 7.0);
  params.node = NodeIndex{4, 4};
  params.radius = 0.4;
  DragForce drag(params, cloth.pattern);
  const Field3 force = cloth.pull(drag, 1e-3);
  Vec3 sum = Vec3::Zero();
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) sum += force.at(n);
  EXPECT_NEAR(sum.norm(), 7.0, 7.0 * 200 * kEps);
}

TEST(DragSpring, HoldsAPinnedNodeWithoutDividingByZero) {
  Scene scene = flatScene(2, 2);
  const ClothPattern pattern = makePattern(scene);  // its top row is pinned
  const ClothState state = makeInitialState(scene, pattern);
  DragForce drag(springOf(1e9, 5.0), pattern);
  Field3 force;
  force.assign(pattern.grid.size(), 0.0);
  Field damping(pattern.grid.size(), 0.0);
  drag.addForces(pattern, state.position, 0.0, 0.01, force, damping);
  EXPECT_NEAR(force.at(pattern.grid.index(0, 0)).norm(), 5.0, 5.0 * 8.0 * kEps);
}

}  // namespace
}  // namespace curtain
