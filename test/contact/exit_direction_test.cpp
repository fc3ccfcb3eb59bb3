// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that passes through a box comes out across itself, however near its other sides are; cloth that ends in it by
// the shortest way.
#include "contact/response/exit_direction.h"

#include <gtest/gtest.h>

#include "curtain_sim/simulator.h"
#include "obstacles/obstacle_set.h"
#include "testing.h"

namespace curtain {
namespace {

/// A box at the origin, and cloth of 9 x 9 nodes 4 cm apart in a plane of constant y: its middle is at `middle`.
struct BoxInCloth {
  BoxInCloth(const Vec3& size, const Vec3& middle) {
    scene = curtain_test::flatScene(9, 9, 0.32, 0.32);
    scene.pins.kind = PinKind::kNone;
    ObstacleParams box;
    box.name = "box";
    box.shape = ShapeKind::kBox;
    box.size = size;
    scene.obstacles.push_back(box);
    pattern = makePattern(scene);
    obstacles = std::make_unique<ObstacleSet>(scene, shapesBy(resolveMeshUrl));
    position.assign(pattern.grid.size(), 0.0);
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < 9; ++j) position.set(pattern.grid.index(i, j), middle + 0.04 * Vec3(j - 4, 0.0, 4 - i));
    }
    const MovingObstacle& moving = obstacles->moving(0);
    near = std::make_unique<ObstacleCandidates>(pattern, *moving.shape, ObstacleGaps{0.004, 0.0012}, alone);
    near->prepare(moving, position, position);
  }

  /// Where a node comes out that would by itself leave along `own`.
  SurfacePoint exitOf(int i, int j, const Vec3& own, const std::vector<PenetratingFace>& faces = {}) const {
    const ExitDirection exit(pattern.grid, *near, faces);
    SurfacePoint surface;
    surface.normal = own;
    return exit.exitSurface(position.at(pattern.grid.index(i, j)), surface);
  }

  Scene scene;
  ClothPattern pattern;
  std::unique_ptr<ObstacleSet> obstacles;
  const Workers alone{1};
  Field3 position;
  std::unique_ptr<ObstacleCandidates> near;
};

TEST(ExitDirection, IsAcrossTheClothWhereItGoesOnOnBothSides) {
  // 3 cm of cloth to the sides, 19 cm across it.
  const BoxInCloth setup({0.06, 0.4, 0.06}, {0.0, 0.01, 0.0});
  for (const Vec3& own : {Vec3(1.0, 0.0, 0.0), Vec3(-1.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0)}) {
    const SurfacePoint exit = setup.exitOf(4, 4, own);
    EXPECT_NEAR(exit.normal.y(), 1.0, 1e-12);
    EXPECT_NEAR(exit.distance, -0.19, 0.001);
  }
  const BoxInCloth other_side({0.06, 0.4, 0.06}, {0.0, -0.01, 0.0});
  EXPECT_NEAR(other_side.exitOf(4, 4, Vec3::UnitX()).normal.y(), -1.0, 1e-12);
}

TEST(ExitDirection, IsAlongTheClothWhereItEndsInside) {
  // Its last row is 2 cm below the box's upper side.
  const BoxInCloth setup({0.06, 0.4, 0.06}, {0.0, 0.01, 0.17});
  const SurfacePoint exit = setup.exitOf(8, 4, Vec3::UnitX());
  EXPECT_NEAR(exit.normal.z(), 1.0, 1e-12);
  EXPECT_NEAR(exit.distance, -0.02, 0.001);
}

TEST(ExitDirection, LeavesANodeItsOwnOnTheSameSide) {
  const BoxInCloth setup({0.06, 0.4, 0.06}, {0.0, 0.01, 0.0});
  const Vec3 own = Vec3(0.3, 1.0, 0.0).normalized();
  EXPECT_EQ(setup.exitOf(4, 4, own).normal, own);
}

TEST(ExitDirection, OfFacesAloneIsAcrossThem) {
  // Between the nodes.
  const BoxInCloth setup({0.02, 0.4, 0.02}, {0.02, 0.01, 0.02});
  ASSERT_TRUE(setup.near->nodes().empty());
  const auto node = [&](int i, int j) { return static_cast<std::uint32_t>(setup.pattern.grid.index(i, j)); };
  PenetratingFace face{{node(4, 3), node(5, 3), node(4, 4)}, {}};
  face.deepest.weights = {0.0, 0.5, 0.5};
  const SurfacePoint exit = setup.exitOf(4, 4, Vec3::UnitX(), {face});
  EXPECT_NEAR(exit.normal.y(), 1.0, 1e-12);
}

}  // namespace
}  // namespace curtain
