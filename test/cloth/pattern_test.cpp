// SPDX-License-Identifier: BSD-3-Clause
//
// The pattern of a cloth: rest lengths add up to its edges, areas to its area, masses to density times area, and the
// pins are the nodes that the scene names.
#include <gtest/gtest.h>

#include <numeric>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kEps;
using curtain_test::ringScene;

// A sum of n positive numbers that add up to `total`, each rounded a few times: n + 8 roundings of at most the total.
double sumTolerance(std::size_t n, double total) { return (static_cast<double>(n) + 8.0) * kEps * total; }

double sum(const Field& field) { return std::accumulate(field.begin(), field.end(), 0.0); }

// Every kind of cloth the format can say, at sizes on and off the padding.
std::vector<Scene> manyScenes() {
  std::vector<Scene> scenes;
  for (const bool closed : {false, true}) {
    for (const int columns : {3, 8, 13}) {
      for (const bool tapered : {false, true}) {
        Scene scene = closed ? ringScene(5, columns, 1.5, 0.8) : flatScene(5, columns, 1.5, 0.8);
        if (tapered) scene.cloth.hem_width = 1.1;
        scenes.push_back(scene);
        scene.cloth.row_spacing = {1.0, 2.0, 0.5, 3.0};
        for (int link = 0; link < weftLinkCount(scene.cloth); ++link) {
          scene.cloth.column_spacing.push_back(1.0 + 0.3 * (link % 3));
        }
        scenes.push_back(scene);
      }
    }
  }
  return scenes;
}

TEST(Pattern, AreasAddUpToTheTrapezeBetweenTopAndHem) {
  for (const Scene& scene : manyScenes()) {
    const ClothPattern pattern = makePattern(scene);
    // A row's share is the mean of the rods at it times its weft; that is the trapezoid rule, exact for a width that
    // grows linearly.
    const double hem = scene.cloth.hem_width.value_or(scene.cloth.width);
    const double area = scene.cloth.height * 0.5 * (scene.cloth.width + hem);
    EXPECT_NEAR(sum(pattern.area), area, sumTolerance(pattern.area.size(), area));
  }
}

TEST(Pattern, MassesAddUpToDensityTimesArea) {
  for (Scene scene : manyScenes()) {
    for (const Lumping lumping : {Lumping::kArea, Lumping::kUniform}) {
      scene.cloth.lumping = lumping;
      scene.cloth.surface_density = 0.37;
      const ClothPattern pattern = makePattern(scene);
      const double mass = 0.37 * sum(pattern.area);
      EXPECT_NEAR(sum(pattern.mass), mass, 2.0 * sumTolerance(pattern.mass.size(), mass));
      for (int i = 0; i < pattern.grid.rows; ++i) {
        for (int j = 0; j < pattern.grid.columns; ++j) {
          const std::size_t n = pattern.grid.index(i, j);
          if (lumping == Lumping::kArea) {
            EXPECT_DOUBLE_EQ(pattern.mass[n], 0.37 * pattern.area[n]);
          } else {
            EXPECT_EQ(pattern.mass[n], pattern.mass[0]);
          }
        }
      }
    }
  }
}

TEST(Pattern, InteriorBorderAndCornerSharesOfAnEvenSheetAre4To2To1) {
  const ClothPattern pattern = makePattern(flatScene(5, 9, 2.0, 4.0));  // cells of 0.5 m x 0.5 m, exact in binary
  EXPECT_EQ(pattern.area[pattern.grid.index(2, 4)], 0.25);
  EXPECT_EQ(pattern.area[pattern.grid.index(0, 4)], 0.125);
  EXPECT_EQ(pattern.area[pattern.grid.index(2, 8)], 0.125);
  EXPECT_EQ(pattern.area[pattern.grid.index(4, 0)], 0.0625);
  const ClothPattern ring = makePattern(ringScene(5, 8, 2.0, 4.0));
  EXPECT_EQ(ring.area[ring.grid.index(2, 0)], 0.25) << "a ring has no side border";
  EXPECT_EQ(ring.area[ring.grid.index(0, 7)], 0.125);
}

TEST(Pattern, RestLengthsAddUpAlongEveryRowAndColumn) {
  for (const Scene& scene : manyScenes()) {
    const ClothPattern pattern = makePattern(scene);
    const Grid& grid = pattern.grid;
    const double hem = scene.cloth.hem_width.value_or(scene.cloth.width);
    for (int j = 0; j < grid.columns; ++j) {
      double length = 0.0;
      for (int i = 1; i < grid.rows; ++i) length += pattern.warp_rest[grid.index(i, j)];
      EXPECT_NEAR(length, scene.cloth.height, sumTolerance(5, scene.cloth.height));
    }
    for (int i = 0; i < grid.rows; ++i) {
      double length = 0.0;
      for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) length += pattern.weft_rest[grid.index(i, j)];
      double down = 0.0;
      for (int above = 1; above <= i; ++above) down += pattern.warp_rest[grid.index(above, 0)];
      const double width = scene.cloth.width + (hem - scene.cloth.width) * down / scene.cloth.height;
      EXPECT_NEAR(length, width, sumTolerance(30, width)) << "row " << i;
    }
  }
}

TEST(Pattern, SpacingsAreProportions) {
  Scene scene = flatScene(4, 4, 1.2, 2.0);
  scene.cloth.hem_width = 3.0;
  scene.cloth.row_spacing = {1.0, 2.0, 3.0};
  scene.cloth.column_spacing = {1.0, 3.0, 6.0};
  const ClothPattern pattern = makePattern(scene);
  const Grid& grid = pattern.grid;
  const double rods[] = {0.2, 0.4, 0.6};
  const double widths[] = {2.0, 2.0 + 0.2 / 1.2, 2.0 + 0.6 / 1.2, 3.0};
  const double shares[] = {0.1, 0.3, 0.6};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      if (i > 0) {
        EXPECT_NEAR(pattern.warp_rest[grid.index(i, j)], rods[i - 1], 8 * kEps);
      }
      if (j > 0) {
        EXPECT_NEAR(pattern.weft_rest[grid.index(i, j)], shares[j - 1] * widths[i], 16 * kEps);
      }
    }
  }
  EXPECT_NEAR(pattern.warp_coordinate[pattern.grid.index(2, 0)], 0.6, 8 * kEps);
  EXPECT_NEAR(pattern.weft_coordinate[2], 0.8, 8 * kEps);
}

TEST(Pattern, RowAndColumnMassesAreFactorsOnTopOfTheLumping) {
  for (const Lumping lumping : {Lumping::kArea, Lumping::kUniform}) {
    Scene scene = flatScene(3, 4);
    scene.pins.kind = PinKind::kNone;
    scene.cloth.lumping = lumping;
    const ClothPattern plain = makePattern(scene);
    scene.cloth.row_mass = {1.0, 1.0, 8.0};
    scene.cloth.column_mass = {0.5, 1.0, 1.0, 2.0};
    const ClothPattern heavy = makePattern(scene);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 4; ++j) {
        const std::size_t n = plain.grid.index(i, j);
        // Powers of two: exact.
        const double factor =
            scene.cloth.row_mass[static_cast<std::size_t>(i)] * scene.cloth.column_mass[static_cast<std::size_t>(j)];
        EXPECT_EQ(heavy.mass[n], factor * plain.mass[n]);
        EXPECT_EQ(heavy.inverse_mass[n], plain.inverse_mass[n] / factor);
      }
    }
  }
}

std::vector<NodeIndex> pinsOf(const ClothPattern& pattern) {
  std::vector<NodeIndex> pins;
  for (int i = 0; i < pattern.grid.rows; ++i) {
    for (int j = 0; j < pattern.grid.columns; ++j) {
      const std::size_t n = pattern.grid.index(i, j);
      EXPECT_EQ(pattern.inverse_mass[n] == 0.0, pattern.isPinned({i, j}));
      EXPECT_GT(pattern.mass[n], 0.0) << "a pinned node keeps its mass: it is part of the energy";
      if (pattern.isPinned({i, j})) pins.push_back({i, j});
    }
  }
  return pins;
}

std::string text(const std::vector<NodeIndex>& nodes) {
  std::string out;
  for (const NodeIndex& node : nodes) out += "(" + std::to_string(node.row) + "," + std::to_string(node.column) + ")";
  return out;
}

TEST(Pattern, PinsAreTheNodesNamed) {
  Scene scene = flatScene(3, 4);
  const auto pins = [&](PinKind kind) {
    scene.pins.kind = kind;
    return text(pinsOf(makePattern(scene)));
  };
  scene.pins.nodes = {{2, 3}, {1, 0}};
  EXPECT_EQ(pins(PinKind::kTop), "(0,0)(0,1)(0,2)(0,3)");
  EXPECT_EQ(pins(PinKind::kLeft), "(0,0)(1,0)(2,0)");
  EXPECT_EQ(pins(PinKind::kTopCorners), "(0,0)(0,3)");
  EXPECT_EQ(pins(PinKind::kNone), "");
  EXPECT_EQ(pins(PinKind::kList), "(1,0)(2,3)");
}

TEST(Pattern, PaddingIsImmovableAndHasNeitherMassNorArea) {
  for (const Scene& scene : manyScenes()) {
    const ClothPattern pattern = makePattern(scene);
    const Grid& grid = pattern.grid;
    EXPECT_EQ(grid.stride % kLane, 0);
    EXPECT_GE(grid.stride, grid.columns);
    for (int i = 0; i < grid.rows; ++i) {
      for (int j = grid.columns; j < grid.stride; ++j) {
        const std::size_t n = grid.index(i, j);
        EXPECT_EQ(pattern.mass[n], 0.0);
        EXPECT_EQ(pattern.area[n], 0.0);
        EXPECT_EQ(pattern.inverse_mass[n], 0.0);
      }
    }
  }
}

}  // namespace
}  // namespace curtain
