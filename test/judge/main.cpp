// SPDX-License-Identifier: BSD-3-Clause
//
// The judge: draws random scenes, carries them out and says which of them do not hold. Exit code 1 when one does not.
//
//   curtain_judge [--everyday N] [--wild N] [--sudden N] [--first SEED] [--case FILE]… [--shrink FOLDER] [--csv FILE]
//                 [--repeat-every K] [--most-seconds S] [--most-nodes N] [--write FOLDER] [--verbose]
//
// --write keeps every trial as a file, for --case.
// --most-nodes leaves out larger cloth, and draws on until the count is there.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>

#include "judge/court.h"

namespace {

using namespace curtain;
using namespace curtain_test;

struct Options {
  long count[3] = {0, 0, 0};
  std::uint64_t first = 1;
  std::vector<std::string> cases;
  std::string shrink_to, write_to, csv;
  long repeat_every = 10;
  double max_seconds = 0.0;
  int max_nodes = 1 << 30;
  bool verbose = false;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const auto value = [&]() -> std::string {
      if (++i == argc) throw std::invalid_argument(name + " needs a value");
      return argv[i];
    };
    if (name == "--everyday")
      options.count[0] = std::stol(value());
    else if (name == "--wild")
      options.count[1] = std::stol(value());
    else if (name == "--sudden")
      options.count[2] = std::stol(value());
    else if (name == "--first")
      options.first = std::stoull(value());
    else if (name == "--case")
      options.cases.push_back(value());
    else if (name == "--shrink")
      options.shrink_to = value();
    else if (name == "--write")
      options.write_to = value();
    else if (name == "--csv")
      options.csv = value();
    else if (name == "--repeat-every")
      options.repeat_every = std::stol(value());
    else if (name == "--most-seconds")
      options.max_seconds = std::stod(value());
    else if (name == "--most-nodes")
      options.max_nodes = std::stoi(value());
    else if (name == "--verbose")
      options.verbose = true;
    else
      throw std::invalid_argument("unknown option " + name);
  }
  return options;
}

int columnsOf(const Scene& scene) {
  int columns = scene.cloth.columns;
  for (const LayerParams& layer : scene.layers) columns += layer.cloth.columns;
  return columns;
}

// What a trial has, by the names that the page of random scenes gives it, joined by +.
std::string partsOf(const Drawn& drawn) {
  const Scene& scene = drawn.scene;
  const ClothParams& cloth = scene.cloth;
  const auto isMesh = [](const ObstacleParams& obstacle) { return obstacle.shape == ShapeKind::kMesh; };
  const bool meshes = std::any_of(scene.obstacles.begin(), scene.obstacles.end(), isMesh);
  const std::pair<const char*, bool> parts[] = {
      {"obstacles", !scene.obstacles.empty()},
      {"meshes", meshes},
      {"self-contact", scene.contact.self},
      {"layers", !scene.layers.empty()},
      {"fabric", cloth.shear > 0.0 || cloth.bending_bias > 0.0 || cloth.bending_hysteresis > 0.0},
      {"patches", !cloth.patches.empty()},
      {"bending", cloth.bending_warp > 0.0 || cloth.bending_weft > 0.0},
      {"slits", !cloth.slits.empty()},
      {"ring", cloth.closed},
      {"rail", !scene.rail.path.empty()},
      {"lines", !scene.lines.empty() || !scene.tie_back.empty()},
      {"hands", !drawn.happenings.hands.empty() || !scene.hands.empty()},
      {"relative air", scene.air.law == AirLaw::kRelative}};
  std::string joined;
  for (const auto& [name, has] : parts) {
    if (has) joined += (joined.empty() ? "" : "+") + std::string(name);
  }
  return joined;
}

class Session {
 public:
  explicit Session(const Options& options) : options_(options) {
    if (options.csv.empty()) return;
    csv_.open(options.csv);
    csv_ << "kind,seed,method,parts,rows,columns,frames,substeps,rejected,sweeps,last_resort,stops,momentum_cut,max_"
            "solves,"
            "stretch,energy_gain,energy_finer,brute_forced,crossings,crossings_excused,links_excused,energy_judged,"
            "obstacles,obstacles_excused,"
            "seconds,slowest_frame_s,holds\n";
  }

  void hear(const Drawn& drawn, const std::string& name) {
    Rigour rigour;
    rigour.repeats = options_.repeat_every > 0 && drawn.seed % static_cast<std::uint64_t>(options_.repeat_every) == 0;
    rigour.max_seconds = options_.max_seconds;
    const TrialVerdict verdict = judge(drawn, rigour);
    ++heard_;
    if (!options_.write_to.empty()) std::ofstream(pathIn(options_.write_to, drawn)) << write(drawn);
    record(drawn, verdict);
    if (options_.verbose || !verdict.holds()) {
      std::printf(
          "%s %d x %d, %.3g Hz: %s; stretch %.2e, %lld substeps in %lld frames, %lld rejected, most solves %lld, %lld "
          "stops, %.2f s\n",
          name.c_str(), drawn.scene.cloth.rows, drawn.scene.cloth.columns, drawn.scene.solver.frame_rate,
          verdict.holds() ? "holds" : verdict.faults.front().c_str(), verdict.stretch,
          static_cast<long long>(verdict.substeps), static_cast<long long>(verdict.frames),
          static_cast<long long>(verdict.rejected), static_cast<long long>(verdict.max_solves),
          static_cast<long long>(verdict.stops), verdict.seconds);
      std::fflush(stdout);
    }
    if (verdict.holds()) return;
    ++failed_;
    if (options_.shrink_to.empty()) return;
    rigour.max_seconds = std::max(1.0, 2.0 * verdict.seconds);
    const std::string path = pathIn(options_.shrink_to, drawn);
    std::ofstream(path) << write(shrink(drawn, rigour));
    std::printf("  shrunk to %s\n", path.c_str());
  }

  long heard() const { return heard_; }
  long failed() const { return failed_; }

 private:
  static std::string pathIn(const std::string& folder, const Drawn& drawn) {
    return folder + "/" + kindName(drawn.kind) + "_" + std::to_string(drawn.seed) + ".yaml";
  }
  void record(const Drawn& drawn, const TrialVerdict& v) {
    if (!csv_.is_open()) return;
    csv_ << kindName(drawn.kind) << ',' << drawn.seed << ',' << toString(drawn.scene.solver.method) << ','
         << partsOf(drawn) << ',' << drawn.scene.cloth.rows << ',' << columnsOf(drawn.scene) << ',' << v.frames << ','
         << v.substeps << ',' << v.rejected << ',' << v.sweeps << ',' << v.last_resort << ',' << v.stops << ','
         << v.momentum_cut << ',' << v.max_solves << ',' << v.stretch << ',' << v.energy_gain << ',' << v.energy_finer
         << ',' << v.brute_forced << ',' << v.crossings << ',' << v.crossings_excused << ',' << v.links_excused << ','
         << v.energy_judged << ',' << v.obstacles << ',' << v.obstacles_excused << ',' << v.seconds << ',' << v.slowest
         << ',' << v.holds() << '\n';
    csv_.flush();
  }

  const Options& options_;
  std::ofstream csv_;
  long heard_ = 0, failed_ = 0;
};

std::string contentsOf(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot read " + path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace

int main(int argc, char** argv) try {
  const Options options = parse(argc, argv);
  Session session(options);
  for (const std::string& path : options.cases) session.hear(readTrial(contentsOf(path)), path);
  constexpr Kind kKinds[] = {Kind::kEveryday, Kind::kWild, Kind::kSudden};
  for (int k = 0; k < 3; ++k) {
    std::uint64_t seed = options.first;
    for (long n = 0; n < options.count[k]; ++seed) {
      const Drawn drawn = draw(kKinds[k], seed);
      if (drawn.scene.cloth.rows * columnsOf(drawn.scene) > options.max_nodes) continue;
      session.hear(drawn, std::string(kindName(kKinds[k])) + " " + std::to_string(seed));
      ++n;
    }
  }
  std::printf("%ld of %ld hold\n", session.heard() - session.failed(), session.heard());
  return session.failed() == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << "curtain_judge: " << error.what() << "\n";
  return 2;
}
