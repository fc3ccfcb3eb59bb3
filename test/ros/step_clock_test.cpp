// SPDX-License-Identifier: BSD-3-Clause
//
// Frames lie on a fixed grid of times; late ones are made up for up to a cap and counted beyond it; a clock that
// jumps back starts a new grid.
#include "ros/time/step_clock.h"

#include <gtest/gtest.h>

namespace curtain_ros {
namespace {

constexpr std::int64_t kClockSecond = 1000000000;

// The first look starts the grid; its first frame is due one period later, not at once.
TEST(StepClock, StartsOnePeriodBeforeItsFirstFrame) {
  StepClock clock(100.0, 4);
  EXPECT_EQ(clock.update(5 * kClockSecond).frames, 0);
  EXPECT_EQ(clock.next(), 5 * kClockSecond + kClockSecond / 100);
  EXPECT_EQ(clock.update(5 * kClockSecond + kClockSecond / 100 - 2000).frames, 0);
  EXPECT_EQ(clock.update(5 * kClockSecond + kClockSecond / 100).frames, 1);
  EXPECT_EQ(clock.advance(), 5 * kClockSecond + kClockSecond / 100);
}

// 60 frames a second do not drift, although 1/60 s is no whole number of nanoseconds.
TEST(StepClock, DoesNotDrift) {
  StepClock clock(60.0, 4);
  clock.update(kClockSecond);
  std::int64_t frames = 0;
  std::int64_t last = 0;
  for (std::int64_t now = kClockSecond; now <= 3601 * kClockSecond; now += kClockSecond / 100) {
    const int due = clock.update(now).frames;
    for (int i = 0; i < due; ++i, ++frames) last = clock.advance();
  }
  EXPECT_EQ(frames, 3600 * 60);
  EXPECT_EQ(last, 3601 * kClockSecond);
  EXPECT_EQ(clock.dropped(), 0U);
}

// Ten frames late with a cap of four: the last four of the grid are made, six are counted as dropped.
TEST(StepClock, CapsCatchUpAndCountsWhatItDrops) {
  StepClock clock(10.0, 4);
  clock.update(kClockSecond);
  EXPECT_EQ(clock.update(2 * kClockSecond).frames, 4);
  EXPECT_EQ(clock.dropped(), 6U);
  EXPECT_EQ(clock.advance(), kClockSecond + 7 * kClockSecond / 10);
  for (int i = 0; i < 3; ++i) clock.advance();
  EXPECT_EQ(clock.next(), 2 * kClockSecond + kClockSecond / 10);
  EXPECT_EQ(clock.update(2 * kClockSecond).frames, 0);
}

// A clock that jumps back is a new run from there on; what was dropped before stays counted.
TEST(StepClock, StartsAgainWhenTheClockJumpsBack) {
  StepClock clock(10.0, 1);
  clock.update(kClockSecond);
  clock.update(2 * kClockSecond);
  clock.advance();
  const StepClock::Due due = clock.update(kClockSecond / 2);
  EXPECT_TRUE(due.restarted);
  EXPECT_EQ(due.frames, 0);
  EXPECT_EQ(clock.next(), kClockSecond / 2 + kClockSecond / 10);
  EXPECT_EQ(clock.dropped(), 9U);
  EXPECT_FALSE(clock.update(kClockSecond / 2).restarted);
}

// Clocks written as floating-point seconds come a nanosecond short: that is not late by a tick.
TEST(StepClock, ForgivesRounding) {
  StepClock clock(50.0, 1);
  clock.update(100 * kClockSecond);
  for (int i = 1; i <= 100; ++i) {
    EXPECT_EQ(clock.update(100 * kClockSecond + i * kClockSecond / 50 - 1).frames, 1);
    clock.advance();
  }
}

// In a pause frames are left out, but not counted; afterwards the grid goes on, without a jump.
TEST(StepClock, PassesOverAPause) {
  StepClock clock(10.0, 4);
  clock.update(kClockSecond);
  clock.update(kClockSecond + kClockSecond / 10);
  clock.advance();
  EXPECT_EQ(clock.pass(kClockSecond + kClockSecond / 8).frames, 0);
  EXPECT_EQ(clock.pass(100 * kClockSecond + kClockSecond / 20).frames, 1);
  EXPECT_EQ(clock.pass(100 * kClockSecond + kClockSecond / 20).frames, 0);
  EXPECT_EQ(clock.update(100 * kClockSecond + kClockSecond / 20).frames, 0);
  EXPECT_EQ(clock.next(), 100 * kClockSecond + kClockSecond / 10);
  EXPECT_EQ(clock.update(100 * kClockSecond + kClockSecond / 10).frames, 1);
  EXPECT_EQ(clock.dropped(), 0U);
  EXPECT_TRUE(clock.pass(50 * kClockSecond).restarted) << "it sees a clock that jumps back";
}

// With other frames the grid begins at the last frame, or where the clock was seen last: nothing is late by it.
TEST(StepClock, ChangesItsRate) {
  StepClock clock(10.0, 4);
  clock.update(kClockSecond);
  clock.update(2 * kClockSecond);
  for (int i = 0; i < 4; ++i) clock.advance();
  clock.update(2 * kClockSecond + kClockSecond / 20);
  const std::uint64_t dropped = clock.dropped();
  clock.setRate(1000.0);
  EXPECT_EQ(clock.next(), 2 * kClockSecond + kClockSecond / 20 + kClockSecond / 1000);
  EXPECT_EQ(clock.update(2 * kClockSecond + kClockSecond / 20 + kClockSecond / 1000).frames, 1);
  clock.advance();
  clock.advance();  // ahead of the clock, as a grid of stamps is
  clock.setRate(1.0);
  EXPECT_EQ(clock.next(), 2 * kClockSecond + kClockSecond / 20 + 2 * kClockSecond / 1000 + kClockSecond);
  EXPECT_EQ(clock.dropped(), dropped);
}

// A clock that stands still asks for nothing.
TEST(StepClock, PausesWithTheClock) {
  StepClock clock(10.0, 1);
  clock.update(kClockSecond);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(clock.update(kClockSecond).frames, 0);
}

}  // namespace
}  // namespace curtain_ros
