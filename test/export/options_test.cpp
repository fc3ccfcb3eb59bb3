// SPDX-License-Identifier: BSD-3-Clause
//
// curtain_export as a program: what it writes, and one message for what it can't.
#include <gtest/gtest.h>

#include <cmath>

#include "batch/batch_testing.h"
#include "curtain_sim/scene_yaml.h"
#include "export/gltf_check.h"
#include "export/scenes.h"

namespace {

using curtain_test::lines;
using curtain_test::Outcome;
using curtain_test::readFile;

class ExportTest : public curtain_test::BatchTest {
 protected:
  Outcome exporting(const std::vector<std::string>& arguments, const std::string& before = "") const {
    return run(CURTAIN_EXPORT, arguments, before);
  }

  void expectRefused(const std::vector<std::string>& arguments, const std::vector<std::string>& words,
                     int exit_code = 2, const std::string& before = "") const {
    const std::vector<std::string> there = files();
    const Outcome outcome = exporting(arguments, before);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    EXPECT_EQ(lines(outcome.err).size(), 1u) << outcome.err;
    for (const std::string& word : words) EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_EQ(files(), there) << "nothing is written";
  }
};

TEST_F(ExportTest, WritesAGltfFile) {
  const Outcome outcome = exporting({smallScene(), "--out", "cloth.glb", "--end", "0.5", "--color", "1,0,0.5"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "cloth.glb: 16 frames\n");
  const tinygltf::Model model = curtain_test::readGltf(readFile(path("cloth.glb")));
  EXPECT_EQ(curtain_test::GltfCheck(model).wrong(), std::vector<std::string>());
  EXPECT_EQ(curtain_test::timesOf(model).size(), 16u);
  EXPECT_EQ(model.materials.at(0).pbrMetallicRoughness.baseColorFactor.at(0), 1.0);
}

TEST_F(ExportTest, WritesAFileATick) {
  const std::string scene =
      smallScene("wind: [{id: fan, position: [0.5, -1, 1], direction: [0, 1, 0], pressure: 9}]\n");
  const Outcome outcome = exporting({scene, "--out", "cloth.ply", "--start", "0.1", "--end", "0.3", "--rate", "120"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "cloth_0000.ply to cloth_0024.ply: 25 frames\n");
  // A frame of the scene lasts two ticks: the one that comes next is for both.
  EXPECT_NE(readFile(path("cloth_0000.ply")), readFile(path("cloth_0001.ply")));
  EXPECT_EQ(readFile(path("cloth_0001.ply")), readFile(path("cloth_0002.ply")));
  curtain::Simulator simulator(curtain::readSceneFile(scene).scene);
  for (int frame = 0; frame < 7; ++frame) simulator.step();  // to tick 2, after 0.1 s
  const std::vector<curtain::Vec3> wanted = curtain_test::drawnPositions(simulator);
  const std::vector<std::string> text = lines(readFile(path("cloth_0002.ply")));
  const auto header = std::find(text.begin(), text.end(), "end_header");
  ASSERT_GE(static_cast<std::size_t>(text.end() - header), wanted.size() + 1);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    std::istringstream line(*(header + 1 + static_cast<std::ptrdiff_t>(i)));
    float x = 0.0F, y = 0.0F, z = 0.0F;
    line >> x >> y >> z;  // nine digits are all of a float
    EXPECT_EQ(curtain::Vec3(x, y, z), wanted[i].cast<float>().cast<double>()) << i;
  }
}

TEST_F(ExportTest, RefusesBadInputWithOneMessage) {
  const std::string scene = smallScene();
  std::filesystem::create_directory(folder_ / "folder.glb");
  const std::pair<std::vector<std::string>, std::vector<std::string>> cases[] = {
      {{}, {"a scene file or a bag is needed"}},
      {{scene}, {"--out", "needed"}},
      {{scene, "--out", "cloth.fbx"}, {"--out", ".glb or .ply", "cloth.fbx"}},
      {{scene, "--out", "nowhere/cloth.glb"}, {"--out", "no folder 'nowhere'"}},
      {{scene, "--out", "folder.glb"}, {"--out", "is a folder"}},
      {{scene, "--out"}, {"--out", "needs a value"}},
      {{"scene.txt", "--out", "cloth.glb"}, {"scene.txt", ".yaml", ".bag"}},
      {{"none.yaml", "--out", "cloth.glb"}, {"none.yaml"}},
      {{"none.bag", "--out", "cloth.glb"}, {"none.bag"}},
      {{scene, scene, "--out", "cloth.glb"}, {"one scene or bag"}},
      {{scene, "--out", "cloth.glb", "--rate", "0"}, {"--rate", "[0.001, 100000]", "'0'"}},
      {{scene, "--out", "cloth.glb", "--rate", "30fps"}, {"--rate", "30fps"}},
      {{scene, "--out", "cloth.glb", "--end", "nan"}, {"--end", "nan"}},
      {{scene, "--out", "cloth.glb", "--start", "-1"}, {"--start", "-1"}},
      {{scene, "--out", "cloth.glb", "--start", "2", "--end", "1"}, {"--end", "after --start"}},
      {{scene, "--out", "cloth.glb", "--start", "0.001", "--end", "0.002"}, {"no frame in the part asked for"}},
      {{scene, "--out", "cloth.ply", "--start", "0.001", "--end", "0.002"}, {"no frame in the part asked for"}},
      {{scene, "--out", "cloth.glb", "--topic", "/state"}, {"--topic", "bags"}},
      {{scene, "--out", "cloth.glb", "--color", "1,1"}, {"--color", "three numbers"}},
      {{scene, "--out", "cloth.glb", "--color", "1,1,300"}, {"--color", "[0, 1]", "300"}},
      {{scene, "--out", "cloth.glb", "--colour", "1,1,1"}, {"--colour", "unknown option"}}};
  for (const auto& [arguments, words] : cases) expectRefused(arguments, words);
  expectRefused({this->scene("cloth: {rows: 1, columns: 4}\n", "bad.yaml"), "--out", "cloth.ply"}, {"cloth.rows"});
}

// As with a disk that is full: no file may grow beyond 8 blocks of 512 bytes.
TEST_F(ExportTest, SaysWhatCannotBeWrittenAndLeavesNothingHalf) {
  const std::string full = "ulimit -f 8;";
  expectRefused({smallScene(), "--out", "cloth.glb"}, {"cloth.glb", "cannot be written"}, 4, full);
  expectRefused({scene("cloth: {rows: 40, columns: 40, folds: 1}\n", "large.yaml"), "--out", "cloth.ply"},
                {"cloth_0000.ply", "cannot be written"}, 4, full);
}

TEST_F(ExportTest, Helps) {
  const Outcome outcome = exporting({"--help"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.out.find("--rate HZ"), std::string::npos);
}

}  // namespace
