// SPDX-License-Identifier: BSD-3-Clause
//
// What a cloth leaves of the wind for those behind it.
#include "parts/wind/layer_shadow.h"

#include <gtest/gtest.h>

#include "simulator/scenes.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::layerAt;

// What a sheer leaves of the wind comes to what is behind it; beside it all of it does. By all triangles, one by one.
TEST(LayerShadow, LetsThroughTheShareOfThePores) {
  Scene scene = flatScene(12, 12, 1.0, 1.0);
  scene.cloth.porosity = 0.7;
  LayerParams behind = layerAt("behind", 0.3, 12, 14, 1.0, 1.6);
  behind.cloth.porosity = 0.1;
  behind.hang.from.x() -= 0.3;
  behind.hang.to.x() = behind.hang.from.x() + 1.6;
  scene.layers = {behind};
  const ClothPattern pattern = makePattern(scene);
  Field3 position = makeInitialState(scene, pattern).position;
  curtain_test::shake(pattern, 0.02, 5, position);
  for (const double half_angle : {0.0, 0.3}) {
    WindParams fan = curtain_test::fanAt({0.5, -1.0, scene.hang.from.z() - 0.5}, 1.5);
    fan.direction = Vec3(0.0, 1.0, 0.05);
    fan.half_angle = half_angle;
    fan.pressure = 1.0;
    fan.shadow = true;
    WindSource source(fan, pattern, Layers(scene), 1);
    LayerShadow(pattern).cast(position, source);
    const CoarseMesh mesh = makeCoarseMesh(pattern.grid);
    int shaded = 0, free = 0;
    for (int i = 0; i < 12; ++i) {
      for (int j = 0; j < 26; ++j) {
        const std::size_t n = pattern.grid.index(i, j);
        const Vec3 node = position.at(n), start = source.origin(node);
        double share = 1.0;
        for (const MeshTriangle& triangle : mesh.triangles) {
          const int column = static_cast<int>(triangle[0] % static_cast<std::size_t>(pattern.grid.stride));
          if ((column < 12) == (j < 12)) continue;
          Eigen::Matrix3d sides;  // from the node: s (start - node) + u ab + v ac = a - node, with other signs
          const Vec3 a = position.at(triangle[0]);
          sides << start - node, a - position.at(triangle[1]), a - position.at(triangle[2]);
          const Vec3 at = sides.fullPivLu().solve(a - node);
          if (at.minCoeff() >= 0.0 && at.x() <= 1.0 && at.y() + at.z() <= 1.0) share *= column < 12 ? 0.7 : 0.1;
        }
        if (!source.reachesPoint(node)) continue;
        EXPECT_NEAR(source.shade()[n], share, 1e-12) << i << " " << j;
        ++(share < 1.0 ? shaded : free);
      }
    }
    EXPECT_GT(shaded, 80);
    EXPECT_GT(free, 80);
  }
}

// What is left at the nodes of the wind of a fan before the middle, which blows straight on.
Field shadeStraightOn(const Scene& scene, const ClothPattern& pattern) {
  WindParams fan = curtain_test::fanAt({0.5, -1.0, 0.5}, 3.0);
  fan.pressure = 1.0;
  fan.shadow = true;
  WindSource source(fan, pattern, Layers(scene), 1);
  LayerShadow(pattern).cast(makeInitialState(scene, pattern).position, source);
  return source.shade();
}

// Level grids, one behind the other, and wind straight on: lines to nodes go through nodes and along edges. A sheet
// counts once, a fold of it twice.
TEST(LayerShadow, CountsOnceWhereTrianglesMeet) {
  Scene scene = flatScene(9, 9, 1.0, 1.0);
  scene.cloth.porosity = 0.5;
  scene.layers = {layerAt("behind", 0.25, 9, 9, 1.0, 1.0), layerAt("aside", 0.5, 9, 9, 1.0, 1.0)};
  scene.layers[0].cloth.porosity = 0.25;
  scene.layers[1].hang.from.x() = 0.03;
  scene.layers[1].hang.to.x() = 1.03;
  const ClothPattern pattern = makePattern(scene);
  const Field shade = shadeStraightOn(scene, pattern);
  for (int i = 1; i < 8; ++i) {
    for (int j = 1; j < 8; ++j) {
      EXPECT_NEAR(shade[pattern.grid.index(i, j)], 1.0, 1e-12);
      EXPECT_NEAR(shade[pattern.grid.index(i, 9 + j)], 0.5, 1e-12) << i << " " << j;
      EXPECT_NEAR(shade[pattern.grid.index(i, 18 + j)], 0.125, 1e-12) << i << " " << j;
    }
  }
}

// A patch of the sheer passes as much as its own pores do, behind the cells that begin in it. Lines to nodes go through
// nodes: those of the patch's edge are left out.
TEST(LayerShadow, KnowsPatches) {
  Scene scene = flatScene(9, 9, 1.0, 1.0);
  scene.cloth.porosity = 0.5;
  PatchParams net;
  net.columns = {0, 4};
  net.porosity = 0.75;
  scene.cloth.patches = {net};
  scene.layers = {layerAt("behind", 0.25, 9, 9, 1.0, 1.0)};
  const ClothPattern pattern = makePattern(scene);
  const Field shade = shadeStraightOn(scene, pattern);
  for (int i = 1; i < 8; ++i) {
    for (const int j : {1, 2, 3, 5, 6, 7})
      EXPECT_NEAR(shade[pattern.grid.index(i, 9 + j)], j < 4 ? 0.75 : 0.5, 1e-12) << i << " " << j;
  }
}

}  // namespace
}  // namespace curtain
