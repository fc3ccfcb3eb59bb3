// SPDX-License-Identifier: BSD-3-Clause
//
// Pleated starts: every link as long as at rest, the edge from its beginning to its end, pleats as many as asked for.
#include "scene/heading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::kEps;
using curtain_test::Random;

constexpr Heading kPleated[] = {Heading::kPencil, Heading::kPinch, Heading::kRipple, Heading::kEyelets, Heading::kTabs};

Scene pleatedScene(Heading heading, double fullness, int columns = 73) {
  Scene scene;
  scene.cloth.rows = 5;
  scene.cloth.columns = columns;
  scene.cloth.width = 3.0;
  scene.hang.from = {0.3, -1.0, 2.0};
  scene.hang.to = scene.hang.from + 3.0 / fullness * Vec3(0.6, 0.8, 0.0);
  scene.hang.heading = heading;
  return scene;
}

// Positions of some metres are rounded to eps of their size at each of at most 73 additions, and the angles' size to
// eps of pi, which all links add to.
constexpr double kHeadingRounding = 73.0 * 4.0 * 8.0 * kEps;

TEST(Heading, LinksKeepTheirLengthsAndTheEdgeItsEnds) {
  Random random(3);
  for (const Heading heading : kPleated) {
    for (const double fullness : {1.0, 1.001, 1.5, 2.0, 3.0}) {
      for (const bool uneven : {false, true}) {
        Scene scene = pleatedScene(heading, fullness);
        scene.hang.tilt = 0.3;
        for (int j = 0; uneven && j < 72; ++j) scene.cloth.column_spacing.push_back(random.between(0.8, 1.2));
        ASSERT_TRUE(validate(scene).empty()) << describe(validate(scene));
        const ClothPattern pattern = makePattern(scene);
        const Field3 position = makeInitialState(scene, pattern).position;
        forEachLink(pattern, [&](std::size_t n, std::size_t other, double rest, bool) {
          EXPECT_NEAR((position.at(n) - position.at(other)).norm(), rest, kHeadingRounding);
        });
        EXPECT_LT((position.at(0) - scene.hang.from).norm(), kHeadingRounding);
        // At full width the chord is flat in the angles' size: to the root of eps.
        const double bound = fullness == 1.0 ? 3.0 * std::sqrt(kEps) : kHeadingRounding;
        EXPECT_LT((position.at(pattern.grid.index(0, 72)) - scene.hang.to).norm(), bound);
      }
    }
  }
}

// J_0(a) = 1/2 for an even wave of fullness 2: a = 1.5211 (Abramowitz, Stegun, Table 9.1, inverted). Eight links a
// pleat have it to the quadrature of a periodic function, which errs by J_8(a) < 1e-6.
TEST(Heading, RippleIsTheSineGeneratedCurve) {
  const Scene scene = pleatedScene(Heading::kRipple, 2.0);
  const std::vector<double> angles = headingAngles(scene.hang, std::vector<double>(72, 3.0 / 72), 1.5);
  EXPECT_NEAR(*std::max_element(angles.begin(), angles.end()), 1.5211 * std::cos(curtain_test::kPi / 8), 1e-4);
}

int crossings(const std::vector<double>& angles) {
  int count = 0;
  double last = 0.0;
  for (const double angle : angles) {
    if (std::abs(angle) < 1e-6) continue;
    if (angle * last < 0.0) ++count;
    last = angle;
  }
  return count;
}

TEST(Heading, HasThePleatsAskedForAndElseThoseThatItsLinksShow) {
  const std::vector<double> links(72, 3.0 / 72);
  for (const Heading heading : kPleated) {
    HangParams hang;
    hang.heading = heading;
    const bool narrow = heading == Heading::kPencil || heading == Heading::kTabs;
    EXPECT_EQ(pleatCount(hang, 72), narrow ? 18 : heading == Heading::kPinch ? 8 : 9);
    hang.pleats = 6;
    // An even wave turns to the other side twice a pleat, where its first and last quarters are one side's; three
    // fingers do five times, and once more to the next pleat's. Tabs' bows turn at each end.
    const int turns = heading == Heading::kPinch ? 6 * 6 - 1 : heading == Heading::kTabs ? 2 * 6 - 1 : 2 * 6;
    EXPECT_EQ(crossings(headingAngles(hang, links, 1.5)), turns);
  }
}

// The places of eyelets and tabs, each by the column nearest to it.
TEST(Heading, EyeletsAndTabsHangByTheNearestColumns) {
  Random random(5);
  for (const Heading heading : {Heading::kEyelets, Heading::kTabs}) {
    for (int trial = 0; trial < 200; ++trial) {
      HangParams hang;
      hang.heading = heading;
      std::vector<double> links, places = {0.0};
      for (int j = static_cast<int>(random.between(8.0, 60.0)); j > 0; --j) links.push_back(random.between(0.5, 1.5));
      for (const double link : links) places.push_back(places.back() + link);
      const int parts = pleatCount(hang, static_cast<int>(links.size())) * (heading == Heading::kEyelets ? 2 : 1);
      std::set<int> nearest = {0, static_cast<int>(links.size())};
      for (int k = 0; k <= parts; ++k) {
        const double at = places.back() * k / parts;
        const auto closer = [at](double a, double b) { return std::abs(a - at) < std::abs(b - at); };
        nearest.insert(static_cast<int>(std::min_element(places.begin(), places.end(), closer) - places.begin()));
      }
      const std::vector<int> columns = headingColumns(hang, links);
      EXPECT_EQ(std::set<int>(columns.begin(), columns.end()), nearest) << trial;
      EXPECT_TRUE(std::is_sorted(columns.begin(), columns.end()));
    }
  }
}

TEST(Heading, PinsTopHoldsEyeletsOnTheirPole) {
  const Scene scene = pleatedScene(Heading::kEyelets, 2.0);
  const ClothPattern pattern = makePattern(scene);
  const Field3 position = makeInitialState(scene, pattern).position;
  const Vec3 pole = (scene.hang.to - scene.hang.from).normalized();
  int eyelets = 0;
  for (int j = 0; j < 73; ++j) {
    if (pattern.pinned[pattern.grid.index(0, j)] == 0) continue;
    ++eyelets;
    EXPECT_LT((position.at(pattern.grid.index(0, j)) - scene.hang.from).cross(pole).norm(), kHeadingRounding) << j;
  }
  EXPECT_EQ(eyelets, 19);  // nine waves
}

TEST(Heading, FlatWhereTheEdgeIsAsLongAsTheCloth) {
  HangParams hang;
  hang.heading = Heading::kPinch;
  for (const double angle : headingAngles(hang, std::vector<double>(36, 0.1), 3.6)) EXPECT_NEAR(angle, 0.0, 1e-7);
}

TEST(Hem, WeighsWhatItSays) {
  for (const bool closed : {false, true}) {
    Scene scene = closed ? curtain_test::ringScene(4, 12) : curtain_test::flatScene(4, 12);
    scene.cloth.column_spacing.assign(static_cast<std::size_t>(weftLinkCount(scene.cloth)), 1.0);
    scene.cloth.column_spacing[3] = 2.5;
    const ClothPattern bare = makePattern(scene);
    scene.hem.line_density = 0.07;
    scene.hem.weights.assign(12, 0.0);
    scene.hem.weights[5] = 0.03;
    ASSERT_TRUE(validate(scene).empty());
    const ClothPattern pattern = makePattern(scene);
    double more = 0.0;
    for (int j = 0; j < 12; ++j) {
      const std::size_t above = pattern.grid.index(2, j), hem = pattern.grid.index(3, j);
      EXPECT_EQ(pattern.mass[above], bare.mass[above]);
      EXPECT_EQ(pattern.inverse_mass[hem], 1.0 / pattern.mass[hem]);
      more += pattern.mass[hem] - bare.mass[hem];
    }
    EXPECT_NEAR(more, 0.07 * scene.cloth.hem_width.value_or(scene.cloth.width) + 0.03, 1e-12);
    EXPECT_GT(pattern.mass[pattern.grid.index(3, 5)] - bare.mass[pattern.grid.index(3, 5)], 0.03);
  }
}

}  // namespace
}  // namespace curtain
