// SPDX-License-Identifier: BSD-3-Clause
//
// The cause of dropped frames is the one that it is: frames that take too long, a clock that runs ahead, or a computer
// that did other things.
#include "ros/time/lateness.h"

#include <gtest/gtest.h>

namespace curtain_ros {
namespace {

constexpr double kFrame = 1.0 / 50.0;  // [s]

TEST(Lateness, FramesThatTakeLongerThanTheyHave) {
  EXPECT_EQ(causeOf({0.12, 0.12, 0.12, 4}, kFrame), "a frame takes 30 ms of the 20 ms it has");
  EXPECT_EQ(causeOf({0.5, 0.5, 0.45, 1}, kFrame), "a frame takes 450 ms of the 20 ms it has") << "a single one";
  EXPECT_EQ(causeOf({0.12, 0.08, 0.06, 4}, kFrame), "a frame takes 15 ms of the 13.33 ms it has") << "by a fast clock";
}

// However long the frame before took: it is not what was late.
TEST(Lateness, AClockThatRunsAhead) {
  EXPECT_EQ(causeOf({3600.0, 0.01, 0.0003, 1}, kFrame), "/clock went on by 3600 s within 0.01 s");
  EXPECT_EQ(causeOf({1.0, 0.025, 0.025, 1}, kFrame), "/clock went on by 1 s within 0.025 s");
  EXPECT_EQ(causeOf({1.0, 0.0, 0.0, 0}, kFrame), "/clock went on by 1 s within 0 s");
}

TEST(Lateness, AComputerThatIsBusy) {
  EXPECT_EQ(causeOf({0.31, 0.31, 0.01, 1}, kFrame), "the computer was busy with other things, 0.3 s of 0.31 s");
  EXPECT_EQ(causeOf({0.31, 0.3, 0.0, 0}, kFrame), "the computer was busy with other things, 0.3 s of 0.3 s")
      << "/clock is a tick ahead";
}

}  // namespace
}  // namespace curtain_ros
