// SPDX-License-Identifier: BSD-3-Clause
//
// curtain_cost FEATURE off|idle|active: makes the feature's frames and says what came of them. Small, for it runs under
// callgrind, which counts what weighedFrame() does.
#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <exception>

#include "bench/cost/features.h"

using curtain_bench::Feature;
using curtain_bench::FeatureState;
using curtain_bench::Play;

// By its name, without C++'s, for callgrind.
extern "C" __attribute__((noinline)) void weighedFrame(curtain::Simulator& simulator, Play& play) {
  if (play.each_frame) play.each_frame(simulator);
  simulator.step();
}

namespace {

void runFrames(const Feature& feature, FeatureState state) {
  Play play = feature.play(state);
  curtain::Simulator simulator(play.scene);
  for (int frame = 0; frame < feature.warm_up; ++frame) simulator.step();
  const auto before = simulator.statistics().substeps;
  std::vector<double> ns;
  for (int frame = 0; frame < feature.frames; ++frame) {
    const auto begin = std::chrono::steady_clock::now();
    weighedFrame(simulator, play);
    ns.push_back(std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count());
  }
  std::nth_element(ns.begin(), ns.begin() + feature.frames / 2, ns.end());
  const double median = ns[static_cast<std::size_t>(feature.frames) / 2];
  std::printf("ns: %.4f\nsubsteps: %.4f\nhash: %016" PRIx64 "\n", median / feature.nodes,
              static_cast<double>(simulator.statistics().substeps - before) / feature.frames, simulator.stateHash());
}

}  // namespace

int main(int count, char** words) {
  try {
    for (const FeatureState state : {FeatureState::kOff, FeatureState::kIdle, FeatureState::kActive}) {
      if (count != 3 || curtain_bench::stateName(state) != std::string(words[2])) continue;
      const std::string name = words[1];
      const Feature& feature = curtain_bench::featureOf(name);
      if (!feature.has(state)) break;
      runFrames(feature, state);
      return 0;
    }
    std::fprintf(stderr, "usage: curtain_cost FEATURE off|idle|active\nfeatures:\n");
    for (const Feature& feature : curtain_bench::features()) std::fprintf(stderr, "  %s\n", feature.name.c_str());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "curtain_cost: %s\n", error.what());
    return 1;
  }
}
