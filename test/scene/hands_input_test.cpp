// SPDX-License-Identifier: BSD-3-Clause
//
// Hands, moving pins and paths of drags in scenes: what is wrong is said once, with where and what is allowed.
#include "scene/scene_testing.h"

namespace curtain {
namespace {

std::string tableWith(const std::string& entry) { return "cloth: {rows: 4, columns: 9}\n" + entry + "\n"; }
std::string hand(const std::string& entry) { return tableWith("hands: [{id: a, " + entry + "}]"); }

TEST(HandsInput, AreReadAndWritten) {
  const Scene scene = expectScene(
      tableWith("hands: [{id: a, radius: 0.1, position: [1, 2, 3], start: 1.0, end: 2.0, stiffness: 50,\n"
                "         break_force: 10, motion: [{time: 1}, {time: 2, position: [1, 2, 4]}]},\n"
                "        {id: b, region: box, size: [1, 2, 3], place: {position: [0, 0, 1]}, pinch_force: 5},\n"
                "        {id: c, region: nodes, nodes: [[3, 0], [3, 8]]}]\n"
                "pins_motion: [{time: 0}, {time: 1, position: [0, 0, 1], orientation: [0, 0, 1, 0]}]\n"
                "drag: [{id: d, node: [0, 0], path: [{time: 0, position: [1, 1, 1]}]}]"));
  ASSERT_EQ(scene.hands.size(), 3u);
  EXPECT_EQ(scene.hands[0].grasp.frame.position, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(scene.hands[0].grasp.stiffness, 50.0);
  ASSERT_EQ(scene.hands[0].motion.size(), 2u);
  EXPECT_EQ(scene.hands[0].motion[0].pose.position, Vec3(1.0, 2.0, 3.0)) << "the hand's own";
  EXPECT_EQ(scene.hands[1].grasp.place.position, Vec3(0.0, 0.0, 1.0));
  EXPECT_EQ(scene.hands[1].grasp.region, GraspRegion::kBox);
  ASSERT_EQ(scene.hands[2].grasp.nodes.size(), 2u);
  EXPECT_EQ(scene.pins_motion.size(), 2u);
  EXPECT_EQ(scene.drag[0].path[0].position, Vec3(1.0, 1.0, 1.0));
  EXPECT_EQ(writeScene(readSceneText(writeScene(scene)).scene), writeScene(scene));
}

TEST(HandsInput, TakeSomething) {
  expectProblem(hand("start: 1.0"), "hands[0].radius", {"is missing"});
  expectProblem(hand("radius: 0.0"), "hands[0].radius", {"is 0"});
  expectProblem(hand("region: box"), "hands[0].size", {"is missing"});
  expectProblem(hand("region: fist, radius: 1"), "hands[0].region", {"sphere, box or nodes"});
  expectProblem(hand("region: nodes, nodes: [[3, 0]], radius: 1"), "hands[0].radius", {"region nodes"});
  expectProblem(hand("region: nodes, nodes: [[4, 0]]"), "hands[0].nodes[0]", {"row in [0, 3]"});
  expectProblem(hand("region: nodes, nodes: [[3, 0], [3, 0]]"), "hands[0].nodes[1]", {"once"});
  expectProblem(hand("region: nodes, nodes: [[3, 0]], pinch_force: 1"), "hands[0].pinch_force", {"a sphere or a box"});
  expectProblem(hand("radius: 1, pinch_force: 1, friction: 0"), "hands[0].friction", {"is 0"});
}

TEST(HandsInput, HaveTheirTimes) {
  expectProblem(hand("radius: 1, start: 2, end: 2"), "hands[0].end", {"> start = 2"});
  expectProblem(hand("radius: 1, motion: [{time: 1}, {time: 1}]"), "hands[0].motion[1].time", {"time before it = 1"});
  expectProblem(tableWith("pins_motion: [{time: 1}, {time: 0}]"), "pins_motion[1].time", {"time before it = 1"});
  expectProblem(tableWith("drag: [{id: d, node: [0, 0], path: [{time: 1}, {time: 0}]}]"), "drag[0].path[1].time",
                {"time before it = 1"});
}

TEST(HandsInput, FitTheRestOfTheScene) {
  expectProblem(tableWith("hands: [{id: a, radius: 1}, {id: a, radius: 1}]"), "hands[1].id", {"hands[0]"});
  expectProblem(hand("radius: 1, stiffness: 5") + "solver: {method: paper}", "hands[0].stiffness", {"paper"});
  expectProblem(tableWith("pins: none\npins_motion: [{time: 1}]"), "pins_motion", {"needs pins"});
  expectProblem(tableWith("rail: {path: [[0, 0, 2], [1, 0, 2]]}\npins_motion: [{time: 1}]"), "pins_motion", {"rail"});
  expectProblem(tableWith("drag: [{id: d, node: [0, 0], target: [0, 0, 0], path: [{time: 1}]}]"), "drag[0].target",
                {"beside path"});
}

}  // namespace
}  // namespace curtain
