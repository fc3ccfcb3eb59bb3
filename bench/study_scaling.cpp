// SPDX-License-Identifier: BSD-3-Clause
//
// Time of a 60 Hz frame against the number of nodes: at one shape of grid, with the width alone growing, with the rows
// alone growing. Scenes: the swing, and the gathered curtain in its fan (without the ball) for ours alone.
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "bench/chain.h"
#include "bench/line_up.h"
#include "bench/measure.h"
#include "bench/rivals/rivals.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "bench/threads.h"
#include "curtain_sim/scene_yaml.h"

namespace curtain_bench {
namespace {

struct Size {
  const char* series;
  int rows;
  int columns;
};

const std::vector<Size> kSizes = {
    {"both", 16, 15},     {"both", 44, 40},      {"both", 112, 90},   {"both", 400, 250},
    {"both", 1000, 1000}, {"columns", 44, 10},   {"columns", 44, 40}, {"columns", 44, 160},
    {"columns", 44, 640}, {"columns", 44, 2560}, {"rows", 11, 40},    {"rows", 22, 40},
    {"rows", 44, 40},     {"rows", 88, 40},      {"rows", 176, 40},   {"rows", 352, 40}};

curtain::Scene sceneOf(const std::string& name, const Size& size) {
  curtain::Scene scene = chainScene(size.rows - 1, 0.25 * std::acos(-1.0));
  if (name == "curtain") {
    const auto reading = curtain::readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/config/scenes/curtain.yaml");
    if (!reading.problems.empty()) throw std::runtime_error(curtain::describe(reading.problems));
    scene = reading.scene;
    scene.obstacles.clear();
  }
  scene.cloth.rows = size.rows;
  scene.cloth.columns = size.columns;
  return scene;
}

// Rivals at about the swing's error of a few millimetres at 44 rows.
std::vector<Entry> rivalsOfScaling() {
  std::vector<Entry> entries;
  const auto add = [&entries](const char* method, const char* setting, auto make) {
    entries.push_back({method, setting, make, true});
  };
  using curtain::Scene;
  add("symplectic Euler", "substeps 64; dt*omega 1.8; dashpot 0", [](const Scene&, const ClothStart& start) {
    return makeSymplecticEuler(start, {64, 1.8, 0.0});
  });
  add("XPBD", "substeps 64; iterations 1; compliance 0 m/N", [](const Scene&, const ClothStart& start) {
    return makeXpbd(start, {64, 1, 0.0});
  });
  add("Baraff-Witkin", "substeps 16; stiffness 1000 N/m; tolerance 0.001", [](const Scene&, const ClothStart& start) {
    return makeBaraffWitkin(start, {16, 1e3, 1e-3, 400});
  });
  if (bulletInstalled()) {
    add("btSoftBody", "substeps 16; piterations 3; viterations 0", [](const Scene&, const ClothStart& start) {
      return makeBullet(start, {16, 3, 0});
    });
  }
  return entries;
}

// Of this process [bytes].
double resident() {
  std::ifstream pages("/proc/self/statm");
  double all = 0.0, here = 0.0;
  pages >> all >> here;
  return here * static_cast<double>(sysconf(_SC_PAGESIZE));
}

// What a simulator holds after its first frame, over the nodes [bytes].
double bytesOfNode(const curtain::Scene& scene, const ClothStart& start) {
  malloc_trim(0);
  const double before = resident();
  const auto contestant = makeOurs(scene);
  contestant->frame();
  return (resident() - before) / static_cast<double>(start.count());
}

struct Racer {
  Entry entry;
  int threads = 1;
  std::vector<double> medians;  // [ms] of the frames of each repeat
  Run last;
};

// 60 frames, or as many as 3 s of computing allow; twice, in turns: a median of frames is steady.
void race(const std::string& name, const Size& size, std::vector<Racer>& racers, const Options& options, Table& table) {
  const curtain::Scene scene = sceneOf(name, size);
  curtain::Scene still = scene;
  still.wind.clear();  // clothStart() knows none; the places and masses are the same
  const ClothStart start = clothStart(still);
  const double budget = options.quick ? 1.0 : 3.0;  // [s]
  const double bytes = bytesOfNode(scene, start);
  for (int repeat = 0; repeat < std::min(options.repeats, 2); ++repeat) {
    for (Racer& racer : racers) {
      curtain::Scene with_threads = scene;
      setThreads(with_threads, racer.threads);
      const auto contestant = racer.entry.make(with_threads, start);
      racer.last = run(start, *contestant, 60, budget);
      racer.medians.push_back(racer.last.frame_median);
    }
  }
  for (const Racer& racer : racers) {
    const Run& made = racer.last;
    table.row({name, size.series, racer.entry.method, racer.entry.setting, number(racer.threads), number(size.rows),
               number(size.columns), number(size.rows * size.columns),
               number(*std::min_element(racer.medians.begin(), racer.medians.end())), number(median(racer.medians)),
               number(made.frame_max), number(made.sound ? made.stretch : std::nan("")),
               number(static_cast<double>(made.substeps) / made.frames), number(made.frames), number(bytes)});
  }
}

}  // namespace

void studyScaling(const Options& options) {
  Table table(options.folder, "scaling.csv",
              {"scene", "series", "method", "setting", "threads", "rows", "columns", "nodes", "ms_min", "ms_median",
               "ms_max", "stretch", "substeps", "frames", "our_bytes_a_node"});
  for (const char* name : {"swing", "curtain"}) {
    for (const Size& size : kSizes) {
      const bool shape = std::string(size.series) == "both";
      if (options.quick && (!shape || size.rows > 200)) continue;
      std::vector<Racer> racers;
      for (const std::string& method : curtain::methodNames()) {
        if (method == "paper") continue;  // its cost is known from work_precision, its motion is not one to scale
        if (size.rows == 1000 && method != "auto") continue;
        for (const int threads : threadCounts()) {
          racers.push_back({ourEntry(method, 0), threads, {}, {}});
        }
      }
      if (shape && size.rows < 1000 && name == std::string("swing")) {
        for (Entry& entry : rivalsOfScaling()) racers.push_back({std::move(entry), 1, {}, {}});
      }
      race(name, size, racers, options, table);
      std::fprintf(stderr, "scaling %s %dx%d done\n", name, size.rows, size.columns);
    }
  }
}

}  // namespace curtain_bench
