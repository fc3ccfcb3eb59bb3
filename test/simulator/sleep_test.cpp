// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that falls asleep when nothing moves it, without anybody noticing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "simulator/sleeping_cloth.h"

namespace curtain {
namespace {

using namespace curtain_test;

constexpr double kNotLate = 1e-3;  // [m]

TEST(Sleep, FallsAsleepAndStaysWhereItIs) {
  Simulator simulator(hanging());
  ASSERT_TRUE(sleepsWithin(simulator, 60));
  std::vector<Vec3> place, velocity;
  simulator.copyPositions(place);
  const std::uint64_t revision = simulator.revision(), hash = simulator.stateHash();
  const std::int64_t substeps = simulator.statistics().substeps;
  run(simulator, 100);
  EXPECT_EQ(simulator.revision(), revision);
  EXPECT_EQ(simulator.stateHash(), hash);
  EXPECT_EQ(simulator.statistics().substeps, substeps);
  EXPECT_EQ(simulator.statistics().substeps_last, 0);
  EXPECT_GE(simulator.statistics().asleep_frames, 100);
  EXPECT_EQ(farthestMoved(simulator, place), 0.0);
  EXPECT_EQ(simulator.energy().kinetic, 0.0);
  EXPECT_EQ(simulator.statistics().wakes, 0);
  simulator.copyVelocities(velocity);
  for (const Vec3& v : velocity) EXPECT_EQ(v.norm(), 0.0);
}

TEST(Sleep, NotWhatMovesNorWithoutGravityNorWhenNotWanted) {
  Simulator swing([] {
    Scene scene = flatScene(8, 6);
    scene.hang.tilt = 0.01;
    return scene;
  }());
  Simulator floating([] {
    Scene scene = hanging();
    scene.air.inside = scene.air.border = scene.air.corner = 0.0;
    scene.gravity.setZero();
    return scene;
  }());
  Simulator unwanted(sleepless(hanging()));
  // Frames too far apart to tell a swing from rest.
  Simulator slow([] {
    Scene scene = flatScene(2, 6, 0.0398, 1.0);
    scene.hang.tilt = 0.3;
    scene.solver.frame_rate = 5.0;
    return scene;
  }());
  for (Simulator* simulator : {&swing, &floating, &unwanted, &slow}) {
    run(*simulator, 300);
    EXPECT_FALSE(simulator->statistics().asleep);
    EXPECT_EQ(simulator->statistics().asleep_frames, 0);
  }
}

// Long columns in few substeps: changes between two lengths of these kept it trembling, by 1 cm/s RMS.
TEST(Sleep, ComesToACurtainThatTheWindHasLeft) {
  Scene scene = shippedScene("curtain");
  scene.obstacles.clear();
  Simulator simulator(scene);
  const int second = static_cast<int>(scene.solver.frame_rate);
  run(simulator, 5 * second);
  simulator.clearWinds();
  EXPECT_TRUE(sleepsWithin(simulator, 30 * second));
}

// Overdamped cloth creeps: slow is not at rest.
TEST(Sleep, CreepingClothIsLeftToArrive) {
  Scene scene = hanging();
  scene.hang.to = {1.0, 0.0, 1.2};
  scene.hang.tilt = 0.3;
  scene.air.inside = scene.air.border = scene.air.corner = 40.0;  // c / m = 240 / s: a time constant of 17 s
  Simulator simulator(scene);
  int frame = 0;
  for (; frame < 60 * 600 && !simulator.statistics().asleep; ++frame) simulator.step();
  ASSERT_TRUE(simulator.statistics().asleep);
  const double sine = simulator.position({15, 10}).y() / (1.2 - simulator.position({15, 10}).z());
  // At its resting speed a swing of this size would be 1e-4 / omega = 3e-5 m wide.
  EXPECT_LT(std::abs(sine), 1e-4) << "asleep after " << frame / 60 << " s";
}

TEST(Sleep, SleepsOnWhenNothingOfItMatters) {
  Scene scene = hanging();
  scene.wind.push_back(fan(3.0));
  scene.drag.push_back(pull({0.0, 0.05, 0.0}));
  scene.obstacles.push_back(smallBallAt({5.0, 0.0, 0.6}));
  Simulator simulator(scene);
  ASSERT_TRUE(sleepsWithin(simulator, 900));
  const std::int64_t wakes = simulator.statistics().wakes;
  for (int frame = 0; frame < 60; ++frame) {
    WindParams again = fan(3.0);  // the same, from now on
    again.start = simulator.time();
    EXPECT_TRUE(simulator.setWind(again).empty());
    WindParams elsewhere = fan(50.0);
    elsewhere.id = "elsewhere";
    elsewhere.position.z() = 10.0 + 0.1 * frame;
    elsewhere.unsteadiness = 5.0;
    EXPECT_TRUE(simulator.setWind(elsewhere).empty());
    DragParams held = pull({0.0, 0.05, 0.0});
    held.start = simulator.time();
    EXPECT_TRUE(simulator.setDrag(held).empty());
    Pose pose;
    pose.position = {4.0 - 0.01 * frame, 0.0, 0.6};
    simulator.setObstaclePose(0, pose);
    simulator.step();
  }
  EXPECT_TRUE(simulator.statistics().asleep);
  EXPECT_EQ(simulator.statistics().wakes, wakes);
  EXPECT_EQ(simulator.obstaclePose(0).position.x(), 4.0 - 0.01 * 59);
}

// A bad value changes nothing, so nothing has to wake for it.
TEST(Sleep, SleepsOnWhenASourceIsRefused) {
  Scene scene = hanging();
  scene.wind.push_back(fan(3.0));
  scene.drag.push_back(pull({0.0, 0.05, 0.0}));
  Simulator simulator(scene);
  ASSERT_TRUE(sleepsWithin(simulator, 900));
  const std::int64_t wakes = simulator.statistics().wakes;
  EXPECT_FALSE(simulator.setWind(fan(-1.0)).empty());
  DragParams bad = pull({0.0, 0.1, 0.0});
  bad.radius = -1.0;
  EXPECT_FALSE(simulator.setDrag(bad).empty());
  simulator.step();
  EXPECT_TRUE(simulator.statistics().asleep);
  EXPECT_EQ(simulator.statistics().wakes, wakes);
}

TEST(Sleep, GustsKeepItAwakeHoweverWeak) {
  Scene scene = hanging();
  scene.wind.push_back(fan(0.0));
  scene.wind[0].unsteadiness = 1e-6;
  Simulator simulator(scene);
  run(simulator, 300);
  EXPECT_FALSE(simulator.statistics().asleep);
}

TEST(Sleep, RestsOnABallAndPressesOn) {
  Scene scene = hanging();
  scene.obstacles.push_back(smallBallAt({0.5, -0.1, 0.6}));
  Simulator simulator(scene);
  ASSERT_TRUE(sleepsWithin(simulator, 900));
  const Vec3 force = simulator.contactWrench(0).force;
  EXPECT_GT(force.norm(), 1e-3);
  const int contacts = simulator.statistics().contacts;
  run(simulator, 60);
  EXPECT_EQ(simulator.contactWrench(0).force, force);
  EXPECT_EQ(simulator.statistics().contacts, contacts);
}

// Sleeping and waking take energy or leave it: never does any come from nowhere. No force but gravity acts, so between
// frames the total may not rise by more than without sleeping (leapfrog's own wavering, and what links are let out by:
// a share of the tolerance).
TEST(Sleep, GivesNoEnergyAndNoJump) {
  Scene scene = hanging();
  scene.drag.push_back(pull({0.0, 0.1, 0.0}));
  scene.drag[0].end = 0.5;
  const double allowed = 1e-4 * 0.2 * 9.81;  // 1e-4 m g L
  Simulator simulator(scene);
  std::vector<Vec3> before;
  int changes = 0;
  bool asleep = false;
  run(simulator, 31);
  double energy = simulator.energy().kinetic + simulator.energy().potential;
  for (int frame = 0; frame < 900; ++frame) {
    if (frame == 700) {
      DragParams idle = pull(Vec3::Zero());  // wakes it, and that is all it does
      ASSERT_TRUE(simulator.setDrag(idle).empty());
    }
    simulator.copyPositions(before);
    simulator.step();
    const double now = simulator.energy().kinetic + simulator.energy().potential;
    EXPECT_LE(now, energy + allowed) << "frame " << frame;
    energy = std::min(energy, now);
    if (simulator.statistics().asleep == asleep) continue;
    ++changes;
    asleep = simulator.statistics().asleep;
    // What rests moves less than 1e-4 m/s: less than 2e-6 m in a frame; columns that don't rest yet, 50 times that.
    EXPECT_LT(farthestMoved(simulator, before), 50 * 1e-4 / 60.0) << "frame " << frame;
  }
  EXPECT_GE(changes, 3);  // asleep, awake, asleep
}

// Cloth that never rests moves as if there were no such thing.
TEST(Sleep, ChangesNoBitOfWhatMoves) {
  Scene scene = flatScene(12, 16);
  scene.hang.tilt = 0.8;
  Simulator simulator(scene), reference(sleepless(scene));
  run(simulator, 240);
  run(reference, 240);
  EXPECT_EQ(simulator.stateHash(), reference.stateHash());
}

// Velocities are half a substep old and made new for who asks: that leaves no trace in cloth that falls asleep either.
TEST(Sleep, IsNotDisturbedByWhoLooks) {
  const Scene scene = hanging();
  Simulator simulator(scene), watched(scene);
  std::vector<Vec3> velocities;
  for (int frame = 0; frame < 150; ++frame) {
    for (Simulator* one : {&simulator, &watched}) {
      if (frame == 100) one->setDrag(pull({0.0, 0.05, 0.0}));
      one->step();
    }
    watched.copyVelocities(velocities);
    ASSERT_EQ(simulator.stateHash(), watched.stateHash()) << "frame " << frame;
  }
  EXPECT_EQ(simulator.statistics().wakes, 1) << "nothing woke: nothing could have been disturbed";
}

}  // namespace
}  // namespace curtain
