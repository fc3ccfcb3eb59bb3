// SPDX-License-Identifier: BSD-3-Clause
//
// What must not matter: what is far away, how many threads there are, what time is cut into, in which order columns are
// counted and things are listed.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "properties/growth.h"
#include "properties/kinds.h"
#include "properties/seeds.h"
#include "properties/similarity.h"

namespace curtain {
namespace {

using namespace curtain_test;

constexpr int kComparedFrames = 30;

void expectSame(const Motion& one, const Motion& other, const std::string& what) {
  EXPECT_EQ(firstDifference(one, other), -1) << what << "; apart by " << farthestApart(one, other) << " m";
}

class Independence : public ::testing::TestWithParam<Method> {
 protected:
  Scene sceneOf(std::uint64_t seed, const Kind& kind) const {
    Scene scene = randomScene(seed, kind.wanted);
    scene.solver.method = GetParam();
    return scene;
  }
};

// Obstacles far away that move, a wind that blows elsewhere, one that lets all air through, sources before their time.
Scene withFarThings(Scene scene, RandomScenes random) {
  for (const ShapeKind shape : {ShapeKind::kSphere, ShapeKind::kBox}) {
    ObstacleParams obstacle;
    obstacle.name = "far" + std::to_string(static_cast<int>(shape));
    obstacle.shape = shape;
    if (shape == ShapeKind::kSphere)
      obstacle.radius = 0.5;
    else
      obstacle.size = Vec3(1.0, 2.0, 3.0);
    obstacle.pose.position = 100.0 * random.random().direction();
    Pose later = obstacle.pose;
    later.position += 20.0 * random.random().direction();
    obstacle.motion = {{0.0, obstacle.pose}, {1.0, later}};
    scene.obstacles.insert(scene.obstacles.begin() + random.integer(0, static_cast<int>(scene.obstacles.size())),
                           obstacle);
  }
  WindParams wind;
  wind.id = "elsewhere";
  wind.position = Vec3(50.0, 0.0, 0.0);
  wind.pressure = 100.0;
  wind.unsteadiness = 10.0;
  scene.wind.insert(scene.wind.begin(), wind);
  wind = scene.wind.back();
  wind.id = "later";
  wind.start = 100.0;
  scene.wind.push_back(wind);
  DragParams drag;
  drag.id = "later";
  drag.node = NodeIndex{1, 1};
  drag.force = Vec3(5.0, 0.0, 0.0);
  drag.start = 100.0;
  scene.drag.insert(scene.drag.begin(), drag);
  return scene;
}

TEST_P(Independence, OfWhatIsFarAwayToTheBit) {
  for (const Kind& kind : {slack(), taut(), obstacles(), selfContact()}) {
    for (const std::uint64_t seed : seeds(2)) {
      const Scene scene = sceneOf(seed, kind);
      expectSame(record(scene, kComparedFrames),
                 record(withFarThings(scene, RandomScenes(seed + 500)), kComparedFrames),
                 kind.name + (", " + repeat(seed)));
    }
  }
}

// With strings, obstacles and self-contact; more rows and columns than a block has.
TEST_P(Independence, OfTheNumberOfThreadsToTheBit) {
  for (Kind kind : {obstacles(), selfContact()}) {
    kind.wanted.max_nodes = 20;
    for (const std::uint64_t seed : seeds(1)) {
      Scene scene = sceneOf(seed, kind);
      scene.cloth.rows = std::max(scene.cloth.rows, 18);
      scene.cloth.row_spacing.clear();
      scene.cloth.row_mass.clear();
      scene.solver.threads = 1;
      const Motion one = record(scene, 15);
      for (const int threads : {2, 3}) {
        scene.solver.threads = threads;
        expectSame(one, record(scene, 15),
                   kind.name + (", " + repeat(seed)) + ", " + std::to_string(threads) + " threads");
      }
    }
  }
}

// Frames of 1/60 s in two substeps are frames of 1/120 s in one. (Half of 1/60 is 1/120 to the bit; sixteenths would
// not add up.)
TEST_P(Independence, OfWhatTimeIsCutIntoToTheBit) {
  int compared = 0;
  for (const Kind& kind : {slack(), taut(), obstacles()}) {
    for (const std::uint64_t seed : seeds(3)) {
      Scene scene = sceneOf(seed, kind);
      for (DragParams& drag : scene.drag) drag.end = 100.0;  // one that ends within a frame ends with a substep
      for (ObstacleParams& obstacle : scene.obstacles) obstacle.motion.clear();  // goes straight within a frame
      scene.solver.substeps = 2;
      const Motion coarse = record(scene, kComparedFrames);
      scene.solver.frame_rate *= 2.0;
      scene.solver.substeps = 1;
      const Motion fine = record(scene, 2 * kComparedFrames);
      if (coarse.statistics.rejected + fine.statistics.rejected > 0)
        continue;  // done again in halves, of what is left of a frame
      if (GetParam() == Method::kLeapfrog4 && longestString(scene, coarse) >= 0.999)
        continue;  // goes on as auto, in its own substeps
      ++compared;
      Motion every_other = coarse;
      for (std::size_t frame = 0; frame < coarse.positions.size(); ++frame) {
        every_other.positions[frame] = fine.positions[2 * frame];
        every_other.velocities[frame] = fine.velocities[2 * frame];
      }
      expectSame(coarse, every_other, kind.name + (", " + repeat(seed)));
    }
  }
  EXPECT_GT(compared, 0);
}

// Columns whose strings are slack know nothing of each other: in another order, each moves as it did. Up to 8 of them
// are solved side by side, by the same number of iterations. Without air, which knows the border.
TEST_P(Independence, OfTheOrderOfSlackColumnsToTheBit) {
  const std::vector<std::size_t> order = {3, 0, 6, 1, 7, 5, 2, 4};  // column j was column order[j]
  int slack = 0;
  double gone = 0.0;
  for (const std::uint64_t seed : seeds(3)) {
    Wanted wanted;
    wanted.max_nodes = 8;
    Scene scene = sceneOf(seed, {"", wanted, false});
    scene.cloth.columns = static_cast<int>(order.size());
    scene.cloth.column_spacing.clear();
    scene.cloth.lumping = Lumping::kUniform;
    scene.cloth.column_mass = {1.0, 1.3, 0.7, 1.1, 0.9, 1.2, 0.8, 1.05};
    scene.hang.to = scene.hang.from + Vec3(0.4 * scene.cloth.width, 0.0, 0.0);
    scene.gravity.x() = 0.0;
    Random random(seed + 300);
    for (std::size_t j = 0; j < order.size(); ++j) {
      DragParams drag;
      drag.id = std::to_string(j);
      drag.node = NodeIndex{scene.cloth.rows - 1, static_cast<int>(j)};
      drag.force = Vec3(0.0, random.between(-1e-3, 1e-3), random.between(-1e-3, 1e-3));
      scene.drag.push_back(drag);
    }
    Scene permuted = scene;
    for (std::size_t j = 0; j < order.size(); ++j) {
      permuted.cloth.column_mass[j] = scene.cloth.column_mass[order[j]];
      permuted.drag[j].force = scene.drag[order[j]].force;
    }
    Motion motion = record(scene, kComparedFrames);
    if (stringsMayPull(scene, motion)) continue;
    ++slack;
    gone = std::max(gone, farthestGone(motion));
    Motion other = columnsFrom(record(permuted, kComparedFrames), [&](int j) {
      return static_cast<int>(std::find(order.begin(), order.end(), static_cast<std::size_t>(j)) - order.begin());
    });
    for (Motion* const one : {&motion, &other}) {  // where along the line a column hangs is its own
      for (auto* const frames : {&one->positions, &one->velocities}) {
        for (auto& at : *frames) {
          for (Vec3& p : at) p.x() = 0.0;
        }
      }
    }
    expectSame(motion, other, repeat(seed));
  }
  EXPECT_GT(slack, 0) << "strings pull in all of them";
  EXPECT_GT(gone, 0.05);
}

// Obstacles have names, and their list no order.
TEST_P(Independence, OfTheOrderOfObstaclesToTheBit) {
  int contacts = 0;
  for (const std::uint64_t seed : seeds(3, {12})) {
    const Scene scene = sceneOf(seed, obstacles());
    const Motion motion = record(scene, kComparedFrames);
    contacts += motion.statistics.contacts_max;
    Scene other = scene;
    std::reverse(other.obstacles.begin(), other.obstacles.end());
    expectSame(motion, record(other, kComparedFrames), repeat(seed) + ", reversed");
    other = scene;
    std::rotate(other.obstacles.begin(), other.obstacles.begin() + 2, other.obstacles.end());
    expectSame(motion, record(other, kComparedFrames), repeat(seed) + ", rotated");
  }
  EXPECT_GT(contacts, 0) << "nothing ever touched";
}

// Winds and drags listed the other way round, and a drag given in two halves, which other drags come between: sums are
// rounded otherwise, no more. Tolerance as in rigid_motion_test.cpp; of scenes where rounding decides how a contact
// goes on (15 of 1000 with obstacles), no farther apart than numbers that are off by a few of their last bits lead to.
TEST_P(Independence, OfTheOrderOfLists) {
  for (const Kind& kind : {slack(), obstacles()}) {
    for (const std::uint64_t seed : seeds(2, {12})) {
      Scene scene = sceneOf(seed, kind);
      for (ObstacleParams& obstacle : scene.obstacles)
        obstacle.motion.clear();  // several that jam the cloth leave it no one way
      WindParams another = scene.wind.front();
      another.id = "another";
      another.direction += Vec3(0.3, -0.2, 0.1);
      scene.wind.push_back(another);
      const Motion motion = record(scene, kComparedFrames);
      constexpr double kOff = 1e-7;
      const double growth = growthOf(scene, motion, kOff, seed);
      if (!(growth * kOff < 1e-3)) continue;
      Scene other = scene;
      DragParams half = other.drag[0];
      half.id = "half";
      half.force *= 0.3;
      other.drag[0].force *= 0.7;
      other.drag.push_back(half);
      std::reverse(other.wind.begin(), other.wind.end());
      std::reverse(other.drag.begin(), other.drag.end());
      const double single = kind.wanted.gentle && !stringsMayPull(scene, motion) ? 0.0 : kSingle;
      const double apart = farthestApart(motion, record(other, kComparedFrames));
      double bound = growth * (roundingShare(scene, motion, 5.0) + single);
      constexpr double kLastBits = 1e-14;
      if (apart > bound) bound = 2.0 * kLastBits * growthOf(scene, motion, kLastBits, seed, 32);
      EXPECT_LE(apart, bound) << kind.name << ", " << repeat(seed);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Independence, kEveryMethod, nameOfMethod);

// ---- columns that pull at each other -------------------------------------------------------------------------

class Counting : public ::testing::TestWithParam<Method> {
 protected:
  // What a method leaves open: how far the motion is from those in twice as many substeps, and with links held closer.
  // The equations say nothing of the way to their solution, which begins at one column and goes on to the next; it may
  // end anywhere in that. Four times that: both motions are off, and by the largest difference of only two samples
  // each.
  static double leftOpen(const Scene& scene, const Motion& motion) {
    Scene other = scene;
    other.solver.substeps *= 2;
    const double by_step = farthestApart(motion, record(other, kComparedFrames));
    other = scene;
    other.solver.stretch_tolerance *= 0.5;
    return 4.0 * (by_step + farthestApart(motion, record(other, kComparedFrames)));
  }
};

// From the other end of the line. Contact is left out: quads are cut along one diagonal, which another way round is the
// other.
TEST_P(Counting, BeginsAtEitherEnd) {
  int telling = 0;
  for (const std::uint64_t seed : seeds(3)) {
    Kind kind = taut();
    Scene scene = randomScene(seed, kind.wanted);
    scene.solver.method = GetParam();
    scene.solver.substeps = 8;
    const Motion motion = record(scene, kComparedFrames);
    const Motion other =
        columnsFrom(record(reversed(scene), kComparedFrames), [&](int j) { return scene.cloth.columns - 1 - j; });
    const double open = leftOpen(scene, motion);
    EXPECT_LE(farthestApart(motion, other), open) << repeat(seed);
    telling += open < 0.1 * farthestGone(motion) ? 1 : 0;
  }
  EXPECT_GT(telling, 0) << "too much is left open to say anything";
}

// A ring has no seam: counted from another column, with all around it turned by as many links.
TEST_P(Counting, BeginsAnywhereOnARing) {
  int telling = 0;
  for (const std::uint64_t seed : seeds(3)) {
    Wanted wanted = taut().wanted;
    wanted.drags = false;
    Scene scene = randomScene(seed, wanted);
    for (WindParams& wind : scene.wind) wind.pressure *= 0.2;
    scene.cloth.closed = true;
    scene.cloth.columns = 7 + 3 * static_cast<int>(seed % 5);
    scene.cloth.column_spacing.clear();
    scene.cloth.column_mass.clear();
    for (int j = 0; j < scene.cloth.columns; ++j) scene.cloth.column_mass.push_back(1.0 + 0.1 * (j % 3));
    scene.pins = PinParams();
    scene.hang.tilt = 0.0;
    scene.gravity = Vec3(0.0, 0.0, -9.81);
    scene.solver.method = GetParam();
    scene.solver.substeps = 8;
    const Motion motion = record(scene, kComparedFrames);
    Similarity turn;
    const Scene other = cycled(scene, 2, turn);
    const Motion moved = columnsFrom(seenBack(turn, record(other, kComparedFrames)),
                                     [&](int j) { return (j + 2) % scene.cloth.columns; });
    const double open = leftOpen(scene, motion);
    EXPECT_LE(farthestApart(motion, moved), open) << repeat(seed);
    telling += open < 0.1 * farthestGone(motion) ? 1 : 0;
  }
  EXPECT_GT(telling, 0) << "too much is left open to say anything";
}

// The paper's rows are gone through from left to right once: their order is part of that method.
INSTANTIATE_TEST_SUITE_P(Methods, Counting, ::testing::Values(Method::kAuto, Method::kLeapfrog, Method::kImplicit),
                         nameOfMethod);

}  // namespace
}  // namespace curtain
