// SPDX-License-Identifier: BSD-3-Clause
//
// Where the time of a frame goes: Statistics::stage_seconds on the scenes that ship and on the two test scenes.
#include <cmath>

#include "bench/chain.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"

namespace curtain_bench {
namespace {

struct NamedScene {
  std::string name;
  curtain::Scene scene;
};

std::vector<NamedScene> scenesOfStages() {
  std::vector<NamedScene> scenes;
  for (const char* name : {"curtain", "flag", "skirt", "parachute", "sheet"}) {
    const auto reading = curtain::readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/config/scenes/" + name + ".yaml");
    if (!reading.problems.empty()) throw std::runtime_error(curtain::describe(reading.problems));
    scenes.push_back({name, reading.scene});
  }
  const double pi = std::acos(-1.0);
  scenes.push_back({"swing", chainScene(43, 0.25 * pi)});
  curtain::Scene corners = chainScene(43, 0.5 * pi);
  corners.cloth.height = 1.0;
  corners.hang.to = curtain::Vec3(0.9, 0.0, 0.0);
  corners.pins.kind = curtain::PinKind::kTopCorners;
  scenes.push_back({"two corners", corners});
  return scenes;
}

}  // namespace

void studyStages(const Options& options) {
  const int frames = options.quick ? 120 : 300;
  Table table(options.folder, "stages.csv", {"scene", "stage", "ms_per_frame", "share"});
  for (const NamedScene& named : scenesOfStages()) {
    curtain::Simulator simulator(named.scene);
    for (int frame = 0; frame < frames; ++frame) simulator.step();
    const curtain::Statistics& statistics = simulator.statistics();
    double sum = 0.0;
    for (const double seconds : statistics.stage_seconds) sum += seconds;
    for (int s = 0; s < curtain::kStageCount; ++s) {
      const double seconds = statistics.stage_seconds[static_cast<std::size_t>(s)];
      table.row({named.name, curtain::stageName(static_cast<curtain::Stage>(s)), number(1e3 * seconds / frames),
                 number(seconds / sum)});
    }
  }
}

}  // namespace curtain_bench
