// SPDX-License-Identifier: BSD-3-Clause
//
// A bar that spins beside the cloth, into it, gives it what its work says and no more: at 10 to 50 revolutions a second
// its ends move by many links in a frame, and pass nodes by less than the distance that is kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "energy_books.h"
#include "scene/pi.h"
#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

Scene beside() {
  Scene scene = flatScene(12, 10);
  scene.hang.from.z() = scene.hang.to.z() = 2.0;
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  ObstacleParams bar;
  bar.name = "bar";
  bar.shape = ShapeKind::kBox;
  bar.size = Vec3(0.6, 0.1, 0.3);
  bar.pose.position = Vec3(0.5, -1.0, 1.4);
  scene.obstacles = {bar};
  return scene;
}

class SpinningBar : public ::testing::TestWithParam<double> {};

TEST_P(SpinningBar, GivesWhatItsWorkSays) {
  const double per_second = GetParam(), rate = std::max(60.0, 6.0 * per_second);
  Scene scene = beside();
  scene.solver.frame_rate = rate;
  double max_work = 0.0;
  for (const double away : {0.0825, 0.0925, 0.1, 0.1075, 0.115, 0.1225, 0.13, 0.1375, 0.145}) {
    Simulator simulator(scene);
    const auto turned = [&](double turns) {
      Pose pose;
      pose.position = Vec3(0.5, away, 1.4);
      pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(2.0 * kPi * turns, Vec3::UnitX()));
      return pose;
    };
    simulator.setObstaclePose(0, turned(0.0), true);
    simulator.countWork(true);
    EnergyBooks books(weightScale(simulator));
    books.open(simulator);
    for (int frame = 0; simulator.time() < 1.5; ++frame) {
      simulator.setObstaclePose(0, turned(per_second * (frame + 1) / rate), false);
      simulator.step();
      books.look(simulator, false);
    }
    EXPECT_LE(books.gain(), kSchemeGain) << per_second << " rev/s, " << away << " m away";
    max_work = std::max(max_work, simulator.work().obstacles / weightScale(simulator));
  }
  EXPECT_GT(max_work, 1.0);  // it does hit the cloth
}

INSTANTIATE_TEST_SUITE_P(Speeds, SpinningBar, ::testing::Values(10.0, 20.0, 35.0, 50.0), [](const auto& it) {
  return "At" + std::to_string(static_cast<int>(it.param)) + "RevolutionsASecond";
});

}  // namespace
}  // namespace curtain
