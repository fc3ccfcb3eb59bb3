// SPDX-License-Identifier: BSD-3-Clause
//
// Impact zones: nodes that would go through each other move as one body, with their momentum.
#include "contact/response/impact_zones.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::kEps;
using curtain_test::Random;

// Free nodes of unequal masses anywhere, each on its own way.
struct Ways {
  explicit Ways(PinKind pins = PinKind::kNone) {
    Scene scene = curtain_test::flatScene(4, 5);
    scene.pins.kind = pins;
    pattern = makePattern(scene);
    Random random(3);
    start = curtain_test::randomPositions(pattern.grid, random, 1.0);
    end = curtain_test::randomPositions(pattern.grid, random, 1.0);
  }
  std::size_t node(int i, int j) const { return pattern.grid.index(i, j); }
  Vec3 move(std::size_t n) const { return end.at(n) - start.at(n); }

  ClothPattern pattern;
  Field3 start, end;
};

TEST(Zones, KeepMomentumAngularMomentumAndToFirstOrderDistances) {
  Ways ways;
  ImpactZones zones(ways.pattern);
  const std::vector<std::size_t> members{ways.node(0, 0), ways.node(1, 3), ways.node(2, 2), ways.node(3, 4)};
  const auto sum = [&](bool angular) {
    Vec3 total = Vec3::Zero();
    for (const std::size_t n : members) {
      const Vec3 momentum = ways.pattern.mass[n] * ways.move(n);
      total += angular ? Vec3(ways.start.at(n).cross(momentum)) : momentum;
    }
    return total;
  };
  const Vec3 linear = sum(false), angular = sum(true);
  for (std::size_t k = 1; k < members.size(); ++k) zones.join(members[k - 1], members[k]);
  const Vec3 alone = ways.end.at(ways.node(2, 1));
  zones.makeRigid(ways.start, ways.end);
  EXPECT_LT((sum(false) - linear).norm(), 100.0 * kEps);
  EXPECT_LT((sum(true) - angular).norm(), 100.0 * kEps);
  for (const std::size_t a : members) {
    for (const std::size_t b : members) {
      const Vec3 between = ways.start.at(a) - ways.start.at(b);
      EXPECT_NEAR(between.dot(ways.move(a) - ways.move(b)), 0.0, 100.0 * kEps);
    }
  }
  EXPECT_EQ(ways.end.at(ways.node(2, 1)), alone) << "of no zone";
}

TEST(Zones, TwoNodesThatMeetHeadOnGoOnTogether) {
  Ways ways;
  const std::size_t a = ways.node(1, 1), b = ways.node(1, 2);  // of one mass
  ways.start.set(a, Vec3(0.0, 0.0, 0.0));
  ways.start.set(b, Vec3(1.0, 0.0, 0.0));
  ways.end.set(a, Vec3(2.0, 0.0, 0.0));
  ways.end.set(b, Vec3(0.0, 0.0, 0.0));
  ImpactZones zones(ways.pattern);
  zones.join(a, b);
  zones.makeRigid(ways.start, ways.end);
  EXPECT_LT((ways.end.at(a) - Vec3(0.5, 0.0, 0.0)).norm(), 4.0 * kEps);
  EXPECT_LT((ways.end.at(b) - Vec3(1.5, 0.0, 0.0)).norm(), 4.0 * kEps);
}

TEST(Zones, OneWithAPinGoesWithIt) {
  Ways ways(PinKind::kTop);
  const std::size_t pin = ways.node(0, 2), free = ways.node(2, 2), far = ways.node(3, 0);
  const Vec3 pin_move = ways.move(pin), far_end = ways.end.at(far);
  ImpactZones zones(ways.pattern);
  zones.join(free, pin);
  zones.makeRigid(ways.start, ways.end);
  EXPECT_EQ(ways.end.at(free), ways.start.at(free) + pin_move);
  EXPECT_EQ(ways.move(pin), pin_move);
  EXPECT_EQ(ways.end.at(far), far_end);
}

TEST(Zones, JoinedByANodeTheyAreOneAndOtherwiseMoveApart) {
  Ways ways;
  ImpactZones zones(ways.pattern);
  EXPECT_FALSE(zones.any());
  zones.join(ways.node(0, 0), ways.node(0, 1));
  zones.join(ways.node(3, 3), ways.node(3, 4));
  Field3 apart = ways.end;
  zones.makeRigid(ways.start, apart);
  zones.join(ways.node(0, 1), ways.node(3, 4));
  Field3 together = ways.end;
  zones.makeRigid(ways.start, together);
  const auto changesDistance = [&](const Field3& end) {
    const std::size_t a = ways.node(0, 0), b = ways.node(3, 3);
    return (ways.start.at(a) - ways.start.at(b)).dot(end.at(a) - ways.start.at(a) - end.at(b) + ways.start.at(b));
  };
  EXPECT_GT(std::abs(changesDistance(apart)), 0.01);
  EXPECT_NEAR(changesDistance(together), 0.0, 100.0 * kEps);
  zones.clear();
  EXPECT_FALSE(zones.any());
  Field3 none = ways.end;
  zones.makeRigid(ways.start, none);
  EXPECT_EQ(none.at(ways.node(0, 0)), ways.end.at(ways.node(0, 0)));
}

TEST(Zones, StoppedStayWhereTheyWereButForPins) {
  Ways ways(PinKind::kTop);
  const std::size_t pin = ways.node(0, 0), free = ways.node(1, 0);
  const Vec3 pin_end = ways.end.at(pin);
  ImpactZones zones(ways.pattern);
  zones.join(pin, free);
  zones.stop(ways.start, ways.end);
  EXPECT_EQ(ways.end.at(free), ways.start.at(free));
  EXPECT_EQ(ways.end.at(pin), pin_end);
}

}  // namespace
}  // namespace curtain
