// SPDX-License-Identifier: BSD-3-Clause
//
// --save and --restore: a run in two parts is the run in one, to the bit; and what can't be restored or saved ends with
// exit code 2.

#include "batch/batch_testing.h"

namespace {

using curtain_test::BatchTest;
using curtain_test::kMoving;
using curtain_test::lines;
using curtain_test::Outcome;
using curtain_test::readFile;

class Snapshots : public BatchTest {
 protected:
  void expectRefused(const std::vector<std::string>& arguments, const std::vector<std::string>& fragments,
                     int exit_code = 2) {
    const auto before = files();
    const Outcome run = batch(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(run.err.rfind("curtain_batch: ", 0), 0U) << run.err;
    for (const std::string& fragment : fragments) EXPECT_NE(run.err.find(fragment), std::string::npos) << run.err;
    EXPECT_EQ(files(), before) << "nothing written";
  }
};

TEST_F(Snapshots, ARunInTwoPartsIsTheRunInOne) {
  const std::string scene = smallScene(kMoving);
  const auto whole = stats({scene, "--duration", "0.8", "--out", path("whole.csv"), "--sample", "0.6,0.8"});
  stats({scene, "--duration", "0.5", "--save", path("half.snap")});
  const auto rest = stats(
      {scene, "--restore", path("half.snap"), "--duration", "0.3", "--out", path("rest.csv"), "--sample", "0.6,0.8"});
  for (const char* key :
       {"frames", "simulated_s", "substeps_mean", "sweeps_mean", "stretch_max", "contacts_max", "state_hash"}) {
    EXPECT_EQ(whole.at(key), rest.at(key)) << key;
  }
  EXPECT_EQ(readFile(path("whole.csv")), readFile(path("rest.csv")));
  EXPECT_GT(lines(readFile(path("rest.csv"))).size(), 2U);
}

TEST_F(Snapshots, OfNoDurationIsTheSameAgain) {
  const std::string scene = smallScene(kMoving);
  const auto saved = stats({scene, "--duration", "0.2", "--save", path("a.snap")});
  const auto again = stats({scene, "--restore", path("a.snap"), "--duration", "0", "--save", path("b.snap")});
  EXPECT_EQ(saved.at("state_hash"), again.at("state_hash"));
  const auto on = stats({scene, "--restore", path("a.snap"), "--duration", "0.2"});
  EXPECT_EQ(stats({scene, "--restore", path("b.snap"), "--duration", "0.2"}).at("state_hash"), on.at("state_hash"));
}

TEST_F(Snapshots, ThatDoNotFitAreRefused) {
  const std::string scene = smallScene(kMoving);
  stats({scene, "--duration", "0.2", "--save", path("a.snap")});
  const std::string snapshot = readFile(path("a.snap"));
  std::ofstream(path("short.snap"), std::ios::binary) << snapshot.substr(0, snapshot.size() / 2);
  std::string damaged = snapshot;
  damaged[snapshot.size() / 2] = static_cast<char>(damaged[snapshot.size() / 2] ^ 1);
  std::ofstream(path("damaged.snap"), std::ios::binary) << damaged;
  const std::vector<std::string> outputs = {"--out",   "out.csv",   "--mesh", "mesh.ply",
                                            "--stats", "more.json", "--save", "b.snap"};
  const auto refused = [&](std::vector<std::string> arguments, const std::vector<std::string>& fragments) {
    arguments.insert(arguments.end(), outputs.begin(), outputs.end());
    expectRefused(arguments, fragments);
  };
  refused({scene, "--restore", "none.snap"}, {"--restore", "none.snap", "No such file"});
  refused({scene, "--restore", "scene.yaml"}, {"--restore", "scene.yaml", "no snapshot"});
  refused({scene, "--restore", "short.snap"}, {"--restore", "short.snap", "cut short"});
  refused({scene, "--restore", "damaged.snap"}, {"--restore", "damaged.snap", "checksum"});
  refused({scene, "--restore", "a.snap", "--rows", "6"}, {"--restore", "a.snap", "cloth.rows", "5", "6"});
  refused({scene, "--restore", "a.snap", "--method", "implicit"}, {"solver.method", "leapfrog", "implicit"});
  refused({scene, "--restore", "a.snap", "--sample", "0.1"}, {"--sample", "before the start"});
  refused({scene, "--restore", "a.snap", "--sample", "1.3"}, {"--sample", "after the end"});
}

TEST_F(Snapshots, ThatCanNotBeWrittenAreSaidSo) {
  expectRefused({smallScene(), "--save", "no folder/a.snap"}, {"--save", "no folder"});
  expectRefused({smallScene(), "--save", "."}, {"--save", "folder"});
  expectRefused({smallScene(), "--duration", "0.1", "--save", "/dev/full"}, {"--save", "/dev/full", "not a file"}, 4);
}

}  // namespace
