// SPDX-License-Identifier: BSD-3-Clause
//
// What a scene file says arrives in the scene: design.md's example, every way to spell a value, trees built in code
// (the node's parameters), files and their mesh paths.
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "scene/scene_testing.h"

namespace curtain {
namespace {

// The example of design.md, section 3, with its dots filled in.
constexpr const char* kDesignExample = R"(
cloth:
  rows: 44                 # nodes along the warp, hung edge first [2..4096]
  columns: 40
  height: 2.0
  width: 1.0
  hem_width: 1.0
  surface_density: 0.2
  lumping: area
  closed: false
  folds: 6
  porosity: 0.0
hang:
  from: [0, 0, 2.2]
  to: [1.0, 0, 2.2]
  tilt: 0.0
pins: top
gravity: [0, 0, -9.81]
air: {density: 1.2, law: continuous, threshold: 1.0, inside: 0.0, border: 0.0, corner: 0.0, fast_gain: 0.0}
wind:
  - {id: fan, position: [0, -2, 1], direction: [0, 3, 0], radius: 1.0, half_angle: 0.2, pressure: 5.0,
     porosity_weight: 1.0, distance_weight: 1.0, unsteadiness: 0.0, correlation_time: 0.2, start: 0.0, end: .inf}
drag:
  - {id: hand, node: [43, 20], force: [0, 0.5, 0], radius: 0.0, start: 0.0, end: 1.0}
obstacles:
  - {name: ball, frame: world, shape: sphere, radius: 0.3, position: [0.5, 0.1, 1], orientation: [0, 0, 0, 1],
     friction: 0.3, motion: [{time: 0.0, position: [0, 0, 0], orientation: [0, 0, 0, 1]},
     {time: 1, position: [1, 0, 0], orientation: [1, 0, 0, 0]}]}
contact: {thickness: 0.004, friction: 0.3, self: false, recovery_speed: 0.1, zone_iterations: 8}
solver: {method: auto, frame_rate: 60, substeps: auto, stretch_tolerance: 1.0e-3, seed: 1}
)";

TEST(GoodInput, DesignExampleIsRead) {
  const Scene scene = expectScene(kDesignExample);
  EXPECT_EQ(scene.cloth.rows, 44);
  EXPECT_EQ(scene.cloth.columns, 40);
  EXPECT_EQ(scene.cloth.hem_width, std::optional<double>(1.0));
  ASSERT_EQ(scene.wind.size(), 1u);
  EXPECT_EQ(scene.wind[0].id, "fan");
  EXPECT_EQ(scene.wind[0].direction, Vec3(0.0, 3.0, 0.0));
  EXPECT_EQ(scene.wind[0].half_angle, 0.2);
  EXPECT_EQ(scene.wind[0].end, std::numeric_limits<double>::infinity());
  ASSERT_EQ(scene.drag.size(), 1u);
  EXPECT_EQ(scene.drag[0].node->row, 43);
  EXPECT_EQ(scene.drag[0].node->column, 20);
  EXPECT_FALSE(scene.drag[0].point.has_value());
  EXPECT_EQ(scene.drag[0].force, Vec3(0.0, 0.5, 0.0));
  ASSERT_EQ(scene.obstacles.size(), 1u);
  EXPECT_EQ(scene.obstacles[0].pose.position, Vec3(0.5, 0.1, 1.0));
  ASSERT_EQ(scene.obstacles[0].motion.size(), 2u);
  EXPECT_EQ(scene.obstacles[0].motion[1].time, 1.0);
  EXPECT_EQ(scene.obstacles[0].motion[1].pose.orientation.x(), 1.0);
  EXPECT_EQ(scene.obstacles[0].motion[1].pose.orientation.w(), 0.0);
}

TEST(GoodInput, EveryWordHasItsMeaning) {
  const auto lumping = [](const char* word) {
    return expectScene(std::string("cloth: {rows: 2, columns: 2, lumping: ") + word + "}").cloth.lumping;
  };
  EXPECT_EQ(lumping("area"), Lumping::kArea);
  EXPECT_EQ(lumping("uniform"), Lumping::kUniform);
  const auto pins = [](const char* word) { return expectScene(std::string(smallScene()) + "pins: " + word).pins.kind; };
  EXPECT_EQ(pins("top"), PinKind::kTop);
  EXPECT_EQ(pins("left"), PinKind::kLeft);
  EXPECT_EQ(pins("top_corners"), PinKind::kTopCorners);
  EXPECT_EQ(pins("none"), PinKind::kNone);
  EXPECT_EQ(pins("[]"), PinKind::kList);
  const auto law = [](const char* word) {
    return expectScene(std::string(smallScene()) + "air: {law: " + word + "}").air.law;
  };
  EXPECT_EQ(law("continuous"), AirLaw::kContinuous);
  EXPECT_EQ(law("printed"), AirLaw::kPrinted);
  EXPECT_EQ(law("relative"), AirLaw::kRelative);
  const auto shape = [](const char* text) {
    return expectScene(std::string(smallScene()) + "obstacles: [{name: a, shape: " + text + "}]").obstacles[0].shape;
  };
  EXPECT_EQ(shape("sphere, radius: 1.0"), ShapeKind::kSphere);
  EXPECT_EQ(shape("box, size: [1, 1, 1]"), ShapeKind::kBox);
  EXPECT_EQ(shape("cylinder, radius: 1.0, length: 1.0"), ShapeKind::kCylinder);
  EXPECT_EQ(shape("capsule, radius: 1.0, length: 1.0"), ShapeKind::kCapsule);
  EXPECT_EQ(shape("plane"), ShapeKind::kPlane);
  EXPECT_EQ(shape("mesh, mesh: a.stl"), ShapeKind::kMesh);
}

TEST(GoodInput, MethodNamesReadBack) {
  const std::vector<std::string> expected = {"auto", "leapfrog", "leapfrog4", "implicit", "paper"};
  EXPECT_EQ(methodNames(), expected);
  EXPECT_EQ(toString(Method::kAuto), "auto");
  EXPECT_EQ(toString(Method::kPaper), "paper");
  EXPECT_EQ(methodFromName("leapfrog"), std::optional<Method>(Method::kLeapfrog));
  EXPECT_EQ(methodFromName("implicit"), std::optional<Method>(Method::kImplicit));
  EXPECT_FALSE(methodFromName("Auto").has_value());
  EXPECT_EQ(expectScene(std::string(smallScene()) + "solver: {method: paper}").solver.method, Method::kPaper);
}

TEST(GoodInput, NumbersAreReadAsYaml11SpellsThem) {
  const auto height = [](const std::string& text) {
    return expectScene("cloth: {rows: 2, columns: 2, height: " + text + "}").cloth.height;
  };
  EXPECT_EQ(height("3"), 3.0);
  EXPECT_EQ(height("+3"), 3.0);
  EXPECT_EQ(height("3."), 3.0);
  EXPECT_EQ(height(".5"), 0.5);
  EXPECT_EQ(height("1.0e-3"), 0.001);
  EXPECT_EQ(height("1.5E+2"), 150.0);
  EXPECT_EQ(expectScene("cloth: {rows: 2, columns: 2, porosity: 4.9406564584124654e-324}").cloth.porosity,
            4.9406564584124654e-324);
  EXPECT_EQ(height("!!float 1e-3"), 0.001);  // the tag makes it a number in YAML 1.1 too
}

TEST(GoodInput, FlagsAreReadAsYaml11SpellsThem) {
  const auto closed = [](const std::string& text) {
    return expectScene("cloth: {rows: 2, columns: 3, closed: " + text + "}").cloth.closed;
  };
  for (const char* text : {"true", "True", "TRUE", "yes", "on"}) EXPECT_TRUE(closed(text)) << text;
  for (const char* text : {"false", "False", "FALSE", "no", "Off"}) EXPECT_FALSE(closed(text)) << text;
}

TEST(GoodInput, SlitsAreReadAsColumnsAndAsMaps) {
  const Scene scene = expectScene("cloth: {rows: 4, columns: 7, slits: [3, {column: 1, from_row: 3}]}");
  ASSERT_EQ(scene.cloth.slits.size(), 2u);
  EXPECT_EQ(scene.cloth.slits[0].column, 3);
  EXPECT_EQ(scene.cloth.slits[0].from_row, 0);
  EXPECT_EQ(scene.cloth.slits[1].column, 1);
  EXPECT_EQ(scene.cloth.slits[1].from_row, 3);
  const Scene ring = expectScene("cloth: {rows: 4, columns: 5, closed: true, slits: [4]}");
  EXPECT_EQ(ring.cloth.slits[0].column, 4);
}

TEST(GoodInput, PinListScaleSubstepsAndSeedAreRead) {
  const Scene scene = expectScene(std::string(smallScene()) +
                                  "pins: [[0, 0], [3, 2]]\nsolver: {substeps: 7, seed: 18446744073709551615}\n"
                                  "obstacles:\n- {name: a, shape: mesh, mesh: a.stl, scale: 0.001}\n"
                                  "- {name: b, shape: mesh, mesh: b.stl, scale: [1, -2, 3]}\n");
  ASSERT_EQ(scene.pins.nodes.size(), 2u);
  EXPECT_EQ(scene.pins.nodes[1].row, 3);
  EXPECT_EQ(scene.pins.nodes[1].column, 2);
  EXPECT_EQ(scene.solver.substeps, 7);
  EXPECT_EQ(scene.solver.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(scene.obstacles[0].scale, Vec3::Constant(0.001));
  EXPECT_EQ(scene.obstacles[1].scale, Vec3(1.0, -2.0, 3.0));
  EXPECT_TRUE(std::isnan(scene.obstacles[0].friction));
}

TEST(GoodInput, NearlyUnitQuaternionsAreNormalised) {
  const auto orientation = [](const std::string& text) {
    const std::string obstacle = "obstacles: [{name: a, shape: plane, orientation: " + text + "}]";
    return expectScene(std::string(smallScene()) + obstacle).obstacles[0].pose.orientation;
  };
  const Eigen::Quaterniond q = orientation("[0.0, 0.707, 0.0, 0.707]");
  EXPECT_NEAR(q.norm(), 1.0, 1e-15);  // two roundings
  EXPECT_EQ(q.y(), q.w());
  EXPECT_EQ(orientation("[0.0, 0.0, 0.6, 0.8]").z(), 0.6);  // unit already: as typed
}

// A lying bar that moves goes on lying, and one that turns does it where it is.
TEST(GoodInput, PosesOfAMotionAreTheObstaclesWhereTheySayNothing) {
  const Scene scene =
      expectScene(std::string(smallScene()) +
                  "obstacles:\n- {name: a, shape: plane, motion: [{time: 0.0, position: [7, 8, 9]}, {time: 1.0, "
                  "orientation: [1, 0, 0, 0]}],\n   position: [1, 2, 3], orientation: [0.0, 0.6, 0.0, 0.8]}\n"
                  "- {name: b, shape: plane, motion: [{time: 0.0}]}\n");
  const Vec3 place(1.0, 2.0, 3.0);
  const Eigen::Vector4d lying(0.0, 0.6, 0.0, 0.8), turned(1.0, 0.0, 0.0, 0.0), upright(0.0, 0.0, 0.0, 1.0);
  const auto turnOf = [](const Pose& pose) { return Eigen::Vector4d(pose.orientation.coeffs()); };
  ASSERT_EQ(scene.obstacles.at(0).motion.size(), 2u);
  EXPECT_EQ(scene.obstacles[0].motion[0].pose.position, Vec3(7.0, 8.0, 9.0));
  EXPECT_EQ(turnOf(scene.obstacles[0].motion[0].pose), lying);
  EXPECT_EQ(scene.obstacles[0].motion[1].pose.position, place);
  EXPECT_EQ(turnOf(scene.obstacles[0].motion[1].pose), turned);
  EXPECT_EQ(scene.obstacles.at(1).motion.at(0).pose.position, Vec3(0.0, 0.0, 0.0));
  EXPECT_EQ(turnOf(scene.obstacles[1].motion[0].pose), upright);
  const Scene back = expectScene(writeScene(scene));
  EXPECT_EQ(writeScene(back), writeScene(scene));
  EXPECT_EQ(turnOf(back.obstacles.at(0).motion.at(0).pose), lying);
}

// Programs may be compiled for AVX, where aligned quaternions are laid out otherwise than in the library.
TEST(GoodInput, LayoutDoesNotDependOnInstructionSet) {
  EXPECT_EQ(alignof(Pose), alignof(double));
  EXPECT_EQ(alignof(PoseKey), alignof(double));
  EXPECT_EQ(alignof(ObstacleParams), alignof(double));
  EXPECT_EQ(alignof(Scene), alignof(double));
}

// What the node does: values by their type, text with the tag "!".
TEST(GoodInput, TreeBuiltInCodeIsRead) {
  YAML::Node root;
  root["cloth"]["rows"] = 4;
  root["cloth"]["columns"] = 3;
  root["cloth"]["closed"] = false;
  root["solver"]["stretch_tolerance"] = 1e-6;  // yaml-cpp spells it 9.99e-07: a value, not text
  root["solver"]["frame_rate"] = 1e4;
  YAML::Node id("5");
  id.SetTag("!");
  root["wind"][0]["id"] = id;
  root["wind"][0]["end"] = ".inf";  // yaml-cpp 0.6 would spell the number inf
  const SceneReading reading = readScene(root);
  ASSERT_TRUE(reading.problems.empty()) << describe(reading.problems);
  EXPECT_EQ(reading.scene.solver.stretch_tolerance, 1e-6);
  EXPECT_EQ(reading.scene.solver.frame_rate, 1e4);
  EXPECT_EQ(reading.scene.wind[0].id, "5");
  EXPECT_EQ(reading.scene.wind[0].end, std::numeric_limits<double>::infinity());

  YAML::Node text("3e-06");
  text.SetTag("!");
  root["solver"]["stretch_tolerance"] = text;
  const SceneReading of_text = readScene(root);
  ASSERT_TRUE(of_text.problems.empty()) << describe(of_text.problems);
  EXPECT_EQ(of_text.scene.solver.stretch_tolerance, 3e-6);

  text = YAML::Node("1e-6 m");
  text.SetTag("!");
  root["solver"]["stretch_tolerance"] = text;
  const std::vector<Problem> problems = readScene(root).problems;
  ASSERT_EQ(problems.size(), 1u) << describe(problems);
  EXPECT_EQ(problems[0].key, "solver.stretch_tolerance");
  EXPECT_NE(problems[0].text.find("is the text \"1e-6 m\""), std::string::npos) << problems[0].text;
}

TEST(GoodInput, UndefinedTreeIsOneProblem) {
  const YAML::Node map(YAML::NodeType::Map);
  EXPECT_EQ(readScene(map["nothing"]).problems.size(), 1u);
  EXPECT_EQ(readScene(YAML::Node()).problems.size(), 1u);
}

TEST(GoodInput, RelativeMeshPathsAreTakenFromTheFilesFolder) {
  const std::string folder = ::testing::TempDir() + "scene_test_" + std::to_string(std::rand());
  const std::string path = folder + ".yaml";  // in TempDir itself
  std::ofstream(path)
      << smallScene()
      << "obstacles:\n- {name: a, shape: mesh, mesh: meshes/a.stl}\n"
         "- {name: b, shape: mesh, mesh: /far/b.stl}\n- {name: c, shape: mesh, mesh: 'package://p/c.stl'}\n"
         "- {name: d, shape: mesh, mesh: ../d.stl}\n- {name: e, shape: plane}\n";
  const SceneReading reading = readSceneFile(path);
  std::remove(path.c_str());
  ASSERT_TRUE(reading.problems.empty()) << describe(reading.problems);
  EXPECT_EQ(reading.scene.obstacles[0].mesh, ::testing::TempDir() + "meshes/a.stl");
  EXPECT_EQ(reading.scene.obstacles[1].mesh, "/far/b.stl");
  EXPECT_EQ(reading.scene.obstacles[2].mesh, "package://p/c.stl");
  EXPECT_EQ(reading.scene.obstacles[3].mesh.find(".."), std::string::npos) << reading.scene.obstacles[3].mesh;
  EXPECT_EQ(reading.scene.obstacles[4].mesh, "");
}

// The scenes that the package ships can be read, each by itself.
TEST(GoodInput, ShippedScenesAreRead) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(CURTAIN_SOURCE_DIR) + "/config/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    ++count;
    const SceneReading reading = readSceneFile(entry.path().string());
    EXPECT_TRUE(reading.problems.empty()) << describe(reading.problems, entry.path().string());
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace curtain
