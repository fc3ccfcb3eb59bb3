// SPDX-License-Identifier: BSD-3-Clause
//
// Bad input ends curtain_batch with exit code 2 and a message on stderr that names what is wrong and where, and nothing
// is written: neither an output file nor a line on stdout.
#include "batch/batch_testing.h"

namespace {

using curtain_test::BatchTest;
using curtain_test::Outcome;

class BadInput : public BatchTest {
 protected:
  // Runs with all outputs asked for and expects a refusal that has every fragment in it.
  void expectRefused(std::vector<std::string> arguments, const std::vector<std::string>& fragments) {
    for (const char* left : {"out.csv", "mesh.ply", "stats.json"}) std::filesystem::remove(path(left));
    const auto before = files();
    const auto asks = [&](const char* option) {
      return std::find(arguments.begin(), arguments.end(), option) != arguments.end();
    };
    const std::pair<const char*, const char*> outputs[] = {
        {"--out", "out.csv"}, {"--mesh", "mesh.ply"}, {"--stats", "stats.json"}};
    const std::vector<std::string> given = arguments;
    // In front, lest an option at the end that lacks its value takes one of these for it.
    for (const auto& [option, name] : outputs) {
      if (!asks(option)) arguments.insert(arguments.begin(), {option, name});
    }
    const Outcome run = batch(arguments);
    std::string text;
    for (const std::string& argument : given) text += " " + argument;
    SCOPED_TRACE(text + "\n" + run.err);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(run.out, "");
    for (const std::string& fragment : fragments) {
      EXPECT_NE(run.err.find(fragment), std::string::npos) << "lacks: " << fragment;
    }
    EXPECT_EQ(run.err.rfind("curtain_batch: ", 0), 0u) << "says who speaks";
    EXPECT_EQ(files(), before) << "nothing written";
  }

  void expectSceneRefused(const std::string& text, const std::vector<std::string>& fragments) {
    std::vector<std::string> all = fragments;
    all.push_back("scene.yaml");
    expectRefused({scene(text)}, all);
  }
};

const char* const kCloth = "cloth: {rows: 5, columns: 4}\n";

TEST_F(BadInput, UnknownAndIncompleteOptionsAreRefused) {
  const std::string good = smallScene();
  expectRefused({}, {"scene"});
  expectRefused({good, "--frobnicate"}, {"--frobnicate", "unknown option"});
  expectRefused({good, "-x"}, {"-x", "unknown option"});
  expectRefused({good, good}, {"one scene"});
  for (const char* option :
       {"--duration", "--method", "--substeps", "--rows", "--columns", "--sample", "--sample-rate"}) {
    expectRefused({good, option}, {option, "needs a value"});
  }
  for (const char* value : {"-1", "nan", "inf", "soon", "1s", ""}) {
    expectRefused({good, "--duration", value}, {"--duration", std::string("'") + value + "'"});
  }
  for (const char* option : {"--substeps", "--rows", "--columns"}) {
    for (const char* value : {"0", "-3", "2.5", "many", "nan"}) {
      expectRefused({good, option, value}, {option, std::string("'") + value + "'"});
    }
  }
  expectRefused({good, "--method", "magic"}, {"--method", "magic", "--list-methods"});
  expectRefused({good, "--sample", "0.1,x"}, {"--sample", "'x'"});
  expectRefused({good, "--sample", "0.1,,0.2"}, {"--sample"});
  expectRefused({good, "--sample", "0.2,0.1"}, {"--sample", "0.2,0.1"});
  expectRefused({good, "--sample", "-1"}, {"--sample", "'-1'"});
  expectRefused({good, "--sample", ""}, {"--sample"});
  expectRefused({good, "--sample-rate", "0"}, {"--sample-rate", "> 0", "'0'"});
  expectRefused({good, "--sample-rate", "fast"}, {"--sample-rate", "'fast'"});
  expectRefused({good, "--sample-rate", "1000000"}, {"--sample-rate", "at most 1000000 states"});
  expectRefused({good, "--sample-rate", "10", "--sample", "0"}, {"--sample-rate", "--sample, too"});
  expectRefused({good, "--mesh", "mesh.dae"}, {"--mesh", "mesh.dae", ".ply", ".obj", ".stl"});
}

TEST_F(BadInput, OverridesAreJudgedLikeTheSceneItself) {
  const std::string good = smallScene();
  expectRefused({good, "--rows", "1"}, {"rows", "[2, 4096]", "1"});
  expectRefused({good, "--columns", "5000"}, {"columns", "[2, 4096]", "5000"});
  expectRefused({good, "--substeps", "20000"}, {"substeps", "20000"});
  const std::string pinned = scene("cloth: {rows: 5, columns: 4}\npins: [[4, 3]]\n");
  expectRefused({pinned, "--rows", "3"}, {"pins[0]", "[4, 3]"});
}

TEST_F(BadInput, ADurationThatNoMemoryHoldsIsNamed) {
  for (const char* value : {"1e12", "1e300"}) expectRefused({smallScene(), "--duration", value}, {"--duration", value});
}

TEST_F(BadInput, OutputsInMissingFoldersAreRefused) {
  const std::string good = smallScene();
  expectRefused({good, "--out", "nowhere/out.csv"}, {"--out", "nowhere"});
  expectRefused({good, "--mesh", "nowhere/mesh.ply"}, {"--mesh", "nowhere"});
  expectRefused({good, "--stats", "nowhere/stats.json"}, {"--stats", "nowhere"});
}

// What is written last is noticed too: a short file may wait in a buffer until it is closed.
TEST_F(BadInput, OutputsOnAFullDiskAreAFailure) {
  const std::pair<const char*, const char*> outputs[] = {{"--out", "full.csv"},
                                                         {"--mesh", "full.ply"},
                                                         {"--mesh", "full.obj"},
                                                         {"--mesh", "full.stl"},
                                                         {"--stats", "full.json"}};
  for (const auto& [option, name] : outputs) {
    std::filesystem::create_symlink("/dev/full", folder_ / name);
    const Outcome run = batch({smallScene(), "--duration", "0.1", "--sample", "0.1", option, name});
    EXPECT_EQ(run.exit_code, 4) << option << ' ' << name;
    EXPECT_NE(run.err.find(name), std::string::npos) << run.err;
  }
}

TEST_F(BadInput, OutputsThatAreFoldersAreRefused) {
  const std::string good = smallScene();
  std::filesystem::create_directories(folder_ / "folder.ply");
  expectRefused({good, "--out", "folder.ply"}, {"folder.ply"});
  expectRefused({good, "--stats", "folder.ply"}, {"folder.ply"});
  expectRefused({good, "--mesh", "folder.ply"}, {"folder.ply"});
}

TEST_F(BadInput, MeshNamesWithoutAnEndingAreRefused) {
  for (const char* name : {"m", "abc", "mesh", "ply", ".stl", "mesh.ply.txt"}) {
    expectRefused({smallScene(), "--mesh", name}, {"--mesh", name});
  }
}

TEST_F(BadInput, SceneFilesThatCanNotBeReadAreRefused) {
  expectRefused({"missing.yaml"}, {"missing.yaml"});
  expectRefused({folder_.string()}, {folder_.string()});
  expectSceneRefused("", {"empty"});
  expectSceneRefused("cloth: {rows: 5, columns: 4\n", {"line"});
}

TEST_F(BadInput, SceneValuesOutOfRangeAreRefused) {
  expectSceneRefused(std::string(kCloth) + "colour: red\n", {"colour"});
  expectSceneRefused("cloth: {rows: 5, columns: 4, rovs: 6}\n", {"cloth.rovs"});
  expectSceneRefused("cloth: {columns: 4}\n", {"cloth.rows", "missing"});
  expectSceneRefused("cloth: {rows: 1, columns: 4}\n", {"cloth.rows", "[2, 4096]", "1"});
  expectSceneRefused("cloth: {rows: 5, columns: 1}\n", {"cloth.columns"});
  expectSceneRefused("cloth: {rows: 5, columns: 4, height: 1e3 m}\n", {"cloth.height", "1e3 m"});
  expectSceneRefused("cloth: {rows: 5, columns: 4, height: 1e99}\n", {"cloth.height", "1e+99"});
  expectSceneRefused("cloth: {rows: five, columns: 4}\n", {"cloth.rows", "five"});
  expectSceneRefused("cloth: {rows: 5, columns: 4, height: .nan}\n", {"cloth.height"});
  expectSceneRefused(std::string(kCloth) + "gravity: [0, 0, .inf]\n", {"gravity"});
  expectSceneRefused(std::string(kCloth) + "pins: [[5, 0]]\n", {"pins[0]", "[5, 0]"});
  expectSceneRefused(std::string(kCloth) + "hang: {from: [0, 0, 2], to: [3, 0, 2]}\n", {"hang.to", "3", "cloth.width"});
  expectSceneRefused(std::string(kCloth) + "hang: {from: [0, 0, 2], to: [0, 0, 2]}\n", {"hang.to"});
  expectSceneRefused(std::string(kCloth) + "wind: [{id: a, radius: -1.0}]\n", {"wind[0].radius"});
  expectSceneRefused(std::string(kCloth) + "drag: [{id: a, node: [9, 9], force: [1, 0, 0]}]\n", {"drag[0].node"});
  expectSceneRefused(std::string(kCloth) + "solver: {method: magic}\n", {"solver.method", "magic"});
}

TEST_F(BadInput, AllProblemsAreListedAtOnce) {
  expectSceneRefused("cloth: {rows: 1, columns: 4, width: -1.0}\ncolour: red\n",
                     {"cloth.rows", "cloth.width", "colour"});
}

TEST_F(BadInput, MeshesThatCanNotBeReadAreRefused) {
  const auto withMesh = [&](const std::string& file) {
    return scene(std::string(kCloth) + "obstacles: [{name: bust, shape: mesh, mesh: \"" + file + "\"}]\n");
  };
  expectRefused({withMesh("missing.stl")}, {"bust", "missing.stl"});
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(CURTAIN_SOURCE_DIR) + "/test/meshes")) {
    if (entry.path().filename().string().rfind("bad_", 0) != 0) continue;
    ++count;
    expectRefused({withMesh(entry.path().string())}, {"bust", entry.path().filename().string()});
  }
  EXPECT_GE(count, 10);
}

}  // namespace
