// SPDX-License-Identifier: BSD-3-Clause
//
// A wind source does what Cheng 2000, Eqs. (2)(3) say, nothing outside its cone, the same to both sides of the cloth,
// and, given as a pressure, the same to a cloth whatever its grid.
#include "forces/wind_source.h"

#include <gtest/gtest.h>

#include <cmath>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kEps;
using curtain_test::kPi;
using curtain_test::Random;
using curtain_test::randomPositions;

struct Cloth {
  explicit Cloth(const Scene& scene)
      : pattern(makePattern(scene)), position(makeInitialState(scene, pattern).position) {
    renew();
  }
  void renew() {
    normals.assign(pattern.grid.size(), 0.0);
    nodeAreaVectors(pattern.grid, position, normals);
  }
  Field3 push(WindSource& source, double time = 0.0) const {
    Field3 force;
    force.assign(pattern.grid.size(), 0.0);
    Eigen::AlignedBox3d bounds;
    for (int i = 0; i < pattern.grid.rows; ++i) {
      for (int j = 0; j < pattern.grid.columns; ++j) bounds.extend(position.at(pattern.grid.index(i, j)));
    }
    source.find(pattern.grid, position, bounds);
    source.addForces(pattern, position, normals, time, force);
    return force;
  }
  Field3 push(const WindParams& wind, double porosity = 0.0) const {
    WindSource source(wind, pattern, porosity, 1);
    return push(source);
  }
  Vec3 total(const WindParams& wind) const {
    const Field3 force = push(wind);
    Vec3 sum = Vec3::Zero();
    for (std::size_t n = 0; n < pattern.grid.size(); ++n) sum += force.at(n);
    return sum;
  }
  ClothPattern pattern;
  Field3 position, normals;
};

// Eqs. (2)(3) as printed, with the cone's apex and B from the meeting of a line and a plane.
struct Printed {
  bool near_the_edge = false;  // too close to the cone or to the disc's plane for rounding to tell the sides apart
  Vec3 force = Vec3::Zero();
  double depth = 0.0;
};

Printed printedWind(const WindParams& wind, const Vec3& c, const Vec3& normal, double area, double porosity) {
  Printed result;
  const Vec3 o = wind.position;
  const Vec3 a = wind.direction / wind.direction.norm();
  result.depth = (c - o).dot(a);
  Vec3 b;
  if (wind.half_angle > 0.0) {
    const Vec3 apex = o - wind.radius / std::tan(wind.half_angle) * a;
    const double t = (o - apex).dot(a) / (c - apex).dot(a);
    b = apex + t * (c - apex);
    if ((c - apex).dot(a) <= 0.0) return result;
  } else {
    b = c - result.depth * a;
  }
  const double from_centre = (b - o).norm();
  result.near_the_edge = std::abs(result.depth) < 0.01 || std::abs(from_centre - wind.radius) < 1e-9 * wind.radius;
  if (result.depth < 0.0 || from_centre > wind.radius) return result;
  const Vec3 d = c - b;
  const Vec3 f_w = (wind.pressure * area + wind.node_force) * a;
  const Vec3 f_temp = f_w.dot(d) * d / d.squaredNorm();
  const double cos_psi = std::abs(a.dot(normal)) / (a.norm() * normal.norm());
  const double in_lengths = d.squaredNorm() / (wind.reference_length * wind.reference_length);
  result.force =
      (1.0 - wind.porosity_weight * porosity) * cos_psi / (wind.distance_weight * (1.0 + in_lengths)) * f_temp;
  return result;
}

WindParams randomWind(Random& random) {
  WindParams wind;
  wind.id = "fan";
  wind.position = random.inBox(1.0);
  wind.direction = random.between(0.1, 10.0) * random.direction();
  wind.radius = random.between(0.3, 1.5);
  wind.half_angle = random.between(0.0, 1.0) < 0.2 ? 0.0 : random.between(0.02, 1.5);
  wind.pressure = random.between(0.0, 20.0);
  wind.node_force = random.between(0.0, 1.0);
  wind.porosity_weight = random.between(0.0, 1.0);
  wind.distance_weight = random.between(0.1, 3.0);
  wind.reference_length = random.between(0.3, 3.0);
  return wind;
}

TEST(WindSource, IsEquations2And3AtRandomPlacesOfRandomCones) {
  Random random(21);
  Cloth cloth(flatScene(8, 8));
  int reached = 0, spared = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const WindParams wind = randomWind(random);
    const double porosity = random.between(0.0, 1.0);
    cloth.position = randomPositions(cloth.pattern.grid, random, 2.0);
    cloth.renew();
    const Field3 force = cloth.push(wind, porosity);
    for (int i = 0; i < 8; ++i) {
      for (int j = 0; j < 8; ++j) {
        const std::size_t n = cloth.pattern.grid.index(i, j);
        const Printed expected =
            printedWind(wind, cloth.position.at(n), cloth.normals.at(n), cloth.pattern.area[n], porosity);
        if (expected.near_the_edge) continue;
        // B is rounded at the size of apex (up to 1.5/tan(0.02) = 75 m) and node (4 m), a dozen operations; d is as
        // long as the node is deep or longer, enters the force's direction twice and its size with |d|^2 / (1 + |d|^2).
        const double error = 12.0 * kEps * 80.0;
        const double tolerance = expected.force.norm() * (6.0 * error / std::abs(expected.depth) + 32.0 * kEps);
        ASSERT_LE((force.at(n) - expected.force).norm(), tolerance) << "trial " << trial;
        ++(expected.force.isZero() ? spared : reached);
      }
    }
  }
  EXPECT_GT(reached, 3000) << "the test must look inside";
  EXPECT_GT(spared, 3000) << "and outside";
}

TEST(WindSource, NothingOutsideTheConeOrBehindTheDisc) {
  WindParams wind;
  wind.id = "fan";
  wind.position = {1.0, 2.0, 3.0};
  wind.direction = Vec3::UnitZ();
  wind.radius = 0.5;
  wind.half_angle = std::atan(0.25);  // apex 2 m behind the disc; the cone is 0.25 m wider each metre
  wind.pressure = 1.0;
  Cloth cloth(flatScene(3, 3));
  const WindSource source(wind, cloth.pattern, 0.0, 1);
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

TEST(WindSource, PushesBothSidesOfTheClothAlike) {
  Random random(22);
  Cloth cloth(flatScene(6, 6));
  WindParams wind = randomWind(random);
  wind.half_angle = 0.5;
  wind.position = {0.5, -1.0, 0.5};
  wind.direction = {0.1, 1.0, 0.2};
  const Field3 front = cloth.push(wind);
  for (Field* axis : {&cloth.normals.x, &cloth.normals.y, &cloth.normals.z}) {
    for (double& value : *axis) value = -value;
  }
  const Field3 back = cloth.push(wind);
  double size = 0.0;
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) {
    EXPECT_EQ(front.at(n), back.at(n));
    size += front.at(n).norm();
  }
  EXPECT_GT(size, 0.0);
}

TEST(WindSource, ClothAlongTheWindOrCrushedCatchesNone) {
  Cloth cloth(flatScene(4, 4));  // in the plane y = 0
  WindParams wind;
  wind.id = "fan";
  wind.position = {-1.0, 0.0, 0.5};
  wind.radius = 5.0;
  wind.pressure = 10.0;
  EXPECT_EQ(cloth.total(wind), Vec3(0.0, 0.0, 0.0));
  cloth.position.assign(cloth.pattern.grid.size(), 0.5);
  cloth.renew();
  EXPECT_EQ(cloth.total(wind), Vec3(0.0, 0.0, 0.0)) << "0 / 0 must not reach the nodes";
}

TEST(WindSource, NarrowConesTendToParallelWind) {
  Random random(23);
  Cloth cloth(flatScene(8, 8));
  for (int trial = 0; trial < 20; ++trial) {
    WindParams wind = randomWind(random);
    wind.radius = 2.0;
    wind.position = Vec3::Zero();
    for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) {
      // Inside the cylinder with room to spare, so that every cone reaches the node too.
      const Vec3 across = random.inBox(1.0);
      const Vec3 axis = wind.direction.normalized();
      cloth.position.set(n, across - across.dot(axis) * axis + random.between(0.0, 2.0) * axis);
    }
    cloth.renew();
    wind.half_angle = 0.0;
    const Field3 parallel = cloth.push(wind);
    for (const double half_angle : {1e-2, 1e-3, 1e-5, 1.1e-6, 0.9e-6, 1e-9}) {
      wind.half_angle = half_angle;
      const Field3 cone = cloth.push(wind);
      for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) {
        // Within the cone AC leaves the axis by psi <= half_angle: the direction changes by psi, f_w.d by cos psi, and
        // |d|^2 by tan^2 psi: relatively psi + 2 psi^2 at most, rounding aside (apex up to 2e6 m away at 1.1e-6).
        const double size = parallel.at(n).norm();
        const double rounding = 2.0 / half_angle * 16.0 * kEps;
        ASSERT_LE((cone.at(n) - parallel.at(n)).norm(), size * (half_angle + 2.0 * half_angle * half_angle + rounding))
            << half_angle;
      }
    }
  }
}

// The sum over nodes of area x f is the trapezoid rule over the cloth: with spacing h on a sheet of area S its error is
// at most S h^2/12 (max |f_xx| + max |f_zz|).
TEST(WindSource, TotalForceDoesNotDependOnTheGrid) {
  WindParams wind;
  wind.id = "fan";
  wind.position = {0.4, -0.8, 0.5};
  wind.direction = {0.1, 1.0, 0.1};
  wind.radius = 1.2;
  wind.half_angle = 0.5;  // the whole sheet is inside: no edge of the wind on the cloth
  wind.pressure = 8.0;
  const Cloth fine(flatScene(81, 81));
  const auto pressureAt = [&](double x, double z) -> Vec3 {
    return printedWind(wind, {x, 0.0, z}, Vec3::UnitY(), 1.0, 0.0).force;
  };
  double bend = 0.0;  // [Pa/m^2]
  constexpr double kStep = 1e-3;
  double bend_x = 0.0, bend_z = 0.0;
  for (double x = 0.0; x <= 1.0; x += 0.05) {
    for (double z = 0.0; z <= 1.0; z += 0.05) {
      const Vec3 twice = 2.0 * pressureAt(x, z);
      bend_x = std::max(bend_x, (pressureAt(x + kStep, z) + pressureAt(x - kStep, z) - twice).norm() / (kStep * kStep));
      bend_z = std::max(bend_z, (pressureAt(x, z + kStep) + pressureAt(x, z - kStep) - twice).norm() / (kStep * kStep));
    }
  }
  bend = 1.1 * (bend_x + bend_z);  // sampled every 5 cm only
  const Vec3 total = fine.total(wind);
  EXPECT_GT(total.y(), 1.0);
  double error_before = 0.0;
  for (const int links : {10, 20, 40}) {
    const Vec3 coarse = Cloth(flatScene(links + 1, links + 1)).total(wind);
    const double h = 1.0 / links;
    const double error = (coarse - total).norm();
    EXPECT_LE(error, (h * h + 1.0 / 6400.0) / 12.0 * bend) << links;
    // Order 2; the reference itself is off by h^2/6400 x the same: ratios (1 - 1/64)/(1/4 - 1/64) = 4.2 and 5.
    if (error_before > 0.0) {
      EXPECT_NEAR(error_before / error, links == 20 ? 4.2 : 5.0, 0.3);
    }
    error_before = error;
  }
}

TEST(WindSource, TotalForceOfADiscOnAWiderClothIsItsArea) {
  WindParams wind;
  wind.id = "fan";
  wind.position = {0.5, 0.0, 0.5};
  wind.direction = Vec3::UnitY();
  wind.radius = 0.3;
  wind.pressure = 8.0;
  wind.distance_weight = 2.0;
  const double expected = 8.0 / 2.0 * kPi * 0.09;
  for (const int links : {10, 20, 40, 80}) {
    // Nodes stand for cells of h x h; only cells that the rim cuts may be wrong, and they lie within h/sqrt(2) of it.
    const double h = 1.0 / links;
    const double strip = 2.0 * kPi * 0.3 * 2.0 * h / std::sqrt(2.0);
    EXPECT_NEAR(Cloth(flatScene(links + 1, links + 1)).total(wind).y(), expected, 4.0 * strip) << links;
  }
}

TEST(WindSource, NodeForceIsThePapersForcePerNode) {
  WindParams wind;
  wind.id = "fan";
  wind.position = {0.5, 0.0, 0.5};  // in the cloth's plane: |d| = 0
  wind.direction = Vec3::UnitY();
  wind.radius = 5.0;
  wind.node_force = 0.25;
  for (const int count : {4, 9}) {
    const Cloth cloth(flatScene(count, count));
    const Field3 force = cloth.push(wind);
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        // Normalising the normal rounds a few times.
        EXPECT_NEAR(force.y[cloth.pattern.grid.index(i, j)], 0.25, 8 * kEps) << "whatever its area";
      }
    }
    const Vec3 alone = cloth.total(wind);
    WindParams both = wind;
    both.pressure = 3.0;
    WindParams pressure = both;
    pressure.node_force = 0.0;
    EXPECT_NEAR((cloth.total(both) - cloth.total(pressure) - alone).norm(), 0.0, 100 * 32 * kEps) << "they add up";
  }
}

TEST(WindSource, WeightsScaleTheForce) {
  const Cloth cloth(flatScene(5, 5));
  WindParams wind;
  wind.id = "fan";
  wind.position = {0.5, -1.0, 0.5};
  wind.direction = Vec3::UnitY();
  wind.radius = 5.0;
  wind.pressure = 4.0;
  const double plain = cloth.total(wind).y();
  EXPECT_NEAR(plain, 4.0 / (1.0 + 1.0), 200 * kEps) << "1 m away: half the pressure";
  const auto total = [&](double porosity_weight, double porosity, double distance_weight) {
    WindParams weighted = wind;
    weighted.porosity_weight = porosity_weight;
    weighted.distance_weight = distance_weight;
    const Field3 force = cloth.push(weighted, porosity);
    double sum = 0.0;
    for (const double y : force.y) sum += y;
    return sum;
  };
  EXPECT_NEAR(total(1.0, 0.3, 1.0), 0.7 * plain, 200 * kEps);
  EXPECT_NEAR(total(0.5, 0.3, 1.0), 0.85 * plain, 200 * kEps);
  EXPECT_NEAR(total(0.0, 1.0, 1.0), plain, 200 * kEps);
  EXPECT_EQ(total(1.0, 1.0, 1.0), 0.0) << "all of the air passes through";
  EXPECT_NEAR(total(1.0, 0.0, 4.0), 0.25 * plain, 200 * kEps);
  wind.reference_length = 0.5;
  EXPECT_NEAR(total(1.0, 0.0, 1.0), 4.0 / (1.0 + 4.0), 200 * kEps) << "1 m away is two lengths";
}

TEST(WindSource, BlowsFromStartUntilBeforeEndAndOnlyWithStrength) {
  const Cloth cloth(flatScene(3, 3));
  WindParams wind;
  wind.id = "fan";
  wind.start = 1.0;
  wind.end = 2.0;
  const auto blows = [&](double time) { return WindSource(wind, cloth.pattern, 0.0, 1).blowsAt(time); };
  EXPECT_FALSE(blows(1.5)) << "no pressure, no node force, no gusts";
  for (double* strength : {&wind.pressure, &wind.node_force, &wind.unsteadiness}) {
    *strength = 1.0;
    EXPECT_FALSE(blows(std::nextafter(1.0, 0.0)));
    EXPECT_TRUE(blows(1.0));
    EXPECT_TRUE(blows(std::nextafter(2.0, 0.0)));
    EXPECT_FALSE(blows(2.0));
    *strength = 0.0;
  }
}

// ---- what it can't reach -----------------------------------------------------------------------------------------

Eigen::AlignedBox3d randomBox(Random& random) {
  const Vec3 middle = random.inBox(4.0), half = random.between(0.1, 1.5) * (random.inBox(0.5) + Vec3::Constant(0.5));
  return {middle - half, middle + half};
}

TEST(WindSource, ReachesNoPlaceOfABoxThatItMayNotReach) {
  Random random(8);
  const Cloth cloth(flatScene(2, 2));
  int out_of_reach = 0, missed = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const WindSource source(randomWind(random), cloth.pattern, 0.0, 1);
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

TEST(WindSource, ReachesAlongItsEdge) {
  const Cloth cloth(flatScene(2, 2));
  WindParams wind;
  wind.id = "edge";
  wind.direction = Vec3::UnitX();
  wind.radius = 1.0;
  wind.pressure = 1.0;
  wind.half_angle = std::atan(0.5);
  const WindSource source(wind, cloth.pattern, 0.0, 1);
  const auto at = [](double x, double y) { return Eigen::AlignedBox3d(Vec3(x, y, -0.5), Vec3(x + 1.0, y + 1.0, 0.5)); };
  EXPECT_FALSE(source.mayReach(at(-1.001, -0.5)));  // behind the disc
  EXPECT_TRUE(source.mayReach(at(-0.999, -0.5)));
  EXPECT_FALSE(source.mayReach(at(1.0, 2.001)));  // the cone's radius is 2 where the box ends
  EXPECT_TRUE(source.mayReach(at(1.0, 1.999)));
}

// Parallel wind on the middle of a cloth of 1 m.
WindParams gustless() {
  WindParams wind;
  wind.id = "fan";
  wind.position = {0.5, -1.0, 0.5};
  wind.direction = Vec3::UnitY();
  wind.radius = 0.3;
  wind.pressure = 3.0;
  return wind;
}

TEST(WindSource, FindsNothingOutsideTheBounds) {
  const Cloth cloth(flatScene(5, 5));
  WindSource source(gustless(), cloth.pattern, 0.0, 1);
  source.find(cloth.pattern.grid, cloth.position, Eigen::AlignedBox3d(Vec3(0, 0, 0), Vec3(1, 0, 1)));
  EXPECT_TRUE(source.reaches());
  EXPECT_FALSE(source.reachesRow(0));
  EXPECT_TRUE(source.reachesRow(2));
  source.find(cloth.pattern.grid, cloth.position, Eigen::AlignedBox3d(Vec3(0, 0, 9), Vec3(1, 0, 10)));
  EXPECT_FALSE(source.reaches());
  EXPECT_FALSE(source.reachesRow(2)) << "of an earlier look";
}

// ---- gusts of a source -------------------------------------------------------------------------------------------

WindParams gusts(const std::string& id) {
  WindParams wind;
  wind.id = id;
  wind.position = {0.5, 0.0, 0.5};
  wind.direction = Vec3::UnitY();
  wind.radius = 5.0;
  wind.unsteadiness = 2.0;
  return wind;
}

// Sum over nodes and times of the product of two sources' gusts over the geometric mean of their squares.
double likeness(const WindParams& one, std::uint64_t seed_one, const WindParams& other, std::uint64_t seed_other) {
  const Cloth cloth(flatScene(9, 9));
  WindSource a(one, cloth.pattern, 0.0, seed_one), b(other, cloth.pattern, 0.0, seed_other);
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (int sample = 0; sample < 500; ++sample) {
    const double time = 2.1 * sample * one.correlation_time;
    const Field3 fa = cloth.push(a, time), fb = cloth.push(b, time);
    for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) {
      ab += fa.at(n).dot(fb.at(n));
      aa += fa.at(n).squaredNorm();
      bb += fb.at(n).squaredNorm();
    }
  }
  return ab / std::sqrt(aa * bb);
}

TEST(WindSource, GustsRepeatWithIdAndSeedAndAreTheirOwnOtherwise) {
  // 500 independent times x 3 components x at least one independent patch: 1/sqrt(1500) = 0.026 standard deviation.
  EXPECT_NEAR(likeness(gusts("a"), 1, gusts("a"), 1), 1.0, 1e-12);
  EXPECT_NEAR(likeness(gusts("a"), 1, gusts("b"), 1), 0.0, 5 * 0.026);
  EXPECT_NEAR(likeness(gusts("a"), 1, gusts("a"), 2), 0.0, 5 * 0.026);
  EXPECT_NEAR(likeness(gusts("fan"), 1, gusts("fan2"), 1), 0.0, 5 * 0.026);
}

TEST(WindSource, GustsStartWithTheSource) {
  const Cloth cloth(flatScene(4, 4));
  WindParams wind = gusts("a");
  WindSource early(wind, cloth.pattern, 0.0, 1);
  wind.start = 8.0;
  WindSource late(wind, cloth.pattern, 0.0, 1);
  const Field3 a = cloth.push(early, 0.375), b = cloth.push(late, 8.375);  // exact in binary
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) EXPECT_EQ(a.at(n), b.at(n));
}

TEST(WindSource, GustsAreTheUnsteadinessInPascalOnTheNodesArea) {
  const Cloth cloth(flatScene(9, 9));
  WindSource source(gusts("a"), cloth.pattern, 0.0, 1);
  double sum = 0.0;
  int count = 0;
  for (int sample = 0; sample < 2000; ++sample) {
    const Field3 force = cloth.push(source, 2.1 * sample * 0.2);
    for (const auto& [i, j] : {std::pair{0, 0}, std::pair{4, 4}, std::pair{8, 3}}) {
      const std::size_t n = cloth.pattern.grid.index(i, j);
      sum += (force.at(n) / (2.0 * cloth.pattern.area[n])).squaredNorm();
      count += 3;
    }
  }
  // Variance 1 a component; 2000 independent times x 3 components x 3 nodes more than a correlation length apart.
  EXPECT_NEAR(sum / count, 1.0, 5.0 * std::sqrt(2.0 / count));
}

}  // namespace
}  // namespace curtain
