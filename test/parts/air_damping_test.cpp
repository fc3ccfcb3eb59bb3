// SPDX-License-Identifier: BSD-3-Clause
//
// Air damping is Cheng 2000, Eq. (4), per area, by the node's place; the velocity update that carries it never turns a
// node around, keeps the terminal velocity, and tends to the exact motion as the step shrinks.
#include "parts/air/air_damping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "step/substep.h"
#include "testing.h"
#include "truth_table.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kEps;
using curtain_test::ringScene;

Field coefficients(const AirParams& air, const Scene& scene, double speed) {
  const ClothPattern pattern = makePattern(scene);
  const AirDamping damping(air, scene.cloth, pattern);
  Field3 velocity;
  velocity.assign(pattern.grid.size(), 0.0);
  const Vec3 v = speed * Vec3(2.0, -3.0, 6.0) / 7.0;
  for (std::size_t n = 0; n < pattern.grid.size(); ++n) velocity.set(n, v);
  Field out(pattern.grid.size(), 0.0);
  damping.addCoefficients(velocity, out);
  return out;
}

TEST(DampingGrowth, IsEquation4Printed) {
  AirParams air;
  air.law = AirLaw::kPrinted;
  for (const double threshold : {0.5, 1.0, 2.0}) {
    air.threshold = threshold;
    // Force over rho c_r v: 1 up to the threshold, |v| above.
    EXPECT_EQ(dampingGrowth(air, 0.0), 1.0);
    EXPECT_EQ(dampingGrowth(air, threshold), 1.0) << "<= threshold is still the first branch";
    EXPECT_EQ(dampingGrowth(air, std::nextafter(threshold, 9.0)), std::nextafter(threshold, 9.0));
    EXPECT_EQ(dampingGrowth(air, 7.0), 7.0);
  }
}

TEST(DampingGrowth, ContinuousLawHasNoJumpAndTheSameBranches) {
  AirParams air;
  for (const double threshold : {0.5, 1.0, 2.0}) {
    air.threshold = threshold;
    EXPECT_EQ(dampingGrowth(air, 0.0), 1.0);
    EXPECT_EQ(dampingGrowth(air, threshold), 1.0);
    EXPECT_NEAR(dampingGrowth(air, std::nextafter(threshold, 9.0)), 1.0, 2 * kEps);
    EXPECT_EQ(dampingGrowth(air, 8.0 * threshold), 8.0);
  }
}

TEST(DampingGrowth, FastGainRaisesTheCoefficientWithSpeed) {
  AirParams air;
  air.fast_gain = 0.5;
  air.threshold = 2.0;
  EXPECT_EQ(dampingGrowth(air, 1.0), 1.5);
  EXPECT_EQ(dampingGrowth(air, 4.0), 3.0 * 2.0);
  air.law = AirLaw::kPrinted;
  EXPECT_EQ(dampingGrowth(air, 4.0), 3.0 * 4.0);
}

TEST(AirDamping, CoefficientsAreByPlaceTimesAreaTimesDensity) {
  AirParams air;
  air.density = 1.5;
  air.inside = 0.25;
  air.border = 0.5;
  air.corner = 2.0;
  for (const bool closed : {false, true}) {
    const Scene scene = closed ? ringScene(5, 6) : flatScene(5, 6);
    const ClothPattern pattern = makePattern(scene);
    const Field slow = coefficients(air, scene, 0.5);
    const Field fast = coefficients(air, scene, 3.0);
    for (int i = 0; i < 5; ++i) {
      for (int j = 0; j < 6; ++j) {
        const int missing = (i == 0 || i == 4 ? 1 : 0) + (!closed && (j == 0 || j == 5) ? 1 : 0);
        const double place = missing == 0 ? 0.25 : missing == 1 ? 0.5 : 2.0;
        const std::size_t n = pattern.grid.index(i, j);
        EXPECT_NEAR(slow[n], 1.5 * place * pattern.area[n], 4 * kEps) << i << ", " << j << (closed ? " closed" : "");
        EXPECT_NEAR(fast[n], 3.0 * slow[n], 16 * kEps);
      }
    }
  }
}

TEST(AirDamping, AddsToWhatIsThereAndLeavesPaddingAlone) {
  AirParams air;
  air.inside = air.border = air.corner = 1.0;
  const Scene scene = flatScene(3, 3);
  const ClothPattern pattern = makePattern(scene);
  const AirDamping damping(air, scene.cloth, pattern);
  Field3 velocity;
  velocity.assign(pattern.grid.size(), 0.0);
  Field once(pattern.grid.size(), 0.0), on_top(pattern.grid.size(), 4.0);
  damping.addCoefficients(velocity, once);
  damping.addCoefficients(velocity, on_top);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < pattern.grid.stride; ++j) {
      const std::size_t n = pattern.grid.index(i, j);
      EXPECT_EQ(on_top[n], 4.0 + once[n]);
      EXPECT_EQ(once[n] > 0.0, j < 3);
    }
  }
}

TEST(AirDamping, TotalDoesNotDependOnTheGrid) {
  AirParams air;
  air.inside = air.border = air.corner = 0.7;
  for (const int count : {3, 10, 60}) {
    double sum = 0.0;
    for (const double c : coefficients(air, flatScene(count, count, 1.5, 2.0), 0.1)) sum += c;
    EXPECT_NEAR(sum, 1.2 * 0.7 * 3.0, count * count * kEps * 3.0) << count;
  }
}

TEST(AirDamping, IsActiveWhenAnyPlaceHasACoefficient) {
  const Scene sheet = flatScene(4, 4), closed = ringScene(4, 4);
  const ClothPattern pattern = makePattern(sheet), ring = makePattern(closed);
  const AirParams none;
  EXPECT_FALSE(AirDamping(none, sheet.cloth, pattern).active());
  for (double AirParams::*place : {&AirParams::inside, &AirParams::border, &AirParams::corner}) {
    AirParams air;
    air.*place = 0.1;
    EXPECT_TRUE(AirDamping(air, sheet.cloth, pattern).active());
    EXPECT_EQ(AirDamping(air, closed.cloth, ring).active(), place != &AirParams::corner) << "a ring has no corners";
    air.density = 0.0;
    EXPECT_FALSE(AirDamping(air, sheet.cloth, pattern).active());
  }
}

// ---- the update of one node ----------------------------------------------------------------------------------------

TEST(DampedStep, NeverReversesOrSpeedsUpAtAnyCoefficientAndStep) {
  for (double c = 1e-12; c <= 1.1e12; c *= 10.0) {
    for (double w = 1e-6; w <= 1.1e6; w *= 100.0) {
      for (double dt = 1e-9; dt <= 1.1e3; dt *= 10.0) {
        const DampedStep step = dampedStep(c, w, dt);
        ASSERT_GT(step.keep, 0.0) << c << ' ' << w << ' ' << dt;
        ASSERT_LE(step.keep, 1.0);
        ASSERT_GT(step.gain, 0.0);
        ASSERT_LE(step.gain, 1.0);
      }
    }
  }
  EXPECT_EQ(dampedStep(0.0, 3.0, 0.1).keep, 1.0);
  EXPECT_EQ(dampedStep(0.0, 3.0, 0.1).gain, 1.0);
  EXPECT_EQ(dampedStep(1e12, 0.0, 0.1).keep, 1.0) << "pinned";
}

TEST(DampedStep, KeepsTheTerminalVelocityAndNeverPassesIt) {
  const double force = 0.7;
  for (double c = 1e-12; c <= 1.1e12; c *= 10.0) {
    for (double dt = 1e-6; dt <= 1.1; dt *= 10.0) {
      const double w = 4.0;
      const double terminal = force / c;
      const DampedStep step = dampedStep(c, w, dt);
      const auto next = [&](double v) { return step.keep * v + step.gain * w * force * dt; };
      // About eight roundings, each relative: keep, gain, their products and the sum of two positive terms.
      EXPECT_NEAR(next(terminal), terminal, 8.0 * kEps * terminal) << c << ' ' << dt;
      for (const double share : {0.0, 0.5, 0.99}) EXPECT_LE(next(share * terminal), terminal * (1.0 + 8.0 * kEps));
      for (const double share : {1.01, 2.0, 1e6}) EXPECT_GE(next(share * terminal), terminal * (1.0 - 8.0 * kEps));
    }
  }
}

TEST(DampedStep, AgreesWithTheExponentialToSecondOrder) {
  for (const double z : {1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
    const DampedStep step = dampedStep(z, 1.0, 1.0);
    // e^-z - keep = -z^3/6 + O(z^4), (1 - e^-z)/z - gain = z^2/6 + O(z^3).
    EXPECT_NEAR(step.keep, std::exp(-z), z * z * z / 6.0 + kEps) << z;
    EXPECT_NEAR(step.gain, -std::expm1(-z) / z, z * z / 6.0 + kEps) << z;
  }
}

// ---- against the exact motion of one node (test/truth/damping_law.csv) ---------------------------------------------

struct Case {
  double gravity, k, m, threshold, v0;
  std::vector<double> t, v, x;

  bool linearAt(double speed) const { return speed <= threshold; }
  // Speeds tend to their end one way, so the samples tell. Reaching counts: the motion may stay on the threshold.
  bool crosses() const { return v0 < threshold ? v.back() >= threshold : v.back() <= threshold; }
  double drag(double speed) const { return (linearAt(speed) ? k * speed : k * speed * speed) / m; }
};

std::vector<Case> truth() {
  std::map<std::vector<double>, Case> cases;
  for (const auto& row : curtain_test::readTruth("damping_law.csv")) {
    const auto number = [&](const char* name) { return std::stod(row.at(name)); };
    const std::vector<double> key = {number("gravity"), number("k=rho*c_r"), number("m"), number("vt"), number("v0")};
    Case& c = cases[key];
    std::tie(c.gravity, c.k, c.m, c.threshold, c.v0) = std::tie(key[0], key[1], key[2], key[3], key[4]);
    c.t.push_back(number("t"));
    c.v.push_back(number("v_exact"));
    c.x.push_back(number("x_exact"));
  }
  std::vector<Case> list;
  for (auto& entry : cases) list.push_back(entry.second);
  return list;
}

struct Motion {
  double v = 0.0, x = 0.0;
};

// One free node of area 1 m^2: what a solver does with the coefficients of the step's start.
Motion integrate(const Case& c, double until, double dt) {
  AirParams air;
  air.law = AirLaw::kPrinted;
  air.threshold = c.threshold;
  Motion motion{c.v0, 0.0};
  const auto steps = static_cast<int>(std::lround(until / dt));
  for (int n = 0; n < steps; ++n) {
    const double before = motion.v;
    const DampedStep step = dampedStep(c.k * dampingGrowth(air, std::abs(before)), 1.0 / c.m, dt);
    motion.v = step.keep * before + step.gain * c.gravity * dt;
    motion.x += 0.5 * (before + motion.v) * dt;
  }
  return motion;
}

constexpr double kPrinted = 1e-12;  // the table gives 14 digits of numbers up to 50

// Errors of v and x at a time for a step dt, for motion on one branch (or across a threshold of 1, where the branches
// meet). The law rises with v, so errors do not grow: they are at most the sum of those of the steps.
//   linear:    the rational factors miss e^-z by z^3/6 of the distance to the terminal velocity: a step by z^2/6 a dt
//   quadratic: the coefficient is the start's; it changes by k a dt within a step, weighs half of that over the step,
//              and acts on v: k/m a v dt^2 / 2 a step, besides the linear one with z = k v dt/m
// a, the size of the acceleration, shrinks on the way to the terminal velocity, so the start's is the largest; v is
// largest at one of its ends. Terms of the next order: 10 %, steps are chosen so that z <= 0.1.
Motion bound(const Case& c, double until, double v_end, double dt) {
  const double fastest = std::max(c.v0, v_end);
  const double slope = c.linearAt(fastest) ? 1.0 : fastest;  // growth
  const double a = std::abs(c.gravity - c.drag(c.v0));
  const double z = c.k / c.m * slope * dt;
  double rate = z * z / 6.0 * a;
  if (!c.linearAt(fastest)) rate += 0.5 * c.k / c.m * a * fastest * dt;
  const double ev = 1.1 * until * rate;
  // Trapezoid rule: v'' = (d drag / d v) a.
  const double bend = c.k / c.m * (c.linearAt(fastest) ? 1.0 : 2.0 * fastest) * a;
  return {ev + kPrinted, until * ev + 1.1 * until * dt * dt / 12.0 * bend + until * dt * ev + kPrinted};
}

double stepFor(const Case& c, double until, double z) {
  const double fastest = std::max({c.v0, c.v.back(), 1.0});
  const double wanted = std::min(0.05, z / (c.k / c.m * fastest));
  return until / std::ceil(until / wanted);
}

TEST(DampedMotion, TendsToTheExactOneOnEachBranch) {
  int linear = 0, quadratic = 0;
  for (const Case& c : truth()) {
    if (c.crosses()) continue;
    ++(c.linearAt(c.v0) ? linear : quadratic);
    for (std::size_t sample = 0; sample < c.t.size(); ++sample) {
      for (const double z : {0.1, 0.02, 0.004}) {
        const double dt = stepFor(c, c.t[sample], z);
        const Motion motion = integrate(c, c.t[sample], dt);
        const Motion error = bound(c, c.t[sample], c.v[sample], dt);
        EXPECT_NEAR(motion.v, c.v[sample], error.v)
            << "k " << c.k << " m " << c.m << " v0 " << c.v0 << " t " << c.t[sample];
        EXPECT_NEAR(motion.x, c.x[sample], error.x)
            << "k " << c.k << " m " << c.m << " v0 " << c.v0 << " t " << c.t[sample];
      }
    }
  }
  EXPECT_GT(linear, 20);
  EXPECT_GT(quadratic, 20);
}

// Order: error of a step over that of half of it, where the errors are far above the table's digits. The next term of
// the error is z times the first, z <= 0.02 here: 10 % allows for its factor of up to 5.
TEST(DampedMotion, ConvergesWithOrder2OnTheLinearAnd1OnTheQuadraticBranch) {
  int linear = 0, quadratic = 0;
  for (const Case& c : truth()) {
    if (c.crosses()) continue;
    const bool is_linear = c.linearAt(c.v0);
    for (std::size_t sample = 0; sample < c.t.size(); ++sample) {
      const double dt = stepFor(c, c.t[sample], 0.02);
      const double coarse = std::abs(integrate(c, c.t[sample], dt).v - c.v[sample]);
      const double fine = std::abs(integrate(c, c.t[sample], 0.5 * dt).v - c.v[sample]);
      // Where the exact motion has come to rest or to its terminal velocity there is no error left to halve.
      if (fine < 1e3 * kPrinted || coarse < 1e-6 * std::abs(c.v[sample] - c.v0)) continue;
      ++(is_linear ? linear : quadratic);
      const double order = is_linear ? 4.0 : 2.0;
      EXPECT_NEAR(coarse / fine, order, 0.1 * order)
          << "k " << c.k << " m " << c.m << " vt " << c.threshold << " v0 " << c.v0 << " t " << c.t[sample];
    }
  }
  EXPECT_GT(linear, 20);
  EXPECT_GT(quadratic, 20);
}

// Across a threshold other than 1 m/s the printed law jumps. A step that crosses carries the wrong branch for at most
// dt: an error of dt |a1 - a2|, a1 before, a2 after; and errors of the crossing's time turn errors e before it into e
// a2/a1. Where the two branches push against each other (vt > 1, one slows what the other speeds up) the motion stays
// on the threshold and the steps dither about it by at most one step's change, dt (|a1| + |a2|).
TEST(DampedMotion, TendsToTheExactOneAcrossTheThreshold) {
  int smooth = 0, jumping = 0, sliding = 0;
  for (const Case& c : truth()) {
    if (!c.crosses()) continue;
    const double low = c.gravity - c.k * c.threshold / c.m;
    const double high = c.gravity - c.k * c.threshold * c.threshold / c.m;
    const double a1 = c.linearAt(c.v0) ? low : high;
    const double a2 = c.linearAt(c.v0) ? high : low;
    const bool slides = a1 * a2 < 0.0;
    ++(c.threshold == 1.0 ? smooth : slides ? sliding : jumping);
    for (std::size_t sample = 0; sample < c.t.size(); ++sample) {
      for (const double z : {0.05, 0.01, 0.002}) {
        const double dt = stepFor(c, c.t[sample], z);
        const Motion motion = integrate(c, c.t[sample], dt);
        Case fast = c;  // the bound of the quadratic branch holds for both: its slope is the larger
        fast.threshold = std::min(c.threshold, 0.999 * std::max(c.v0, c.v[sample]));
        const Motion one_branch = bound(fast, c.t[sample], c.v[sample], dt);
        // The largest acceleration may be that after the jump.
        const double largest = std::max({std::abs(c.gravity - c.drag(c.v0)), std::abs(a1), std::abs(a2)});
        const double scale = largest / std::max(1e-300, std::abs(c.gravity - c.drag(c.v0)));
        const double smooth_error = std::max(1.0, scale) * one_branch.v;
        const double jump = slides ? dt * (std::abs(a1) + std::abs(a2)) : dt * std::abs(a1 - a2);
        const double growth = slides ? 1.0 : std::max(1.0, a2 / a1);
        const double ev = (smooth_error + jump) * growth;
        const double ex = c.t[sample] * ev + std::max(1.0, scale) * one_branch.x + dt * jump;
        EXPECT_NEAR(motion.v, c.v[sample], ev) << "k " << c.k << " m " << c.m << " vt " << c.threshold << " v0 " << c.v0
                                               << " g " << c.gravity << " t " << c.t[sample] << " dt " << dt;
        EXPECT_NEAR(motion.x, c.x[sample], ex) << "k " << c.k << " m " << c.m << " vt " << c.threshold << " v0 " << c.v0
                                               << " g " << c.gravity << " t " << c.t[sample] << " dt " << dt;
      }
    }
  }
  EXPECT_GT(smooth, 10);
  EXPECT_GT(jumping, 10);
  EXPECT_GT(sliding, 0);
}

}  // namespace
}  // namespace curtain
