// SPDX-License-Identifier: BSD-3-Clause
//
// The two bounds that make a substep end well whatever acts: predicted motion is cut, and the path to what was solved
// is taken only as far as links hold.
#include "step/schemes/last_resort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "step/trust_region.h"
#include "step/warp_solver.h"
#include "step/weft_links.h"
#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

struct Cloth {
  explicit Cloth(Scene given)
      : scene(std::move(given)),
        pattern(makePattern(scene)),
        state(makeInitialState(scene, pattern)),
        distances(pattern, {}, 1e-3, 1.0),
        resort(pattern, distances) {}

  double stretchOf(const Field3& position) const {
    const Stretch warp = warpStretch(pattern, position);
    return std::max({warp.longer, warp.shorter, weftStretch(pattern, position)});
  }

  Scene scene;
  ClothPattern pattern;
  ClothState state;
  DistanceRows distances;
  LastResort resort;
};

Scene pinnedBy(PinKind kind, int rows = 7, int columns = 6) {
  Scene scene = flatScene(rows, columns);
  scene.hang.to.x() = 0.95;
  scene.pins.kind = kind;
  return scene;
}

// The lengths of a field's displacements stay what they are, rounding apart.
constexpr double kRounding = 1e-12;

TEST(LastResort, NoNodeIsPredictedToGoFurtherThanItsReach) {
  Cloth cloth(pinnedBy(PinKind::kTop));
  Random random(3);
  const double h = 1e-3, reach = 0.25, link = shortestLink(cloth.pattern);
  Field3 velocity = randomPositions(cloth.pattern.grid, random, 1e6);
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) {
    if (cloth.pattern.inverse_mass[n] <= 0.0) velocity.set(n, Vec3::Zero());
  }
  EXPECT_GT(cloth.resort.cut(cloth.state.position, cloth.pattern.inverse_mass, h, reach, velocity), 0.0);
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) {
    EXPECT_LE(h * velocity.at(n).norm(), reach * link * (1.0 + kRounding)) << n;
  }
}

TEST(LastResort, WhatIsSlowIsNotCut) {
  Cloth cloth(pinnedBy(PinKind::kTop));
  Random random(4);
  const double h = 1e-3, link = shortestLink(cloth.pattern);
  Field3 velocity = randomPositions(cloth.pattern.grid, random, 0.1 * link / h);
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) {
    if (cloth.pattern.inverse_mass[n] <= 0.0) velocity.set(n, Vec3::Zero());
  }
  const Field3 before = velocity;
  EXPECT_EQ(cloth.resort.cut(cloth.state.position, cloth.pattern.inverse_mass, h, 0.5, velocity), 0.0);
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) EXPECT_EQ(velocity.at(n), before.at(n));
}

// A force beyond numbers counts as none: there is no direction to it.
TEST(LastResort, ADirectionlessVelocityIsDropped) {
  Cloth cloth(pinnedBy(PinKind::kTop));
  Field3 velocity;
  velocity.assign(cloth.pattern.grid.size(), 0.0);
  const std::size_t node = cloth.pattern.grid.index(3, 2);
  velocity.set(node, Vec3(std::numeric_limits<double>::infinity(), 0.0, std::nan("")));
  cloth.resort.cut(cloth.state.position, cloth.pattern.inverse_mass, 1e-3, 0.5, velocity);
  EXPECT_EQ(velocity.at(node), Vec3(Vec3::Zero()));
}

// Cloth that goes along with its pins is not cut, however fast they are, and where a path is cut to nothing it still
// follows them.
TEST(LastResort, ClothFollowsTheRigidMotionOfItsPins) {
  Cloth cloth(pinnedBy(PinKind::kTop));
  const double h = 1e-2;
  const Vec3 turn(0.3, 2.0, 5.0), drift(40.0, -3.0, 1.0), centre(0.2, 0.0, 0.9);
  Field3 velocity;
  velocity.assign(cloth.pattern.grid.size(), 0.0);
  for (int i = 0; i < cloth.pattern.grid.rows; ++i) {
    for (int j = 0; j < cloth.pattern.grid.columns; ++j) {
      const std::size_t n = cloth.pattern.grid.index(i, j);
      velocity.set(n, drift + turn.cross(cloth.state.position.at(n) - centre));
    }
  }
  cloth.resort.cut(cloth.state.position, cloth.pattern.inverse_mass, h, 1e-5, velocity);
  EXPECT_TRUE(cloth.resort.pinsMove());
  // Pins go straight on, the cloth turns about the row they stand on: links leave their lengths by the square of the
  // angle they turn by.
  const double angle = h * turn.norm();
  EXPECT_LE(cloth.stretchOf(cloth.resort.follows()), angle * angle);
}

TEST(LastResort, ThePathEndsWhereTheFirstLinkLeavesItsBound) {
  for (const PinKind kind : {PinKind::kTop, PinKind::kLeft, PinKind::kTopCorners, PinKind::kNone}) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      Cloth cloth(pinnedBy(kind));
      Random random(seed);
      Field3 velocity;
      velocity.assign(cloth.pattern.grid.size(), 0.0);
      cloth.resort.cut(cloth.state.position, cloth.pattern.inverse_mass, 1e-3, 0.5, velocity);
      Field3 end = cloth.state.position;
      shake(cloth.pattern, random.between(0.0, 0.2), seed, end);
      const Field3 whole = end;
      const double allowed = std::pow(10.0, random.between(-6.0, -1.0));
      const LastResort::Bound bound = cloth.resort.bound(cloth.pattern.inverse_mass, allowed, end);
      // Rounding of a length near one, over the shortest link.
      const double rounding = 16.0 * kEps / shortestLink(cloth.pattern);
      EXPECT_LE(cloth.stretchOf(end), std::max(allowed, cloth.stretchOf(cloth.state.position)) + rounding);
      EXPECT_GE(bound.share, 0.0);
      EXPECT_LE(bound.share, 1.0);
      if (bound.share < 1.0) {
        EXPECT_GT(bound.moment, 0.0);
        // Not shorter than it must be: a little further on some link is beyond it.
        Field3 further = cloth.state.position;
        const double share = bound.share + 1e-6;
        for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) {
          further.add(n, share * (whole.at(n) - cloth.state.position.at(n)));
        }
        EXPECT_GT(cloth.stretchOf(further), allowed - rounding) << seed;
      }
    }
  }
}

// Overlong by a little less than ten times the bound.
TEST(LastResort, LinksThatBeginBeyondTheBoundGetNoWorse) {
  Cloth cloth(pinnedBy(PinKind::kTop));
  Field3 start = cloth.state.position;
  const std::size_t node = cloth.pattern.grid.index(6, 3);
  start.add(node, Vec3(0.0, 0.0, -0.009 / 6.0));
  Field3 velocity;
  velocity.assign(cloth.pattern.grid.size(), 0.0);
  cloth.resort.cut(start, cloth.pattern.inverse_mass, 1e-3, 0.5, velocity);
  Field3 worse = start, better = start;
  worse.add(node, Vec3(0.0, 0.0, -0.001));
  better.add(node, Vec3(0.0, 0.0, 0.001));
  EXPECT_EQ(cloth.resort.bound(cloth.pattern.inverse_mass, 1e-3, worse).share, 0.0);
  EXPECT_EQ(cloth.resort.bound(cloth.pattern.inverse_mass, 1e-3, better).share, 1.0);
}

// Far beyond the bound, as after pins that were pulled apart or a state that was put there, any end will do that is
// better as a whole.
TEST(LastResort, LinksFarBeyondTheBoundComeBackAsTheyCan) {
  Cloth cloth(pinnedBy(PinKind::kTop));
  Field3 start = cloth.state.position;
  for (int j = 0; j < cloth.pattern.grid.columns; ++j) start.add(cloth.pattern.grid.index(6, j), Vec3(0.0, 0.0, -1.0));
  Field3 velocity;
  velocity.assign(cloth.pattern.grid.size(), 0.0);
  cloth.resort.cut(start, cloth.pattern.inverse_mass, 1e-3, 0.5, velocity);
  Field3 end = start;
  for (int j = 0; j < cloth.pattern.grid.columns; ++j) end.add(cloth.pattern.grid.index(5, j), Vec3(0.0, 0.0, -0.3));
  EXPECT_EQ(cloth.resort.bound(cloth.pattern.inverse_mass, 1e-3, end).share, 1.0);
}

TEST(TrustRegion, ShrinksWithFailuresAndGrowsUntilItBoundsNothing) {
  TrustRegion trust;
  EXPECT_FALSE(trust.bounded());
  trust.schemeFailed();
  const double first = trust.reach();
  EXPECT_TRUE(trust.bounded());
  for (int k = 0; k < 100; ++k) trust.failed(false);
  const double least = trust.reach();
  EXPECT_GT(least, 0.0);
  EXPECT_LT(least, 1e-3 * first);
  int successes = 0;
  while (trust.bounded() && successes < 1000) {
    const double before = trust.reach();
    trust.succeeded();
    EXPECT_GT(trust.reach(), before);
    ++successes;
  }
  EXPECT_LT(successes, 100);
}

TEST(TrustRegion, LetsTheSchemeTryAgainAtAFrameAfterAFailureInContact) {
  TrustRegion trust;
  EXPECT_FALSE(trust.rules(true));
  trust.schemeFailed();
  EXPECT_TRUE(trust.rules(true));
  trust.failed(true);
  EXPECT_TRUE(trust.rules(false));
  EXPECT_FALSE(trust.rules(true));
  const double reach = trust.reach();
  trust.schemeFailed();
  EXPECT_TRUE(trust.rules(true));
  EXPECT_EQ(trust.reach(), reach);
  trust.failed(true);
  trust.succeeded();
  EXPECT_TRUE(trust.rules(true));
  trust.failed(false);
  EXPECT_TRUE(trust.rules(true));
}

}  // namespace
}  // namespace curtain
