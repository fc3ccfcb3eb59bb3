// SPDX-License-Identifier: BSD-3-Clause
//
// Stamps follow ROS time and never go back, whatever happens between two readings of two clocks; only a clock that was
// set back takes them along, and that is counted.
#include "ros/time/stamp_keeper.h"

#include <gtest/gtest.h>

namespace curtain_ros {
namespace {

constexpr std::int64_t kMillisecond = 1000000;
constexpr std::int64_t kStampSecond = 1000 * kMillisecond;
constexpr std::int64_t kFrame = 16 * kMillisecond;
constexpr std::int64_t kOffset = 1000 * kStampSecond;

TEST(StampKeeper, AddsTheOffset) {
  StampKeeper keeper;
  EXPECT_EQ(keeper.stamp(kFrame, {kOffset, 100}), kOffset + kFrame);
  EXPECT_EQ(keeper.stamp(2 * kFrame, {kOffset + 50, 100}), kOffset + 50 + 2 * kFrame);
}

// Held up for 30 ms between the readings, the offset seems 15 ms larger: it is not believed, and the next stamp is a
// frame later.
TEST(StampKeeper, IsNotMovedByAThreadThatWasHeldUp) {
  StampKeeper keeper;
  keeper.stamp(kFrame, {kOffset, 100});
  EXPECT_EQ(keeper.stamp(2 * kFrame, {kOffset + 15 * kMillisecond, 30 * kMillisecond}), kOffset + 2 * kFrame);
  EXPECT_EQ(keeper.stamp(3 * kFrame, {kOffset, 100}), kOffset + 3 * kFrame);
}

// The first reading has nothing to be held against. When a better one shows that it was 30 ms too high, stamps wait.
TEST(StampKeeper, NeverGoesBackWhenTheFirstReadingWasWrong) {
  StampKeeper keeper;
  std::int64_t last = keeper.stamp(kFrame, {kOffset + 30 * kMillisecond, 60 * kMillisecond});
  for (int frame = 2; frame < 10; ++frame) {
    const std::int64_t stamp = keeper.stamp(frame * kFrame, {kOffset, 100});
    EXPECT_GT(stamp, last);
    last = stamp;
  }
  EXPECT_EQ(last, kOffset + 9 * kFrame);
  EXPECT_EQ(keeper.setBack(), 0U);
}

TEST(StampKeeper, FollowsAClockThatIsSet) {
  StampKeeper keeper;
  keeper.stamp(kFrame, {kOffset, 100});
  EXPECT_EQ(keeper.stamp(2 * kFrame, {kOffset + 3600 * kStampSecond, 100}), kOffset + 3600 * kStampSecond + 2 * kFrame);
  EXPECT_EQ(keeper.setBack(), 0U);
  EXPECT_EQ(keeper.stamp(3 * kFrame, {kOffset, 100}), kOffset + 3 * kFrame);
  EXPECT_EQ(keeper.setBack(), 1U);
}

}  // namespace
}  // namespace curtain_ros
