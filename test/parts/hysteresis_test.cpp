// SPDX-License-Identifier: BSD-3-Clause
//
// Friction within the fabric: its force is the slope of what it stores and leaves no momentum, and a strip that is bent
// to and fro runs round the loop that KES measures.
#include "parts/hysteresis/hysteresis.h"

#include <gtest/gtest.h>

#include <cmath>

#include "parts/elastic_fabric.h"
#include "scene/pi.h"

namespace curtain {
namespace {

using curtain_test::Fabric;

constexpr double kWidth = 1.2e-3;          // 2HB [N]
constexpr double kBendingRigidity = 1e-4;  // B [N m]
constexpr double kSlider = 10.0;           // K_p / B

Scene rubbing(Scene scene) {
  scene.cloth.bending_warp = scene.cloth.bending_weft = kBendingRigidity;
  scene.cloth.bending_hysteresis = kWidth;
  scene.pins.kind = PinKind::kNone;
  return scene;
}

TEST(Hysteresis, ForceIsTheEnergysSlopeAndLeavesNoMomentum) {
  for (const Scene& scene : curtain_test::fabricScenes()) {
    for (const double reach : {1e-4, 0.03}) {  // sliders that stick, and that slip
      Fabric fabric(rubbing(scene));
      Hysteresis friction(fabric.scene.cloth, fabric.pattern);
      friction.commit(fabric.position);
      curtain_test::shake(fabric.pattern, reach, 3, fabric.position);
      curtain_test::expectSlope(fabric, friction);
    }
  }
}

// A strip along the warp or the weft, bent to an arc of this curvature.
void bend(Fabric& fabric, bool warp, double curvature) {
  const Grid& grid = fabric.pattern.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const double rest =
          warp ? fabric.pattern.warp_rest[grid.index(1, 0)] : fabric.pattern.weft_rest[grid.index(0, 1)];
      const double turn = curvature * rest;  // at each joint
      const int links = warp ? i : j;
      double along = 0.0, up = 0.0;
      for (int k = 0; k < links; ++k) {
        along += rest * std::cos(k * turn);
        up += rest * std::sin(k * turn);
      }
      const double across = 0.1 * (warp ? j : -i);
      fabric.position.set(grid.index(i, j), warp ? Vec3(across, up, -along) : Vec3(along, up, across));
    }
  }
}

// Moment of the strip: work of its couples for each turn of its joints.
double momentOf(Fabric& fabric, Hysteresis& friction, bool warp, double curvature) {
  constexpr double kStep = 1e-6;
  double low = 0.0, high = 0.0;
  bend(fabric, warp, curvature - kStep);
  friction.forceAt(fabric.position, low);
  bend(fabric, warp, curvature + kStep);
  friction.forceAt(fabric.position, high);
  bend(fabric, warp, curvature);
  return (high - low) / (2.0 * kStep);
}

// Width 2HB, area 4 HB (k - HB / K_p), and what was dissipated is that area. sin(turn) for turns of 0.02 is off by 7e-5
// of it, and steps of 1/200 of the way by as much where the loop turns round.
TEST(Hysteresis, RunsRoundTheLoopOfKes) {
  for (const bool warp : {true, false}) {
    Fabric fabric(rubbing(warp ? curtain_test::flatScene(21, 2, 0.4, 0.1) : curtain_test::flatScene(2, 21, 0.1, 0.4)));
    Hysteresis friction(fabric.scene.cloth, fabric.pattern);
    constexpr double kMost = 2.0;  // curvature [1/m]
    constexpr int kSteps = 200;
    constexpr double kJoints = 19 * 0.02;  // length that turns [m]
    constexpr double kStrip = 0.1;         // its width [m]
    double area = 0.0, dissipated = 0.0, last = 0.0, at_zero[2] = {0.0, 0.0};
    const auto go = [&](double curvature, double step) {
      const double moment = momentOf(fabric, friction, warp, curvature) / (kJoints * kStrip);
      area += 0.5 * (moment + last) * step;
      last = moment;
      dissipated += friction.commit(fabric.position);
      return moment;
    };
    for (int k = 1; k <= kSteps; ++k) go(kMost * k / kSteps, 0.0);
    area = dissipated = 0.0;
    for (const int way : {-1, 1}) {
      for (int k = 1; k <= 2 * kSteps; ++k) {
        const double curvature = -way * kMost * (1.0 - static_cast<double>(k) / kSteps);
        const double moment = go(curvature, way * kMost / kSteps);
        if (k == kSteps) at_zero[way > 0 ? 1 : 0] = moment;
      }
    }
    const double loop = 2.0 * kWidth * (kMost - 0.5 * kWidth / (kSlider * kBendingRigidity));
    EXPECT_NEAR(at_zero[1] - at_zero[0], kWidth, 1e-2 * kWidth) << warp;
    EXPECT_NEAR(area, loop, 1e-2 * loop) << warp;
    EXPECT_NEAR(dissipated / (kJoints * kStrip), loop, 1e-2 * loop) << warp;
  }
}

TEST(Hysteresis, NoFrequencyIsAboveItsBound) {
  for (const Scene& scene : {curtain_test::flatScene(7, 6), curtain_test::unevenScene(7, 6, false)}) {
    const Fabric fabric(rubbing(scene));
    Hysteresis friction(fabric.scene.cloth, fabric.pattern);
    const double largest = curtain_test::largestOmegaSquared(fabric, friction);
    EXPECT_LE(largest, friction.omegaSquared() * (1.0 + 1e-6));
    EXPECT_GT(largest, 0.1 * friction.omegaSquared());
  }
}

// What substeps leave behind is taken back where they are repeated.
TEST(Hysteresis, RemembersItsSlips) {
  Fabric fabric(rubbing(curtain_test::fabricScenes()[0]));
  Hysteresis friction(fabric.scene.cloth, fabric.pattern);
  std::vector<double> memory;
  friction.save(memory);
  double before = 0.0, after = 0.0;
  const Field3 at_start = fabric.position;
  friction.forceAt(at_start, before);
  curtain_test::shake(fabric.pattern, 0.03, 3, fabric.position);
  EXPECT_GT(friction.commit(fabric.position), 0.0);
  EXPECT_EQ(friction.commit(fabric.position), 0.0);
  friction.forceAt(at_start, after);
  EXPECT_NE(before, after);
  EXPECT_EQ(friction.restore(memory.data()), memory.data() + memory.size());
  friction.forceAt(at_start, after);
  EXPECT_EQ(before, after);
}

}  // namespace
}  // namespace curtain
