// SPDX-License-Identifier: BSD-3-Clause
//
// Snapshots: what is restored goes on as what was saved, to the bit, whatever it is in the middle of.
#include <gtest/gtest.h>

#include <cstdlib>

#include "simulator/snapshot_format.h"
#include "simulator/snapshot_testing.h"

namespace curtain {
namespace {

using curtain_test::ballAt;
using curtain_test::Deeds;
using curtain_test::expectContinues;
using curtain_test::expectSameStatistics;
using curtain_test::flatScene;
using curtain_test::Life;
using curtain_test::Random;
using curtain_test::randomDeeds;
using curtain_test::randomScene;
using curtain_test::restoreOrFail;
using curtain_test::run;

// A curtain of 1 m x 1 m in damping air; short substeps, as of test/simulator/sleeping_cloth.h.
Scene hanging(int columns = 20) {
  Scene scene = flatScene(16, columns);
  scene.hang.to.x() = 0.9;
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  scene.solver.substeps = 32;
  return scene;
}

TEST(Snapshot, GoesOnWithEveryMethod) {
  Scene scene = flatScene(12, 10);
  scene.hang.to.x() = 0.7;
  scene.hang.tilt = 0.5;
  for (const std::string& name : methodNames()) {
    SCOPED_TRACE(name);
    scene.solver.method = *methodFromName(name);
    ASSERT_NO_FATAL_FAILURE(expectContinues(scene, Life()));
  }
}

// The companion moves along for one second of four; before the first frame substeps are rehearsed.
TEST(Snapshot, GoesOnWithinAnEstimate) {
  Scene scene = flatScene(6, 4);
  scene.hang.tilt = 0.8;
  scene.solver.position_tolerance = 1e-3;
  for (const Method method : {Method::kAuto, Method::kLeapfrog4}) {
    scene.solver.method = method;
    for (const int saved_at : {0, 1, 30, 60, 120, 239, 241}) {
      SCOPED_TRACE(toString(method) + ", saved at " + std::to_string(saved_at));
      Life life;
      life.saved_at = saved_at;
      life.end = saved_at + 70;
      ASSERT_NO_FATAL_FAILURE(expectContinues(scene, life));
    }
  }
}

TEST(Snapshot, GoesOnWhileItSleeps) {
  const Scene scene = hanging();
  Life life;
  life.saved_at = 100;
  life.end = 200;
  life.deeds = [](Simulator& simulator, int frame) {
    if (frame == 150) {
      EXPECT_TRUE(simulator.setGravity({0.3, 0.0, -9.81}).empty());
    }
  };
  life.other = [](Simulator& simulator, int frame) {
    EXPECT_TRUE(simulator.setGravity({0.1 * frame, 0.0, -9.81}).empty());
  };
  Simulator scout(scene);
  run(scout, life.deeds, 0, life.saved_at);
  ASSERT_TRUE(scout.statistics().asleep);
  expectContinues(scene, life);
}

// Dropped: it lies on a floor and on itself, with friction.
TEST(Snapshot, GoesOnWhileItCrumples) {
  Scene scene = flatScene(14, 14);
  scene.hang.tilt = 0.1;
  scene.pins.kind = PinKind::kNone;
  scene.contact.self = true;
  scene.contact.thickness = 0.01;
  ObstacleParams floor = ballAt({0.0, 0.0, -0.05}, 1.0);
  floor.name = "floor";
  floor.shape = ShapeKind::kPlane;
  scene.obstacles = {floor, ballAt({0.5, 0.05, 0.2}, 0.15)};
  for (const int saved_at : {10, 25, 45}) {
    SCOPED_TRACE(saved_at);
    Life life;
    life.saved_at = saved_at;
    life.end = saved_at + 12;
    ASSERT_NO_FATAL_FAILURE(expectContinues(scene, life));
  }
}

// CURTAIN_SEEDS=first:count for others than these.
TEST(Snapshot, GoesOnInRandomScenesAtRandomFrames) {
  std::uint64_t first = 1, count = 12;
  if (const char* const seeds = std::getenv("CURTAIN_SEEDS")) {
    char* end = nullptr;
    first = std::strtoull(seeds, &end, 10);
    count = std::strtoull(end + 1, nullptr, 10);
  }
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Scene scene = randomScene(random);
    Scene other_threads = scene;
    other_threads.solver.threads = random.integer(1, 2);
    Life life;
    life.saved_at = random.integer(0, 40);
    life.end = life.saved_at + random.integer(5, 20);
    life.other_frames = random.integer(0, 20);
    life.deeds = randomDeeds(seed, random.between(0.0, 0.3));
    life.other = randomDeeds(seed + 777, random.between(0.0, 0.4));
    expectContinues(scene, life, other_threads);
    if (HasFailure()) return;
  }
}

// Computing time decides there: what it goes on from is the same, what it comes to need not be.
TEST(Snapshot, KeepsWhatABudgetHasCost) {
  Scene scene = flatScene(24, 20);
  scene.hang.to.x() = 0.6;
  scene.hang.tilt = 0.8;
  scene.solver.budget_ms = 0.2;
  scene.solver.frame_rate = 30.0;
  Simulator simulator(scene), restored(scene);
  for (int frame = 0; frame < 20; ++frame) {
    simulator.movePin({0, 3}, Vec3(0.1, 0.01 * frame, 1.0));
    simulator.step();
  }
  ASSERT_NO_FATAL_FAILURE(restoreOrFail(restored, simulator.snapshot()));
  EXPECT_EQ(restored.stateHash(), simulator.stateHash());
  expectSameStatistics(restored.statistics(), simulator.statistics());
  const double lost = restored.statistics().lost_time;
  for (int frame = 0; frame < 10; ++frame) restored.step();
  EXPECT_TRUE(restored.statistics().finite);
  EXPECT_GE(restored.statistics().lost_time, lost);
  EXPECT_EQ(restored.statistics().frames, 30);
}

// Velocities that somebody has asked for are those of then, whatever gravity has come to be since.
TEST(Snapshot, KeepsWhatHasBeenLookedAt) {
  Scene scene = flatScene(8, 6);
  scene.hang.tilt = 0.5;
  Simulator simulator(scene), restored(scene);
  for (int frame = 0; frame < 10; ++frame) simulator.step();
  std::vector<Vec3> before, after;
  simulator.copyVelocities(before);
  EXPECT_TRUE(simulator.setGravity({0.0, 3.0, 0.0}).empty());
  ASSERT_NO_FATAL_FAILURE(restoreOrFail(restored, simulator.snapshot()));
  simulator.copyVelocities(after);
  EXPECT_EQ(before, after);
  restored.copyVelocities(after);
  EXPECT_EQ(before, after);
}

// What a snapshot carries, by name, type and count. When this fails, what is carried has changed: raise
// kSnapshotVersion (src/simulator/snapshot_format.h) and write the new numbers here.
TEST(Snapshot, HasAVersionForEveryLayout) {
  Scene all = flatScene(4, 5);
  all.solver.position_tolerance = 1e-3;
  all.contact.self = true;
  all.obstacles = {ballAt({0.0, 0.0, 0.0}, 0.1), ballAt({0.0, 1.0, 0.0}, 0.1)};
  all.obstacles[1].name = "cube";
  all.obstacles[1].shape = ShapeKind::kMesh;
  all.obstacles[1].mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/cube_quads.obj";
  SnapshotParts parts;
  const std::string snapshot = Simulator(all).snapshot();
  ASSERT_FALSE(unpackSnapshot(snapshot, parts).has_value());
  EXPECT_EQ(kSnapshotVersion, 21U);
  EXPECT_EQ(parts.layout, 822323291U);
  const std::string plain = Simulator(flatScene(4, 5)).snapshot();
  ASSERT_FALSE(unpackSnapshot(plain, parts).has_value());
  EXPECT_EQ(parts.layout, 1985687758U);
}

}  // namespace
}  // namespace curtain
