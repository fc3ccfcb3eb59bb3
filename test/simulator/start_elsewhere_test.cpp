// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that starts laid over something, or at the nodes of a file.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>

#include "simulator/export.h"
#include "simulator/scenes.h"
#include "testing.h"

namespace curtain_test {
namespace {

using namespace curtain;

Scene laidOver(ShapeKind shape) {
  Scene scene = flatScene(17, 17, 0.8, 0.8);
  scene.cloth.shear = 20.0;
  scene.cloth.bending_warp = scene.cloth.bending_weft = 1e-5;
  scene.pins.kind = PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = 0.3;
  scene.contact.self = true;
  scene.contact.friction = 0.5;
  ObstacleParams thing;
  thing.name = "thing";
  thing.shape = shape;
  thing.radius = shape == ShapeKind::kSphere ? 0.25 : 0.05;
  thing.length = 1.0;
  thing.size = Vec3(0.5, 0.4, 0.3);
  thing.pose.position = Vec3(1.0, 2.0, 0.5);
  if (shape == ShapeKind::kCapsule) thing.pose.orientation = Rotation(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()));
  scene.obstacles = {thing};
  scene.hang.start.over = "thing";
  return scene;
}

// In a folder of its own, which goes with it.
class StartFile {
 public:
  explicit StartFile(const std::string& name, const std::string& text = "")
      : folder_(std::filesystem::temp_directory_path() /
                ("curtain_start_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / name).string();
    if (!text.empty()) std::ofstream(path_) << text;
  }
  ~StartFile() { std::filesystem::remove_all(folder_); }
  StartFile(const StartFile&) = delete;
  StartFile& operator=(const StartFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::filesystem::path folder_;
  std::string path_;
};

std::string tableOf(const Simulator& simulator) {
  std::ostringstream table;
  writeStateHeader(table);
  writeState(simulator, table);
  return table.str();
}

Scene startedAt(const std::string& file, Scene scene) {
  scene.hang.start = {};
  scene.hang.start.file = file;
  return scene;
}

// It lies on the thing and stays there: what moves in two seconds is less than a link.
TEST(StartsElsewhere, LaidOverSomethingStaysThere) {
  for (const ShapeKind shape : {ShapeKind::kSphere, ShapeKind::kBox, ShapeKind::kCapsule, ShapeKind::kPlane}) {
    SCOPED_TRACE(static_cast<int>(shape));
    Simulator simulator(laidOver(shape));
    std::vector<Vec3> before, after;
    simulator.copyPositions(before);
    EXPECT_EQ(simulator.time(), 0.0);
    EXPECT_EQ(simulator.selfCrossings(), 0);
    EXPECT_EQ(simulator.piercings(0).nodes, 0);
    EXPECT_LT(simulator.obstacleDistance(0).distance, 2.0 * simulator.scene().contact.thickness);
    const double energy = energyOf(simulator);
    run(simulator, 120);
    // Contacts lift by up to the tenth of the gap that they leave cloth in.
    const double lift = 0.1 * simulator.scene().contact.thickness;
    EXPECT_LE(energyOf(simulator), energy + massOf(simulator) * kGravity * lift);
    EXPECT_GT(energyOf(simulator), energy - 1e-3 * massOf(simulator) * kGravity * 0.8);
    simulator.copyPositions(after);
    double most = 0.0;
    for (std::size_t n = 0; n < before.size(); ++n) most = std::max(most, (after[n] - before[n]).norm());
    EXPECT_LT(most, 0.05);
    simulator.reset();
    simulator.copyPositions(after);
    EXPECT_EQ(before, after);
  }
}

TEST(StartsElsewhere, FromATableItsNodesAreThoseOfTheTable) {
  Simulator laid(laidOver(ShapeKind::kSphere));
  const std::string early = tableOf(laid);
  run(laid, 5);
  const std::string late = tableOf(laid);
  const StartFile file("nodes.csv", early + late.substr(late.find('\n') + 1));  // of two times the last
  Simulator simulator(startedAt(file.path(), laid.scene()));
  std::vector<Vec3> wanted, got;
  laid.copyPositions(wanted);
  simulator.copyPositions(got);
  EXPECT_EQ(wanted, got);  // 17 digits
}

TEST(StartsElsewhere, FromATableThatWasWrittenOnWindows) {
  const Scene scene = flatScene(3, 3, 0.2, 0.2);
  std::string text;
  for (const char letter : tableOf(Simulator(scene)))
    text += letter == '\n' ? std::string("\r\n") : std::string(1, letter);
  const StartFile file("nodes.csv", text);
  EXPECT_EQ(Simulator(startedAt(file.path(), scene)).position({2, 2}), Simulator(scene).position({2, 2}));
}

TEST(StartsElsewhere, FromAMeshItsNodesAreThoseOfTheFirstLayer) {
  Simulator laid(laidOver(ShapeKind::kBox));
  const StartFile file("mesh.ply");
  writeMesh(laid, file.path());
  Simulator simulator(startedAt(file.path(), laid.scene()));
  std::vector<Vec3> wanted, got;
  laid.copyPositions(wanted);
  simulator.copyPositions(got);
  for (std::size_t n = 0; n < wanted.size(); ++n) EXPECT_LT((wanted[n] - got[n]).norm(), 1e-8);  // 9 digits
  run(simulator, 30);
  EXPECT_EQ(simulator.selfCrossings(), 0);
}

TEST(StartsElsewhere, WhatIsWrongWithAFileIsSaid) {
  Scene scene = flatScene(3, 3, 0.2, 0.2);
  scene.contact.self = true;
  const std::string good = tableOf(Simulator(scene));
  const auto refused = [&](const std::string& name, const std::string& text, const std::string& words) {
    const StartFile file(name, text);
    Scene started = scene;
    started.hang.start.file = file.path();
    try {
      const Simulator simulator(started);
      ADD_FAILURE() << "accepted, but " << words;
    } catch (const std::invalid_argument& error) {
      const std::string said = error.what();
      EXPECT_EQ(said.rfind("hang.start.file: ", 0), 0U) << said;
      EXPECT_NE(said.find(words), std::string::npos) << said;
    }
  };
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos);
    return text.replace(at, from.size(), to);
  };
  refused("none.csv", "", "can't open");
  refused("nodes.txt", good, "must end in .csv or .ply");
  refused("nodes.csv", with("row", "line"), "has no row");
  refused("nodes.csv", with("0,2,2,", "0,2,3,"), "must be a node of the cloth of 3 x 3 nodes, is [2, 3]");
  refused("nodes.csv", good.substr(0, good.rfind("0,2,2,")), "has no [2, 2]");
  refused("nodes.csv", with("0,2,2,", "0,2,2,9,"), "must have 9 fields, has 10");
  refused("nodes.csv", good + "0,2,2,nan,0,0,0,0,0\n", "must be a number");
  refused("nodes.csv", good + "0,2,2,0.2m,0,0,0,0,0\n", "must be a number, is '0.2m'");
  refused("nodes.csv", good + "0,2,2,5,0,0,0,0,0\n", "m long, is");
  refused("mesh.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 9\nend_header\n", "must be an ASCII PLY");
  refused("mesh.ply", "ply\nformat ascii 1.0\nelement vertex 8\nend_header\n", "must have 9 vertices");
  refused("mesh.ply", "ply\nformat ascii 1.0\nelement vertex 9\nend_header\n0 0 0\n", "ends before its last vertex");
}

// A cloth that was put into an obstacle would stay in it.
TEST(StartsElsewhere, NothingMayBePierced) {
  Scene scene = flatScene(5, 5, 0.4, 0.4);
  const StartFile file("nodes.csv", tableOf(Simulator(scene)));
  scene.obstacles = {ballAt({0.2, 0.0, 0.2}, 0.05)};
  scene.hang.start.file = file.path();
  try {
    const Simulator simulator(scene);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("goes through the obstacle"), std::string::npos) << error.what();
  }
}

// What stands on the thing is in the way, and what is smooth and steep holds nothing.
TEST(StartsElsewhere, WhereItCannotLieItIsNotLaid) {
  const auto refused = [](const Scene& scene, const std::string& words) {
    try {
      const Simulator simulator(scene);
      ADD_FAILURE() << "accepted, but " << words;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  Scene scene = laidOver(ShapeKind::kBox);
  ObstacleParams mug = ballAt(scene.obstacles[0].pose.position + Vec3(0.1, 0.0, 0.2), 0.08);
  mug.name = "mug";
  scene.obstacles.push_back(mug);
  refused(scene, "hang.start.over: the cloth goes through the obstacle 'mug' where it is spread out");
  scene = laidOver(ShapeKind::kSphere);
  scene.obstacles[0].radius = 0.02;
  scene.contact.friction = 0.0;
  scene.obstacles[0].pose.position.z() = 2.0;
  scene.hang.from.x() += 0.3;
  scene.hang.to.x() += 0.3;
  scene.cloth.row_mass.assign(17, 1.0);
  scene.cloth.row_mass[0] = 30.0;  // it hangs down on one side
  refused(scene, "hang.start.over: the cloth slides off it");
}

TEST(StartsElsewhere, WhatDoesNotGoTogetherIsRefused) {
  const auto refused = [](const std::function<void(Scene&)>& change, const std::string& key) {
    Scene scene = laidOver(ShapeKind::kSphere);
    change(scene);
    const std::vector<Problem> problems = validate(scene);
    ASSERT_EQ(problems.size(), 1U) << describe(problems);
    EXPECT_EQ(problems[0].key, key);
  };
  refused([](Scene& scene) { scene.hang.start.file = "a.csv"; }, "hang.start");
  refused([](Scene& scene) { scene.hang.start.over = "nobody"; }, "hang.start.over");
  refused([](Scene& scene) { scene.pins.kind = PinKind::kTop; }, "hang.start.over");
  refused([](Scene& scene) { scene.hang.start.over = ""; }, "hang.start.over");
  refused([](Scene& scene) { scene.gravity = Vec3::Zero(); }, "hang.start.over");
}

}  // namespace
}  // namespace curtain_test
