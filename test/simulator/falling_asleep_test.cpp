// SPDX-License-Identifier: BSD-3-Clause
//
// When cloth falls asleep, told where it is: no motion is computed. Whole simulators: sleep_test.cpp, wake_test.cpp.
#include <gtest/gtest.h>

#include <vector>

#include "simulator/rest.h"
#include "testing.h"

namespace curtain {
namespace {

constexpr double kFrame = 1.0 / 60.0;
constexpr double kWindow = 0.5;                // s; as long must the cloth keep to its place
constexpr double kSpeed = 1e-3;                // m/s
constexpr double kAllowed = kSpeed * kWindow;  // m, from its place

Scene restingScene() {
  Scene scene = curtain_test::flatScene(4, 7);
  scene.solver.frame_rate = 60.0;
  scene.solver.rest_speed = kSpeed;
  scene.solver.stretch_tolerance = 1e-3;
  return scene;
}

// Seven columns at rest; one that is told to drifts on by so much a frame.
struct Cloth {
  Cloth() { rest.setLimits(0.0); }
  // So many seconds from now on.
  void wait(double seconds) {
    for (const double end = time + seconds - 1e-9; time < end;) {
      time += kFrame;
      for (int i = 1; i < 4; ++i) state.position.add(pattern.grid.index(i, 2), Vec3(drift, 0.0, 0.0));
      if (rest.due()) rest.check(state, time, gusts, touches);
    }
  }

  Scene scene = restingScene();
  ClothPattern pattern = makePattern(scene);
  ClothState state = makeInitialState(scene, pattern);
  Rest rest{scene, pattern};
  double drift = 0.0;
  bool gusts = false, touches = false;
  double time = 0.0;
};

TEST(FallingAsleep, IsConsideredEverySevenNineFiveAndElevenFrames) {
  Cloth cloth;
  std::vector<int> due;
  for (int frame = 0; frame < 34; ++frame) {
    if (cloth.rest.due()) due.push_back(frame);
  }
  EXPECT_EQ(due, (std::vector<int>{0, 7, 16, 21, 32}));
}

TEST(FallingAsleep, TakesHalfASecondInPlace) {
  Cloth cloth;
  cloth.wait(kWindow);
  EXPECT_FALSE(cloth.rest.asleep());
  EXPECT_TRUE(cloth.rest.watches());
  cloth.wait(11 * kFrame);
  EXPECT_TRUE(cloth.rest.asleep());
}

TEST(FallingAsleep, IsNotForClothOfWhichAColumnDrifts) {
  Cloth cloth;
  cloth.drift = 1.2 * kAllowed / (kWindow / kFrame);
  cloth.wait(3.0);
  EXPECT_FALSE(cloth.rest.asleep());
  cloth.drift = 0.0;
  cloth.wait(1.0);
  EXPECT_TRUE(cloth.rest.asleep());
}

TEST(FallingAsleep, IsNotForClothOfWhichANodeIsFast) {
  Cloth cloth;
  cloth.state.velocity.set(cloth.pattern.grid.index(3, 6), Vec3(0.0, 51.0 * kSpeed, 0.0));
  cloth.wait(1.0);
  EXPECT_FALSE(cloth.rest.asleep());
  EXPECT_FALSE(cloth.rest.watches());
}

TEST(FallingAsleep, IsNotForClothInGusts) {
  Cloth cloth;
  cloth.gusts = true;
  cloth.wait(1.0);
  EXPECT_FALSE(cloth.rest.asleep());
  cloth.gusts = false;
  cloth.wait(11 * kFrame);
  EXPECT_TRUE(cloth.rest.asleep()) << "it kept to its place meanwhile";
}

// In contact the solve leaves nodes anywhere within the tolerance of a link: 8 of these are allowed.
TEST(FallingAsleep, AllowsClothInContactItsJitter) {
  Cloth cloth;
  const double jitter = 8.0 * 1e-3 * shortestLink(cloth.pattern);
  ASSERT_GT(jitter, 2.0 * kAllowed);
  cloth.drift = 0.5 * (kAllowed + jitter) / (kWindow / kFrame);
  cloth.touches = true;
  cloth.wait(1.0);
  EXPECT_TRUE(cloth.rest.asleep());
}

TEST(FallingAsleep, BeginsAgainWhenDisturbed) {
  Cloth cloth;
  cloth.wait(1.0);
  EXPECT_FALSE(cloth.rest.wake()) << "nothing disturbs it";
  cloth.rest.disturb();
  EXPECT_TRUE(cloth.rest.asleep()) << "until it is woken";
  EXPECT_TRUE(cloth.rest.wake());
  EXPECT_FALSE(cloth.rest.asleep());
  EXPECT_EQ(cloth.rest.wakes(), 1);
  EXPECT_FALSE(cloth.rest.wake()) << "it is awake";
  cloth.wait(kWindow);
  EXPECT_FALSE(cloth.rest.asleep()) << "it starts resting again";
  cloth.wait(22 * kFrame);
  EXPECT_TRUE(cloth.rest.asleep());
}

TEST(FallingAsleep, NeedsGravityAndSpeedAndShortFrames) {
  Cloth cloth;
  const Scene good = cloth.scene;
  const auto canWith = [&cloth](const Scene& scene) {
    cloth.scene = scene;
    cloth.rest.setLimits(0.0);
    return cloth.rest.can();
  };
  Scene bad = good;
  bad.gravity = Vec3::Zero();
  EXPECT_FALSE(canWith(bad));
  bad = good;
  bad.solver.rest_speed = 0.0;
  EXPECT_FALSE(canWith(bad));
  bad = good;
  bad.solver.frame_rate = 1.0 / 0.06;
  EXPECT_FALSE(canWith(bad));
  EXPECT_TRUE(canWith(good));
}

}  // namespace
}  // namespace curtain
