// SPDX-License-Identifier: BSD-3-Clause
//
// Hands that hold the cloth: who is held, that it follows, and that it is really let go.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "curtain_sim/simulator.h"
#include "simulator/hands.h"
#include "simulator/sleeping_cloth.h"
#include "testing.h"

namespace curtain_test {
namespace {

using namespace curtain;

Vec3 inFrame(const Pose& frame, const Vec3& at) { return frame.orientation.conjugate() * (at - frame.position); }

Pose randomPose(Random& random, const Pose& from, double way, double turn) {
  return {from.position + way * random.direction(),
          (Eigen::AngleAxisd(random.between(-turn, turn), random.direction()) * from.orientation).normalized()};
}

// Cloth with all that may keep something of its pins: bending, pleats that are pressed in, self-contact, an obstacle.
Scene busy() {
  Scene scene = flatScene(14, 12);
  scene.hang.to.x() = 0.8;
  scene.hang.tilt = 0.6;
  scene.pins.kind = PinKind::kTopCorners;
  scene.cloth.bending_warp = scene.cloth.bending_weft = 1e-4;
  scene.contact.self = true;
  scene.obstacles.push_back(ballAt({0.4, 0.2, 0.6}, 0.15));
  scene.solver.rest_speed = 0.0;
  return scene;
}

std::vector<NodeIndex> patch(int row, int column, int rows, int columns) {
  std::vector<NodeIndex> nodes;
  for (int i = row; i < row + rows; ++i) {
    for (int j = column; j < column + columns; ++j) nodes.push_back({i, j});
  }
  return nodes;
}

Scene pinnedThere(Scene scene, const std::vector<NodeIndex>& nodes) {
  scene.pins.kind = PinKind::kList;
  scene.pins.nodes = nodes;
  scene.pins.nodes.push_back({0, 0});
  scene.pins.nodes.push_back({0, scene.cloth.columns - 1});
  return scene;
}

std::vector<Scene> scenesOfAllKinds() {
  std::vector<Scene> scenes;
  for (const Method method : {Method::kAuto, Method::kLeapfrog, Method::kImplicit, Method::kPaper}) {
    Scene scene = busy();
    scene.solver.method = method;
    if (method == Method::kPaper) scene.cloth.bending_warp = scene.cloth.bending_weft = 0.0;
    scenes.push_back(scene);
  }
  scenes.push_back(busy());
  scenes.back().solver.position_tolerance = 1e-3;
  scenes.push_back(busy());
  scenes.back().air.law = AirLaw::kRelative;
  scenes.push_back(flatScene(12, 15));  // flat: its proof knows the pins too
  scenes.back().contact.self = true;
  scenes.back().pins.kind = PinKind::kTopCorners;
  scenes.back().solver.rest_speed = 0.0;
  return scenes;
}

// A node held from the start is one that the scene pins: to the bit, whatever keeps something of the pins.
TEST(Grasp, IsAPin) {
  std::vector<NodeIndex> held = patch(6, 4, 3, 2);
  held.push_back({0, 1});  // beside a pin: the link between them gets longer than it is
  for (const Scene& scene : scenesOfAllKinds()) {
    SCOPED_TRACE(toString(scene.solver.method));
    const Scene same = pinnedThere(scene, {});
    Simulator hand(same), pins(pinnedThere(scene, held));
    ASSERT_EQ(refusal(hand, nodeGrasp("hand", held)), "");
    std::vector<Vec3> start, of_hand, of_pins;
    for (const NodeIndex& node : held) start.push_back(pins.position(node));
    for (int frame = 0; frame < 24; ++frame) {
      const Vec3 way = std::min(frame, 15) * Vec3(0.01, -0.02, 0.013);
      hand.moveGrasp("hand", {way, Rotation::Identity()});
      for (std::size_t k = 0; k < held.size() && frame <= 15; ++k) pins.movePin(held[k], way + start[k]);
      hand.step();
      pins.step();
      // Its nodes keep a velocity, for when they are let go, and pins do not: so positions are compared.
      hand.copyPositions(of_hand);
      pins.copyPositions(of_pins);
      ASSERT_EQ(of_hand, of_pins) << "frame " << frame;
    }
  }
}

// And one that is let go before anything moved was never held.
TEST(Grasp, LeavesNothingBehind) {
  for (const Scene& scene : scenesOfAllKinds()) {
    SCOPED_TRACE(toString(scene.solver.method));
    Simulator held(scene), free(scene);
    ASSERT_EQ(refusal(held, nodeGrasp("hand", patch(5, 3, 4, 4))), "");
    ASSERT_EQ(refusal(held, nodeGrasp("other", patch(10, 3, 1, 4))), "");
    ASSERT_TRUE(held.releaseGrasp("hand"));
    held.releaseAllGrasps();
    EXPECT_TRUE(held.grasps().empty());
    for (int frame = 0; frame < 15; ++frame) {
      held.step();
      free.step();
      ASSERT_EQ(held.stateHash(), free.stateHash()) << "frame " << frame;
    }
  }
}

// After it moved, the cloth goes on as free cloth of the same places and velocities. A chain that swings, so that what
// is off at first does not grow: both begin with half a substep of another scheme, which is off by (g h / 2) t and the
// 1e-3 that links may lack of 1 m. A node that were still held would be off by 0.8 m/s t.
TEST(Grasp, LetsGoOfMovingCloth) {
  Scene scene = flatScene(14, 2, 1.0, 0.1);
  scene.solver.substeps = 16;
  Simulator held(scene), free(scene);
  ASSERT_EQ(refusal(held, nodeGrasp("hand", patch(8, 0, 2, 2))), "");
  const Vec3 speed(0.1, 0.8, 0.3);  // [m/s]
  for (int frame = 1; frame <= 20; ++frame) {
    held.moveGrasp("hand", {frame / 60.0 * speed, Rotation::Identity()});
    held.step();
  }
  std::vector<Vec3> positions, velocities;
  held.copyVelocities(velocities);
  EXPECT_LE((velocities[8 * 2] - speed).norm(), 1e-9) << "what moves has a velocity";
  ASSERT_TRUE(held.releaseGrasp("hand"));
  EXPECT_FALSE(held.pinned({8, 0}));
  held.copyPositions(positions);
  held.copyVelocities(velocities);
  EXPECT_LE((velocities[8 * 2] - speed).norm(), 1e-9) << "what is let go keeps it";
  ASSERT_TRUE(free.setState(positions, velocities).empty());
  for (int frame = 1; frame <= 20; ++frame) {
    held.step();
    free.step();
    const double t = frame / 60.0, h = 1.0 / 60.0 / 16.0;
    EXPECT_LE(farthestApart(held, free), 1e-3 + 9.81 * h / 2.0 * t) << "frame " << frame;
  }
}

// Jerked about by up to 3 m/s and 12 rad/s, in any direction.
TEST(Grasp, FollowsItsFrame) {
  for (const bool pinches : {false, true}) {
    SCOPED_TRACE(pinches ? "between pads" : "rigid");
    Scene scene = flatScene(20, 20);
    scene.contact.self = true;
    Simulator simulator(scene);
    GraspParams grasp = ballGrasp("hand", {0.5, 0.0, 0.3}, 0.08);
    if (pinches) grasp.pinch_force = 1e4;
    ASSERT_EQ(refusal(simulator, grasp), "");
    const std::vector<NodeIndex> nodes = simulator.graspState("hand")->nodes;
    ASSERT_GT(nodes.size(), 4U);
    std::vector<Vec3> places;
    for (const NodeIndex& node : nodes) places.push_back(inFrame(grasp.frame, simulator.position(node)));
    Random random(7);
    Pose pose = grasp.frame;
    for (int frame = 0; frame < 120; ++frame) {
      const Pose next = randomPose(random, pose, random.between(0.0, 0.05), 0.2);
      const auto off = [](const Pose& at) { return (at.position - Vec3(0.5, 0.1, 0.65)).norm(); };
      if (off(next) < std::max(0.2, off(pose))) pose = next;  // not beyond the cloth's reach
      ASSERT_TRUE(simulator.moveGrasp("hand", pose));
      simulator.step();
      ASSERT_EQ(simulator.graspState("hand")->nodes.size(), nodes.size());
      for (std::size_t k = 0; k < nodes.size(); ++k)
        ASSERT_LE((inFrame(pose, simulator.position(nodes[k])) - places[k]).norm(), 1e-4) << "frame " << frame;
    }
    EXPECT_TRUE(simulator.statistics().finite);
  }
}

TEST(Grasp, WakesSleepingCloth) {
  Simulator simulator(hanging());
  ASSERT_TRUE(sleepsWithin(simulator, 1200));
  const GraspParams grasp = ballGrasp("hand", simulator.position({15, 10}), 0.1);
  ASSERT_EQ(refusal(simulator, grasp), "");
  EXPECT_FALSE(simulator.statistics().asleep);
  ASSERT_TRUE(sleepsWithin(simulator, 1200)) << "held cloth sleeps too";
  const GraspState asleep = *simulator.graspState("hand");
  simulator.moveGrasp("hand", grasp.frame);
  run(simulator, 3);
  EXPECT_TRUE(simulator.statistics().asleep) << "nothing has moved";
  EXPECT_EQ(simulator.graspState("hand")->force, asleep.force);
  std::vector<Vec3> before;
  simulator.copyPositions(before);
  simulator.moveGrasp("hand", {grasp.frame.position + Vec3(0.0, 0.2, 0.05), Rotation::Identity()});
  run(simulator, 10);
  EXPECT_GT(farthestMoved(simulator, before), 0.15);
  ASSERT_TRUE(sleepsWithin(simulator, 1200));
  simulator.copyPositions(before);
  ASSERT_TRUE(simulator.releaseGrasp("hand"));
  run(simulator, 20);
  EXPECT_GT(farthestMoved(simulator, before), 0.01);
}

TEST(Grasp, EndsWithReset) {
  const Scene scene = flatScene(12, 10);
  Simulator simulator(scene), fresh(scene);
  ASSERT_EQ(refusal(simulator, nodeGrasp("hand", patch(8, 4, 2, 2))), "");
  for (int frame = 1; frame < 10; ++frame) {
    simulator.moveGrasp("hand", {Vec3(0.0, 0.02 * frame, 0.0), Rotation::Identity()});
    simulator.step();
  }
  simulator.reset();
  EXPECT_TRUE(simulator.grasps().empty());
  for (int frame = 0; frame < 20; ++frame) {
    simulator.step();
    fresh.step();
    ASSERT_EQ(simulator.stateHash(), fresh.stateHash());
  }
}

// Placed elsewhere, nodes are held where they are put.
TEST(Grasp, HoldsWhatIsPutElsewhere) {
  Simulator simulator(flatScene(8, 6));
  ASSERT_EQ(refusal(simulator, nodeGrasp("hand", {{7, 2}, {7, 3}})), "");
  std::vector<Vec3> positions;
  simulator.copyPositions(positions);
  for (Vec3& at : positions) at += Vec3(0.0, 0.3, 0.0);
  ASSERT_TRUE(simulator.setState(positions, std::vector<Vec3>(positions.size(), Vec3::Zero())).empty());
  simulator.step();
  EXPECT_EQ(simulator.position({7, 2}), positions[7 * 6 + 2]);
  simulator.moveGrasp("hand", {Vec3(0.0, 0.01, 0.0), Rotation::Identity()});
  simulator.step();
  EXPECT_LE((simulator.position({7, 2}) - positions[7 * 6 + 2] - Vec3(0.0, 0.01, 0.0)).norm(), 1e-12);
}

TEST(Grasp, RefusesInWords) {
  Scene scene = flatScene(8, 6);
  Simulator simulator(scene);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](const std::function<void(GraspParams&)>& break_it) {
    GraspParams grasp = ballGrasp("hand", {0.5, 0.0, 0.5}, 0.2);
    break_it(grasp);
    const std::uint64_t before = simulator.stateHash();
    const std::string text = refusal(simulator, grasp);
    EXPECT_EQ(simulator.stateHash(), before);
    return text;
  };
  EXPECT_NE(refused([](GraspParams& g) { g.id = ""; }).find("grasp.id must be text"), std::string::npos);
  EXPECT_NE(refused([](GraspParams& g) { g.radius = -1.0; }).find("grasp.radius must be"), std::string::npos);
  EXPECT_NE(refused([&](GraspParams& g) { g.radius = nan; }).find("grasp.radius must be"), std::string::npos);
  EXPECT_NE(refused([&](GraspParams& g) { g.frame.position.x() = nan; }).find("grasp.frame.position[0]"),
            std::string::npos);
  EXPECT_NE(refused([](GraspParams& g) { g.frame.orientation = Rotation(0.0, 0.0, 0.0, 0.0); }).find("unit quaternion"),
            std::string::npos);
  EXPECT_NE(refused([](GraspParams& g) { g.break_force = -1.0; }).find("grasp.break_force must be"), std::string::npos);
  EXPECT_NE(refused([](GraspParams& g) { g.pinch_force = 0.0; }).find("grasp.pinch_force must be"), std::string::npos);
  EXPECT_NE(refused([](GraspParams& g) { g.stiffness = 0.0; }).find("grasp.stiffness must be"), std::string::npos);
  EXPECT_NE(refused([](GraspParams& g) {
              g.pinch_force = 1.0;
              g.friction = 0.0;
            }).find("grasp.friction must be"),
            std::string::npos);
  EXPECT_NE(refused([](GraspParams& g) { g.frame.position.y() = 5.0; }).find("grasp.region holds no free node"),
            std::string::npos);
  EXPECT_NE(refused([](GraspParams& g) { g.region = GraspRegion::kNodes; }).find("must list at least one"),
            std::string::npos);
  const auto listed = [&](std::vector<NodeIndex> nodes) {
    return refused([&](GraspParams& g) {
      g.region = GraspRegion::kNodes;
      g.nodes = nodes;
    });
  };
  EXPECT_NE(listed({{8, 0}}).find("grasp.nodes[0] must be [row, column]"), std::string::npos);
  EXPECT_NE(listed({{3, 3}, {3, 3}}).find("grasp.nodes[1] must be listed once"), std::string::npos);
  EXPECT_NE(listed({{0, 2}}).find("is pinned by the scene"), std::string::npos);
  ASSERT_EQ(refusal(simulator, nodeGrasp("other", {{4, 2}})), "");
  EXPECT_NE(listed({{4, 2}}).find("is held already, by 'other'"), std::string::npos);
  EXPECT_NE(refusal(simulator, nodeGrasp("other", {{5, 2}})).find("'other' holds the cloth already"),
            std::string::npos);
  EXPECT_FALSE(simulator.movePin({4, 2}, Vec3::Zero())) << "its hand moves it";
  EXPECT_FALSE(simulator.moveGrasp("nobody", Pose()));
  EXPECT_FALSE(simulator.moveGrasp("other", {Vec3(nan, 0.0, 0.0), Rotation::Identity()}));
  EXPECT_FALSE(simulator.releaseGrasp("nobody"));
  EXPECT_FALSE(simulator.graspState("nobody").has_value());

  scene.solver.method = Method::kPaper;
  Simulator paper(scene);
  GraspParams grasp = ballGrasp("hand", {0.5, 0.0, 0.5}, 0.2);
  grasp.break_force = 1.0;
  EXPECT_NE(refusal(paper, grasp).find("not with method paper"), std::string::npos);
}

// Threads, and a snapshot in the middle, change no bit.
TEST(Grasp, HasTheSameBits) {
  Scene scene = busy();
  scene.cloth.rows = 18;
  scene.cloth.columns = 13;
  const auto live = [](Simulator& simulator, int frame) {
    Random random(static_cast<std::uint64_t>(frame));
    if (frame == 5) {
      ASSERT_EQ(refusal(simulator, ballGrasp("rigid", simulator.position({11, 3}), 0.09)), "");
    }
    if (frame == 8) {
      GraspParams soft = ballGrasp("soft", simulator.position({11, 10}), 0.09);
      soft.stiffness = 100.0;
      soft.break_force = 30.0;
      ASSERT_EQ(refusal(simulator, soft), "");
    }
    if (frame == 10) {
      GraspParams pads = ballGrasp("pads", simulator.position({16, 6}), 0.1);
      pads.pinch_force = 0.5;
      ASSERT_EQ(refusal(simulator, pads), "");
    }
    for (const std::string& id : simulator.grasps()) {
      const GraspState state = *simulator.graspState(id);
      if (state.nodes.empty()) continue;
      simulator.moveGrasp(id, {simulator.position(state.nodes.front()) + random.inBox(0.01),
                               Rotation(Eigen::AngleAxisd(random.between(-0.3, 0.3), Vec3::UnitY()))});
    }
    if (frame == 30) simulator.releaseGrasp("rigid");
    simulator.step();
  };
  scene.solver.threads = 1;
  Simulator one(scene), again(scene);
  scene.solver.threads = 2;
  Simulator two(scene);
  for (int frame = 0; frame < 40; ++frame) {
    live(one, frame);
    live(two, frame);
    if (frame % 7 == 3) {
      ASSERT_TRUE(again.restore(one.snapshot()).empty());
    } else if (frame > 3) {
      live(again, frame);
      ASSERT_EQ(one.stateHash(), again.stateHash()) << "restored, frame " << frame;
      ASSERT_EQ(one.grasps(), again.grasps());
      for (const std::string& id : one.grasps()) {
        const GraspState p = *one.graspState(id), q = *again.graspState(id);
        ASSERT_EQ(p.nodes.size(), q.nodes.size());
        ASSERT_EQ(p.force, q.force);
        ASSERT_EQ(p.torque, q.torque);
        ASSERT_EQ(p.slipped, q.slipped);
        ASSERT_EQ(p.end, q.end);
      }
    }
    ASSERT_EQ(one.stateHash(), two.stateHash()) << "two threads, frame " << frame;
  }
}

}  // namespace
}  // namespace curtain_test
