// SPDX-License-Identifier: BSD-3-Clause
//
// Obstacles get from pose to pose without steps in their speed, and never beyond a pose where they stop or turn back.
#include "obstacles/pose_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace curtain {
namespace {

constexpr double kFrame = 1.0 / 60.0;     // [s]
constexpr double kArm = 0.5;              // [m]
constexpr double kCurveRounding = 1e-11;  // of values near 1, over a frame's length

Pose poseOf(const Vec3& position, const Vec3& turn = Vec3::Zero()) { return changed(Pose(), {position, turn}); }

double distance(const Pose& a, const Pose& b) { return changeBetween(a, b).reach(kArm); }

// A frame curve that was led along a path until this time, the end of its frame.
FrameCurve ledAlong(const std::function<Pose(double)>& path, int frames) {
  FrameCurve curve;
  curve.put(path(0.0));
  for (int k = 0; k < frames; ++k) {
    if (k > 0) curve.arrive(path(k * kFrame));
    curve.lead(path(k * kFrame), path((k + 1) * kFrame), kFrame, kArm);
  }
  return curve;
}

TEST(FrameCurve, IsExactForConstantAcceleration) {
  const Vec3 acceleration(3.0, -2.0, 4.0), spin_up(2.0, 1.0, -2.0);
  const auto path = [&](double t) { return poseOf(0.5 * t * t * acceleration, 0.5 * t * t * spin_up); };
  const int frames = 20;
  const FrameCurve curve = ledAlong(path, frames);
  for (const double share : {0.0, 0.3, 0.5, 0.9, 1.0}) {
    const double t = (frames - 1 + share) * kFrame;
    EXPECT_LT(distance(curve.at(share), path(t)), kCurveRounding) << share;
    const PoseChange speed = (1.0 / kFrame) * curve.rateAt(share);
    EXPECT_LT((speed.move - t * acceleration).norm(), kCurveRounding / kFrame) << share;
    EXPECT_LT((speed.turn - t * spin_up).norm(), kCurveRounding / kFrame) << share;
  }
}

// A rigid body that tumbles about a changing axis. What the curve says of its speed is how its poses change.
TEST(FrameCurve, HasNoStepsInItsSpeed) {
  const auto path = [](double t) {
    return poseOf(Vec3(std::sin(t), std::cos(2.0 * t), 0.1 * t), Vec3(std::sin(3.0 * t), t, std::cos(t)));
  };
  for (int frames = 2; frames < 100; ++frames) {
    const FrameCurve before = ledAlong(path, frames), after = ledAlong(path, frames + 1);
    EXPECT_LT(distance(before.at(1.0), after.at(0.0)), kCurveRounding);
    const PoseChange step = after.rateAt(0.0) - before.rateAt(1.0);
    EXPECT_LT(step.reach(kArm), kCurveRounding) << frames;
    const double d = 1e-5;
    const PoseChange slope = (0.5 / d) * changeBetween(after.at(0.4 - d), after.at(0.4 + d));
    EXPECT_LT((slope - after.rateAt(0.4)).reach(kArm), 1e-8) << frames;
  }
}

// It moves, slows down in all ways, stops, goes back; everything slower than what counts as a blow.
TEST(FrameCurve, StaysBetweenItsPosesWhereItStopsOrTurnsBack) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> speed(-0.15, 0.15);
  FrameCurve curve;
  curve.put(Pose());
  double x = 0.0;
  int smooth = 0;
  for (int k = 0; k < 2000; ++k) {
    const double to = k % 7 == 0 ? x : x + kFrame * speed(random);
    curve.arrive(poseOf(Vec3(x, 0.0, 0.0)));
    curve.lead(poseOf(Vec3(x, 0.0, 0.0)), poseOf(Vec3(to, 0.0, 0.0)), kFrame, kArm);
    for (double share = 0.0; share <= 1.0; share += 0.05) {
      EXPECT_GE(curve.at(share).position.x(), std::min(x, to) - 1e-15);
      EXPECT_LE(curve.at(share).position.x(), std::max(x, to) + 1e-15);
    }
    smooth += (curve.rateAt(0.0) - curve.rateAt(0.5)).move.norm() > 1e-9 ? 1 : 0;
    x = to;
  }
  EXPECT_GT(smooth, 200) << "not all frames are even";
}

// A step of 3 m/s in a frame is more than 2 g: no speed between.
TEST(FrameCurve, LeavesABlowABlow) {
  const auto path = [](double t) { return poseOf(Vec3(3.0 * std::max(0.0, t - 3.0 * kFrame), 0.0, 0.0)); };
  for (const double share : {0.0, 0.25, 1.0})
    EXPECT_NEAR(ledAlong(path, 4).rateAt(share).move.x(), 3.0 * kFrame, 1e-12) << share;
}

ObstacleParams moving(const std::vector<PoseKey>& keys) {
  ObstacleParams params;
  params.motion = keys;
  return params;
}

TEST(ScriptedMotion, GoesThroughItsPosesAndNotBeyond) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int n = 0; n < 200; ++n) {
    std::vector<PoseKey> keys;
    double time = 0.0, x = 0.0;
    for (int k = 0; k < 8; ++k) {
      keys.push_back({time, poseOf(Vec3(x, 0.0, 0.0), Vec3(0.0, 0.0, x))});
      time += 0.6 + 0.5 * number(random);
      if (k % 3 != 1) x += 0.1 * number(random);  // slow enough for no blow
    }
    const ScriptedMotion script(moving(keys), kArm);
    for (std::size_t k = 0; k < keys.size(); ++k) {
      EXPECT_LT(distance(script.at(keys[k].time), keys[k].pose), 1e-15);
      if (k == 0) continue;
      const double a = keys[k - 1].pose.position.x(), b = keys[k].pose.position.x();
      for (double share = 0.0; share <= 1.0; share += 0.02) {
        const Pose pose = script.at(keys[k - 1].time + share * (keys[k].time - keys[k - 1].time));
        EXPECT_GE(pose.position.x(), std::min(a, b) - 1e-14);
        EXPECT_LE(pose.position.x(), std::max(a, b) + 1e-14);
      }
      if (k + 1 == keys.size()) continue;
      const PoseChange step = script.rateAt(keys[k].time + 1e-9) - script.rateAt(keys[k].time - 1e-9);
      EXPECT_LT(step.reach(kArm), 1e-6) << "no steps in its speed";
    }
  }
}

TEST(ScriptedMotion, KnowsEvenSpeedsAndAccelerations) {
  const ScriptedMotion even(moving({{1.0, poseOf(Vec3::Zero())}, {3.0, poseOf(Vec3(4.0, 0.0, 0.0))}}), kArm);
  EXPECT_NEAR(even.at(1.5).position.x(), 1.0, 1e-15);
  EXPECT_NEAR(even.rateAt(2.5).move.x(), 2.0, 1e-14);
  EXPECT_EQ(even.rateAt(0.5).move.x(), 0.0);
  std::vector<PoseKey> keys;
  for (const double t : {0.0, 0.2, 0.3, 0.7, 1.0}) keys.push_back({t, poseOf(Vec3(2.0 * t * t, 0.0, 0.0))});
  const ScriptedMotion curve(moving(keys), kArm);
  for (double t = 0.0; t < 1.0; t += 0.01) EXPECT_NEAR(curve.at(t).position.x(), 2.0 * t * t, 1e-14) << t;
  ObstacleParams params;
  params.pose = poseOf(Vec3(1.0, 2.0, 3.0), Vec3(0.3, 0.0, 0.0));
  params.velocity = Vec3(1.0, 0.0, 0.0);
  params.acceleration = Vec3(0.0, 0.0, -2.0);
  params.spin = Vec3(0.0, 0.0, 5.0);
  const ScriptedMotion steady(params, kArm);
  EXPECT_LT((steady.at(2.0).position - Vec3(3.0, 2.0, -1.0)).norm(), 1e-14);
  const Rotation turned(Eigen::AngleAxisd(10.0, Vec3::UnitZ()) * Eigen::Quaterniond(params.pose.orientation));
  EXPECT_NEAR(std::abs(turned.dot(steady.at(2.0).orientation)), 1.0, 1e-14) << "about the world's axis";
  EXPECT_LT((steady.rateAt(2.0).move - Vec3(1.0, 0.0, -4.0)).norm(), 1e-14);
}

// No point within the arm is faster than the bound.
TEST(ScriptedMotion, BoundsItsSpeed) {
  const std::vector<PoseKey> keys = {{0.0, poseOf(Vec3::Zero())},
                                     {0.2, poseOf(Vec3(1.0, 0.0, 0.0), Vec3(0.5, 0.0, 0.0))},
                                     {0.9, poseOf(Vec3(1.2, 0.5, 0.0), Vec3(0.5, 2.0, 0.0))},
                                     {1.0, poseOf(Vec3(1.2, 0.5, 0.0), Vec3(0.5, 2.0, 0.0))}};
  const ScriptedMotion script(moving(keys), kArm);
  for (double from = 0.0; from < 0.8; from += 0.1) {
    double most = 0.0;
    for (double t = from; t <= from + 0.2; t += 1e-3) most = std::max(most, script.rateAt(t).reach(kArm));
    EXPECT_LE(most, script.fastest(from, from + 0.2, kArm) * (1.0 + 1e-12));
    EXPECT_GT(most, 0.2 * script.fastest(from, from + 0.2, kArm));
  }
}

}  // namespace
}  // namespace curtain
