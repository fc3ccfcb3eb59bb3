// SPDX-License-Identifier: BSD-3-Clause
//
// The bookkeeping of frames of limited computing time, told what time it is. Whole simulators: test/budget.
#include "simulator/budget.h"

#include <gtest/gtest.h>

namespace curtain {
namespace {

using Time = Budget::Clock::time_point;

Time at(double seconds) {
  return Time(std::chrono::duration_cast<Budget::Clock::duration>(std::chrono::duration<double>(100.0 + seconds)));
}

TEST(Budget, NoneAllowsEverything) {
  Budget budget(0.0);
  budget.beginFrame(at(0.0));
  budget.substepTook(10.0, true);
  EXPECT_FALSE(budget.any());
  EXPECT_FALSE(budget.over(at(1e6)));
  EXPECT_TRUE(budget.affordsCompanion());
  EXPECT_GT(budget.affordable(at(1e6)), 1000);
  EXPECT_EQ(budget.substepEnds(), Time::max());
}

TEST(Budget, StartsNoSubstepThatThereIsNoTimeFor) {
  Budget budget(10.0);
  budget.beginFrame(at(0.0));
  EXPECT_FALSE(budget.over(at(0.001)));
  budget.substepTook(0.003, true);
  // A tenth is kept free: 9 ms, of which such a substep needs 3.
  EXPECT_EQ(budget.affordable(at(-1e-6)), 3);
  EXPECT_EQ(budget.affordable(at(0.005)), 1);
  // One is only started with 1.4 times that left.
  EXPECT_FALSE(budget.over(at(0.0047)));
  EXPECT_TRUE(budget.over(at(0.0049)));
  EXPECT_LE(budget.substepEnds(), at(0.00901));
}

TEST(Budget, KeepsTimeForWhatComesAfterTheSubsteps) {
  Budget budget(10.0);
  budget.beginFrame(at(0.0));
  budget.substepTook(0.001, true);
  budget.endFrame(1.0, at(0.002), at(0.004));
  budget.beginFrame(at(1.0));
  EXPECT_LE(budget.substepEnds(), at(1.00701));
  EXPECT_GE(budget.substepEnds(), at(1.00699));
}

TEST(Budget, LeavesTheCompanionAtHomeWhenBothDontFit) {
  Budget budget(10.0);
  budget.beginFrame(at(0.0));
  budget.referenceTook(0.004);
  budget.endFrame(1.0, at(0.0049), at(0.0049));
  EXPECT_TRUE(budget.affordsCompanion());
  budget.referenceTook(0.008);
  budget.beginFrame(at(1.0));
  budget.endFrame(1.0, at(1.009), at(1.009));
  EXPECT_FALSE(budget.affordsCompanion());
}

TEST(Budget, IsPatientOnlyForSoLong) {
  Budget budget(10.0);
  for (int frame = 0; frame < 4; ++frame) {
    budget.beginFrame(at(frame));
    EXPECT_NE(budget.substepEnds(), Time::max()) << frame;
    EXPECT_TRUE(budget.over(at(frame + 0.0095)));
    budget.substepTook(0.009, false);
    budget.endFrame(0.0, at(frame + 0.0095), at(frame + 0.0095));
  }
  budget.beginFrame(at(10.0));
  EXPECT_EQ(budget.substepEnds(), Time::max());
  EXPECT_FALSE(budget.over(at(10.5)));
  budget.substepTook(0.02, true);  // what it needed
  EXPECT_TRUE(budget.over(at(10.02)));
  budget.endFrame(0.1, at(10.02), at(10.02));
  budget.beginFrame(at(11.0));
  EXPECT_NE(budget.substepEnds(), Time::max());
}

}  // namespace
}  // namespace curtain
