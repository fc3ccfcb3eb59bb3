// SPDX-License-Identifier: BSD-3-Clause
//
// What each feature costs: without it, with it in vain, at work. Instructions once, for they repeat; times in turns,
// the least of the repeats.
#include <algorithm>
#include <array>
#include <stdexcept>

#include "bench/cost/weigh.h"
#include "bench/studies.h"
#include "bench/table.h"

namespace curtain_bench {
namespace {

constexpr std::array<FeatureState, 3> kStates = {FeatureState::kOff, FeatureState::kIdle, FeatureState::kActive};

}  // namespace

void studyFeatures(const Options& options) {
  Table table(
      options.folder, "features.csv",
      {"feature", "state", "what", "instructions", "instructions_per_substep", "substeps", "ns_min", "same_motion"});
  for (const Feature& feature : features()) {
    std::array<double, 3> ns;
    ns.fill(std::numeric_limits<double>::infinity());
    for (int repeat = 0; repeat < options.repeats; ++repeat) {
      for (std::size_t s = 0; s < kStates.size(); ++s) {
        if (feature.has(kStates[s])) ns[s] = std::min(ns[s], clockOf(feature, kStates[s]).ns);
      }
    }
    std::string off_hash;
    for (std::size_t s = 0; s < kStates.size(); ++s) {
      if (!feature.has(kStates[s])) continue;
      const Weight weight = weigh(feature, kStates[s]);
      if (kStates[s] == FeatureState::kOff) off_hash = weight.state_hash;
      const std::string& what = kStates[s] == FeatureState::kIdle ? feature.idle_is : feature.active_is;
      table.row({feature.name, stateName(kStates[s]), kStates[s] == FeatureState::kOff ? "without" : what,
                 number(weight.instructions, 6),
                 weight.substeps > 0.0 ? number(weight.instructions / weight.substeps, 6) : "", number(weight.substeps),
                 number(ns[s]), weight.state_hash == off_hash ? "yes" : "no"});
    }
  }
}

}  // namespace curtain_bench
