// SPDX-License-Identifier: BSD-3-Clause
//
// When something is sent: at its rate, more slowly at rest, at once to somebody new. No ROS master needed.
#include "ros/time/pace.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace curtain_ros {
namespace {

TEST(RateDivider, ZeroIsEveryFrame) {
  RateDivider every(0.0, 60.0), third(20.0, 60.0);
  EXPECT_TRUE(every.tick() && third.tick()) << "the first frame is one";
  int thirds = 0;
  for (int frame = 0; frame < 60; ++frame) {
    EXPECT_TRUE(every.tick());
    thirds += third.tick();
  }
  EXPECT_EQ(thirds, 20);
}

/// Pictures sent in that many frames of 1/60 s.
int sentIn(int frames, Pace& pace, std::uint32_t subscribers, std::uint64_t& picture, bool changes) {
  int sent = 0;
  for (int frame = 0; frame < frames; ++frame) {
    picture += changes;
    pace.tick();
    if (pace.due(subscribers)) sent += pace.send(picture);
  }
  return sent;
}

TEST(Pace, SlowsDownAtRestAndHurriesForNewSubscribers) {
  Pace pace(20.0, 1.0, 60.0);
  std::uint64_t picture = 0;
  EXPECT_EQ(sentIn(60, pace, 0, picture, true), 0) << "nobody looks";
  EXPECT_EQ(sentIn(60, pace, 1, picture, true), 20);
  EXPECT_EQ(sentIn(600, pace, 1, picture, false), 10) << "at rest";
  EXPECT_EQ(sentIn(3, pace, 2, picture, false), 1) << "somebody new";
  EXPECT_EQ(sentIn(30, pace, 2, picture, false), 0);
  EXPECT_EQ(sentIn(30, pace, 1, picture, false), 1) << "one less changes nothing: the picture of the second";
  EXPECT_EQ(sentIn(3, pace, 1, picture, true), 1) << "moves again";
}

TEST(Pace, ZeroIsEveryFrameAndNoOtherRateAtRest) {
  Pace always(0.0, 0.0, 60.0), state(0.0, 10.0, 60.0);
  std::uint64_t picture = 0;
  EXPECT_EQ(sentIn(60, always, 1, picture, true), 60);
  EXPECT_EQ(sentIn(60, always, 1, picture, false), 60);
  EXPECT_EQ(sentIn(60, state, 1, picture, true), 60);
  EXPECT_EQ(sentIn(60, state, 1, picture, false), 10);
}

// A frame that another follows at once is not looked at; the next one is.
TEST(Pace, WhatIsDueWaitsForTheLook) {
  Pace pace(20.0, 1.0, 60.0);
  pace.tick();
  pace.tick();
  EXPECT_TRUE(pace.due(1));
  EXPECT_FALSE(pace.due(1));
}

TEST(Pace, HurriesWithoutLosingItsTurn) {
  Pace pace(10.0, 1.0, 60.0);
  std::uint64_t picture = 1;
  EXPECT_EQ(sentIn(3, pace, 1, picture, false), 1);
  EXPECT_FALSE(pace.lacks(picture, 1));
  EXPECT_TRUE(pace.lacks(picture, 2)) << "somebody new";
  EXPECT_TRUE(pace.lacks(picture, 2)) << "until it is sent";
  pace.hurry();
  EXPECT_EQ(sentIn(1, pace, 2, picture, false), 1) << "at rest, and between two turns";
  EXPECT_EQ(sentIn(1, pace, 2, picture, true), 0);
  EXPECT_EQ(sentIn(1, pace, 2, picture, true), 1) << "the sixth frame's turn";
}

}  // namespace
}  // namespace curtain_ros
