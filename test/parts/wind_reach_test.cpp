// SPDX-License-Identifier: BSD-3-Clause
//
// A wind source does nothing outside its cone, and says before what it cannot reach.
#include <gtest/gtest.h>

#include <cmath>

#include "parts/wind_on_cloth.h"

namespace curtain {
namespace {

using namespace curtain_test;

TEST(WindReach, NothingOutsideTheConeOrBehindTheDisc) {
  WindParams wind;
  wind.id = "fan";
  wind.position = {1.0, 2.0, 3.0};
  wind.direction = Vec3::UnitZ();
  wind.radius = 0.5;
  wind.half_angle = std::atan(0.25);  // apex 2 m behind the disc; the cone is 0.25 m wider each metre
  wind.pressure = 1.0;
  WindyCloth cloth(flatScene(3, 3));
  const WindSource source(wind, cloth.pattern, porous(cloth.pattern, 0.0), 1);
  const auto reached = [&](double across, double along) {
    return source.reachesPoint(wind.position + Vec3(across, 0.0, along));
  };
  EXPECT_TRUE(reached(0.0, 0.0)) << "the disc itself";
  EXPECT_TRUE(reached(0.499, 0.0));
  EXPECT_FALSE(reached(0.501, 0.0));
  EXPECT_TRUE(reached(0.749, 1.0));
  EXPECT_FALSE(reached(0.751, 1.0));
  EXPECT_TRUE(reached(1.499, 4.0));
  EXPECT_FALSE(reached(1.501, 4.0));
  EXPECT_FALSE(reached(0.0, -1e-9));
  EXPECT_FALSE(reached(0.0, -1.0)) << "between apex and disc";
  EXPECT_FALSE(reached(0.0, -5.0)) << "behind the apex";
  const std::size_t middle = cloth.pattern.grid.index(1, 1);
  cloth.position.set(middle, wind.position);
  cloth.normals.set(middle, Vec3(0.0, 0.6, 0.8));
  EXPECT_EQ(cloth.push(wind).at(middle).normalized(), wind.direction) << "at the disc's centre d is no direction";
}

Eigen::AlignedBox3d randomBox(Random& random) {
  const Vec3 middle = random.inBox(4.0), half = random.between(0.1, 1.5) * (random.inBox(0.5) + Vec3::Constant(0.5));
  return {middle - half, middle + half};
}

TEST(WindReach, ReachesNoPlaceOfABoxThatItMayNotReach) {
  Random random(8);
  const WindyCloth cloth(flatScene(2, 2));
  int out_of_reach = 0, missed = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const WindSource source(randomWind(random), cloth.pattern, porous(cloth.pattern, 0.0), 1);
    const Eigen::AlignedBox3d box = randomBox(random);
    const bool may = source.mayReach(box);
    bool does = false;
    for (int sample = 0; sample < 200; ++sample) {
      Vec3 place;
      for (int k = 0; k < 3; ++k) {
        // Corners and sides more often than chance would have them.
        const double share = std::min(1.0, std::max(0.0, random.between(-0.5, 1.5)));
        place[k] = box.min()[k] + share * (box.max()[k] - box.min()[k]);
      }
      does = does || source.reachesPoint(place);
    }
    ASSERT_TRUE(may || !does) << "trial " << trial;
    out_of_reach += does ? 0 : 1;
    missed += may && !does ? 1 : 0;
  }
  // A plane parts most of what can be parted.
  EXPECT_GT(out_of_reach, 1000);
  EXPECT_LT(missed, out_of_reach / 4);
}

TEST(WindReach, ReachesAlongItsEdge) {
  const WindyCloth cloth(flatScene(2, 2));
  WindParams wind;
  wind.id = "edge";
  wind.direction = Vec3::UnitX();
  wind.radius = 1.0;
  wind.pressure = 1.0;
  wind.half_angle = std::atan(0.5);
  const WindSource source(wind, cloth.pattern, porous(cloth.pattern, 0.0), 1);
  const auto at = [](double x, double y) { return Eigen::AlignedBox3d(Vec3(x, y, -0.5), Vec3(x + 1.0, y + 1.0, 0.5)); };
  EXPECT_FALSE(source.mayReach(at(-1.001, -0.5)));  // behind the disc
  EXPECT_TRUE(source.mayReach(at(-0.999, -0.5)));
  EXPECT_FALSE(source.mayReach(at(1.0, 2.001)));  // the cone's radius is 2 where the box ends
  EXPECT_TRUE(source.mayReach(at(1.0, 1.999)));
}

// Parallel wind on the middle of a cloth of 1 m.
WindParams gustless() {
  WindParams wind = fanAt({0.5, -1.0, 0.5}, 0.3);
  wind.pressure = 3.0;
  return wind;
}

TEST(WindReach, FindsNothingOutsideTheBounds) {
  const WindyCloth cloth(flatScene(5, 5));
  WindSource source(gustless(), cloth.pattern, porous(cloth.pattern, 0.0), 1);
  source.find(cloth.pattern.grid, cloth.position, Eigen::AlignedBox3d(Vec3(0, 0, 0), Vec3(1, 0, 1)));
  EXPECT_TRUE(source.reaches());
  EXPECT_FALSE(source.reachesRow(0));
  EXPECT_TRUE(source.reachesRow(2));
  source.find(cloth.pattern.grid, cloth.position, Eigen::AlignedBox3d(Vec3(0, 0, 9), Vec3(1, 0, 10)));
  EXPECT_FALSE(source.reaches());
  EXPECT_FALSE(source.reachesRow(2)) << "of an earlier look";
}

}  // namespace
}  // namespace curtain
