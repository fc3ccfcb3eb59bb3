// SPDX-License-Identifier: BSD-3-Clause
//
// Frames that callers ask for in a pause: each gets as many as it asked for, callers take turns, and whoever can't get
// his is told why, at once.
#include "ros/services/lock_step.h"

#include <gtest/gtest.h>

namespace curtain_ros {
namespace {

using Answer = LockStep::Answer;

// The answer, which must have come.
Answer answered(std::future<Answer>& answer) {
  const bool came = answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  EXPECT_TRUE(came);
  return came ? answer.get() : Answer();
}
bool waits(const std::future<Answer>& answer) {
  return answer.wait_for(std::chrono::seconds(0)) == std::future_status::timeout;
}

// Makes frames as long as some are asked for, `most` at most; how many that were.
int make(LockStep& steps, std::uint64_t& frame, int most = 1000) {
  int made = 0;
  for (; made < most && steps.asked(); ++made) {
    Answer now;
    now.frame = ++frame;
    now.simulated_time = static_cast<double>(frame) / 60.0;
    now.stamp = ros::Time(now.simulated_time);
    steps.made(now);
  }
  return made;
}

TEST(LockStep, MakesAsManyAsAreAskedFor) {
  LockStep steps(true);
  std::uint64_t frame = 41;
  std::future<Answer> answer = steps.ask(10);
  EXPECT_EQ(make(steps, frame, 9), 9);
  EXPECT_TRUE(waits(answer));
  EXPECT_TRUE(steps.lastOfRequest());
  EXPECT_EQ(make(steps, frame), 1);
  const Answer got = answered(answer);
  EXPECT_TRUE(got.success);
  EXPECT_EQ(got.message, "");
  EXPECT_EQ(got.frame, 51U);
  EXPECT_EQ(got.simulated_time, 51.0 / 60.0);
  EXPECT_EQ(got.stamp, ros::Time(51.0 / 60.0));
  EXPECT_FALSE(steps.asked());
}

// One that asked for very many, and may have died, does not hold up another.
TEST(LockStep, CallersTakeTurns) {
  LockStep steps(true);
  std::uint64_t frame = 0;
  std::future<Answer> many = steps.ask(1000);
  make(steps, frame, 100);
  std::future<Answer> few = steps.ask(3);
  make(steps, frame, 6);
  EXPECT_TRUE(answered(few).success);
  EXPECT_TRUE(waits(many));
  EXPECT_EQ(make(steps, frame), 1003 - 106) << "each gets its own";
  EXPECT_TRUE(answered(many).success);
}

TEST(LockStep, RefusesWhatCanNotBe) {
  LockStep running(false), paused(true);
  for (const std::uint32_t frames : {0U, 100001U, 4294967295U}) {
    std::future<Answer> answer = paused.ask(frames);
    const Answer got = answered(answer);
    EXPECT_FALSE(got.success);
    EXPECT_EQ(got.message, "frames: must be an integer in [1, 100000], is " + std::to_string(frames));
  }
  std::future<Answer> answer = running.ask(1);
  const Answer got = answered(answer);
  EXPECT_FALSE(got.success);
  EXPECT_EQ(got.message, "the node is running: pause it first, by ~pause");
  EXPECT_FALSE(running.asked());
  EXPECT_FALSE(paused.asked());
  std::future<Answer> most = paused.ask(kMaxFrames);
  EXPECT_TRUE(waits(most));
}

// Going on, a restart, the end of the node: all who wait are told, with what was made.
TEST(LockStep, TellsAllWhenTheFramesEnd) {
  LockStep steps(true);
  std::uint64_t frame = 0;
  std::future<Answer> a = steps.ask(5), b = steps.ask(7);
  make(steps, frame, 3);
  steps.setPaused(false);
  const Answer got_a = answered(a), got_b = answered(b);
  EXPECT_FALSE(got_a.success);
  EXPECT_EQ(got_a.message, "the node was told to go on: 2 of 5 frames were made");
  EXPECT_EQ(got_a.frame, 3U);
  EXPECT_EQ(got_b.message, "the node was told to go on: 1 of 7 frames were made");
  EXPECT_EQ(got_b.frame, 2U);
  EXPECT_FALSE(steps.asked());
  steps.setPaused(true);
  EXPECT_TRUE(steps.paused());
  EXPECT_FALSE(steps.asked()) << "it is not taken up again";
  steps.made(Answer());  // a frame in which all was ended
}

}  // namespace
}  // namespace curtain_ros
