// SPDX-License-Identifier: BSD-3-Clause
//
// What contact costs: scenes of 44 x 40 nodes with and without it, made frame by frame in turns on one core.
#include <algorithm>

#include "bench/contact_scenes.h"
#include "bench/measure.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/simulator.h"

namespace curtain_bench {
namespace {

using curtain::Scene;

// The medians of one run's frames from `first` on [ms], without and with.
void compare(const std::string& name, const Scene& without, const Scene& with_it, int first, int last, int repeats,
             Table& table) {
  std::vector<double> off, on, ratio;
  double worst = 0.0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    curtain::Simulator a(without), b(with_it);
    std::vector<double> frames_a, frames_b;
    for (int frame = 0; frame < last; ++frame) {
      a.step();
      b.step();
      if (frame < first) continue;
      frames_a.push_back(1e3 * a.statistics().step_seconds);
      frames_b.push_back(1e3 * b.statistics().step_seconds);
      worst = std::max(worst, frames_b.back());
    }
    off.push_back(median(frames_a));
    on.push_back(median(frames_b));
    ratio.push_back(on.back() / off.back());
  }
  table.row({name, number(*std::min_element(off.begin(), off.end())), number(*std::min_element(on.begin(), on.end())),
             number(*std::min_element(on.begin(), on.end()) - *std::min_element(off.begin(), off.end())),
             number(*std::min_element(ratio.begin(), ratio.end())), number(median(ratio)), number(worst)});
}

}  // namespace

void studyContact(const Options& options) {
  Table table(options.folder, "contact.csv",
              {"scene", "ms_without", "ms_with", "ms_added", "ratio_min", "ratio_median", "ms_longest"});
  const int repeats = options.quick ? 1 : options.repeats;
  const int frames = options.quick ? 60 : 240;
  const Scene swing = curtainOf(44, 40, 1.0, 0.7);
  compare("obstacle out of reach", swing, with(swing, ballAt({20.0, 0.0, 0.0})), 0, frames, repeats, table);
  compare("obstacle beside", swing, with(swing, ballAt({2.2, 0.0, 1.0})), 0, frames, repeats, table);
  const Scene hanging = dampedBy(curtainOf(44, 40, 0.8, 0.0), 0.5);
  compare("ball in it", hanging, with(hanging, ballAt({0.4, -0.2, 1.1})), 60, 60 + frames, repeats, table);
  compare("flat (itself)", swing, touchingItself(swing), 0, frames, repeats, table);
  const Scene gathered = blown(curtainOf(44, 40, 0.6, 0.0));
  compare("gathered to 60 % (itself)", gathered, touchingItself(gathered), 0, frames, repeats, table);
  compare("heap on the floor (itself)", falling(44, 40), touchingItself(falling(44, 40)), 120,
          options.quick ? 140 : 240, options.quick ? 1 : 2, table);
}

}  // namespace curtain_bench
