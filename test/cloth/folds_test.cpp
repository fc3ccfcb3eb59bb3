// SPDX-License-Identifier: BSD-3-Clause
//
// Second-layer nodes: k rods of equal length between two nodes, in the plane of chord and bow, always on the same side,
// changing continuously with the chord, and meeting the neighbour's fold with one tangent.
#include "cloth/folds.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kEps;
using curtain_test::kPi;
using curtain_test::Random;
using curtain_test::randomPositions;
using curtain_test::ringScene;

const int kRodCounts[] = {2, 3, 6, 16, 64};

// first, inner nodes, second.
std::vector<Vec3> place(int k, const FoldArc& arc) {
  std::vector<Vec3> points(static_cast<std::size_t>(k) + 1);
  FoldShape(k).place(arc, points.data() + 1);
  points.front() = arc.first;
  points.back() = arc.second;
  return points;
}

FoldArc randomArc(Random& random, double chord_ratio) {
  FoldArc arc;
  arc.rest = random.between(0.01, 1.0);
  const Vec3 along = random.direction();
  arc.first = random.inBox(1.0);
  arc.second = arc.first + chord_ratio * arc.rest * along;
  // Square to the chord as rounded, which for a short one is far from `along`.
  const Vec3 chord = arc.first == arc.second ? along : Vec3(arc.second - arc.first).normalized();
  arc.bow = chord.cross(random.direction()).normalized();
  return arc;
}

std::vector<double> chordRatios() {
  std::vector<double> ratios = {0.0, 1e-12, 1e-6, 1e-3, 0.999, 1.0 - 1e-6, 1.0 - 1e-9, 1.0 - 1e-11, 1.0};
  for (int step = 1; step < 100; ++step) ratios.push_back(step / 100.0);
  return ratios;
}

// [m] Each of the k rods is added with a rounding of the position (below 2 sqrt(3) m) and of its own direction, which
// the recurrence of k rotations carries: the last rod, which closes the arc, gathers them all. Links within 1e-12 of
// taut lie on the chord, each piece short by that share (FoldShape::place).
double pieceTolerance(int k, double rest) { return 1e-12 * rest / k + 4.0 * k * kEps * (3.5 + rest); }

TEST(Folds, EveryPieceHasItsLengthAndTheEndsAreMet) {
  Random random(1);
  for (const int k : kRodCounts) {
    for (const double ratio : chordRatios()) {
      const FoldArc arc = randomArc(random, ratio);
      const std::vector<Vec3> points = place(k, arc);
      for (int p = 0; p < k; ++p) {
        const auto at = static_cast<std::size_t>(p);
        // Where the chord is 0 there is no direction along it and the nodes lie in one point: see the next test.
        if (ratio == 0.0) continue;
        ASSERT_NEAR((points[at + 1] - points[at]).norm(), arc.rest / k, pieceTolerance(k, arc.rest))
            << "k " << k << " ratio " << ratio << " piece " << p;
      }
    }
  }
}

// In a child process, for a wrong answer here is a read beyond an empty table.
TEST(FoldsDeathTest, OneRodPlacesNothingOnASlackLink) {
  const auto placeOneRod = [] {
    FoldArc arc;
    arc.first = Vec3::Zero();
    arc.second = Vec3::UnitX();
    arc.bow = Vec3::UnitY();
    arc.rest = 2.0;
    FoldShape(1).place(arc, nullptr);
    std::exit(0);
  };
  EXPECT_EXIT(placeOneRod(), testing::ExitedWithCode(0), "");
}

TEST(Folds, CoincidentEndsGiveFinitePointsWithinReach) {
  for (const int k : kRodCounts) {
    FoldArc arc;
    arc.first = arc.second = Vec3(1.0, 2.0, 3.0);
    arc.bow = Vec3::UnitY();
    arc.rest = 0.1;
    for (const Vec3& point : place(k, arc)) {
      ASSERT_TRUE(point.allFinite());
      EXPECT_LE((point - arc.first).norm(), 0.05 + 8 * kEps) << "no rod chain of 0.1 m reaches further and comes back";
    }
  }
}

TEST(Folds, LieInThePlaneOfChordAndBowOnTheBowsSide) {
  Random random(2);
  for (const int k : {2, 6, 16}) {
    for (const double ratio : chordRatios()) {
      if (ratio == 0.0) continue;
      const FoldArc arc = randomArc(random, ratio);
      const Vec3 along = (arc.second - arc.first).normalized();
      const double tolerance = 4.0 * k * kEps * (3.5 + arc.rest);  // as above
      for (const Vec3& point : place(k, arc)) {
        ASSERT_NEAR((point - arc.first).dot(along.cross(arc.bow)), 0.0, tolerance) << "k " << k << " ratio " << ratio;
        ASSERT_GE((point - arc.first).dot(arc.bow), -tolerance) << "k " << k << " ratio " << ratio;
      }
    }
  }
}

TEST(Folds, TautOrOverlongLinksAreStraightAndEven) {
  Random random(4);
  for (const int k : {2, 6, 16}) {
    for (const double ratio : {1.0 - 1e-13, 1.0, 1.0 + 1e-6, 1.5}) {
      const FoldArc arc = randomArc(random, ratio);
      const std::vector<Vec3> points = place(k, arc);
      for (int p = 0; p <= k; ++p) {
        const Vec3 expected = arc.first + (arc.second - arc.first) * (static_cast<double>(p) / k);
        EXPECT_LE((points[static_cast<std::size_t>(p)] - expected).norm(), 8 * kEps * 3.5);
      }
    }
  }
}

TEST(Folds, ChangeContinuouslyFromClosedToTaut) {
  // With s = sqrt(1 - chord/rest) the rods turn by k da/ds = 2 sqrt(6) (thin arc) … 4 pi (closed circle) in all, no rod
  // by more than half of it, and no node is further along the rods than rest/2 from a fixed end: it moves by at most
  // pi rest ds, and by the shift of the far end, 2 s rest ds. 20 % on top, as the turn rate is checked at its ends.
  constexpr int kSteps = 2000;
  constexpr double ds = 1.0 / kSteps;
  for (const int k : {2, 3, 6, 16}) {
    std::vector<Vec3> before;
    double highest = 0.0;
    for (int step = 1; step < kSteps; ++step) {
      const double s = step * ds;
      FoldArc arc;
      arc.rest = 1.0;
      arc.first = Vec3::Zero();
      arc.second = Vec3(1.0 - s * s, 0.0, 0.0);
      arc.bow = Vec3::UnitZ();
      const std::vector<Vec3> points = place(k, arc);
      for (std::size_t p = 0; p < points.size(); ++p) {
        const Vec3 start = before.empty() ? Vec3(static_cast<double>(p) / k, 0.0, 0.0) : before[p];
        ASSERT_LE((points[p] - start).norm(), 1.2 * (kPi + 2.0) * ds) << "k " << k << " s " << s << " node " << p;
        highest = std::max(highest, points[p].z());
      }
      before = points;
    }
    EXPECT_GE(highest, 0.28) << "a closed fold is as high as the polygon of perimeter 1, at least the hexagon's 0.288";
  }
}

// ---- folds of a cloth ------------------------------------------------------------------------------------------

struct Cloth {
  explicit Cloth(const Scene& scene)
      : pattern(makePattern(scene)), position(makeInitialState(scene, pattern).position) {
    vectors.assign(pattern.grid.size(), 0.0);
    renew();
  }
  void renew() { nodeAreaVectors(pattern.grid, position, vectors); }
  FoldArc arc(int i, int j) const { return foldArc(pattern.grid, pattern.weft_rest, position, vectors, i, j); }
  ClothPattern pattern;
  Field3 position, vectors;
};

Scene gathered(int rows, int columns) {
  Scene scene = flatScene(rows, columns);
  scene.hang.to = scene.hang.from + 0.6 * Vec3::UnitX();
  return scene;
}

TEST(FoldArcs, BowIsAUnitVectorSquareToTheChordOnAnyCloth) {
  Random random(5);
  for (const bool closed : {false, true}) {
    Cloth cloth(closed ? ringScene(5, 8) : flatScene(5, 8));
    cloth.position = randomPositions(cloth.pattern.grid, random, 0.5);
    cloth.renew();
    for (int i = 0; i < 5; ++i) {
      for (int j = closed ? 0 : 1; j < 8; ++j) {
        const FoldArc arc = cloth.arc(i, j);
        EXPECT_NEAR(arc.bow.norm(), 1.0, 4 * kEps);
        // What is left along the chord was rounded at the size of the area vectors, which may be some tens of times the
        // bow that remains.
        EXPECT_NEAR(arc.bow.dot((arc.second - arc.first).normalized()), 0.0, 1000 * kEps);
        EXPECT_EQ(arc.second, cloth.position.at(cloth.pattern.grid.index(i, j)));
        EXPECT_EQ(arc.first, cloth.position.at(cloth.pattern.grid.index(i, (j + 7) % 8)));
      }
    }
  }
}

TEST(FoldArcs, AreFiniteOnClothCrushedToAPointOrALine) {
  Cloth cloth(flatScene(4, 5));
  for (const Vec3& step : {Vec3(0.0, 0.0, 0.0), Vec3(0.01, 0.0, 0.0)}) {
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 5; ++j) cloth.position.set(cloth.pattern.grid.index(i, j), Vec3(j * step));
    }
    cloth.renew();
    for (int j = 1; j < 5; ++j) {
      const FoldArc arc = cloth.arc(1, j);
      ASSERT_TRUE(arc.bow.allFinite());
      EXPECT_NEAR(arc.bow.norm(), 1.0, 4 * kEps);
    }
  }
}

TEST(FoldArcs, AlternateAlongARowAndAgreeDownAColumn) {
  const Cloth cloth(gathered(5, 9));
  for (int i = 0; i < 5; ++i) {
    for (int j = 1; j < 9; ++j) {
      EXPECT_NEAR(cloth.arc(i, j).bow.dot(cloth.arc(0, j).bow), 1.0, 8 * kEps) << "pleats run down the cloth";
      if (j == 1) continue;
      EXPECT_NEAR(cloth.arc(i, j).bow.dot(cloth.arc(i, j - 1).bow), -1.0, 8 * kEps) << "left of " << j;
    }
  }
}

void expectOneTangent(const Cloth& cloth, int k, int i, int j, int next, double tolerance) {
  const std::vector<Vec3> left = place(k, cloth.arc(i, j));
  const std::vector<Vec3> right = place(k, cloth.arc(i, next));
  const auto last = static_cast<std::size_t>(k);
  const Vec3 in = (left[last] - left[last - 1]).normalized();
  const Vec3 out = (right[1] - right[0]).normalized();
  EXPECT_LE((in - out).norm(), tolerance) << "k " << k << " at node " << i << ", " << j;
}

TEST(FoldArcs, NeighboursMeetWithOneTangentOnEvenlyGatheredCloth) {
  const Cloth cloth(gathered(4, 9));
  for (const int k : {2, 6, 16}) {
    for (int i = 0; i < 4; ++i) {
      // Rods of rest/k = 1/(8 k) m, their ends known to pieceTolerance.
      for (int j = 1; j < 8; ++j) expectOneTangent(cloth, k, i, j, j + 1, 2.0 * pieceTolerance(k, 0.125) * 8.0 * k);
    }
  }
}

TEST(FoldArcs, NeighboursMeetWithOneTangentAllAroundAnEvenRing) {
  Scene scene = ringScene(4, 16);
  scene.hang.radius = 0.6 / (2.0 * kPi);
  const Cloth cloth(scene);
  for (const int k : {2, 6, 16}) {
    for (int j = 0; j < 16; ++j) {
      // Chords turn by 2 pi/16 at every node while the bows alternate, so two tangents differ by that turn, no more.
      expectOneTangent(cloth, k, 1, j, (j + 1) % 16, 2.0 * kPi / 16.0 + 1e-9);
    }
  }
}

TEST(FoldArcs, DoNotFlipWhenNodesTremble) {
  const Cloth still(gathered(6, 9));
  Random random(6);
  const double spacing = 0.6 / 8.0;  // [m] the shorter edge of the cells
  const double shake = 0.02 * spacing;
  for (int trial = 0; trial < 100; ++trial) {
    Cloth cloth = still;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 9; ++j) cloth.position.add(cloth.pattern.grid.index(i, j), random.inBox(shake));
    }
    cloth.renew();
    for (int i = 0; i < 6; ++i) {
      for (int j = 1; j < 9; ++j) {
        // Every edge (>= spacing) is moved by at most 2 sqrt(3) shake, i.e. turns by less than 0.07; a normal of two
        // edges by less than 0.14, projecting square to the chord adds 0.07: cos(0.21) = 0.978. A flip gives -1.
        EXPECT_GE(cloth.arc(i, j).bow.dot(still.arc(i, j).bow), 0.97) << i << ", " << j;
      }
    }
  }
}

}  // namespace
}  // namespace curtain
