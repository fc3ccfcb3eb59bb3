// SPDX-License-Identifier: BSD-3-Clause
//
// What a scene moves by itself: its hands, its pins, the targets of its drags. It does what a user does between frames,
// to the bit.
#include <gtest/gtest.h>

#include <cmath>

#include "obstacles/pose_curve.h"
#include "simulator/scenes.h"
#include "simulator/sleeping_cloth.h"
#include "testing.h"

namespace curtain_test {
namespace {

using namespace curtain;

constexpr double kRate = 60.0;

HandParams handAt(const std::string& id, const Vec3& position, double radius) {
  HandParams hand;
  hand.grasp.id = id;
  hand.grasp.frame.position = position;
  hand.grasp.radius = radius;
  return hand;
}

// A curve that turns, too, and is no straight line.
std::vector<PoseKey> curveFrom(const Pose& begin, double time) {
  Pose middle = begin, end = begin;
  middle.position += Vec3(0.1, 0.2, 0.15);
  middle.orientation = Rotation(Eigen::AngleAxisd(0.6, Vec3::UnitZ()));
  end.position += Vec3(-0.1, 0.3, 0.2);
  return {{time, begin}, {time + 0.4, middle}, {time + 0.9, end}};
}

GraspEnd endOf(const Simulator& simulator, const std::string& id) { return simulator.graspState(id)->end; }

// A rigid hand and one that gives, which take hold late and let go; the cloth bends and touches itself and a ball.
TEST(SceneHands, DoWhatAUserDoes) {
  for (const Method method : {Method::kAuto, Method::kLeapfrog4, Method::kImplicit, Method::kPaper}) {
    SCOPED_TRACE(toString(method));
    Scene plain = flatScene(12, 10);
    plain.solver.method = method;
    plain.contact.self = true;
    plain.obstacles.push_back(ballAt({0.5, 0.25, 0.5}, 0.15));
    const bool by_paper = method == Method::kPaper;
    if (!by_paper) plain.cloth.bending_warp = plain.cloth.bending_weft = 1e-4;
    Scene scene = plain;
    HandParams left = handAt("left", {0.0, 0.0, 0.0}, 0.15), right = handAt("right", {1.0, 0.0, 0.0}, 0.15);
    left.start = 0.0;
    left.end = 1.0;
    right.start = 0.21;  // between two frames
    right.end = 0.81;
    if (!by_paper) right.grasp.stiffness = 50.0;
    left.motion = curveFrom(left.grasp.frame, 0.1);
    right.motion = curveFrom(right.grasp.frame, 0.1);  // on its way when it takes hold
    scene.hands = {left, right};
    Simulator by_itself(scene), led(plain);
    for (int frame = 0; frame < 90; ++frame) {
      const double time = led.time();
      for (const HandParams& hand : {left, right}) {
        const ScriptedMotion motion(hand.grasp.frame, hand.motion, 0.15);
        const auto first = static_cast<int>(std::ceil(hand.start * kRate - 1e-6));
        const auto last = static_cast<int>(std::ceil(hand.end * kRate - 1e-6));
        GraspParams grasp = hand.grasp;
        grasp.frame = motion.at(time);
        if (frame == last) {
          EXPECT_TRUE(led.releaseGrasp(grasp.id));
        }
        if (frame == first) {
          const std::vector<Problem> problems = led.setGrasp(grasp);
          EXPECT_TRUE(problems.empty()) << describe(problems);
        }
        if (frame >= first && frame < last) {
          EXPECT_TRUE(led.moveGrasp(grasp.id, motion.at((frame + 1) * (1.0 / kRate))));
        }
      }
      by_itself.step();
      led.step();
      ASSERT_EQ(by_itself.stateHash(), led.stateHash()) << "frame " << frame;
    }
    EXPECT_EQ(endOf(by_itself, "left"), GraspEnd::kReleased);
    EXPECT_EQ(endOf(by_itself, "right"), GraspEnd::kReleased);
  }
}

TEST(SceneHands, WaitHoldReleaseAndMiss) {
  Scene scene = flatScene(8, 8);
  scene.hands = {handAt("hand", {1.0, 0.0, 0.0}, 0.1), handAt("far", {5.0, 0.0, 0.0}, 0.1)};
  for (HandParams& hand : scene.hands) hand.start = 0.5, hand.end = 1.0;
  Simulator simulator(scene);
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(endOf(simulator, "hand"), GraspEnd::kWaiting);
    run(simulator, 30);
    EXPECT_EQ(endOf(simulator, "hand"), GraspEnd::kWaiting);
    run(simulator, 1);
    EXPECT_EQ(endOf(simulator, "hand"), GraspEnd::kNone);
    ASSERT_EQ(simulator.graspState("hand")->nodes.size(), 1U);
    EXPECT_TRUE(simulator.pinned({7, 7}));
    EXPECT_EQ(endOf(simulator, "far"), GraspEnd::kMissed);
    EXPECT_NE(describeFailure(scene.hands[1], GraspEnd::kMissed).find("'far' took nothing at 0.5 s"),
              std::string::npos);
    run(simulator, 30);
    EXPECT_EQ(endOf(simulator, "hand"), GraspEnd::kReleased);
    EXPECT_FALSE(simulator.pinned({7, 7}));
    simulator.reset();
  }
}

// A hand of the scene that the user let go of stays away, until the scene begins again.
TEST(SceneHands, AreTheUsersToo) {
  Scene scene = flatScene(8, 8);
  scene.hands = {handAt("hand", {1.0, 0.0, 0.0}, 0.1)};
  scene.hands[0].start = 0.1;
  Simulator simulator(scene);
  GraspParams other = scene.hands[0].grasp;
  const std::vector<Problem> problems = simulator.setGrasp(other);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_NE(problems[0].text.find("begins later: release it first"), std::string::npos);
  EXPECT_TRUE(simulator.releaseGrasp("hand"));
  run(simulator, 20);
  EXPECT_FALSE(simulator.graspState("hand").has_value());
  simulator.reset();
  run(simulator, 20);
  EXPECT_EQ(endOf(simulator, "hand"), GraspEnd::kNone);
}

// One whose whole time lies between two frames holds nothing, and has missed nothing.
TEST(SceneHands, BetweenTwoFramesHoldNothing) {
  Scene scene = flatScene(8, 8);
  scene.hands = {handAt("hand", {1.0, 0.0, 0.0}, 0.1)};
  scene.hands[0].start = 0.001;
  scene.hands[0].end = 0.005;
  Simulator simulator(scene);
  run(simulator, 3);
  EXPECT_EQ(endOf(simulator, "hand"), GraspEnd::kReleased);
}

// A motion that has begun before time 0 leads the pins on from there.
TEST(ScenePins, BeginWhereTheyAreAtTimeZero) {
  Scene scene = flatScene(8, 8);
  Pose far;
  far.position = Vec3(0.0, 2.0, 0.0);
  scene.pins_motion = {{-10.0, Pose()}, {10.0, far}};
  Simulator simulator(scene);
  run(simulator, 1);
  EXPECT_NEAR(simulator.position({0, 0}).y(), 2.0 / 20.0 / kRate, 1e-9);
}

// 2 N are more than its cloth of 0.2 kg can bear in one hand.
TEST(SceneHands, LoseTheCloth) {
  Scene scene = flatScene(8, 8);
  scene.pins.kind = PinKind::kNone;
  scene.hands = {handAt("weak", {0.0, 0.0, 1.0}, 0.1), handAt("strong", {1.0, 0.0, 1.0}, 0.1)};
  scene.hands[0].grasp.break_force = 0.5;
  Simulator simulator(scene);
  run(simulator, 120);
  EXPECT_EQ(endOf(simulator, "weak"), GraspEnd::kBroken);
  EXPECT_EQ(endOf(simulator, "strong"), GraspEnd::kNone);
}

// Between any two frames: before it begins, while it moves, after it has let go.
TEST(SceneHands, GoOnFromSnapshots) {
  Scene scene = flatScene(8, 8);
  scene.hands = {handAt("hand", {1.0, 0.0, 0.0}, 0.2), handAt("soft", {0.0, 0.0, 0.0}, 0.2)};
  scene.hands[1].grasp.stiffness = 30.0;
  for (HandParams& hand : scene.hands) {
    hand.start = 0.2;
    hand.end = 0.6;
    hand.motion = curveFrom(hand.grasp.frame, 0.2);
  }
  scene.pins_motion = curveFrom(Pose(), 0.1);
  Simulator whole(scene);
  std::vector<std::string> snapshots;
  for (int frame = 0; frame < 60; ++frame) {
    snapshots.push_back(whole.snapshot());
    whole.step();
  }
  for (std::size_t from = 0; from < snapshots.size(); from += 7) {
    Simulator restored(scene);
    const std::vector<Problem> problems = restored.restore(snapshots[from]);
    ASSERT_TRUE(problems.empty()) << describe(problems);
    run(restored, 60 - static_cast<int>(from));
    EXPECT_EQ(restored.stateHash(), whole.stateHash()) << "from frame " << from;
    EXPECT_EQ(endOf(restored, "hand"), GraspEnd::kReleased);
  }
}

// As shipped: nothing jams, nothing crosses, and the free edge lies on the other one.
TEST(SceneHands, FoldATowel) {
  Simulator simulator(shippedScene("folded_towel"));
  while (simulator.time() < 5.5) {
    simulator.step();
    ASSERT_EQ(simulator.statistics().quality, FrameQuality::kResolved) << simulator.time() << " s";
  }
  EXPECT_EQ(endOf(simulator, "left"), GraspEnd::kReleased);
  EXPECT_EQ(endOf(simulator, "right"), GraspEnd::kReleased);
  EXPECT_EQ(simulator.selfCrossings(), 0);
  for (const int column : {0, 10, 20}) {
    const Vec3 apart = simulator.position({28, column}) - simulator.position({0, column});
    // The hands lay it down 30 mm short of the other edge and 25 mm above the table: 39 mm, and half as much for its
    // fall.
    EXPECT_LT(apart.norm(), 0.06) << "column " << column;
    EXPECT_GT(apart.z(), 0.0);
  }
}

TEST(SceneHands, WakeSleepingCloth) {
  Scene scene = hanging();
  scene.hands = {handAt("hand", {0.5, 0.0, 0.2}, 0.3)};
  scene.hands[0].start = 20.0;
  scene.hands[0].motion = {{25.0, {{0.5, 0.0, 0.2}, Rotation::Identity()}},
                           {26.0, {{0.5, 0.1, 0.2}, Rotation::Identity()}}};
  Simulator simulator(scene);
  while (simulator.time() < 19.9) simulator.step();
  ASSERT_TRUE(simulator.statistics().asleep);
  while (simulator.time() < 24.9) simulator.step();
  EXPECT_EQ(endOf(simulator, "hand"), GraspEnd::kNone);
  ASSERT_TRUE(simulator.statistics().asleep);
  const NodeIndex held = simulator.graspState("hand")->nodes.front();
  const Vec3 before = simulator.position(held);
  while (simulator.time() < 26.1) simulator.step();
  EXPECT_NEAR(simulator.position(held).y() - before.y(), 0.1, 1e-12);
}

// Rounding of products of numbers below 2: every coordinate is a sum of a few.
TEST(ScenePins, MoveAsOneBody) {
  Scene scene = flatScene(8, 8);
  const Pose begin{{0.5, 0.0, 1.0}, Rotation(Eigen::AngleAxisd(0.3, Vec3::UnitX()))};
  scene.pins_motion = curveFrom(begin, 0.0);
  const ScriptedMotion motion(begin, scene.pins_motion, 1.0);
  Simulator simulator(scene), led([&] {
    Scene plain = scene;
    plain.pins_motion.clear();
    return plain;
  }());
  std::vector<Vec3> places;
  for (int j = 0; j < 8; ++j)
    places.push_back(begin.orientation.conjugate() * (simulator.position({0, j}) - begin.position));
  for (int frame = 0; frame < 60; ++frame) {
    const Pose pose = motion.at((frame + 1) * (1.0 / kRate));
    for (int j = 0; j < 8; ++j) {
      const Vec3 place = pose.position + pose.orientation * places[static_cast<std::size_t>(j)];
      if (frame < 54) led.movePin({0, j}, place);
    }
    simulator.step();
    led.step();
    for (int j = 0; j < 8; ++j) {
      const Vec3 place = pose.position + pose.orientation * places[static_cast<std::size_t>(j)];
      EXPECT_LT((simulator.position({0, j}) - place).norm(), 32.0 * kEps) << frame;
    }
  }
  EXPECT_EQ(simulator.stateHash(), led.stateHash());
}

// Without weight and air the cloth follows a target of even speed without lag: its damper acts on what they differ by.
TEST(DragPaths, AreFollowedWithoutLag) {
  Scene scene = flatScene(6, 6);
  scene.pins.kind = PinKind::kNone;
  scene.gravity = Vec3::Zero();
  const Vec3 speed(0.0, 0.0, 0.4);
  DragParams drag;
  drag.id = "drag";
  drag.node = NodeIndex{0, 3};
  const Vec3 from = Simulator(scene).position(*drag.node);
  drag.path = {{0.0, from}, {30.0, from + 30.0 * speed}};
  scene.drag = {drag};
  Simulator simulator(scene);
  while (simulator.time() < 20.0) simulator.step();
  const Vec3 target = from + simulator.time() * speed;
  // A damper against the ground alone would hold the node c u / k behind, c = 2 sqrt(k m / 4) = 2 kg/s: 40 mm. A
  // quarter of that tells the two apart; what is left are slow swings of the cloth about its even motion.
  EXPECT_LT((simulator.position(*drag.node) - target).norm(), 0.01);
  scene.drag[0].path.pop_back();  // one point: a target that stands
  Scene standing = scene;
  standing.drag[0].path.clear();
  standing.drag[0].target = from;
  Simulator by_path(scene), by_target(standing);
  run(by_path, 60);
  run(by_target, 60);
  EXPECT_EQ(by_path.stateHash(), by_target.stateHash());
}

}  // namespace
}  // namespace curtain_test
