// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that falls asleep when nothing moves it, a column at a time, and without anybody noticing.
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
    EXPECT_EQ(simulator->statistics().asleep, 0);
    EXPECT_EQ(simulator->statistics().asleep_frames, 0);
  }
}

// Overdamped cloth creeps: slow is not at rest.
TEST(Sleep, CreepingClothIsLeftToArrive) {
  Scene scene = hanging();
  scene.hang.to = {1.0, 0.0, 1.2};
  scene.hang.tilt = 0.3;
  scene.air.inside = scene.air.border = scene.air.corner = 40.0;  // c / m = 240 / s: a time constant of 17 s
  Simulator simulator(scene);
  int frame = 0;
  for (; frame < 60 * 600 && simulator.statistics().asleep == 0; ++frame) simulator.step();
  ASSERT_GT(simulator.statistics().asleep, 0);
  const double sine = simulator.position({15, 10}).y() / (1.2 - simulator.position({15, 10}).z());
  // At its resting speed a swing of this size would be 1e-4 / omega = 3e-5 m wide.
  EXPECT_LT(std::abs(sine), 1e-4) << "asleep after " << frame / 60 << " s";
}

TEST(Sleep, SleepsOnWhenNothingOfItMatters) {
  Scene scene = hanging();
  scene.wind.push_back(fan(3.0));
  scene.drag.push_back(pull({0.0, 0.05, 0.0}));
  scene.obstacles.push_back(ballAt({5.0, 0.0, 0.6}));
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
  EXPECT_EQ(simulator.statistics().asleep, simulator.columns());
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
  EXPECT_EQ(simulator.statistics().asleep, simulator.columns());
  EXPECT_EQ(simulator.statistics().wakes, wakes);
}

TEST(Sleep, GustsKeepItAwakeHoweverWeak) {
  Scene scene = hanging();
  scene.wind.push_back(fan(0.0));
  scene.wind[0].unsteadiness = 1e-6;
  Simulator simulator(scene);
  run(simulator, 300);
  EXPECT_EQ(simulator.statistics().asleep, 0);
}

TEST(Sleep, RestsOnABallAndPressesOn) {
  Scene scene = hanging();
  scene.obstacles.push_back(ballAt({0.5, -0.1, 0.6}));
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
  int changes = 0, asleep = 0;
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

// One edge of a gathered curtain is led to and fro: what hangs beyond sleeps all the while, and nobody sees it.
TEST(Sleep, ColumnsSleepWhileOthersMove) {
  Scene scene = flatScene(24, 40);
  scene.hang.from = {0.0, 0.0, 1.2};
  scene.hang.to = {0.8, 0.0, 1.2};
  scene.air.inside = scene.air.border = scene.air.corner = 0.5;
  scene.contact.self = true;
  Scene parallel = scene;
  parallel.solver.threads = 2;
  Simulator simulator(scene), reference(sleepless(scene)), threaded(parallel);
  int most = 0, least = 40;
  double apart = 0.0;
  for (int frame = 0; frame < 900; ++frame) {
    DragParams hand;
    hand.id = "hand";
    hand.node = NodeIndex{23, 1};
    hand.target = Vec3(0.02, 0.1 * std::sin(0.05 * frame), 0.2);
    hand.stiffness = 5.0;
    for (Simulator* one : {&simulator, &reference, &threaded}) {
      if (frame > 90 && frame < 600) {
        ASSERT_TRUE(one->setDrag(hand).empty());
      }
      one->step();
    }
    apart = std::max(apart, farthestApart(simulator, reference));
    ASSERT_EQ(simulator.stateHash(), threaded.stateHash()) << "frame " << frame;
    if (frame > 200 && frame < 600) {
      most = std::max(most, simulator.statistics().asleep);
      least = std::min(least, simulator.statistics().asleep);
    }
  }
  std::printf("asleep while one edge moves: %d to %d of 40, apart by at most %.1e m, %d wakes\n", least, most, apart,
              static_cast<int>(simulator.statistics().wakes));
  EXPECT_GE(most, 20);
  EXPECT_LT(most, 40);
  EXPECT_LT(apart, kNotLate);
  EXPECT_EQ(simulator.statistics().asleep, 40) << "when all is over";
}

// The same of a ring: what moves lies on both sides of where its columns begin and end.
TEST(Sleep, ColumnsOfARingSleepWhileOthersMove) {
  Scene scene = curtain_test::ringScene(16, 32, 1.0, 2.0);
  scene.hang.radius = 0.22;
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  Simulator simulator(scene), reference(sleepless(scene));
  int most = 0;
  double apart = 0.0;
  for (int frame = 0; frame < 600; ++frame) {
    DragParams hand;
    hand.id = "hand";
    hand.node = NodeIndex{15, 0};
    hand.target = Vec3(0.22, 0.05 * std::sin(0.05 * frame), 1.0);
    hand.stiffness = 5.0;
    for (Simulator* one : {&simulator, &reference}) {
      if (frame > 60) {
        ASSERT_TRUE(one->setDrag(hand).empty());
      }
      one->step();
    }
    apart = std::max(apart, farthestApart(simulator, reference));
    if (frame > 200) most = std::max(most, simulator.statistics().asleep);
  }
  std::printf("asleep of a ring while a node moves: up to %d of 32, apart by at most %.1e m\n", most, apart);
  EXPECT_GE(most, 16);
  EXPECT_LT(most, 32);
  EXPECT_LT(apart, kNotLate);
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

// Velocities are half a substep old and made new for who asks: that leaves no trace in columns that sleep either.
TEST(Sleep, IsNotDisturbedByWhoLooks) {
  Scene scene = hanging();
  scene.cloth.columns = 40;
  Simulator simulator(scene), watched(scene);
  std::vector<Vec3> velocities;
  int partly = 0;
  for (int frame = 0; frame < 150; ++frame) {
    for (Simulator* one : {&simulator, &watched}) {
      DragParams drag = pull({0.0, 0.02 + 1e-3 * frame, 0.0});
      drag.node = NodeIndex{15, 38};
      if (frame % 6 == 0) one->setDrag(drag);
      one->step();
    }
    watched.copyVelocities(velocities);
    partly += simulator.statistics().asleep > 0 && simulator.statistics().asleep < 40 ? 1 : 0;
    ASSERT_EQ(simulator.stateHash(), watched.stateHash()) << "frame " << frame;
  }
  EXPECT_GT(partly, 0);
  EXPECT_GT(simulator.statistics().wakes, 0) << "nothing woke: nothing could have been disturbed";
}

}  // namespace
}  // namespace curtain
