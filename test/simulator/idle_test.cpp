// SPDX-License-Identifier: BSD-3-Clause
//
// What a scene has but does nothing in it changes no bit of the motion.
#include <gtest/gtest.h>

#include "curtain_sim/simulator.h"
#include "simulator/composition.h"
#include "simulator/force_field.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::ballAt;
using curtain_test::flatScene;

Scene swing() {
  Scene scene = flatScene(23, 20, 2.0, 1.0);
  scene.hang.tilt = 0.7;
  return scene;
}

std::uint64_t hashAfter(const Scene& scene, int frames = 60) {
  Simulator simulator(scene);
  for (int frame = 0; frame < frames; ++frame) simulator.step();
  return simulator.stateHash();
}

WindParams windAt(const Vec3& position, const Vec3& direction, double radius) {
  WindParams wind;
  wind.id = "fan";
  wind.position = position;
  wind.direction = direction;
  wind.radius = radius;
  wind.pressure = 8.0;
  wind.unsteadiness = 3.0;
  return wind;
}

// The solver has a shorter way for weight alone.
bool actsAtStart(const Scene& scene) {
  const ClothPattern pattern = makePattern(scene);
  const ObstacleSet obstacles(scene, shapesBy({}));
  const Workers workers(1);
  const Composition parts{scene, pattern, obstacles, workers};
  ForceField forces(scene, pattern, parts.all);
  const ClothState state = makeInitialState(scene, pattern);
  forces.begin(state, 0.0, 0.0, 0.01);
  return !forces.evaluate(state, {}).weight_only;
}

void expectNothingFrom(const WindParams& wind, const std::string& what) {
  Scene scene = swing();
  const std::uint64_t without = hashAfter(scene);
  scene.wind.push_back(wind);
  EXPECT_EQ(hashAfter(scene), without) << what;
  EXPECT_FALSE(actsAtStart(scene)) << what;
}

TEST(Idle, AWindThatReachesNoNodeIsNone) {
  expectNothingFrom(windAt({6.0, -3.0, 1.0}, Vec3::UnitY(), 0.5), "it blows past");
  expectNothingFrom(windAt({0.5, -4.0, 1.0}, -Vec3::UnitY(), 2.0), "it blows away");
  expectNothingFrom(windAt({1.1, -3.0, 1.0}, Vec3::UnitY(), 0.02), "it blows past by less than bounds can tell");
  WindParams later = windAt({0.5, -3.0, 1.0}, Vec3::UnitY(), 1.0);
  later.start = 100.0;
  expectNothingFrom(later, "it has not started");
  WindParams still = windAt({0.5, -3.0, 1.0}, Vec3::UnitY(), 1.0);
  still.pressure = still.unsteadiness = 0.0;
  expectNothingFrom(still, "it is still");
}

TEST(Idle, AWindThatReachesAFewNodesIsNot) {
  Scene scene = swing();
  const std::uint64_t without = hashAfter(scene);
  scene.wind.push_back(windAt({0.99, -3.0, 1.95}, Vec3::UnitY(), 0.1));
  EXPECT_NE(hashAfter(scene), without);
  EXPECT_TRUE(actsAtStart(scene));
}

TEST(Idle, AWindThroughWhichAllAirPassesIsNone) {
  Scene scene = swing();
  scene.cloth.porosity = 1.0;
  const std::uint64_t without = hashAfter(scene);
  scene.wind.push_back(windAt({0.5, -3.0, 1.0}, Vec3::UnitY(), 1.0));
  EXPECT_EQ(hashAfter(scene), without);
}

// The second one's normals and gusts must not depend on what the first one has looked at.
TEST(Idle, AWindThatReachesNothingChangesNoOther) {
  Scene scene = swing();
  scene.wind.push_back(windAt({0.5, -3.0, 0.5}, Vec3::UnitY(), 0.6));
  const std::uint64_t without = hashAfter(scene);
  WindParams other = windAt({1.3, -3.0, 1.0}, Vec3::UnitY(), 0.02);
  other.id = "other";
  scene.wind.insert(scene.wind.begin(), other);
  EXPECT_EQ(hashAfter(scene), without);
}

TEST(Idle, ADragBeforeItsTimeIsNone) {
  Scene scene = swing();
  const std::uint64_t without = hashAfter(scene);
  DragParams drag;
  drag.id = "hand";
  drag.node = NodeIndex{20, 10};
  drag.target = Vec3(0.0, 1.0, 1.0);
  drag.start = 100.0;
  scene.drag.push_back(drag);
  EXPECT_EQ(hashAfter(scene), without);
}

TEST(Idle, AnObstacleFarAwayIsNone) {
  for (const Vec3& place : {Vec3(20.0, 0.0, 0.0), Vec3(2.2, 0.0, 1.0), Vec3(1.5, 0.0, 1.0)}) {
    Scene scene = swing();
    const std::uint64_t without = hashAfter(scene);
    ObstacleParams ball = ballAt(place, 0.3);
    scene.obstacles.push_back(ball);
    EXPECT_EQ(hashAfter(scene), without) << place.transpose();
  }
}

TEST(Idle, SelfContactOfFlatClothIsNone) {
  Scene scene = swing();
  const std::uint64_t without = hashAfter(scene);
  scene.contact.self = true;
  EXPECT_EQ(hashAfter(scene), without);
}

TEST(Idle, FoldsMoveNothing) {
  Scene scene = swing();
  const std::uint64_t without = hashAfter(scene);
  scene.cloth.folds = 6;
  EXPECT_EQ(hashAfter(scene), without);
}

}  // namespace
}  // namespace curtain
