// SPDX-License-Identifier: BSD-3-Clause
//
// What the net says stays flat does: no two elements that share no node come within the reach, at any time on the way.
// And it says so of cloth that hangs, turns and bends.
#include "contact/broad_phase/cloth_flatness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/nearest_on_way.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::nearestOnWay;
using curtain_test::Random;
using curtain_test::ringScene;

constexpr double kReach = 0.004, kOverlong = 1e-3;

struct Sheet {
  explicit Sheet(const Scene& scene)
      : pattern(makePattern(scene)),
        flat(makeInitialState(scene, pattern).position),
        net(pattern, 0, pattern.grid.columns, kOverlong) {}
  bool stays(const Field3& start, const Field3& end) {
    net.invalidate();
    return net.isFlat(start, kReach) && net.staysFlat(end, kReach);
  }
  ClothPattern pattern;
  Field3 flat;
  ClothFlatness net;
};

Scene sheetScene() { return flatScene(44, 40, 2.0, 1.0); }

// Every node by where it lies on the cloth, u along the weft, v along the warp.
template <typename Place>
Field3 laid(const ClothPattern& pattern, const Place& place) {
  Field3 position;
  position.assign(pattern.grid.size(), 0.0);
  for (int i = 0; i < pattern.grid.rows; ++i) {
    for (int j = 0; j < pattern.grid.columns; ++j) {
      position.set(pattern.grid.index(i, j), place(pattern.weft_coordinate[static_cast<std::size_t>(j)],
                                                   pattern.warp_coordinate[pattern.grid.index(i, j)]));
    }
  }
  return position;
}

// Rolled about the weft by an angle from top to hem [rad].
Field3 rolled(const ClothPattern& pattern, double angle) {
  return laid(pattern, [angle](double u, double v) {
    const double radius = 2.0 / angle;
    return Vec3(u, radius * (1.0 - std::cos(v / radius)), -radius * std::sin(v / radius));
  });
}

TEST(ClothFlatness, SeesFlatCloth) {
  Sheet sheet(sheetScene());
  EXPECT_TRUE(sheet.stays(sheet.flat, sheet.flat));
}

TEST(ClothFlatness, SeesClothThatHangsAskewTurnsAndBends) {
  const ClothPattern pattern = makePattern(sheetScene());
  for (const double angle : {0.1, 0.7, 1.5, -1.5}) {
    Sheet sheet(sheetScene());
    EXPECT_TRUE(sheet.stays(rolled(pattern, angle), rolled(pattern, angle + 0.05))) << angle;
  }
  Sheet sheet(sheetScene());
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.1, Vec3(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  Field3 turned = sheet.flat;
  for (std::size_t n = 0; n < turned.x.size(); ++n) turned.set(n, turn * turned.at(n));
  EXPECT_TRUE(sheet.stays(sheet.flat, turned));
}

// Both ends are flat; in between the cloth passes through a line.
TEST(ClothFlatness, KnowsThatStraightWaysMayFoldWhatIsFlatAtBothEnds) {
  Sheet sheet(sheetScene());
  Field3 mirrored = sheet.flat;
  for (double& x : mirrored.x) x = -x;
  EXPECT_FALSE(sheet.stays(sheet.flat, mirrored));
}

// A pleat takes up so little of the cloth that no line of nodes but the one across it is bent.
TEST(ClothFlatness, SeesAPleatOfTwoLinks) {
  for (int row = 0; row + 4 < 44; ++row) {
    for (const bool along_warp : {true, false}) {
      Sheet sheet(sheetScene());
      const int first = std::min(row, 35);
      const auto coordinate = [&](int k) {
        return along_warp ? sheet.pattern.warp_coordinate[sheet.pattern.grid.index(k, 0)]
                          : sheet.pattern.weft_coordinate[static_cast<std::size_t>(k)];
      };
      const double from = coordinate(first + 1), to = coordinate(first + 2);
      const auto pleated = [=](double s) { return s < from ? s : s < to ? 2.0 * from - s : s - 2.0 * (to - from); };
      const Field3 position = laid(sheet.pattern, [&](double u, double v) {
        return along_warp ? Vec3(u, 0.0, -pleated(v)) : Vec3(pleated(u), 0.0, -v);
      });
      EXPECT_FALSE(sheet.stays(position, position)) << first << (along_warp ? " warp" : " weft");
    }
  }
}

// Random folds of all sizes, the smallest of a corner alone: reflections make no link longer.
TEST(ClothFlatness, SaysNothingThatIsNotTrue) {
  Random random(17);
  constexpr int kLooked = 30;  // trials that are looked at whatever the net says: pairs in folded cloth are many
  int proved = 0, folded = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    Sheet sheet(trial % 3 == 0 ? flatScene(12, 9, 0.3, 0.2) : sheetScene());
    Field3 start = trial % 2 == 0 ? sheet.flat : rolled(sheet.pattern, random.between(0.1, 4.0));
    if (trial % 3 == 0) start = sheet.flat;
    Field3 end = start;
    const int folds = static_cast<int>(random.between(0.0, 3.0));
    for (int fold = 0; fold < folds; ++fold) {
      const Vec3 normal = random.direction();
      const auto node = sheet.pattern.grid.index(static_cast<int>(random.between(0.0, sheet.pattern.grid.rows)),
                                                 static_cast<int>(random.between(0.0, sheet.pattern.grid.columns)));
      const double offset = normal.dot(end.at(node));
      for (std::size_t n = 0; n < sheet.pattern.grid.size(); ++n) {
        const double beyond = normal.dot(end.at(n)) - offset;
        if (beyond > 0.0) end.add(n, -2.0 * beyond * normal);
      }
    }
    const bool stays = sheet.stays(start, end);
    proved += stays ? 1 : 0;
    if (!stays && trial >= kLooked) continue;
    const double distance = nearestOnWay(sheet.pattern, start, end, 2.0 * kReach);
    folded += distance < kReach ? 1 : 0;
    ASSERT_TRUE(!stays || distance > kReach) << "trial " << trial;
  }
  EXPECT_GT(proved, 200);
  EXPECT_GT(folded, kLooked / 3);
}

// Pins are moved apart by whom they belong to: the bound does not hold for links between them.
TEST(ClothFlatness, TrustsNoLinkBetweenPins) {
  Sheet sheet(sheetScene());
  Field3 position = sheet.flat;
  // The top row's first link doubled, its second folded back.
  position.x[1] = 2.0 * sheet.pattern.weft_coordinate[1];
  position.x[2] = 0.5 * sheet.pattern.weft_coordinate[1];
  EXPECT_FALSE(sheet.stays(position, position));
}

TEST(ClothFlatness, LeavesUnevenAndClosedClothAlone) {
  Scene tapered = sheetScene();
  tapered.cloth.hem_width = 0.8;
  for (const Scene& scene : {ringScene(44, 40, 2.0, 1.0), tapered}) {
    Sheet sheet(scene);
    EXPECT_FALSE(sheet.stays(sheet.flat, sheet.flat));
  }
}

}  // namespace
}  // namespace curtain
