// SPDX-License-Identifier: BSD-3-Clause
//
// What is said to be flat keeps all elements without a common node apart, and most cloth that does is said to be flat:
// windows of few quads, and of patches.
#include "contact/narrow_phase/flatness.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cloth/coarse_mesh.h"
#include "contact/broad_phase/flat_patches.h"
#include "contact/element_distances.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::distanceOfSegments;
using curtain_test::distanceToTriangle;
using curtain_test::flatScene;
using curtain_test::Random;

constexpr double kLink = 0.02;

/// Cloth that is bent, sheared and squeezed by chance, and moved.
struct Cloth {
  ClothPattern pattern;
  Field3 start, end;

  Cloth(int rows, int columns, double rough, Random& random) {
    Scene scene = flatScene(rows, columns, kLink * (rows - 1), kLink * (columns - 1));
    scene.pins.kind = PinKind::kNone;
    pattern = makePattern(scene);
    const double squeeze = random.between(0.1, 1.2), shear = random.between(-0.6, 0.6), wave = random.between(0.0, 0.5);
    const double turn = random.between(0.0, 3.0), swing = random.between(0.0, 0.3);
    // Every second link of the last column may be shorter.
    const double border = random.between(0.0, 1.0) < 0.5 ? 0.0 : random.between(0.0, 1.0);
    rough *= squeeze;
    for (Field3* const at : {&start, &end}) {
      const Eigen::AngleAxisd rotation(turn + (at == &end ? swing : 0.0), Vec3(1.0, 2.0, 3.0).normalized());
      at->assign(pattern.grid.size(), 0.0);
      for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
          const Vec3 flat(squeeze * j + shear * i, wave * std::sin(0.7 * j + 0.3 * i),
                          i + (j + 1 < columns ? 0.0 : i % 2 * border));
          at->set(pattern.grid.index(i, j), rotation * (kLink * (flat + random.inBox(rough))));
        }
      }
    }
  }

  // Whether any two elements without a common node come within reach, of quads of these rows and columns.
  bool comesWithin(double reach, int row, int column, int high, int wide) const {
    std::vector<QuadElements> quads;
    std::vector<Eigen::AlignedBox3d> boxes;
    for (int i = row; i < row + high; ++i) {
      for (int j = column; j < column + wide; ++j) {
        quads.push_back(quadElements(pattern.grid, i, j));
        boxes.emplace_back();
        for (const std::uint32_t n : quads.back().corners) boxes.back().extend(start.at(n)).extend(end.at(n));
      }
    }
    for (std::size_t p = 0; p < quads.size(); ++p) {
      for (std::size_t q = 0; q < quads.size(); ++q) {
        if (boxes[p].exteriorDistance(boxes[q]) <= reach && comeWithin(reach, quads[p], quads[q])) return true;
      }
    }
    return false;
  }

 private:
  bool comeWithin(double reach, const QuadElements& p, const QuadElements& q) const {
    const auto shared = [](std::uint32_t n, const auto& nodes) {
      return std::find(nodes.begin(), nodes.end(), n) != nodes.end();
    };
    double least = 1e300;
    for (int instant = 0; instant <= 8; ++instant) {
      const auto at = [&](std::uint32_t n) -> Vec3 { return start.at(n) + instant / 8.0 * (end.at(n) - start.at(n)); };
      for (const MeshTriangle& t : q.triangles) {
        for (const std::uint32_t n : p.corners) {
          if (!shared(n, t)) least = std::min(least, distanceToTriangle(at(n), at(t[0]), at(t[1]), at(t[2])));
        }
      }
      for (int k = 0; k < p.edge_count; ++k) {
        for (int l = 0; l < q.edge_count; ++l) {
          const MeshEdge &a = p.edges[static_cast<std::size_t>(k)], &b = q.edges[static_cast<std::size_t>(l)];
          if (!shared(a[0], b) && !shared(a[1], b))
            least = std::min(least, distanceOfSegments(at(a[0]), at(a[1]), at(b[0]), at(b[1])));
        }
      }
    }
    return least <= reach;
  }
};

TEST(Flatness, IsProvedOfWindowsThatKeepApartAlone) {
  Random random(12);
  int proved = 0, kept = 0;
  for (int round = 0; round < 1000; ++round) {
    constexpr int kLeft = 3;  // column of the tested window's first node
    const int high = 1 + round % 2, wide = 1 + round / 2 % 2;
    const Cloth cloth(high + 1, kLeft + wide + 1, random.between(0.0, 0.3), random);
    SweptNodes nodes(cloth.pattern.grid);
    nodes.set(cloth.start, cloth.end);
    const Spacings per_spacing(cloth.pattern);
    const double reach = random.between(0.0, 0.6 * kLink);
    const auto &from = nodes.start(), &to = nodes.end();
    const FlatNodes first{
        static_cast<std::size_t>(nodes.grid().stride),
        {{from[0].data(), from[1].data(), from[2].data()}, {to[0].data(), to[1].data(), to[2].data()}},
        per_spacing.u.data(),
        per_spacing.v.data(),
        static_cast<float>(reach),
        1e-7f};
    const bool said = (flatWindows(first, high, wide) >> kLeft & 1U) != 0;
    const bool keeps = !cloth.comesWithin(reach, 0, kLeft, high, wide);
    ASSERT_TRUE(keeps || !said) << round << ": " << high << " x " << wide;
    proved += said ? 1 : 0;
    kept += keeps ? 1 : 0;
  }
  EXPECT_GT(proved, kept * 6 / 10);
}

TEST(Flatness, IsProvedOfPatchesThatKeepApartAlone) {
  Random random(13);
  int proved = 0, kept = 0, windows = 0;
  for (int round = 0; round < 600; ++round) {
    const Cloth cloth(2 + round % 13, round % 2 == 0 ? 5 + round % 3 * 4 : 2 + round % 11, random.between(0.0, 0.1),
                      random);
    const Grid& grid = cloth.pattern.grid;
    SweptNodes nodes(grid);
    nodes.set(cloth.start, cloth.end);
    const Spacings per_spacing(cloth.pattern);
    FlatPatches patches(nodes.grid(), per_spacing);
    for (int row = 0; row < patches.rows(); ++row) patches.measureRow(nodes, row);
    nodes.setLargest(patches.largest());
    const double reach = random.between(0.0, 0.6 * kLink);
    bool all = true;
    const bool said_all = patches.find(static_cast<float>(reach), nodes.rounding());
    for (int patch = 0; patch < patches.rows() * patches.columns(); ++patch, ++windows) {
      const int row = patch / patches.columns() * FlatPatches::kAlong,
                column = patch % patches.columns() * FlatPatches::kAlong;
      const bool keeps = !cloth.comesWithin(reach, row, column, std::min(2 * FlatPatches::kAlong, grid.rows - 1 - row),
                                            std::min(2 * FlatPatches::kAlong, grid.columns - 1 - column));
      ASSERT_TRUE(keeps || !patches.isFlat(patch)) << round << ": " << row << ", " << column;
      all = all && patches.isFlat(patch);
      proved += patches.isFlat(patch) ? 1 : 0;
      kept += keeps ? 1 : 0;
    }
    EXPECT_EQ(said_all, all);
  }
  EXPECT_GT(proved, kept / 4);
  EXPECT_LT(kept, windows * 9 / 10);
}

}  // namespace
}  // namespace curtain
