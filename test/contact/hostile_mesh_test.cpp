// SPDX-License-Identifier: BSD-3-Clause
//
// Mesh files that are made to hang the program, to fill its memory or its stack: each of them did so by way of assimp.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "obstacles/mesh_loader.h"

namespace {

namespace fs = std::filesystem;

class HostileMesh : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("curtain_hostile_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    limitTime(60);  // what hangs fails, however busy the machine is
  }
  void TearDown() override {
    limitTime(0);
    fs::remove_all(folder_);
  }

  // Of the processor [s]; 0: none.
  static void limitTime(int seconds) {
    itimerval limit{};
    limit.it_value.tv_sec = seconds;
    ASSERT_EQ(setitimer(ITIMER_PROF, &limit, nullptr), 0);
  }

  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }

  void expectRefused(const std::string& path, const std::string& reason) const {
    try {
      curtain::loadMesh(path, curtain::Vec3::Ones(), "chair");
      ADD_FAILURE() << "loaded";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }

  fs::path folder_;
};

const char* const kNode =
    "<node id=\"n0\"><matrix>1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1</matrix>"
    "<instance_geometry url=\"#cube\"/></node>";

// The cube with other nodes in its scene, and a library of nodes.
std::string cubeWith(const std::string& nodes, const std::string& library = "") {
  std::ifstream file(CURTAIN_SOURCE_DIR "/test/meshes/cube.dae");
  std::ostringstream text;
  text << file.rdbuf();
  std::string all = text.str();
  const std::size_t node = all.find(kNode);
  EXPECT_NE(node, std::string::npos);
  all.replace(node, std::string(kNode).size(), nodes);
  return all.insert(all.find("<library_visual_scenes>"), "<library_nodes>" + library + "</library_nodes>");
}

std::string instance(const std::string& id) { return "<instance_node url=\"#" + id + "\"/>"; }

TEST_F(HostileMesh, ANodeThatStandsForItselfIsRefused) {
  const std::string circle =
      "<node id=\"a\"><instance_geometry url=\"#cube\"/><node id=\"b\">" + instance("a") + "</node></node>";
  expectRefused(file("circle.dae", cubeWith(circle)), "or for themselves");
  const std::string by_name = "<node name=\"a\"><node>" + instance("a") + "</node></node>";
  expectRefused(file("name.dae", cubeWith(by_name)), "or for themselves");
  const std::string library = "<node id=\"a\">" + instance("b") + "</node><node id=\"b\">" + instance("a") + "</node>";
  expectRefused(file("library.dae", cubeWith("<node>" + instance("a") + "</node>", library)), "or for themselves");
}

TEST_F(HostileMesh, EachNodeTwiceTheOneBeforeIsRefused) {
  std::string library = "<node id=\"a0\"><instance_geometry url=\"#cube\"/></node>";
  for (int i = 1; i < 40; ++i) {
    const std::string before = instance("a" + std::to_string(i - 1));
    library += "<node id=\"a" + std::to_string(i) + "\">" + before + before + "</node>";
  }
  expectRefused(file("twice.dae", cubeWith("<node>" + instance("a39") + "</node>", library)), "100000 nodes");
}

TEST_F(HostileMesh, NodesThatStandForOthersAreRead) {
  const std::string library = "<node id=\"a\" name=\"b\"><instance_geometry url=\"#cube\"/></node>";
  // A node that has the name of what it stands for is no circle: the library comes first.
  const std::string nodes =
      "<node name=\"a\">" + instance("a") + "</node><node><translate>3 0 0</translate>" + instance("a") + "</node>";
  EXPECT_EQ(
      curtain::loadMesh(file("two.dae", cubeWith(nodes, library)), curtain::Vec3::Ones(), "chair").triangles.size(),
      24u);
}

TEST_F(HostileMesh, ElementsWithinElementsAreRefused) {
  std::string nodes;
  for (int i = 0; i < 200000; ++i) nodes += "<node>";
  for (int i = 0; i < 200000; ++i) nodes += "</node>";
  expectRefused(file("deep.dae", cubeWith(nodes)), "100 deep");
}

TEST_F(HostileMesh, IndicesThatAreNoneAreRefused) {
  for (const char* bad : {"0 2 x", "0 2 1e5", "0 2 \xFF\xFF", "0 2 <![CDATA[,]]>"}) {
    std::string text = cubeWith(kNode);
    expectRefused(file("indices.dae", text.replace(text.find("<p>0 2"), 6, std::string("<p>") + bad)),
                  "list of indices");
  }
}

TEST_F(HostileMesh, OneCornerAfterTheOtherIsRefused) {
  std::ostringstream text;
  constexpr int kCorners = 100000;  // minutes to cut into triangles
  for (int i = 0; i < kCorners; ++i) {
    const double radius = 1 + i % 2;
    text << "v " << radius * std::cos(6.28 * i / kCorners) << " " << radius * std::sin(6.28 * i / kCorners) << " 0\n";
  }
  text << "f";
  for (int i = 1; i <= kCorners; ++i) text << " " << i;
  expectRefused(file("star.obj", text.str() + "\n"), "polygon of 100000 corners");
}

// Whoever opens a pipe waits until somebody writes to it.
TEST_F(HostileMesh, AMaterialThatIsAPipeIsNotOpened) {
  const std::string pipe = (folder_ / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& name : {pipe, std::string("pipe")}) {
    const std::string path = file("pipe.obj", "mtllib " + name + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(curtain::loadMesh(path, curtain::Vec3::Ones(), "chair").triangles.size(), 1u);
  }
}

TEST_F(HostileMesh, AFileThatIsFarTooLargeIsRefused) {
  const std::string path = file("large.stl", "solid large\n");
  fs::resize_file(path, std::uintmax_t{257} << 20U);  // of holes: takes no room
  expectRefused(path, "larger than 256 MiB");
}

// 50000 times the same part of 100 triangles.
TEST_F(HostileMesh, PartsUsedAgainAndAgainAreRefused) {
  std::string nodes;
  for (int i = 0; i < 50000; ++i) nodes += "<node><instance_geometry url=\"#cube\"/></node>";
  std::string text = cubeWith(nodes);
  std::string triangles;
  for (int i = 0; i < 100; ++i) triangles += "0 1 2 ";
  const std::size_t begin = text.find("<p>") + 3;
  text.replace(begin, text.find("</p>") - begin, triangles);
  text.replace(text.find("<triangles count=\"12\""), 21, "<triangles count=\"100\"");
  expectRefused(file("again.dae", text), "more than 4 million triangles");
}

}  // namespace
