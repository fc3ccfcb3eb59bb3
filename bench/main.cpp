// SPDX-License-Identifier: BSD-3-Clause
//
// curtain_bench: runs the studies named on the command line, or all.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "bench/rivals/rivals.h"
#include "bench/studies.h"
#include "curtain_sim/scene.h"

namespace curtain_bench {

const std::vector<Study>& studies() {
  static const std::vector<Study> all = {{"work_precision", studyWorkPrecision},
                                         {"slopes", studySlopes},
                                         {"energy", studyEnergy},
                                         {"modes", studyModes},
                                         {"nets", studyNets},
                                         {"wind", studyWind},
                                         {"hard_spot", studyHardSpot},
                                         {"gusts", studyGusts},
                                         {"scaling", studyScaling},
                                         {"stages", studyStages},
                                         {"contact", studyContact},
                                         {"contact_frames", studyContactFrames},
                                         {"contact_peers", studyContactPeers},
                                         {"gathered", studyGathered},
                                         {"fabric", studyFabric},
                                         {"closed_forms", studyClosedForms},
                                         {"ccd", studyCcd},
                                         {"features", studyFeatures},
                                         {"sensing", studySensing}};
  return all;
}

namespace {

int usage() {
  std::fprintf(
      stderr,
      "usage: curtain_bench [--out FOLDER] [--quick] [--repeats N] [--scene PART] [--bullet] [--methods] [--studies] "
      "[STUDY…]\nstudies:");
  for (const Study& study : studies()) std::fprintf(stderr, " %s", study.name.c_str());
  std::fprintf(stderr, "\n");
  return 2;
}

void runStudy(const Study& study, const Options& options) {
  const auto begin = std::chrono::steady_clock::now();
  study.run(options);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::fprintf(stderr, "%s: done in %.0f s\n", study.name.c_str(), seconds);
}

int benchMain(int count, char** words) {
  Options options;
  std::vector<const Study*> chosen;
  for (int w = 1; w < count; ++w) {
    const std::string word = words[w];
    if (word == "--quick") {
      options.quick = true;
    } else if (word == "--bullet") {
      std::printf("%s\n", bulletDescription().c_str());
      return 0;
    } else if (word == "--methods") {
      for (const std::string& method : curtain::methodNames()) std::printf("%s ", method.c_str());
      std::printf("\n");
      return 0;
    } else if (word == "--studies") {
      for (const Study& study : studies()) std::printf("%s\n", study.name.c_str());
      return 0;
    } else if (word == "--out" && w + 1 < count) {
      options.folder = words[++w];
    } else if (word == "--scene" && w + 1 < count) {
      options.scene = words[++w];
    } else if (word == "--repeats" && w + 1 < count) {
      options.repeats = std::atoi(words[++w]);
      if (options.repeats < 1) return usage();
    } else {
      const std::size_t before = chosen.size();
      for (const Study& study : studies()) {
        if (study.name == word) chosen.push_back(&study);
      }
      if (chosen.size() == before) return usage();
    }
  }
  if (chosen.empty()) {
    for (const Study& study : studies()) chosen.push_back(&study);
  }
  for (const Study* const study : chosen) runStudy(*study, options);
  return 0;
}

}  // namespace
}  // namespace curtain_bench

int main(int count, char** words) {
  try {
    return curtain_bench::benchMain(count, words);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "curtain_bench: %s\n", error.what());
    return 1;
  }
}
