// SPDX-License-Identifier: BSD-3-Clause
//
// The gathered curtain of config/scenes/curtain.yaml without contact, in its gusting fan and in the same fan without
// gusts: time a frame, and how far a run is from our finest one as time goes on. Ours only: the rivals have no wind.
#include <algorithm>
#include <cmath>

#include "bench/line_up.h"
#include "bench/measure.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"

namespace curtain_bench {
namespace {

curtain::Scene curtainScene(bool gusts) {
  const auto reading = curtain::readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/config/scenes/curtain.yaml");
  if (!reading.problems.empty()) throw std::runtime_error(curtain::describe(reading.problems));
  curtain::Scene scene = reading.scene;
  scene.obstacles.clear();
  scene.contact.self = false;
  if (!gusts) {
    for (curtain::WindParams& wind : scene.wind) wind.unsteadiness = 0.0;
  }
  return scene;
}

// The simulator's start is all that is needed of it: masses and pins, for the distance.
ClothStart startOf(curtain::Scene scene) {
  scene.wind.clear();
  return clothStart(scene);
}

void compare(const std::string& name, const curtain::Scene& scene, const Options& options, Table& figures,
             Table& motion) {
  const ClothStart start = startOf(scene);
  const int frames = options.quick ? 120 : 300;
  const int finest = options.quick ? 64 : 256;
  curtain::Scene fine = scene;
  fine.solver.method = curtain::Method::kLeapfrog;
  fine.solver.substeps = finest;
  fine.solver.stretch_tolerance = 1e-6;
  fine.solver.max_sweeps = 1000;
  std::vector<Points> reference;
  const auto finest_run = makeOurs(fine);
  run(start, *finest_run, frames, 120.0,
      [&](int, const Contestant&, const Points& positions) { reference.push_back(positions); });
  const std::vector<Entry> entries = ourEntries({4, 8, 16, 32, 64});
  std::vector<Run> runs(entries.size());
  std::vector<std::vector<double>> medians(entries.size());
  for (int repeat = 0; repeat < std::min(options.repeats, 3); ++repeat) {
    for (std::size_t e = 0; e < entries.size(); ++e) {
      const auto contestant = entries[e].make(scene, start);
      runs[e] = run(start, *contestant, frames, 60.0, [&](int frame, const Contestant&, const Points& positions) {
        if (repeat > 0 || frame % 3 != 0 || frame > static_cast<int>(reference.size())) return;
        const double error = rmsDistance(start, positions, reference[static_cast<std::size_t>(frame - 1)]);
        motion.row({name, entries[e].method, entries[e].setting, number(frame * start.frame_seconds), number(error)});
      });
      medians[e].push_back(runs[e].frame_median);
    }
  }
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const Run& made = runs[e];
    figures.row({name, entries[e].method, entries[e].setting,
                 number(*std::min_element(medians[e].begin(), medians[e].end())), number(median(medians[e])),
                 number(made.frame_max), number(made.sound ? made.stretch : std::nan("")),
                 number(static_cast<double>(made.substeps) / made.frames)});
  }
}

}  // namespace

void studyGusts(const Options& options) {
  Table figures(options.folder, "gusts.csv",
                {"wind", "method", "setting", "ms_min", "ms_median", "ms_max", "stretch", "substeps"});
  Table motion(options.folder, "gusts_motion.csv", {"wind", "method", "setting", "t_s", "error_m"});
  compare("steady", curtainScene(false), options, figures, motion);
  compare("gusts", curtainScene(true), options, figures, motion);
}

}  // namespace curtain_bench
