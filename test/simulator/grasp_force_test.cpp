// SPDX-License-Identifier: BSD-3-Clause
//
// What hands pull with, share, lose, and let slide between their pads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "curtain_sim/simulator.h"
#include "simulator/hands.h"
#include "testing.h"

namespace curtain_test {
namespace {

using namespace curtain;

// 1 m x 0.2 m, of 40 g; nothing holds it but hands. Damped, so that it comes to rest in seconds.
Scene strip() {
  Scene scene = flatScene(21, 5, 1.0, 0.2);
  scene.cloth.surface_density = 0.2;
  scene.pins.kind = PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = 2.0;
  return scene;
}
constexpr double kWeight = 0.04 * 9.81;  // of the strip [N]

// In a box around its upper quarter, between pads.
GraspParams pinched(double hold) {
  GraspParams grasp;
  grasp.id = "pads";
  grasp.region = GraspRegion::kBox;
  grasp.frame.position = {0.1, 0.0, 0.9};
  grasp.size = {0.4, 0.4, 0.26};
  grasp.friction = 0.4;
  grasp.pinch_force = hold / (2.0 * grasp.friction);
  return grasp;
}

Vec3 momentumOf(const Simulator& simulator) {
  std::vector<Vec3> velocities;
  simulator.copyVelocities(velocities);
  Vec3 sum = Vec3::Zero();
  for (int n = 0; n < simulator.rows() * simulator.columns(); ++n)
    sum += simulator.mass({n / simulator.columns(), n % simulator.columns()}) * velocities[static_cast<std::size_t>(n)];
  return sum;
}

// What hangs on a hand pulls with its weight, about where the weight is. However the hand holds.
TEST(Grasp, FeelsTheWeight) {
  for (int kind = 0; kind < 3; ++kind) {
    SCOPED_TRACE(kind);
    Scene scene = strip();
    scene.air.inside = scene.air.border = scene.air.corner = 5.0;
    Simulator simulator(scene);
    GraspParams grasp = ballGrasp("hand", {0.02, 0.01, 1.0}, 0.11);  // three of five nodes: it comes to rest
    if (kind == 1) grasp.stiffness = 40.0;
    if (kind == 2) grasp.pinch_force = 10.0;
    ASSERT_EQ(refusal(simulator, grasp), "");
    for (int frame = 0; frame < 1800; ++frame) simulator.step();
    const GraspState state = *simulator.graspState("hand");
    EXPECT_LE((state.force - Vec3(0.0, 0.0, -kWeight)).norm(), 1e-3 * kWeight);
    Vec3 torque = Vec3::Zero();
    for (int i = 0; i < simulator.rows(); ++i) {
      for (int j = 0; j < simulator.columns(); ++j)
        torque +=
            (simulator.position({i, j}) - grasp.frame.position).cross(Vec3(0.0, 0.0, -9.81 * simulator.mass({i, j})));
    }
    EXPECT_LE((state.torque - torque).norm(), 1e-3 * kWeight * 1.0);
    EXPECT_EQ(state.end, GraspEnd::kNone);
  }
}

// A hand that gives way does so by the weight over its stiffness.
TEST(Grasp, GivesWayByItsStiffness) {
  Simulator simulator(strip());
  GraspParams grasp = ballGrasp("hand", {0.1, 0.0, 1.0}, 0.06);
  grasp.stiffness = 20.0;
  ASSERT_EQ(refusal(simulator, grasp), "");
  const std::vector<NodeIndex> nodes = simulator.graspState("hand")->nodes;
  double before = 0.0, after = 0.0;
  for (const NodeIndex& node : nodes) before += simulator.position(node).z() / static_cast<double>(nodes.size());
  for (int frame = 0; frame < 900; ++frame) simulator.step();
  for (const NodeIndex& node : nodes) after += simulator.position(node).z() / static_cast<double>(nodes.size());
  EXPECT_NEAR(before - after, kWeight / grasp.stiffness, 1e-3 * kWeight / grasp.stiffness + 1e-6);
}

// The force on a hand that carries cloth along is what changes its momentum: over a second, within the 1e-3 that links
// may lack.
TEST(Grasp, GivesTheMomentumThatTheClothTakes) {
  Scene scene = strip();
  scene.air = AirParams();
  scene.gravity = Vec3::Zero();
  scene.solver.substeps = 8;
  Simulator simulator(scene);
  ASSERT_EQ(refusal(simulator, ballGrasp("hand", {0.1, 0.0, 1.0}, 0.12)), "");
  Vec3 given = Vec3::Zero();
  for (int frame = 1; frame <= 60; ++frame) {
    const double t = frame / 60.0;
    simulator.moveGrasp("hand", {Vec3(0.1, 0.5 * t * t, 1.0 + 0.25 * t * t), Rotation::Identity()});
    simulator.step();
    given -= simulator.graspState("hand")->force / 60.0;
  }
  // Leapfrog's last kick is half done when the velocities are read: up to half a substep of the mean force.
  const double tolerance = 1e-3 * momentumOf(simulator).norm() + given.norm() / 60.0 / 8.0;
  EXPECT_LE((given - momentumOf(simulator)).norm(), tolerance)
      << given.transpose() << " / " << momentumOf(simulator).transpose();
}

// A ball beneath the edge of what is held carries a part of it, and so do the held nodes of the faces that lie on it:
// hand and ball have the weight together.
TEST(Grasp, FeelsWhatIsPressedOnIt) {
  Scene scene = flatScene(13, 13);
  scene.hang.tilt = kPi / 2.0;
  scene.pins.kind = PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = 5.0;
  Simulator flat(scene);
  const Vec3 middle = flat.position({6, 6});
  scene.obstacles.push_back(ballAt(middle + Vec3(0.2, 0.0, -0.152), 0.15));
  Simulator simulator(scene);
  ASSERT_EQ(refusal(simulator, ballGrasp("hand", middle, 0.2)), "");
  for (int frame = 0; frame < 900; ++frame) simulator.step();
  Vec3 hand = Vec3::Zero(), ball = Vec3::Zero();
  for (int frame = 0; frame < 60; ++frame) {
    simulator.step();
    hand += simulator.graspState("hand")->force / 60.0;
    ball += simulator.contactWrench(0).force / 60.0;
  }
  const double weight = 0.2 * 9.81;
  EXPECT_LE((hand + ball - Vec3(0.0, 0.0, -weight)).norm(), 1e-2 * weight)
      << hand.transpose() << " / " << ball.transpose();
  EXPECT_LT(ball.z(), -0.05 * weight);
}

// Columns that a hand and pins pull apart have no solution. What their tensions come to is the last sweeps' affair, but
// it stays so: with the inertia m of all of the cloth at most, a Newton step of a rod of length l changes its tension
// by m l / (h^2 kSmallestPivot) (warp_solver.cpp) at most, 7e12 N here. It grew by 1e12 a frame where inertia followed
// tensions without bound.
TEST(Grasp, PullsApartWithoutGrowth) {
  Scene scene = flatScene(8, 6);
  scene.hang.to.x() = 0.9;
  Simulator simulator(scene);
  for (int frame = 0; frame < 20; ++frame) simulator.step();
  ASSERT_EQ(refusal(simulator, nodeGrasp("hand", {{7, 3}})), "");
  const Vec3 from = simulator.position({7, 3});
  double most = 0.0;
  for (int frame = 1; frame <= 60; ++frame) {
    ASSERT_TRUE(simulator.moveGrasp("hand", {from - Vec3(0.0, 0.0, 0.01 * frame), Rotation::Identity()}));
    simulator.step();
    std::vector<double> warp, weft;
    simulator.copyTensions(warp, weft);
    for (const double tension : warp) most = std::max(most, std::abs(tension));
    for (const double tension : weft) most = std::max(most, tension);
  }
  EXPECT_GT(simulator.statistics().warp_stretch, 0.1);  // it is pulled apart
  EXPECT_LT(most, 7e12);
}

// Two hands share the weight; when one lets go the other has it.
TEST(Grasp, HandsOver) {
  Simulator simulator(strip());
  ASSERT_EQ(refusal(simulator, nodeGrasp("left", {{0, 0}, {0, 1}, {0, 2}})), "");
  EXPECT_NE(refusal(simulator, nodeGrasp("right", {{0, 2}, {0, 3}})), "") << "{0, 2} is held";
  // Of its region it takes what is beside the other hand.
  ASSERT_EQ(refusal(simulator, ballGrasp("right", simulator.position({0, 3}), 0.07)), "");
  const std::vector<NodeIndex> taken = simulator.graspState("right")->nodes;
  ASSERT_EQ(taken.size(), 3U);  // {0, 3}, {0, 4}, {1, 3}
  for (int frame = 0; frame < 600; ++frame) simulator.step();
  const Vec3 both = simulator.graspState("left")->force + simulator.graspState("right")->force;
  EXPECT_LE((both - Vec3(0.0, 0.0, -kWeight)).norm(), 1e-3 * kWeight);
  const Vec3 held = simulator.position({0, 3}), free = simulator.position({0, 0});
  ASSERT_TRUE(simulator.releaseGrasp("left"));
  EXPECT_EQ(simulator.grasps(), std::vector<std::string>{"right"});
  for (int frame = 0; frame < 300; ++frame) simulator.step();
  EXPECT_EQ(simulator.position({0, 3}), held);
  EXPECT_GT((simulator.position({0, 0}) - free).norm(), 0.02);
  EXPECT_GT(-simulator.graspState("right")->force.z(), 0.9 * kWeight);
}

// A hand tears off the cloth when that is drawn taut; the rest of its way it makes without it.
TEST(Grasp, Breaks) {
  for (const bool gives : {false, true}) {
    Scene scene = flatScene(12, 8);
    Simulator simulator(scene);
    GraspParams grasp = ballGrasp("hand", {0.5, 0.0, 0.0}, 0.15);
    grasp.break_force = 5.0;
    if (gives) grasp.stiffness = 500.0;
    ASSERT_EQ(refusal(simulator, grasp), "");
    int torn = 0;
    for (int frame = 1; frame <= 60 && torn == 0; ++frame) {
      simulator.moveGrasp("hand", {Vec3(0.5, 0.0, -0.01 * frame), Rotation::Identity()});
      simulator.step();
      if (simulator.graspState("hand")->end == GraspEnd::kBroken) torn = frame;
    }
    ASSERT_GT(torn, 0);
    const GraspState state = *simulator.graspState("hand");
    EXPECT_TRUE(state.nodes.empty());
    EXPECT_GE(state.force.norm(), 5.0);
    EXPECT_FALSE(simulator.pinned({11, 4}));
    EXPECT_FALSE(simulator.moveGrasp("hand", Pose())) << "it has ended";
    for (int frame = 0; frame < 30; ++frame) simulator.step();
    EXPECT_LE(simulator.statistics().warp_stretch, 2e-3);
    EXPECT_EQ(refusal(simulator, ballGrasp("hand", simulator.position({11, 4}), 0.05)), "") << "it may try again";
    EXPECT_EQ(simulator.graspState("hand")->end, GraspEnd::kNone);
  }
}

// Below 2 mu N nothing slides: what a held node may be off is 1e-4 m.
TEST(Grasp, HoldsBetweenPads) {
  Simulator simulator(strip());
  ASSERT_EQ(refusal(simulator, pinched(1.1 * kWeight)), "");
  for (int frame = 0; frame < 900; ++frame) simulator.step();
  const GraspState state = *simulator.graspState("pads");
  EXPECT_LE(state.slipped, 1e-4);
  EXPECT_LE((state.force - Vec3(0.0, 0.0, -kWeight)).norm(), 1e-3 * kWeight);
}

// Above it the cloth slides out, pulling with just that, and no faster than what is left of its weight lets it.
TEST(Grasp, SlidesOutBetweenPads) {
  Scene scene = strip();
  scene.air = AirParams();
  Simulator simulator(scene);
  const double hold = 0.5 * kWeight;
  ASSERT_EQ(refusal(simulator, pinched(hold)), "");
  std::size_t held = simulator.graspState("pads")->nodes.size();
  double slipped = 0.0, at_first = 0.0;
  int frame = 0;
  for (; simulator.graspState("pads")->end == GraspEnd::kNone && frame < 200; ++frame) {
    simulator.step();
    const GraspState state = *simulator.graspState("pads");
    EXPECT_LE(state.nodes.size(), held) << "nothing comes from above";
    held = state.nodes.size();
    if (frame >= 3 && held > 0) {
      EXPECT_NEAR(-state.force.z(), hold, 0.05 * hold) << "frame " << frame;
    }
    EXPECT_GE(state.slipped, slipped);
    slipped = state.slipped;
    if (frame == 5) at_first = momentumOf(simulator).z();
    if (frame == 15) {
      EXPECT_NEAR(at_first - momentumOf(simulator).z(), (kWeight - hold) * 10.0 / 60.0, 0.05 * hold * 10.0 / 60.0);
    }
  }
  EXPECT_EQ(simulator.graspState("pads")->end, GraspEnd::kSlippedOut);
  // The top row is 0.23 m above the box's lower end: with an acceleration of g / 2 that takes 0.306 s, 18.4 frames. The
  // strip's corners lag behind.
  EXPECT_NEAR(frame, 18.4, 3.0);
  EXPECT_NEAR(slipped, 0.23, 0.05);
}

// Two pads that are drawn along hanging cloth: it passes between them, new cloth comes in, and they feel 2 mu N.
TEST(Grasp, SlidesAlongTheCloth) {
  Scene scene = flatScene(41, 7, 2.0, 0.3);
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  Simulator simulator(scene);
  GraspParams grasp = pinched(0.3);
  grasp.frame.position = {0.15, 0.0, 1.4};
  ASSERT_EQ(refusal(simulator, grasp), "");
  const double speed = 0.5;
  double worst = 0.0;
  for (int frame = 1; frame <= 90; ++frame) {
    simulator.moveGrasp("pads", {grasp.frame.position - Vec3(0.0, 0.0, speed * frame / 60.0), Rotation::Identity()});
    simulator.step();
    const GraspState state = *simulator.graspState("pads");
    ASSERT_EQ(state.end, GraspEnd::kNone);
    EXPECT_GE(state.nodes.size(), 5U * 6U);
    if (frame > 30) worst = std::max(worst, std::abs(state.force.z() - 0.3));
  }
  EXPECT_LE(worst, 0.05 * 0.3);
  EXPECT_NEAR(simulator.graspState("pads")->slipped, speed * 1.5, 0.02);
}

}  // namespace
}  // namespace curtain_test
