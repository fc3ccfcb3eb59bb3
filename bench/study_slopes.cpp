// SPDX-License-Identifier: BSD-3-Clause
//
// The order of our methods as observed: how much the swing's error goes down when the substeps are doubled.
#include <cmath>

#include "bench/chain.h"
#include "bench/line_up.h"
#include "bench/measure.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/scene.h"

namespace curtain_bench {

void studySlopes(const Options& options) {
  constexpr int kFrames = 60;
  constexpr double kBudget = 20.0;  // [s]
  const curtain::Scene scene = chainScene(43, 0.25 * 3.14159265358979323846);
  const ClothStart start = clothStart(scene);
  const Points truth = chainTruth(start, 45, 1.0);
  Table table(options.folder, "slopes.csv", {"method", "substeps", "error_m", "order"});
  for (const std::string& method : curtain::methodNames()) {
    double last = std::nan("");
    for (int substeps = 1; substeps <= (options.quick ? 32 : 128); substeps *= 2) {
      const auto contestant = ourEntry(method, substeps).make(scene, start);
      const Run made = run(start, *contestant, kFrames, kBudget);
      const double error = made.sound && !made.cut ? rmsDistance(start, made.end, truth) : std::nan("");
      table.row({method, number(substeps), number(error), number(std::log2(last / error))});
      last = error;
    }
  }
}

}  // namespace curtain_bench
