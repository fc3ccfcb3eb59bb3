// SPDX-License-Identifier: BSD-3-Clause
//
// How a frame is cut into substeps: by what is asked for, by the tensions, by failures and by the time there is.
#include "step/step_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "step/constants.h"
#include "step/schemes/composition.h"
#include "testing.h"

namespace curtain {
namespace {

constexpr double kFrame = 1.0 / 64.0;

// Of a cloth without weight, which asks for no more than one substep a frame.
struct Control {
  explicit Control(Method method, int substeps = 0, int max_substeps = 128) {
    params.method = method;
    params.substeps = substeps;
    params.max_substeps = max_substeps;
    params.frame_rate = 1.0 / kFrame;
    steps.emplace(params, pattern, Vec3::Zero());
  }
  SubstepPlan next(double remaining = kFrame) { return steps->next(remaining, solver); }
  void accept(int times, double omega = 0.0) {
    SubstepOutcome outcome;
    outcome.accepted = outcome.settled = true;
    outcome.omega_squared = omega * omega;
    for (int k = 0; k < times; ++k) steps->accepted(next(), outcome);
  }

  ClothPattern pattern = makePattern(curtain_test::flatScene(3, 2));
  Workers workers{1};
  Step solver{pattern, {}, 1e-3, 60, workers};
  SolverParams params;
  std::optional<StepControl> steps;
};

TEST(StepControl, FixedSubstepsShareTheFrameEvenly) {
  Control control(Method::kLeapfrog, 4);
  EXPECT_EQ(control.next().h, kFrame / 4);
  EXPECT_EQ(control.next(kFrame / 2).h, kFrame / 4);
  control.accept(1, 1e6);
  EXPECT_EQ(control.next().h, kFrame / 4) << "whatever the tensions";
}

TEST(StepControl, TensionsAreGivenAsManySubstepsAsTheirPhaseNeeds) {
  for (const Method method : {Method::kAuto, Method::kLeapfrog}) {
    Control control(method);
    EXPECT_EQ(control.next().h, kFrame);
    control.accept(1, 5.5 * kPhasePerStep / kFrame);
    EXPECT_EQ(control.next().h, kFrame / 6) << toString(method);
    control.steps->reset();
    EXPECT_EQ(control.next().h, kFrame) << toString(method);
  }
}

TEST(StepControl, ComposedSubstepsAreAsLongAsTheirLongestStageMayBe) {
  Control control(Method::kLeapfrog4);
  control.accept(1, 5.5 * kPhasePerStep / (kLongestStage * kFrame));
  EXPECT_EQ(control.next().h, kFrame / 6);
  EXPECT_TRUE(control.next().precise);
}

// 4 m / (m_node l) of what hangs: three nodes of equal mass half a metre apart, two of which the first rod carries.
TEST(StepControl, BeforeTheFirstSubstepTheClothHangsByItsWeight) {
  Scene scene = curtain_test::flatScene(3, 2);
  scene.cloth.lumping = Lumping::kUniform;
  const StepControl steps(scene.solver, makePattern(scene), Vec3(0.0, 0.0, -10.0));
  EXPECT_DOUBLE_EQ(steps.longestStableStep(), kLongestPhase / std::sqrt(4.0 * 2.0 / 0.5 * 10.0));
}

TEST(StepControl, ARejectedStepIsHalvedAndGrowsAgainAfterEightGoodOnes) {
  Control control(Method::kLeapfrog);
  control.steps->rejected(control.next(), SubstepOutcome());
  EXPECT_EQ(control.next().h, kFrame / 2);
  control.accept(3 * kGoodToGrow - 1);  // 0.5 times 1.4 times 1.4 is still less than a frame
  EXPECT_EQ(control.next().h, kFrame / 2);
  control.accept(1);
  EXPECT_EQ(control.next().h, kFrame);
}

// What arrives fast says how long a substep may be. That is no failure: the step grows again as soon as nothing
// touches.
TEST(StepControl, AStepIsAsShortAsWhatArrivesAsks) {
  Control control(Method::kLeapfrog);
  SubstepOutcome arrives;
  arrives.longest_step = kFrame / 16;
  EXPECT_TRUE(control.next().may_be_shorter);
  control.steps->rejected(control.next(), arrives);
  EXPECT_EQ(control.next().h, kFrame / 16);
  control.accept(1);
  EXPECT_EQ(control.next().h, kFrame / 8);
  control.accept(3);
  EXPECT_EQ(control.next().h, kFrame);
}

TEST(StepControl, NoFixedOrSmallestStepIsMadeShorter) {
  EXPECT_FALSE(Control(Method::kLeapfrog, 4).next().may_be_shorter);
  Control control(Method::kLeapfrog, 0, 8);
  SubstepOutcome arrives;
  arrives.longest_step = kFrame / 100;
  control.steps->rejected(control.next(), arrives);
  EXPECT_EQ(control.next().h, kFrame / 8);
  EXPECT_FALSE(control.next().may_be_shorter);
}

TEST(StepControl, WhatFailsAtTheSmallestStepIsLeftToTheLastResort) {
  Control control(Method::kLeapfrog, 0, 8);
  for (int failure = 0; failure < 4; ++failure) {
    EXPECT_FALSE(control.next().isLastResort()) << failure;
    EXPECT_EQ(control.next().h, kFrame / (1 << failure));
    control.steps->rejected(control.next(), SubstepOutcome());
  }
  EXPECT_TRUE(control.next().isLastResort());
  EXPECT_EQ(control.next().reach, kFirstReach);
  EXPECT_EQ(control.next().h, kFrame / kLastResortSubsteps);
}

TEST(StepControl, ALastResortThatFailsInContactLetsTheSchemeTryOnceAFrame) {
  Control control(Method::kLeapfrog, 0, 8);
  for (int failure = 0; failure < 4; ++failure) control.steps->rejected(control.next(), SubstepOutcome());
  SubstepOutcome unsettled;
  unsettled.accepted = unsettled.touches = true;
  const auto fail = [&] { control.steps->accepted(control.next(kFrame / 2), unsettled); };
  fail();
  EXPECT_TRUE(control.next(kFrame / 2).isLastResort());
  EXPECT_FALSE(control.next().isLastResort());
  control.steps->rejected(control.next(), SubstepOutcome());
  EXPECT_TRUE(control.next().isLastResort()) << "until it fails again";
  fail();
  EXPECT_FALSE(control.next().isLastResort());
  control.steps->tookTooLong(control.next());
  EXPECT_TRUE(control.next().isLastResort()) << "which moves even where its time is over";
  fail();
  control.accept(1);
  EXPECT_FALSE(control.next(kFrame / 2).isLastResort()) << "it has got on by itself";
}

TEST(StepControl, ShortTimeMakesLongerSubstepsButAtMostTwice) {
  Control control(Method::kAuto);
  control.accept(1, 5.5 * kPhasePerStep / kFrame);
  control.steps->allow(4);
  EXPECT_EQ(control.next().h, kFrame / 4);
  EXPECT_TRUE(control.steps->stretched());
  control.steps->allow(1);
  EXPECT_EQ(control.next().h, kFrame / 3);
  control.steps->allow(100);
  EXPECT_EQ(control.next().h, kFrame / 6);
  EXPECT_FALSE(control.steps->stretched());
}

}  // namespace
}  // namespace curtain
