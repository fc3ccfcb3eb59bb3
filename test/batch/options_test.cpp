// SPDX-License-Identifier: BSD-3-Clause
//
// Every option of curtain_batch does what its help says, and the files it writes have the columns, digits, keys and
// counts that tools outside the package rely on.
#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <set>

#include "batch/batch_testing.h"
#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"

namespace {

using curtain_test::BatchTest;
using curtain_test::lines;
using curtain_test::Outcome;
using curtain_test::readFile;

using Options = BatchTest;

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) result.push_back(cell);
  return result;
}

TEST_F(Options, ListMethodsNamesThemAll) {
  const Outcome run = batch({"--list-methods"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(lines(run.out), curtain::methodNames());
  EXPECT_EQ(run.err, "");
  EXPECT_TRUE(files().empty());
}

TEST_F(Options, EveryListedMethodRunsAndMakesADifference) {
  const std::string scene = this->scene("cloth: {rows: 8, columns: 4}\nhang: {tilt: 0.7}\n");
  std::set<std::string> hashes;
  for (const std::string& method : curtain::methodNames()) {
    const auto json = stats({scene, "--method", method, "--duration", "0.2"});
    EXPECT_TRUE(json.at("finite").get<bool>()) << method;
    if (method != "auto") hashes.insert(json.at("state_hash").get<std::string>());
  }
  EXPECT_EQ(hashes.size(), curtain::methodNames().size() - 1) << "auto may well be one of the others";
}

TEST_F(Options, HelpNamesEveryOption) {
  for (const char* option : {"--help", "-h"}) {
    const Outcome run = batch({option});
    EXPECT_EQ(run.exit_code, 0);
    for (const char* name : {"--duration", "--method", "--substeps", "--rows", "--columns", "--out", "--sample",
                             "--sample-rate", "--mesh", "--stats", "--save", "--restore", "--checkpoint", "--every",
                             "--check", "--version", "--progress", "--explain", "--list-methods"}) {
      EXPECT_NE(run.out.find(name), std::string::npos) << name;
    }
  }
}

TEST_F(Options, VersionIsOneLine) {
  const Outcome run = batch({"--version"});
  EXPECT_EQ(run.exit_code, 0);
  ASSERT_EQ(lines(run.out).size(), 1U);
  EXPECT_EQ(run.out.rfind("curtain_batch ", 0), 0U) << run.out;
}

TEST_F(Options, CheckReadsScenesAndRunsNone) {
  const std::string good = smallScene();
  const std::string bad = scene("cloth: {rows: 5, columns: 4}\ncontact: {frictoin: 0.3}\n", "bad.yaml");
  const std::string worse = scene("cloth: {rows: 1, columns: 4}\n", "worse.yaml");
  EXPECT_EQ(batch({"--check", good}).exit_code, 0);
  const Outcome run = batch({"--check", bad, good, worse});
  EXPECT_EQ(run.exit_code, 2);
  const auto said = lines(run.err);
  ASSERT_EQ(said.size(), 2U) << run.err;
  for (const char* part : {"bad.yaml", "contact.frictoin", "did you mean friction"}) {
    EXPECT_NE(said[0].find(part), std::string::npos) << said[0];
  }
  for (const char* part : {"worse.yaml", "cloth.rows"}) EXPECT_NE(said[1].find(part), std::string::npos) << said[1];
}

TEST_F(Options, ExplainSaysWhatRunsAtTheStartAndAtTheEnd) {
  const std::string scene = this->scene(
      "cloth: {rows: 8, columns: 4}\nair: {inside: 1, border: 1, corner: 1}\n"
      "wind: [{id: fan, position: [0.5, -1.0, 1.0], direction: [0, 1, 0], pressure: 3.0, end: 0.5}]\n");
  const Outcome run = batch({scene, "--explain", "--duration", "30"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const std::size_t end = run.out.find("t = 30 s\n");
  ASSERT_NE(end, std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("t = 0 s\n"), 0U);
  EXPECT_LT(run.out.find("+ wind 'fan': reaches the cloth"), end);
  EXPECT_NE(run.out.find("- wind 'fan': ended at 0.5 s", end), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("+ rest: the cloth sleeps", end), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("- self-contact: contact.self is false", end), std::string::npos) << run.out;
}

TEST_F(Options, ExplainTellsOfPatches) {
  const std::string scene =
      this->scene("cloth: {rows: 8, columns: 4, shear: 20, patches: [{rows: [0, 3], shear: 40}]}\n");
  const Outcome run = batch({scene, "--explain", "--duration", "0.1"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("20 and patches N/m"), std::string::npos) << run.out;
}

TEST_F(Options, StatisticsOfRestAndBudget) {
  const auto asleep = stats({smallScene("air: {inside: 1, border: 1, corner: 1}\n"), "--duration", "5"});
  EXPECT_TRUE(asleep.at("rest").at("asleep").get<bool>());
  EXPECT_GT(asleep.at("rest").at("frames_asleep").get<int>(), 100);
  for (const char* key :
       {"estimates_skipped", "longer_substeps", "unfinished_substeps", "shortened_frames", "lost_s", "late_frames"}) {
    EXPECT_EQ(asleep.at("budget").at(key).get<double>(), 0.0) << key;
  }
}

TEST_F(Options, StatisticsHaveTheKeysThatToolsRead) {
  const auto json =
      stats({smallScene("wind: [{id: fan, position: [0.5, -1.0, 1.0], direction: [0, 1, 0], pressure: 3.0}]\n"),
             "--duration", "0.1"});
  for (const char* key : {"wall_s", "substeps_mean", "penetration_max"}) EXPECT_TRUE(json.at(key).is_number()) << key;
  for (const char* key : {"median", "p99", "max"}) EXPECT_GT(json.at("ms_per_frame").at(key).get<double>(), 0.0) << key;
  EXPECT_LE(json.at("ms_per_frame").at("median"), json.at("ms_per_frame").at("p99"));
  EXPECT_LE(json.at("ms_per_frame").at("p99"), json.at("ms_per_frame").at("max"));
  EXPECT_EQ(json.at("nodes").get<int>(), 20);
  EXPECT_EQ(json.at("frames").get<int>(), 6);
  EXPECT_EQ(json.at("quality").at("resolved").get<int>(), 6);
  EXPECT_EQ(json.at("quality").size(), static_cast<std::size_t>(curtain::kFrameQualityCount));
  EXPECT_DOUBLE_EQ(json.at("simulated_s").get<double>(), 0.1);
  EXPECT_DOUBLE_EQ(json.at("substeps_mean").get<double>(), 8.0);
  EXPECT_LE(json.at("stretch_max").at("warp").get<double>(), 1e-3);
  EXPECT_LE(json.at("stretch_max").at("weft").get<double>(), 1e-3);
  EXPECT_GE(json.at("compression_max").at("warp").get<double>(), 0.0);
  const auto& energy = json.at("energy");
  EXPECT_DOUBLE_EQ(energy.at("final").get<double>(),
                   energy.at("kinetic").get<double>() + energy.at("potential").get<double>());
  EXPECT_GT(energy.at("kinetic").get<double>(), 0.0);
  // 0.2 kg/m^2 x 2 m^2, hung from 2.2 m: its middle at 1.2 m. Some hundred roundings at most.
  EXPECT_NEAR(energy.at("initial").get<double>(), 0.4 * 9.81 * 1.2, 1e-12);
  EXPECT_EQ(json.at("contacts_max").get<int>(), 0);
  EXPECT_EQ(json.at("penetration_max").get<double>(), 0.0);
  EXPECT_EQ(json.at("self_crossings").get<int>(), 0);
  for (const char* part : {"nodes", "edges", "faces"}) EXPECT_EQ(json.at("piercings").at(part).get<int>(), 0);
  std::set<std::string> stages;
  double stage_sum = 0.0;
  for (const auto& [name, ms] : json.at("stages").items()) {
    stages.insert(name);
    stage_sum += ms.get<double>();
  }
  EXPECT_EQ(stages, (std::set<std::string>{"forces", "predict", "warp", "weft", "contact", "finish", "estimate"}));
  EXPECT_GT(stage_sum, 0.0);
  EXPECT_LE(stage_sum, 1e3 * json.at("wall_s").get<double>()) << "stages are parts of the stepping time";
  EXPECT_TRUE(json.at("finite").get<bool>());
  const std::string hash = json.at("state_hash").get<std::string>();
  EXPECT_EQ(hash.size(), 16u);
  EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos) << hash;
}

// As with a disk that is full: no file may grow beyond a block of 512 bytes.
TEST_F(Options, StatisticsAreWrittenCompletelyOrNotAtAll) {
  std::ofstream(path("stats.json")) << "of another run";
  const Outcome run =
      this->run(CURTAIN_BATCH, {smallScene(), "--duration", "0", "--stats", "stats.json"}, "ulimit -f 1;");
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find("--stats: stats.json: cannot be written: File too large"), std::string::npos) << run.err;
  EXPECT_EQ(readFile(path("stats.json")), "of another run");
}

TEST_F(Options, StatesHaveNineColumnsOf17DigitsAtTheTimesAsked) {
  // 60 frames a second: 0.05 s is frame 3, 0.06 s is met first by frame 4, 0 is the start.
  const std::string out = path("states.csv");
  const Outcome run = batch({smallScene(), "--duration", "0.1", "--out", out, "--sample", "0,0.05,0.06,0.1"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto rows = lines(readFile(out));
  ASSERT_EQ(rows.size(), 1u + 4u * 20u);
  EXPECT_EQ(rows[0], "t,row,column,x,y,z,vx,vy,vz");
  const int frames[] = {0, 3, 4, 6};
  for (std::size_t n = 0; n < 80; ++n) {
    const auto row = cells(rows[n + 1]);
    ASSERT_EQ(row.size(), 9u) << rows[n + 1];
    EXPECT_NEAR(std::stod(row[0]), frames[n / 20] / 60.0, 1e-15);
    EXPECT_EQ(std::stoi(row[1]), static_cast<int>(n % 20 / 4)) << "row-major";
    EXPECT_EQ(std::stoi(row[2]), static_cast<int>(n % 4));
  }
}

TEST_F(Options, StatesComeSoManyASecondFromTheStartOn) {
  const std::string scene = smallScene();
  ASSERT_EQ(batch({scene, "--duration", "0.3", "--out", "rate.csv", "--sample-rate", "10"}).exit_code, 0);
  ASSERT_EQ(batch({scene, "--duration", "0.3", "--out", "times.csv", "--sample", "0,0.1,0.2,0.3"}).exit_code, 0);
  EXPECT_EQ(readFile(path("rate.csv")), readFile(path("times.csv"))) << "0.3 * 10 is less than 3 in double precision";
  ASSERT_EQ(batch({scene, "--duration", "0.1", "--save", "s.snap"}).exit_code, 0);
  ASSERT_EQ(
      batch({scene, "--restore", "s.snap", "--duration", "0.2", "--out", "rest.csv", "--sample-rate", "10"}).exit_code,
      0);
  const auto rest = lines(readFile(path("rest.csv"))), all = lines(readFile(path("rate.csv")));
  ASSERT_EQ(rest.size(), 1u + 3u * 20u);
  EXPECT_TRUE(std::equal(rest.begin() + 1, rest.end(), all.begin() + 1 + 20));
}

TEST_F(Options, StatesAreTheSimulatorsToTheBit) {
  const std::string out = path("states.csv");
  const std::string scene = smallScene();
  ASSERT_EQ(batch({scene, "--duration", "0.2", "--out", out}).exit_code, 0);
  const auto rows = lines(readFile(out));
  ASSERT_EQ(rows.size(), 21u) << "without --sample: the end";
  curtain::Simulator simulator(curtain::readSceneFile(scene).scene);
  for (int frame = 0; frame < 12; ++frame) simulator.step();
  std::vector<curtain::Vec3> x, v;
  simulator.copyPositions(x);
  simulator.copyVelocities(v);
  for (std::size_t n = 0; n < 20; ++n) {
    const auto row = cells(rows[n + 1]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(std::stod(row[3 + axis]), x[n][static_cast<Eigen::Index>(axis)]) << "17 digits give the double back";
      EXPECT_EQ(std::stod(row[6 + axis]), v[n][static_cast<Eigen::Index>(axis)]);
    }
  }
}

TEST_F(Options, RowsColumnsAndSubstepsOverrideTheScene) {
  const auto json = stats({smallScene(), "--rows", "7", "--columns", "3", "--substeps", "5", "--duration", "0.1"});
  EXPECT_EQ(json.at("nodes").get<int>(), 21);
  EXPECT_DOUBLE_EQ(json.at("substeps_mean").get<double>(), 5.0);
}

TEST_F(Options, DurationIsInSecondsOneByDefaultAndMayBeZero) {
  EXPECT_EQ(stats({smallScene()}).at("frames").get<int>(), 60);
  EXPECT_EQ(stats({smallScene(), "--duration", "0.25"}).at("frames").get<int>(), 15);
  const auto none = stats({smallScene(), "--duration", "0"});
  EXPECT_EQ(none.at("frames").get<int>(), 0);
  EXPECT_EQ(none.at("energy").at("initial"), none.at("energy").at("final"));
}

TEST_F(Options, PlyHoldsTheFineMesh) {
  const std::string mesh = path("mesh.ply");
  ASSERT_EQ(batch({smallScene(), "--duration", "0.1", "--mesh", mesh}).exit_code, 0);
  const auto text = lines(readFile(mesh));
  // 5 rows of 3 links x 3 rods + 1 = 10 nodes; 4 x 9 quads of 2 triangles.
  ASSERT_GT(text.size(), 9u);
  EXPECT_EQ(text[0], "ply");
  EXPECT_EQ(text[1], "format ascii 1.0");
  EXPECT_EQ(text[2], "element vertex 50");
  EXPECT_EQ(text[6], "element face 72");
  EXPECT_EQ(text[8], "end_header");
  ASSERT_EQ(text.size(), 9u + 50u + 72u);
  for (std::size_t n = 9; n < 59; ++n) {
    std::istringstream line(text[n]);
    double x, y, z;
    ASSERT_TRUE(line >> x >> y >> z) << text[n];
    EXPECT_TRUE(std::isfinite(x + y + z));
    EXPECT_TRUE((line >> std::ws).eof());
  }
  for (std::size_t n = 59; n < text.size(); ++n) {
    std::istringstream line(text[n]);
    int count, a, b, c;
    ASSERT_TRUE(line >> count >> a >> b >> c) << text[n];
    EXPECT_EQ(count, 3);
    EXPECT_GE(std::min({a, b, c}), 0);
    EXPECT_LT(std::max({a, b, c}), 50);
  }
}

TEST_F(Options, ObjHoldsTheFineMeshCountedFromOne) {
  const std::string mesh = path("mesh.obj");
  ASSERT_EQ(batch({smallScene(), "--duration", "0.1", "--mesh", mesh}).exit_code, 0);
  int vertices = 0, faces = 0, lowest = 1000, highest = 0;
  for (const std::string& text : lines(readFile(mesh))) {
    std::istringstream line(text);
    std::string kind;
    line >> kind;
    if (kind == "v") {
      double x, y, z;
      ASSERT_TRUE(line >> x >> y >> z) << text;
      ++vertices;
    } else {
      ASSERT_EQ(kind, "f") << text;
      for (int corner = 0; corner < 3; ++corner) {
        int index = 0;
        ASSERT_TRUE(line >> index) << text;
        lowest = std::min(lowest, index);
        highest = std::max(highest, index);
      }
      ++faces;
    }
  }
  EXPECT_EQ(vertices, 50);
  EXPECT_EQ(faces, 72);
  EXPECT_EQ(lowest, 1);
  EXPECT_EQ(highest, 50);
}

// 80 bytes, the number of facets, and for each a normal by the right-hand rule and three corners.
TEST_F(Options, StlHoldsTheFineMesh) {
  const std::string mesh = path("mesh.stl");
  ASSERT_EQ(batch({smallScene(), "--duration", "0.1", "--mesh", mesh}).exit_code, 0);
  const std::string bytes = readFile(mesh);
  ASSERT_EQ(bytes.size(), 84u + 72u * 50u);
  EXPECT_NE(bytes.substr(0, 5), "solid") << "that is how text begins";
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  EXPECT_EQ(count, 72u);
  for (std::size_t at = 84; at < bytes.size(); at += 50) {
    float f[12];
    std::memcpy(f, bytes.data() + at, sizeof f);
    const Eigen::Vector3f normal(f[0], f[1], f[2]), a(f[3], f[4], f[5]), b(f[6], f[7], f[8]), c(f[9], f[10], f[11]);
    const Eigen::Vector3f across = (b - a).cross(c - a);
    ASSERT_GT(across.norm(), 0.0f);
    // Corners are rounded to 24 bits, of edges a tenth to a thousandth of the coordinates.
    EXPECT_NEAR(normal.dot(across.normalized()), 1.0f, 1e-3f);
    EXPECT_NEAR(normal.norm(), 1.0f, 1e-6f);
    EXPECT_TRUE(bytes[at + 48] == 0 && bytes[at + 49] == 0);
  }
}

TEST_F(Options, MeshNamesMayHaveDotsAndFoldersInThem) {
  std::filesystem::create_directories(folder_ / "old.ply.d");
  for (const std::string& name : {path("a.ply.ply"), path("old.ply.d/new.ply"), path("old.ply.d/new.obj")}) {
    const Outcome run = batch({smallScene(), "--duration", "0.05", "--mesh", name});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(std::filesystem::exists(name)) << name;
  }
}

TEST_F(Options, ProgressIsALineASecondOnStderr) {
  const Outcome quiet = batch({smallScene(), "--duration", "2"});
  EXPECT_EQ(quiet.err, "");
  const Outcome run = batch({smallScene(), "--duration", "2", "--progress"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(lines(run.err).size(), 2u) << run.err;
  EXPECT_EQ(run.out, "");
}

// A ball is pushed through the plane of a sheet that is pinned above and below: it has to wait.
TEST_F(Options, AJamIsALineOnStderr) {
  std::string pins;
  for (int j = 0; j < 8; ++j) {
    for (const int row : {0, 7})
      pins += (pins.empty() ? "[" : ", [") + std::to_string(row) + ", " + std::to_string(j) + "]";
  }
  const std::string jam =
      "cloth: {rows: 8, columns: 8, height: 0.8, width: 0.8}\nhang: {from: [0, 0, 0.8], to: [0.8, 0, 0.8]}\npins: [" +
      pins + "]\nobstacles: [{name: ball, shape: sphere, radius: 0.15, position: [0.4, -0.16, 0.42], velocity: [0, ";
  const Outcome waits = batch({scene(jam + "0.4, 0]}]\n"), "--duration", "0.5"});
  EXPECT_EQ(waits.exit_code, 0);
  ASSERT_EQ(lines(waits.err).size(), 1u) << waits.err;
  EXPECT_NE(waits.err.find("obstacles waited 0."), std::string::npos) << waits.err;
  EXPECT_EQ(batch({scene(jam + "-0.4, 0]}]\n"), "--duration", "0.5"}).err, "") << "it goes away";
}

// Of a sheet that falls on a box the mean force is the momentum that it gives up, over the time.
TEST_F(Options, StatisticsHaveTheMeanForceOnAnObstacle) {
  const std::string falls =
      "cloth: {rows: 8, columns: 8, height: 0.3, width: 0.3}\nhang: {from: [-0.15, 0.15, 0.2], to: [0.15, 0.15, 0.2], "
      "tilt: 1.570796}\npins: none\nobstacles: [{name: box, shape: box, size: [1, 1, 0.2], position: [0, 0, -0.1]}]\n";
  const auto run = stats({scene(falls), "--duration", "1"});
  const double weight = 0.3 * 0.3 * 0.2 * 9.81;
  EXPECT_NEAR(run.at("wrenches").at("box").at("force")[2], -weight, 1e-3 * weight) << "in the last frame it lies";
  EXPECT_NEAR(run.at("wrenches").at("box").at("mean").at("force")[2], -weight, 0.01 * weight);
}

TEST_F(Options, WrenchesAreALineAnObstacleAndFrame) {
  const std::string scene = smallScene(
      "hang: {tilt: 1.5707963, from: [-0.4, 0.5, 0.504], to: [0.4, 0.5, 0.504]}\npins: none\n"
      "obstacles:\n  - {name: 'table, \"old\"', shape: box, size: [2, 2, 1]}\n"
      "  - {name: ball, shape: sphere, radius: 0.1, position: [5, 0, 0]}\n");
  ASSERT_EQ(batch({scene, "--duration", "0.5", "--wrenches", "w.csv", "--stats", "s.json"}).exit_code, 0);
  const std::vector<std::string> rows = lines(readFile(path("w.csv")));
  ASSERT_EQ(rows.size(), 1U + 2U * 30U);
  EXPECT_EQ(rows.front(), "t,obstacle,fx,fy,fz,tx,ty,tz,contacts");
  const std::string name = "\"table, \"\"old\"\"\"";
  const std::string& last = rows[rows.size() - 2];
  ASSERT_NE(last.find(name), std::string::npos) << last;
  const auto stats = nlohmann::json::parse(readFile(path("s.json")));
  const auto told = stats.at("wrenches").at("table, \"old\"");
  EXPECT_EQ(std::stod(cells(last.substr(last.find(name) + name.size()))[3]), told.at("force").at(2).get<double>());
  EXPECT_EQ(cells(rows.back())[1], "ball");
  EXPECT_EQ(cells(rows.back())[4], "0");
}

TEST_F(Options, OutputsAreWrittenWhereTheyAreAskedAndNowhereElse) {
  const Outcome run = batch({smallScene(), "--out", "s.csv", "--mesh", "m.obj", "--stats", "t.json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(files(), (std::vector<std::string>{"m.obj", "s.csv", "scene.yaml", "t.json"}));
}

TEST_F(Options, SameRunTwiceGivesTheSameBits) {
  const std::string scene = std::string(CURTAIN_SOURCE_DIR) + "/config/scenes/flag.yaml";
  const auto once = stats({scene, "--duration", "0.5", "--out", path("a.csv")});
  const auto again = stats({scene, "--duration", "0.5", "--out", path("b.csv")});
  EXPECT_EQ(once.at("state_hash"), again.at("state_hash"));
  EXPECT_EQ(readFile(path("a.csv")), readFile(path("b.csv")));
  EXPECT_NE(once.at("state_hash"), stats({scene, "--duration", "0.6"}).at("state_hash")) << "it is a hash of the state";
}

TEST_F(Options, SeedChangesTheGusts) {
  const std::string gusty =
      "cloth: {rows: 5, columns: 4}\nwind: [{id: fan, position: [0.5, -1.0, 1.0], direction: [0, 1, 0], radius: 3.0, "
      "unsteadiness: 2.0}]\nsolver: {seed: ";
  const auto one = stats({scene(gusty + "1}\n"), "--duration", "0.2"});
  const auto two = stats({scene(gusty + "2}\n"), "--duration", "0.2"});
  EXPECT_NE(one.at("state_hash"), two.at("state_hash"));
}

TEST_F(Options, ShippedScenesRun) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(CURTAIN_SOURCE_DIR) + "/config/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    ++count;
    const auto json = stats({entry.path().string(), "--duration", "0.5"});
    EXPECT_TRUE(json.at("finite").get<bool>()) << entry.path();
    EXPECT_EQ(json.at("frames").get<int>(), 30) << entry.path();
  }
  EXPECT_GE(count, 5);
}

}  // namespace
