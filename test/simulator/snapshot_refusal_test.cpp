// SPDX-License-Identifier: BSD-3-Clause
//
// What is no sound snapshot of this scene is refused, says why, and changes nothing, not one bit. What has been changed
// on purpose, with its checksum put right, may be taken for a snapshot, but does no harm.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "simulator/snapshot_format.h"
#include "simulator/snapshot_testing.h"

namespace curtain {
namespace {

using curtain_test::ballAt;
using curtain_test::flatScene;
using curtain_test::Random;
using curtain_test::Reading;
using curtain_test::restoreOrFail;

// Small, with some of everything, and in the middle of it.
Scene busyScene() {
  Scene scene = flatScene(3, 3, 0.2, 0.2);
  scene.hang.to.x() = 0.15;
  scene.hang.tilt = 1.0;
  scene.contact.self = true;
  scene.contact.thickness = 0.02;
  WindParams wind;
  wind.id = "fan";
  wind.position = {0.1, -0.5, 0.1};
  wind.direction = Vec3::UnitY();
  wind.pressure = 2.0;
  wind.unsteadiness = 1.0;
  scene.wind = {wind};
  DragParams drag;
  drag.id = "hand";
  drag.point = Vec3(0.1, 0.0, 0.0);
  drag.target = Vec3(0.1, 0.1, 0.1);
  scene.drag = {drag};
  ObstacleParams ball = ballAt({0.08, 0.1, 0.15}, 0.05);
  ball.motion = {{0.0, ball.pose}, {1.0, Pose()}};
  ObstacleParams cube = ball;
  cube.name = "cube";
  cube.shape = ShapeKind::kMesh;
  cube.mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/cube_quads.obj";
  cube.scale = Vec3::Constant(0.05);
  cube.pose.position = {0.08, 0.16, 0.05};
  cube.motion.clear();
  scene.obstacles = {ball, cube};
  return scene;
}

void live(Simulator& simulator, int frames) {
  for (int frame = 0; frame < frames; ++frame) simulator.step();
  simulator.movePin({0, 1}, Vec3(0.07, 0.0, 0.21));
}

std::string reason(Simulator& simulator, const std::string& snapshot) {
  const std::vector<Problem> problems = simulator.restore(snapshot);
  return problems.empty() ? "" : describe(problems);
}

std::string withRightChecksum(std::string bytes) {
  const std::uint32_t sum = checksum(std::string_view(bytes).substr(0, bytes.size() - sizeof sum));
  std::memcpy(bytes.data() + bytes.size() - sizeof sum, &sum, sizeof sum);
  return bytes;
}

class Refusal : public testing::Test {
 protected:
  Refusal() : other_(busyScene()) {
    Simulator simulator(busyScene());
    live(simulator, 12);
    snapshot_ = simulator.snapshot();
    live(other_, 20);
    before_ = other_.snapshot();
    revision_ = other_.revision();
    hash_ = other_.stateHash();
  }
  void TearDown() override { expectUnchanged(); }
  void expectRefused(const std::string& bytes, const std::string& fragment) {
    const std::string text = reason(other_, bytes);
    ASSERT_NE(text, "");
    ASSERT_NE(text.find(fragment), std::string::npos) << text;
    // All of it is looked at now and then: it takes longer than all else.
    ASSERT_EQ(other_.stateHash(), hash_);
    if (refused_++ % 50 == 0) expectUnchanged();
  }
  void goBack() {
    restoreOrFail(other_, before_);
    revision_ = other_.revision();
  }
  // All that a snapshot holds, and so all that the motion goes on from.
  void expectUnchanged() {
    ASSERT_EQ(other_.revision(), revision_);
    ASSERT_TRUE(other_.snapshot() == before_);
  }

  Simulator other_;
  std::string snapshot_, before_;
  std::uint64_t revision_ = 0, hash_ = 0;
  int refused_ = 0;
};

TEST_F(Refusal, IsNotForWhatIsSound) {
  EXPECT_EQ(reason(other_, snapshot_), "");
  EXPECT_TRUE(other_.snapshot() == snapshot_);
  ASSERT_NO_FATAL_FAILURE(goBack());
}

TEST_F(Refusal, IsOfEveryBeginning) {
  for (std::size_t length = 0; length < snapshot_.size(); ++length) {
    SCOPED_TRACE(length);
    ASSERT_NO_FATAL_FAILURE(
        expectRefused(snapshot_.substr(0, length), length == 0 ? "is no snapshot" : "is cut short"));
  }
  expectRefused(snapshot_ + '\0', "is too long");
}

TEST_F(Refusal, IsOfEveryFlippedByte) {
  for (std::size_t at = 0; at < snapshot_.size(); ++at) {
    SCOPED_TRACE(at);
    std::string bytes = snapshot_;
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << (at % 8)));
    ASSERT_NO_FATAL_FAILURE(expectRefused(bytes, ""));
  }
}

TEST_F(Refusal, IsOfOtherFormatsByName) {
  expectRefused("cloth: {rows: 5, columns: 4}\n", "is no snapshot");
  expectRefused(std::string(100000, '\0'), "is no snapshot");
  std::string bytes = snapshot_;
  const std::uint32_t version = kSnapshotVersion + 1;
  std::memcpy(bytes.data() + 20, &version, sizeof version);
  expectRefused(withRightChecksum(bytes), "version " + std::to_string(version) + ", this program reads version " +
                                              std::to_string(kSnapshotVersion));
  bytes = snapshot_;
  std::swap(bytes[16], bytes[19]);
  expectRefused(withRightChecksum(bytes), "machine with other numbers");
  bytes = snapshot_;
  bytes[40] = static_cast<char>(bytes[40] ^ 1);
  expectRefused(withRightChecksum(bytes), "another build");
}

TEST_F(Refusal, NamesTheFirstKeyOfOtherScenesThatDiffers) {
  const auto refused = [&](Scene scene, const std::string& fragment) {
    Simulator simulator(scene);
    expectRefused(simulator.snapshot(), fragment);
  };
  Scene scene = busyScene();
  scene.cloth.columns = 4;
  scene.wind[0].radius = 0.5;
  refused(scene, "cloth.columns: is 4 there, 3 here");
  scene = busyScene();
  scene.wind[0].radius = 0.5;
  refused(scene, "wind[0].radius: is 0.5 there, 1.0 here");
  scene = busyScene();
  scene.obstacles[0].motion[1].time = 2.0;
  refused(scene, "obstacles[0].motion[1].time: is 2.0 there, 1.0 here");
  scene = busyScene();
  scene.obstacles.pop_back();
  refused(scene, "obstacles: is a list of 1 there, a list of 2 here");
  scene = busyScene();
  scene.cloth.hem_width = 0.19;
  refused(scene, "cloth.hem_width: is 0.19 there, not given here");
  scene = busyScene();
  scene.solver.method = Method::kImplicit;
  refused(scene, "solver.method: is implicit there, auto here");
}

// Gravity and air come with the snapshot; threads change no bit.
TEST_F(Refusal, IsNotForWhatMayDiffer) {
  Scene scene = busyScene();
  scene.gravity = {0.0, 1.0, -3.0};
  scene.air.inside = 0.7;
  scene.solver.threads = 2;
  Simulator simulator(scene);
  live(simulator, 5);
  ASSERT_EQ(reason(other_, simulator.snapshot()), "");
  EXPECT_EQ(other_.scene().gravity, scene.gravity);
  EXPECT_EQ(other_.scene().air.inside, 0.7);
  EXPECT_EQ(other_.stateHash(), simulator.stateHash());
  ASSERT_NO_FATAL_FAILURE(goBack());
}

TEST_F(Refusal, IsOfAMeshThatHasChanged) {
  const std::filesystem::path folder = testing::TempDir();
  const std::string moved = (folder / "moved.obj").string(), changed = (folder / "changed.obj").string();
  std::filesystem::copy_file(busyScene().obstacles[1].mesh, moved, std::filesystem::copy_options::overwrite_existing);
  std::filesystem::copy_file(std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/l_prism.obj", changed,
                             std::filesystem::copy_options::overwrite_existing);
  Scene scene = busyScene();
  scene.obstacles[1].mesh = moved;
  Simulator elsewhere(scene);
  EXPECT_EQ(reason(elsewhere, snapshot_), "") << "the same mesh in another place";
  scene.obstacles[1].mesh = changed;
  Simulator other_mesh(scene);
  const std::string before = other_mesh.snapshot();
  EXPECT_NE(reason(other_mesh, snapshot_).find("file has changed"), std::string::npos);
  EXPECT_TRUE(other_mesh.snapshot() == before);
  std::filesystem::remove(moved);
  std::filesystem::remove(changed);
}

// Goes on with whatever it has been given: ends, and reads nothing that is not its own (sanitizers see to that).
void useAll(Simulator& simulator) {
  for (int frame = 0; frame < 2; ++frame) simulator.step();
  const Reading look(simulator);
  simulator.setGravity({0.0, 0.1, -9.0});
  simulator.setObstaclePose(0, Pose(), false);
  simulator.step();
  EXPECT_FALSE(simulator.snapshot().empty());
}

// CURTAIN_HOSTILE=count for more.
TEST_F(Refusal, IsOrNoHarmIsDoneWhenTheChecksumIsRight) {
  SnapshotParts parts;
  ASSERT_FALSE(unpackSnapshot(snapshot_, parts).has_value());
  const auto first = static_cast<std::size_t>(parts.state.data() - snapshot_.data());
  const std::size_t end = first + parts.state.size();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double numbers[] = {kInfinity, -kInfinity, std::nan(""), 1e300, -1e300, 1e-300, 5e-324, 0.0, -0.0, -1.0, 1e9};
  const std::uint64_t counts[] = {0,    1,        ~std::uint64_t{0}, std::uint64_t{1} << 63,
                                  1000, 1U << 31, 0xFFFFFFFFU,       0x100000001U};
  const int tries = std::getenv("CURTAIN_HOSTILE") != nullptr ? std::atoi(std::getenv("CURTAIN_HOSTILE")) : 600;
  Random random(2);
  int taken = 0, refused = 0;
  for (int k = 0; k < tries; ++k) {
    SCOPED_TRACE(k);
    std::string bytes = snapshot_;
    for (int changes = random.integer(1, 3); changes > 0; --changes) {
      const std::size_t at =
          first + static_cast<std::size_t>(random.between(0.0, static_cast<double>(end - first - 8)));
      const int kind = random.integer(0, 3);
      if (kind == 0) std::memcpy(&bytes[at], &numbers[random.integer(0, 10)], 8);
      if (kind == 1) std::memcpy(&bytes[at], &counts[random.integer(0, 7)], 8);
      if (kind == 2) bytes[at] = static_cast<char>(random.integer(0, 255));
      if (kind == 3) bytes.erase(at, static_cast<std::size_t>(random.integer(1, 16)));
    }
    const std::uint64_t length = bytes.size();
    std::memcpy(&bytes[32], &length, sizeof length);
    bytes = withRightChecksum(bytes);
    if (reason(other_, bytes).empty()) {
      ++taken;
      useAll(other_);
      ASSERT_NO_FATAL_FAILURE(goBack());
    } else {
      ++refused;
    }
    ASSERT_NO_FATAL_FAILURE(expectUnchanged());
  }
  EXPECT_GT(taken, 0);
  EXPECT_GT(refused, 0);
}

// Lengths and text of the scene too.
TEST_F(Refusal, IsOfBadHeadersWithARightChecksum) {
  Random random(3);
  SnapshotParts parts;
  ASSERT_FALSE(unpackSnapshot(snapshot_, parts).has_value());
  const std::size_t carried = kSnapshotHeader + parts.scene.size();
  for (int k = 0; k < 400; ++k) {
    SCOPED_TRACE(k);
    std::string bytes = snapshot_;
    const auto at = static_cast<std::size_t>(random.between(0.0, static_cast<double>(carried)));
    bytes[at] = static_cast<char>(random.integer(0, 255));
    if (bytes == snapshot_) continue;
    bytes = withRightChecksum(bytes);
    // In blanks and in what is set aside a letter may change.
    if (reason(other_, bytes).empty()) {
      ASSERT_GT(at, kSnapshotHeader);
      ASSERT_NO_FATAL_FAILURE(goBack());
    }
    ASSERT_NO_FATAL_FAILURE(expectUnchanged());
  }
  // A nest of lists and a list of lists by name.
  const std::string bomb = "a: &a [1, 1]\nb: &b [*a, *a]\nc: &c [*b, *b]\ncloth: [*c, *c]\n";
  for (const std::string& scene : {std::string(100000, '['), bomb}) {
    expectRefused(packSnapshot({parts.layout, scene, parts.state}), "");
  }
}

}  // namespace
}  // namespace curtain
