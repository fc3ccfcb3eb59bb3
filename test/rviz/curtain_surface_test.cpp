// SPDX-License-Identifier: BSD-3-Clause
//
// What is drawn is the engine's fine mesh, as single precision has it, with normals, the cloth's own coordinates and
// the depth of its folds.
#include "rviz/surface/curtain_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rviz/state_of.h"

namespace curtain_rviz {
namespace {

using curtain::Vec3;
using curtain_test::blownCloth;
using curtain_test::stateOf;

Vec3 toVec3(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

// Positions come as floats, whose rounding at 2 m is 1.2e-7; a fold that is nearly taut bows by the root of what its
// chord is short of its length, sqrt(3/8 x 0.1 x 1.2e-7) = 7e-5 m for a link of 0.1 m.
constexpr double kRounding = 1e-4;

// The drawn vertices are the engine's fine mesh, with its normals.
void expectEnginesMesh(const curtain::Simulator& simulator, const CurtainSurface& surface, double bound) {
  curtain::FineMesh expected;
  simulator.copyFineMesh(expected);
  const int columns = simulator.fineMeshTopology().columns;
  const int drawn = columns + (simulator.scene().cloth.closed ? 1 : 0);
  ASSERT_EQ(surface.vertices().size(), static_cast<std::size_t>(8 * drawn));
  std::vector<Vec3> normals;
  curtain::fineMeshNormals(simulator.fineMeshTopology(), expected, normals);
  for (int i = 0; i < 8; ++i) {
    for (int f = 0; f < drawn; ++f) {
      const auto& vertex = surface.vertices()[static_cast<std::size_t>(i * drawn + f)];
      const auto fine = static_cast<std::size_t>(i * columns + f % columns);
      EXPECT_LT((toVec3(vertex.position) - expected.positions[fine]).norm(), bound) << i << ", " << f;
      EXPECT_NEAR(toVec3(vertex.normal).norm(), 1.0, 1e-6);
      EXPECT_GT(toVec3(vertex.normal).dot(normals[fine]), 0.999);
    }
  }
}

TEST(CurtainSurface, IsTheEnginesFineMesh) {
  const std::vector<curtain::SlitParams> none, cuts = {{2, 0}, {4, 3}};
  for (const auto& slits : {none, cuts}) {
    for (const bool closed : {false, true}) {
      const curtain::Simulator simulator = blownCloth(closed, 30, slits);
      for (const bool folds : {false, true}) {
        CurtainSurface surface;
        EXPECT_TRUE(surface.update(stateOf(simulator, folds)));
        // As its own second layer the node sends the very numbers.
        expectEnginesMesh(simulator, surface, folds ? 1.3e-7 : kRounding);
      }
    }
  }
}

TEST(CurtainSurface, HasNoClothInASlit) {
  CurtainSurface surface;
  surface.update(stateOf(blownCloth(false, 30, {{2, 0}, {4, 3}})));
  // Of 7 strips of 6 links with 4 rods all below a whole slit are cut, and from row 2 down those of one that begins
  // at 3.
  EXPECT_EQ(surface.triangles().size(), 2u * 4u * (7 * 6 - 7 - 5));
}

TEST(CurtainSurface, TrianglesAreWoundAsTheNormalsPoint) {
  for (const bool closed : {false, true}) {
    CurtainSurface surface;
    surface.update(stateOf(blownCloth(closed, 0)));  // where it is blown, normals of sharp folds may turn away
    const std::size_t links = closed ? 7 : 6;
    ASSERT_EQ(surface.triangles().size(), 2 * 7 * links * 4);
    for (const auto& triangle : surface.triangles()) {
      std::array<Vec3, 3> corner;
      Vec3 normal = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_LT(triangle[k], surface.vertices().size());
        corner[k] = toVec3(surface.vertices()[triangle[k]].position);
        normal += toVec3(surface.vertices()[triangle[k]].normal);
      }
      EXPECT_GT((corner[1] - corner[0]).cross(corner[2] - corner[0]).dot(normal), 0.0);
    }
  }
}

TEST(CurtainSurface, CoordinatesRunAlongTheClothAndAroundARing) {
  for (const bool closed : {false, true}) {
    CurtainSurface surface;
    surface.update(stateOf(blownCloth(closed)));
    const std::size_t columns = surface.coordinates().size() / 8;
    EXPECT_EQ(surface.coordinates().size(), surface.vertices().size());
    EXPECT_EQ(surface.coordinates().front().along_weft, 0.0F);
    EXPECT_NEAR(surface.coordinates()[columns - 1].along_weft, 1.0F, 1e-6F) << "its width, or all around";
    EXPECT_NEAR(surface.coordinates().back().along_warp, 1.0F, 1e-6F) << "its height";
    for (std::size_t f = 1; f < columns; ++f) {
      EXPECT_GT(surface.coordinates()[f].along_weft, surface.coordinates()[f - 1].along_weft);
    }
  }
}

TEST(CurtainSurface, IsNewOnlyForAnotherCloth) {
  curtain::Simulator simulator = blownCloth(false);
  CurtainSurface surface;
  EXPECT_TRUE(surface.update(stateOf(simulator)));
  simulator.step();
  EXPECT_FALSE(surface.update(stateOf(simulator)));
  curtain_sim::CurtainState state = stateOf(simulator);
  state.weft_rest[3] *= 1.5F;
  EXPECT_TRUE(surface.update(state));
  EXPECT_TRUE(surface.update(stateOf(blownCloth(true))));
}

// A ridge of a fold stands out of what is a link to either side, the hollows beside it lie behind.
TEST(CurtainSurface, FoldsAreHollowAndRidgedByTurns) {
  CurtainSurface surface;
  surface.update(stateOf(blownCloth(false)));
  const std::size_t columns = surface.vertices().size() / 8;
  ASSERT_EQ(columns, 25u);
  const auto& row = surface.vertices();
  for (std::size_t link = 1; link + 1 < 6; ++link) {
    const float here = row[4 * columns + link * 4 + 2].hollow, next = row[4 * columns + (link + 1) * 4 + 2].hollow;
    EXPECT_LT(here * next, 0.0F) << link;
    EXPECT_GT(std::abs(here), 0.1F) << link;
    EXPECT_LE(std::abs(here), 1.0F);
  }
}

TEST(CurtainSurface, SpreadsNodesValuesEvenly) {
  for (const bool closed : {false, true}) {
    CurtainSurface surface;
    surface.update(stateOf(blownCloth(closed)));
    std::vector<float> nodes(56), out;
    for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n] = static_cast<float>(n % 7 + 100 * (n / 7));
    surface.spread(nodes, out);
    ASSERT_EQ(out.size(), surface.vertices().size());
    const std::size_t columns = out.size() / 8;
    EXPECT_EQ(out[0], 0.0F);
    EXPECT_EQ(out[2], 0.5F);
    EXPECT_EQ(out[columns + 4], 101.0F);
    EXPECT_EQ(out[24], 6.0F);
    if (closed) {
      EXPECT_EQ(out[26], 3.0F) << "half way back to the first column";
      EXPECT_EQ(out[28], 0.0F);
    }
  }
}

TEST(CurtainSurface, KnowsItsPlace) {
  CurtainSurface surface;
  surface.update(stateOf(blownCloth(false)));
  for (const SurfaceVertex& vertex : surface.vertices()) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      EXPECT_LE(surface.lowest()[k], toVec3(vertex.position)[k] + kRounding);
      EXPECT_GE(surface.highest()[k], toVec3(vertex.position)[k] - kRounding);
    }
  }
  Vec3 mean = Vec3::Zero();
  for (const SurfaceVertex& vertex : surface.vertices()) mean += toVec3(vertex.position) / (8.0 * 25.0);
  EXPECT_LT((surface.centre() - mean).norm(), kRounding);
}

}  // namespace
}  // namespace curtain_rviz
