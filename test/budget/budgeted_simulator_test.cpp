// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of limited computing time: nothing changes while there is enough; what is given up is counted, and what must
// not be is not. Time here is how often it has been asked for, which is about as often as there are sweeps: the same on
// every machine, however busy.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "curtain_sim/simulator.h"
#include "testing.h"

// Instead of the standard library's, in all of this program.
std::chrono::steady_clock::time_point std::chrono::steady_clock::now() noexcept {
  static std::chrono::microseconds time{0};
  return std::chrono::steady_clock::time_point(++time);
}

namespace curtain {
namespace {

using curtain_test::ballAt;
using curtain_test::fanAt;
using curtain_test::flatScene;

// What half of the first frames take at most, when they take what they need [ms].
double medianTime(const Scene& scene, int frames) {
  Simulator simulator(scene);
  std::vector<double> milliseconds;
  for (int frame = 0; frame < frames; ++frame) {
    simulator.step();
    milliseconds.push_back(1e3 * simulator.statistics().step_seconds);
  }
  const auto middle = milliseconds.begin() + frames / 2;
  std::nth_element(milliseconds.begin(), middle, milliseconds.end());
  return *middle;
}

Scene blownCurtain() {
  Scene scene = flatScene(20, 24);
  scene.hang.to.x() = 0.7;
  scene.contact.self = true;
  scene.solver.threads = 1;
  scene.air.inside = scene.air.border = scene.air.corner = 0.2;
  WindParams fan = fanAt({0.3, -1.5, 0.5}, 1.5);
  fan.pressure = 6.0;
  fan.unsteadiness = 4.0;
  fan.end = 4.0;
  scene.wind.push_back(fan);
  ObstacleParams ball = ballAt({0.35, -0.6, 0.5}, 0.15);
  ball.motion = {{1.0, ball.pose}, {2.0, ball.pose}, {3.0, ball.pose}};
  ball.motion[1].pose.position.y() = 0.3;
  scene.obstacles.push_back(ball);
  return scene;
}

// If the engine read another clock, the other tests would judge how busy the machine is.
TEST(BudgetedSimulator, CountsTheSameTimeInEveryRun) {
  const double median = medianTime(blownCurtain(), 30);
  EXPECT_GT(median, 0.0);
  EXPECT_EQ(median, medianTime(blownCurtain(), 30));
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
      ASSERT_EQ(b.statistics().quality, FrameQuality::kResolved) << "frame " << frame;
    }
    EXPECT_EQ(b.statistics().shortened_frames + b.statistics().unfinished_substeps + b.statistics().longer_substeps +
                  b.statistics().estimates_skipped + b.statistics().late_frames,
              0);
  }
}

// Less than half the time that it takes: slower, but whole. (Less than a substep takes can't be had.)
TEST(BudgetedSimulator, GivesUpTimeAndNotTheCloth) {
  Scene scene = blownCurtain();
  scene.solver.budget_ms = 0.45 * medianTime(scene, 120);
  Simulator simulator(scene);
  double stretch = 0.0;
  for (int frame = 0; frame < 300; ++frame) {
    const double lost = simulator.statistics().lost_time;
    simulator.step();
    const Statistics& s = simulator.statistics();
    if (s.lost_time > lost) {
      EXPECT_GE(s.quality, FrameQuality::kHurried) << "frame " << frame;
    }
    stretch = std::max({stretch, s.warp_stretch, s.weft_stretch});
    const Piercings pierced = simulator.piercings(0);
    ASSERT_EQ(pierced.nodes + pierced.edges + pierced.faces, 0) << "frame " << frame;
    if (frame % 10 == 0) {
      ASSERT_EQ(simulator.selfCrossings(), 0) << "frame " << frame;
    }
  }
  const Statistics& s = simulator.statistics();
  EXPECT_TRUE(s.finite);
  EXPECT_GT(s.shortened_frames, 0);
  EXPECT_GT(s.lost_time, 0.1);
  EXPECT_LT(s.lost_time, 5.0);
  EXPECT_LE(stretch, scene.solver.stretch_tolerance);
  EXPECT_NEAR(simulator.time(), 5.0, 1e-9);
  const Vec3 goal = simulator.obstacleTarget(0).position;
  EXPECT_LT((goal - Vec3(0.35, -0.6, 0.5)).norm(), 1e-12);
  EXPECT_NEAR(simulator.obstacleLag(0), (goal - simulator.obstaclePose(0).position).norm(), 1e-12);
}

// A ball at 20 m/s and a cloth whose time runs many times slower: the ball must not be many times faster for it.
TEST(BudgetedSimulator, WhatFallsBehindIsNoBlow) {
  Scene scene = flatScene(44, 40, 2.0);
  scene.hang.to.x() = 0.8;
  scene.contact.self = true;
  scene.solver.threads = 1;
  ObstacleParams ball;
  ball.name = "ball";
  ball.radius = 0.3;
  ball.motion = {{0.1, {Vec3(0.4, -1.0, 1.0), Eigen::Quaterniond::Identity()}},
                 {0.2, {Vec3(0.4, 1.0, 1.0), Eigen::Quaterniond::Identity()}}};
  ball.pose = ball.motion[0].pose;
  scene.obstacles.push_back(ball);
  scene.solver.budget_ms = 0.3 * medianTime(scene, 60);
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
  for (const Method method : {Method::kAuto, Method::kLeapfrog, Method::kLeapfrog4, Method::kImplicit}) {
    Scene scene = blownCurtain();
    scene.solver.method = method;
    scene.solver.max_substeps = 64;
    scene.solver.budget_ms = 0.3 * medianTime(scene, 120);
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
  scene.solver.budget_ms = 1e-3;  // once
  scene.solver.threads = 1;
  Simulator simulator(scene);
  for (int frame = 0; frame < 300; ++frame) simulator.step();
  EXPECT_GT(simulator.statistics().lost_time, 1.0);
  EXPECT_FALSE(simulator.statistics().asleep);
}

// A pin that is led on while there is no time for it arrives all the same.
TEST(BudgetedSimulator, PinsArrive) {
  Scene scene = flatScene(40, 40);
  scene.hang.to.x() = 0.8;
  scene.solver.threads = 1;
  scene.solver.budget_ms = 0.3 * medianTime(scene, 10);
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
