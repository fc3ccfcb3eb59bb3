// SPDX-License-Identifier: BSD-3-Clause
//
// A wind source does what Cheng 2000, Eqs. (2)(3) say, the same to both sides of the cloth, and, given as a pressure,
// the same to a cloth whatever its grid.
#include "parts/wind/wind_source.h"

#include <gtest/gtest.h>

#include <cmath>

#include "parts/wind_on_cloth.h"

namespace curtain {
namespace {

using namespace curtain_test;

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

TEST(WindSource, IsEquations2And3AtRandomPlacesOfRandomCones) {
  Random random(21);
  WindyCloth cloth(flatScene(8, 8));
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

TEST(WindSource, PushesBothSidesOfTheClothAlike) {
  Random random(22);
  WindyCloth cloth(flatScene(6, 6));
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
  WindyCloth cloth(flatScene(4, 4));  // in the plane y = 0
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
  WindyCloth cloth(flatScene(8, 8));
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
  const WindyCloth fine(flatScene(81, 81));
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
    const Vec3 coarse = WindyCloth(flatScene(links + 1, links + 1)).total(wind);
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
  WindParams wind = fanAt({0.5, 0.0, 0.5}, 0.3);
  wind.pressure = 8.0;
  wind.distance_weight = 2.0;
  const double expected = 8.0 / 2.0 * kPi * 0.09;
  for (const int links : {10, 20, 40, 80}) {
    // Nodes stand for cells of h x h; only cells that the rim cuts may be wrong, and they lie within h/sqrt(2) of it.
    const double h = 1.0 / links;
    const double strip = 2.0 * kPi * 0.3 * 2.0 * h / std::sqrt(2.0);
    EXPECT_NEAR(WindyCloth(flatScene(links + 1, links + 1)).total(wind).y(), expected, 4.0 * strip) << links;
  }
}

TEST(WindSource, NodeForceIsThePapersForcePerNode) {
  WindParams wind = fanAt({0.5, 0.0, 0.5}, 5.0);  // in the cloth's plane: |d| = 0
  wind.node_force = 0.25;
  for (const int count : {4, 9}) {
    const WindyCloth cloth(flatScene(count, count));
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
  const WindyCloth cloth(flatScene(5, 5));
  WindParams wind = fanAt({0.5, -1.0, 0.5}, 5.0);
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
  const WindyCloth cloth(flatScene(3, 3));
  WindParams wind;
  wind.id = "fan";
  wind.start = 1.0;
  wind.end = 2.0;
  const auto blows = [&](double time) {
    return WindSource(wind, cloth.pattern, porous(cloth.pattern, 0.0), 1).blowsAt(time);
  };
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

}  // namespace
}  // namespace curtain
