// SPDX-License-Identifier: BSD-3-Clause
//
// What frames take of scenes in which cloth touches itself and others: the median, the slowest of a hundred, the
// slowest.
#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "bench/contact_scenes.h"
#include "bench/measure.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"

namespace curtain_bench {
namespace {

using curtain::Scene;

constexpr double kLong = 60.0;  // of computing [s]: a run that takes longer is not repeated

struct Case {
  std::string name;
  Scene scene;
  int first, last;  // frames that count
};

Scene shipped(const std::string& name) {
  auto reading = curtain::readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/config/scenes/" + name + ".yaml");
  if (!reading.problems.empty()) throw std::runtime_error(curtain::describe(reading.problems));
  reading.scene.solver.threads = 1;
  return reading.scene;
}

Scene onThreads(Scene scene, int threads) {
  scene.solver.threads = threads;
  return scene;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const char* name : {"flag", "curtain", "skirt", "sheet", "parachute"}) {
    all.push_back({name, shipped(name), 0, 600});
  }
  const auto addBoth = [&](const std::string& name, const Scene& scene, int first, int last) {
    all.push_back({name + ", one core", scene, first, last});
    all.push_back({name + ", two cores", onThreads(scene, 2), first, last});
  };
  all.push_back({"gathered and blown 44 x 40", touchingItself(blown(curtainOf(44, 40, 0.6, 0.0))), 0, 240});
  addBoth("gathered and blown 105 x 96", touchingItself(blown(curtainOf(105, 96, 0.6, 0.0))), 0, 240);
  addBoth("gathered and blown 105 x 96 without contact", blown(curtainOf(105, 96, 0.6, 0.0)), 0, 240);
  const auto windy = [](int rows, int columns) {
    return touchingItself(with(inSteadyWind(curtainOf(rows, columns, 0.6, 0.0)), swingingBall()));
  };
  all.push_back({"gathered in steady wind with a ball 44 x 40", windy(44, 40), 0, 240});
  addBoth("gathered in steady wind with a ball 105 x 96", windy(105, 96), 0, 240);
  for (const bool bumpy : {false, true}) {
    const std::string name = std::string("over a mesh 105 x 96, ") + (bumpy ? "bumpy" : "smooth");
    addBoth(name + ", settling", draped(105, 96, bumpy), 0, 120);
    addBoth(name + ", settled", draped(105, 96, bumpy), 360, 420);
  }
  all.push_back({"heap 44 x 40", touchingItself(falling(44, 40)), 60, 240});
  for (const double speed : {5.0, 20.0}) {
    const std::string at = " at " + std::to_string(static_cast<int>(speed)) + " m/s";
    const Scene hanging = touchingItself(dampedBy(curtainOf(44, 40, 1.0, 0.0), 0.2));
    all.push_back({"ball through it" + at, with(hanging, ballShotAt(speed)), 0, 90});
    all.push_back({"plate through it" + at, with(hanging, plateShotAt(speed)), 0, 90});
  }
  for (const auto& [rows, columns] : {std::pair(33, 30), {105, 96}, {333, 300}}) {
    const std::string name = "gathered and blown, size " + std::to_string(rows) + " x " + std::to_string(columns);
    all.push_back({name, touchingItself(blown(curtainOf(rows, columns, 0.6, 0.0))), 30, 60});
  }
  return all;
}

void measure(const Case& one, int repeats, Table& table) {
  std::vector<double> medians, late, longest;
  double frames = 0.0, substeps = 0.0, sweeps = 0.0;
  int contacts = 0;
  double seconds = 0.0;
  for (int repeat = 0; repeat < repeats && seconds < kLong; ++repeat) {
    curtain::Simulator simulator(one.scene);
    const curtain::Statistics& now = simulator.statistics();
    std::vector<double> ms;
    for (int frame = 0; frame < one.last; ++frame) {
      const curtain::Statistics before = now;
      simulator.step();
      seconds += now.step_seconds;
      if (frame < one.first) continue;
      ms.push_back(1e3 * now.step_seconds);
      frames += 1.0;
      substeps += static_cast<double>(now.substeps - before.substeps);
      sweeps += static_cast<double>(now.sweeps - before.sweeps);
    }
    contacts = now.contacts_max;
    std::sort(ms.begin(), ms.end());
    medians.push_back(median(ms));
    late.push_back(ms[ms.size() - 1 - ms.size() / 100]);
    longest.push_back(ms.back());
  }
  const auto least = [](const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); };
  table.row({one.name, number(least(medians)), number(median(medians)), number(least(late)), number(least(longest)),
             number(substeps / frames), number(sweeps / frames), number(contacts)});
  std::fprintf(stderr, "%-60s %8.3f ms, 99 %% %8.3f, longest %8.2f, %5.2f substeps, %6.2f sweeps, %d contacts\n",
               one.name.c_str(), least(medians), least(late), least(longest), substeps / frames, sweeps / frames,
               contacts);
}

}  // namespace

void studyContactFrames(const Options& options) {
  std::vector<std::string> columns{"scene",          "ms_median_min", "ms_median_median", "ms_99_min",
                                   "ms_longest_min", "substeps",      "sweeps",           "contacts"};
  // Names hold commas: the table's cells may not.
  Table table(options.folder, "contact_frames.csv", columns);
  for (Case& one : cases()) {
    if (one.name.find(options.scene) == std::string::npos) continue;
    std::replace(one.name.begin(), one.name.end(), ',', ';');
    if (options.quick && (one.first > 60 || one.scene.cloth.rows > 200)) continue;  // minutes each
    if (options.quick) one.last = std::min(one.last, one.first + 30);
    measure(one, options.quick ? 1 : std::min(options.repeats, 2), table);
  }
}

}  // namespace curtain_bench
