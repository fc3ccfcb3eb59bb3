// SPDX-License-Identifier: BSD-3-Clause
//
// Which columns fall asleep and when, told where the cloth is: no motion is computed. Whole simulators: sleep_test.cpp,
// wake_test.cpp.
#include <gtest/gtest.h>

#include <vector>

#include "simulator/rest.h"
#include "testing.h"

namespace curtain {
namespace {

constexpr double kFrame = 1.0 / 60.0;
constexpr double kWindow = 0.5;  // s; as long must a column keep to its place
constexpr double kSpeed = 1e-3;  // m/s

// Seven columns at rest; each that is told to drifts on by a tenth of a millimetre a frame.
struct Cloth {
  Cloth() { rest.setLimits(kSpeed, 9.81, 0.0, 1.0); }
  // So many seconds from now on.
  void wait(double seconds) {
    for (const double end = time + seconds - 1e-9; time < end;) {
      time += kFrame;
      for (const int j : drifting) {
        for (int i = 1; i < 4; ++i) state.position.add(pattern.grid.index(i, j), Vec3(1e-4, 0.0, 0.0));
      }
      if (rest.due()) rest.look(state, time, kept_awake, nullptr, by_column);
    }
  }
  std::vector<int> asleep() const {
    std::vector<int> columns;
    for (int j = 0; j < 7; ++j) {
      if (rest.asleep().has(j)) columns.push_back(j);
    }
    return columns;
  }

  Scene scene = curtain_test::flatScene(4, 7);
  ClothPattern pattern = makePattern(scene);
  ClothState state = makeInitialState(scene, pattern);
  Rest rest{pattern, kFrame, 0.004, 1e-3};
  ColumnSet kept_awake{7};
  std::vector<int> drifting;
  bool by_column = true;
  double time = 0.0;
};

using Columns = std::vector<int>;

TEST(SleepingColumns, AreLookedAtEverySevenNineFiveAndElevenFrames) {
  Cloth cloth;
  std::vector<int> due;
  for (int frame = 0; frame < 34; ++frame) {
    if (cloth.rest.due()) due.push_back(frame);
  }
  EXPECT_EQ(due, (std::vector<int>{0, 7, 16, 21, 32}));
}

TEST(SleepingColumns, HaveKeptToTheirPlaceForHalfASecond) {
  Cloth cloth;
  cloth.wait(kWindow);
  EXPECT_EQ(cloth.asleep(), Columns{});
  EXPECT_TRUE(cloth.rest.watches());
  cloth.wait(11 * kFrame);
  EXPECT_EQ(cloth.asleep(), (Columns{0, 1, 2, 3, 4, 5, 6}));
}

TEST(SleepingColumns, AreThoseThatDoNotDriftAndNoGustReaches) {
  Cloth cloth;
  cloth.drifting = {2};
  cloth.kept_awake.add(5);
  cloth.wait(1.0);
  EXPECT_EQ(cloth.asleep(), (Columns{0, 1, 3, 4, 6}));
  Cloth whole;
  whole.by_column = false;
  whole.drifting = {2};
  whole.wait(1.0);
  EXPECT_EQ(whole.asleep(), Columns{}) << "all or none";
  whole.drifting = {};
  whole.wait(1.0);
  EXPECT_TRUE(whole.rest.asleep().full());
}

TEST(SleepingColumns, WakeWithAllThatSleepSideBySideWithThem) {
  Cloth cloth;
  cloth.drifting = {3};
  cloth.wait(1.0);
  cloth.rest.disturbed().add(1);
  EXPECT_TRUE(cloth.rest.wake());
  EXPECT_EQ(cloth.asleep(), (Columns{4, 5, 6}));
  EXPECT_EQ(cloth.rest.wakes(), 1);
  EXPECT_FALSE(cloth.rest.wake()) << "that was taken note of";
  cloth.rest.disturbed().add(3);
  EXPECT_FALSE(cloth.rest.wake()) << "it is awake";
}

TEST(SleepingColumns, PulledByNeighboursSleepAloneOnlyAfterAPauseThatDoubles) {
  Cloth cloth;
  cloth.drifting = {3};
  cloth.wait(1.0);
  ColumnSet pulled(7);
  pulled.add(2);
  for (const double pause : {2.0, 4.0}) {
    ASSERT_TRUE(cloth.rest.wakeFor(pulled, cloth.time));
    EXPECT_EQ(cloth.asleep(), (Columns{4, 5, 6}));
    cloth.wait(pause - kFrame);
    EXPECT_EQ(cloth.asleep(), (Columns{4, 5, 6})) << pause;
    cloth.wait(12 * kFrame);
    EXPECT_EQ(cloth.asleep(), (Columns{0, 1, 2, 4, 5, 6})) << pause;
  }
}

TEST(SleepingColumns, AreNoneWithoutGravityOrSpeedOrInLongFrames) {
  Cloth cloth;
  cloth.rest.setLimits(kSpeed, 0.0, 0.0, 1.0);
  EXPECT_FALSE(cloth.rest.can());
  cloth.rest.setLimits(0.0, 9.81, 0.0, 1.0);
  EXPECT_FALSE(cloth.rest.can());
  cloth.rest.takeFrame(0.06);
  cloth.rest.setLimits(kSpeed, 9.81, 0.0, 1.0);
  EXPECT_FALSE(cloth.rest.can());
  cloth.rest.takeFrame(kFrame);
  cloth.rest.setLimits(kSpeed, 9.81, 0.0, 1.0);
  EXPECT_TRUE(cloth.rest.can());
}

}  // namespace
}  // namespace curtain
