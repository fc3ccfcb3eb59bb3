// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of limited computing time: nothing changes while there is enough; what is given up is counted, and what must
// not be is not. How long a frame really takes is the machine's business too, so the bookkeeping is tested with a clock
// of its own.
#include "simulator/budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "curtain_sim/simulator.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kPi;
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
  budget.companionTook(0.004);
  budget.endFrame(1.0, at(0.0049), at(0.0049));
  EXPECT_TRUE(budget.affordsCompanion());
  budget.companionTook(0.008);
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

Scene blownCurtain() {
  Scene scene = flatScene(20, 24);
  scene.hang.to.x() = 0.7;
  scene.contact.self = true;
  scene.air.inside = scene.air.border = scene.air.corner = 0.2;
  WindParams fan;
  fan.id = "fan";
  fan.position = {0.3, -1.5, 0.5};
  fan.direction = Vec3::UnitY();
  fan.radius = 1.5;
  fan.pressure = 6.0;
  fan.unsteadiness = 4.0;
  fan.end = 4.0;
  scene.wind.push_back(fan);
  ObstacleParams ball;
  ball.name = "ball";
  ball.radius = 0.15;
  ball.pose.position = {0.35, -0.6, 0.5};
  ball.motion = {{1.0, ball.pose}, {2.0, ball.pose}, {3.0, ball.pose}};
  ball.motion[1].pose.position.y() = 0.3;
  scene.obstacles.push_back(ball);
  return scene;
}

TEST(BudgetedSimulator, ChangesNoBitWhileThereIsTime) {
  for (const double tolerance : {0.0, 1e-3, 1e-5}) {
    Scene scene = blownCurtain();
    scene.contact.self = false;
    scene.solver.position_tolerance = tolerance;
    scene.solver.max_substeps = 64;
    Scene limited = scene;
    limited.solver.budget_ms = 1e6;
    Simulator a(scene), b(limited);
    for (int frame = 0; frame < 90; ++frame) {
      a.step();
      b.step();
      ASSERT_EQ(a.stateHash(), b.stateHash()) << "frame " << frame;
    }
    EXPECT_EQ(b.statistics().shortened_frames + b.statistics().unfinished_substeps + b.statistics().longer_substeps +
                  b.statistics().estimates_skipped + b.statistics().late_frames,
              0);
  }
}

// Less than half the time that it takes: slower, but whole. (Less than a substep takes can't be had.)
TEST(BudgetedSimulator, GivesUpTimeAndNotTheCloth) {
  Scene scene = blownCurtain();
  std::vector<double> full;
  {
    Simulator simulator(scene);
    for (int frame = 0; frame < 120; ++frame) {
      simulator.step();
      full.push_back(simulator.statistics().step_seconds);
    }
  }
  std::nth_element(full.begin(), full.begin() + 60, full.end());
  scene.solver.budget_ms = 0.45e3 * full[60];
  Simulator simulator(scene);
  std::vector<double> seconds;
  double stretch = 0.0;
  for (int frame = 0; frame < 300; ++frame) {
    simulator.step();
    const Statistics& s = simulator.statistics();
    seconds.push_back(s.step_seconds);
    stretch = std::max({stretch, s.warp_stretch, s.weft_stretch});
    const Piercings pierced = simulator.piercings(0);
    ASSERT_EQ(pierced.nodes + pierced.edges + pierced.faces, 0) << "frame " << frame;
    if (frame % 10 == 0) {
      ASSERT_EQ(simulator.selfCrossings(), 0) << "frame " << frame;
    }
  }
  std::sort(seconds.begin(), seconds.end());
  const Statistics& s = simulator.statistics();
  std::printf(
      "budget %.3f ms: median %.3f ms, 90 %% %.3f; longer %d, unfinished %d, shortened %d frames, lost %.2f s, late "
      "%d\n",
      scene.solver.budget_ms, 1e3 * seconds[150], 1e3 * seconds[270], static_cast<int>(s.longer_substeps),
      static_cast<int>(s.unfinished_substeps), static_cast<int>(s.shortened_frames), s.lost_time,
      static_cast<int>(s.late_frames));
  EXPECT_TRUE(s.finite);
  EXPECT_GT(s.shortened_frames, 0);
  EXPECT_GT(s.lost_time, 0.1);
  EXPECT_LT(s.lost_time, 5.0);
  EXPECT_LE(stretch, scene.solver.stretch_tolerance);
  EXPECT_NEAR(simulator.time(), 5.0, 1e-9);
  EXPECT_LT((simulator.obstaclePose(0).position - Vec3(0.35, -0.6, 0.5)).norm(), 1e-12);
}

// A ball at 20 m/s and a cloth whose time runs many times slower: the ball must not be many times faster for it.
TEST(BudgetedSimulator, WhatFallsBehindIsNoBlow) {
  Scene scene = flatScene(44, 40, 2.0);
  scene.hang.to.x() = 0.8;
  scene.contact.self = true;
  scene.solver.threads = 1;
  scene.solver.budget_ms = 4.0;
  ObstacleParams ball;
  ball.name = "ball";
  ball.radius = 0.3;
  ball.motion = {{0.1, {Vec3(0.4, -1.0, 1.0), Eigen::Quaterniond::Identity()}},
                 {0.2, {Vec3(0.4, 1.0, 1.0), Eigen::Quaterniond::Identity()}}};
  ball.pose = ball.motion[0].pose;
  scene.obstacles.push_back(ball);
  Simulator simulator(scene);
  double kinetic = 0.0;
  for (int frame = 0; frame < 60; ++frame) {
    simulator.step();
    kinetic = std::max(kinetic, simulator.energy().kinetic);
    const Piercings pierced = simulator.piercings(0);
    ASSERT_EQ(pierced.nodes + pierced.edges + pierced.faces, 0) << "frame " << frame;
  }
  EXPECT_GT(simulator.statistics().lost_time, 0.1);
  EXPECT_LT(kinetic, 0.5 * 0.4 * 20.0 * 20.0) << "of all of it at the ball's speed [J]";
}

// The implicit scheme takes whatever it has come to, but not because its time is over.
TEST(BudgetedSimulator, NoMethodTakesWhatItHasNotSolved) {
  for (const Method method : {Method::kAuto, Method::kLeapfrog, Method::kLeapfrog4, Method::kBdf2, Method::kImplicit}) {
    Scene scene = blownCurtain();
    scene.solver.method = method;
    scene.solver.max_substeps = 64;
    scene.solver.budget_ms = 0.2;
    Simulator limited(scene);
    double stretch = 0.0;
    for (int frame = 0; frame < 120; ++frame) {
      limited.step();
      stretch = std::max({stretch, limited.statistics().warp_stretch, limited.statistics().weft_stretch});
    }
    EXPECT_EQ(limited.selfCrossings(), 0) << toString(method);
    EXPECT_LE(stretch, scene.solver.stretch_tolerance) << toString(method);
    EXPECT_GT(limited.statistics().lost_time, 0.0) << toString(method);
    EXPECT_GT(limited.statistics().substeps, 20) << toString(method);
  }
}

// Frames that end early hold less motion: what is slow by the clock is not at rest.
TEST(BudgetedSimulator, SlowMotionIsNotRest) {
  Scene scene = flatScene(200, 4, 2.0, 0.1);
  scene.hang.tilt = 0.05;
  scene.solver.budget_ms = 1e-3;
  Simulator simulator(scene);
  for (int frame = 0; frame < 300; ++frame) simulator.step();
  EXPECT_GT(simulator.statistics().lost_time, 1.0);
  EXPECT_EQ(simulator.statistics().asleep, 0);
}

// A pin that is led on while there is no time for it arrives all the same.
TEST(BudgetedSimulator, PinsArrive) {
  Scene scene = flatScene(40, 40);
  scene.hang.to.x() = 0.8;
  scene.solver.budget_ms = 0.05;
  scene.solver.threads = 1;
  Simulator simulator(scene);
  ASSERT_TRUE(simulator.movePin({0, 39}, Vec3(0.8, 0.1, 1.0)));
  int frames = 0;
  while (frames < 2000 && (simulator.position({0, 39}) - Vec3(0.8, 0.1, 1.0)).norm() > 1e-12) {
    simulator.step();
    ++frames;
  }
  EXPECT_LT(frames, 2000);
  EXPECT_GT(simulator.statistics().shortened_frames, 0);
}

}  // namespace
}  // namespace curtain
