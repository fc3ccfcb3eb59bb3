// SPDX-License-Identifier: BSD-3-Clause
//
// What a simulator keeps to save time changes no bit of what comes: whole runs are made twice, once with the caches of
// contact cleared at random within substeps, and, at some frames, with all else that no snapshot carries gone.
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "clear_caches.h"
#include "curtain_sim/scene_yaml.h"
#include "properties/seeds.h"
#include "simulator/snapshot_testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

void expectSameWithoutCaches(const Scene& scene, int frames, std::uint64_t seed, const Deeds& deeds = doNothing) {
  Simulator keeps(scene);
  std::optional<Simulator> forgets(scene);
  Random random(seed);
  const auto clear = [&] { CacheClearing::atRandom(*forgets, 2 * seed + 1); };
  clear();
  for (int frame = 0; frame < frames; ++frame) {
    for (Simulator* const simulator : {&keeps, &*forgets}) {
      deeds(*simulator, frame);
      simulator->step();
    }
    ASSERT_EQ(keeps.stateHash(), forgets->stateHash()) << "frame " << frame;
    expectSameStatistics(keeps.statistics(), forgets->statistics());
    if (random.chance(0.1)) {
      expectSameReading(keeps, *forgets);
      const std::string snapshot = forgets->snapshot();
      forgets.emplace(scene);
      ASSERT_NO_FATAL_FAILURE(restoreOrFail(*forgets, snapshot));
      clear();
    }
    ASSERT_FALSE(testing::Test::HasFailure()) << "frame " << frame;
  }
}

Scene sceneOf(const std::string& name, int rows, int columns) {
  const SceneReading reading = readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/config/scenes/" + name + ".yaml");
  EXPECT_TRUE(reading.problems.empty()) << describe(reading.problems);
  Scene scene = reading.scene;
  scene.cloth.rows = rows;
  scene.cloth.columns = columns;
  return scene;
}

// A flag flaps against itself.
TEST(Caches, ChangeNoBitOfAFlag) { expectSameWithoutCaches(sceneOf("flag", 10, 14), 120, 1); }

// Gathered cloth in wind and gusts, which a ball goes through.
TEST(Caches, ChangeNoBitOfACurtainAndABall) {
  Scene scene = sceneOf("curtain", 16, 14);
  for (PoseKey& key : scene.obstacles[0].motion) key.time *= 0.3;
  expectSameWithoutCaches(scene, 90, 2);
}

// Closed cloth around two capsules that turn.
TEST(Caches, ChangeNoBitOfASkirt) { expectSameWithoutCaches(sceneOf("skirt", 10, 20), 90, 3); }

// Cloth without pins falls in folds on the floor.
TEST(Caches, ChangeNoBitOfASheetOnTheFloor) {
  Scene scene = sceneOf("sheet", 12, 12);
  scene.wind.clear();
  scene.hang.from.z() = scene.hang.to.z() = 0.4;
  scene.hang.tilt = 0.7;
  expectSameWithoutCaches(scene, 90, 4);
}

// Meshes with edges and corners, one of them turning, are blown at.
TEST(Caches, ChangeNoBitOnMeshes) {
  for (const char* const mesh : {"icosphere.stl", "l_prism.obj", "cube_quads.obj", "square_open.obj"}) {
    SCOPED_TRACE(mesh);
    Scene scene = sceneOf("curtain", 14, 12);
    scene.wind[0].pressure = 30.0;
    ObstacleParams& thing = scene.obstacles[0];
    thing.shape = ShapeKind::kMesh;
    thing.radius = 0.0;
    thing.mesh = std::string(CURTAIN_SOURCE_DIR "/test/meshes/") + mesh;
    thing.scale = Vec3::Constant(0.2);
    thing.motion = {{0.0, thing.motion[0].pose}, {1.0, thing.motion[1].pose}};
    thing.motion[0].pose.position.y() = 0.5;
    thing.motion[1].pose.position.y() = -0.5;
    thing.motion[1].pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(1.5, Vec3(1.0, 2.0, 3.0).normalized()));
    ObstacleParams still = thing;
    still.name = "still";
    still.motion.clear();
    still.pose.position = {0.1, 0.25, 0.7};
    scene.obstacles.push_back(still);
    expectSameWithoutCaches(scene, 70, 5);
    if (HasFailure()) return;
  }
}

// A plate goes through where the cloth hangs, faster than one sees.
TEST(Caches, ChangeNoBitBeforeAPlate) {
  Scene scene = sceneOf("curtain", 14, 12);
  ObstacleParams& plate = scene.obstacles[0];
  plate.shape = ShapeKind::kBox;
  plate.radius = 0.0;
  plate.size = {0.8, 0.01, 0.8};
  plate.motion = {{0.3, plate.motion[0].pose}, {0.45, plate.motion[1].pose}};
  expectSameWithoutCaches(scene, 60, 6);
}

// Some of everything, and things done from outside meanwhile.
TEST(Caches, ChangeNoBitOfRandomScenes) {
  for (const std::uint64_t seed : seeds(10, {961})) {
    SCOPED_TRACE(repeat(seed));
    Random random(seed);
    const Scene scene = randomScene(random);
    expectSameWithoutCaches(scene, 40, seed, randomDeeds(seed, 0.1));
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace curtain
