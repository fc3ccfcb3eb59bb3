// SPDX-License-Identifier: BSD-3-Clause
//
// Several flat cloths: what is said to keep apart does, at any time on the way; and it is said of cloths that swing
// side by side.
#include "contact/broad_phase/flat_cloths.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "contact/nearest_on_way.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::layerAt;
using curtain_test::nearestOnWay;
using curtain_test::Random;

constexpr double kClear = 0.004;  // [m]

// A sheet of 12 x 9 nodes and two more behind it.
Scene threeSheets() {
  Scene scene = flatScene(12, 9, 0.3, 0.2);
  for (const double y : {0.03, 0.06}) {
    scene.layers.push_back(layerAt("at" + std::to_string(y), y, 12, 7, 0.3, 0.2));
  }
  return scene;
}

struct Sheets {
  Sheets() : scene(threeSheets()), pattern(makePattern(scene)), flat(makeInitialState(scene, pattern).position) {}
  bool stay(FlatCloths& proof, const Field3& start, const Field3& end) const {
    proof.invalidate();
    return proof.isFlat(start, kClear) && proof.staysFlat(end, kClear);
  }
  // Each cloth moved as a rigid body.
  template <typename Motion>
  Field3 moved(const Motion& motion) const {
    Field3 out = flat;
    for (int i = 0; i < pattern.grid.rows; ++i) {
      for (int j = 0; j < pattern.grid.columns; ++j) {
        const std::size_t n = pattern.grid.index(i, j);
        out.set(n, motion(pattern.layer[static_cast<std::size_t>(j)], flat.at(n)));
      }
    }
    return out;
  }
  Scene scene;
  ClothPattern pattern;
  Field3 flat;
};

TEST(FlatCloths, SeesClothsThatSwingSideBySide) {
  const Sheets sheets;
  FlatCloths proof(sheets.pattern, 1e-3);
  const auto swung = [&](double angle) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vec3::UnitX()).toRotationMatrix();
    return sheets.moved([&](int, const Vec3& at) { return turn * at; });
  };
  Field3 start = sheets.flat;
  ASSERT_TRUE(sheets.stay(proof, start, start));
  for (double angle = 0.05; angle < 1.5; angle += 0.05) {
    proof.advance();
    const Field3 end = swung(angle);
    ASSERT_TRUE(proof.isFlat(start, kClear) && proof.staysFlat(end, kClear)) << angle;
    start = end;
  }
}

TEST(FlatCloths, SeesClothsThatMeet) {
  const Sheets sheets;
  FlatCloths proof(sheets.pattern, 1e-3);
  const auto shifted = [&](double y) {
    return sheets.moved([&](int layer, const Vec3& at) { return layer == 1 ? Vec3(at + Vec3(0.0, y, 0.0)) : at; });
  };
  EXPECT_TRUE(sheets.stay(proof, sheets.flat, shifted(0.02)));
  EXPECT_FALSE(sheets.stay(proof, sheets.flat, shifted(0.028)));  // within the reach
  EXPECT_FALSE(sheets.stay(proof, shifted(0.028), sheets.flat));
  EXPECT_FALSE(sheets.stay(proof, sheets.flat, shifted(0.08)));  // through the one behind it
  EXPECT_TRUE(sheets.stay(proof, shifted(0.08), shifted(0.1)));
  proof.invalidate();
  EXPECT_TRUE(proof.isFlat(sheets.flat, kClear));
  EXPECT_FALSE(proof.staysFlat(shifted(0.08), kClear));
}

// Rigid motions of each cloth, against all pairs of elements that come near.
TEST(FlatCloths, SaysNothingThatIsNotTrue) {
  const Sheets sheets;
  Random random(23);
  int proved = 0, near = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const auto anyPlace = [&] {
      std::array<Eigen::Matrix3d, 3> turn;
      std::array<Vec3, 3> shift;
      for (std::size_t k = 0; k < 3; ++k) {
        turn[k] = Eigen::AngleAxisd(random.between(-0.15, 0.15), random.direction()).toRotationMatrix();
        shift[k] = random.between(0.0, 0.015) * random.direction();
      }
      return sheets.moved([&](int layer, const Vec3& at) {
        const auto k = static_cast<std::size_t>(layer);
        return Vec3(turn[k] * at + shift[k]);
      });
    };
    const Field3 start = anyPlace(), end = anyPlace();
    FlatCloths proof(sheets.pattern, 1e-3);
    const bool stay = sheets.stay(proof, start, end);
    const bool touch = nearestOnWay(sheets.pattern, start, end, 2.0 * kClear) < kClear;
    proved += stay ? 1 : 0;
    near += touch ? 1 : 0;
    ASSERT_FALSE(stay && touch) << "trial " << trial;
  }
  EXPECT_GT(proved, 50);
  EXPECT_GT(near, 50);
}

}  // namespace
}  // namespace curtain
