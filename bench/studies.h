// SPDX-License-Identifier: BSD-3-Clause
//
// The studies of the benchmark, each writing its tables into a folder.
#pragma once

#include <string>
#include <vector>

namespace curtain_bench {

struct Options {
  std::string folder = ".";  ///< where the tables go
  bool quick = false;        ///< fewer settings and sizes, shorter runs
  int repeats = 5;           ///< of the runs whose time counts
  std::string scene;         ///< contact_frames: only scenes whose name has this in it
};

struct Study {
  std::string name;
  void (*run)(const Options& options);
};

void studyWorkPrecision(const Options& options);
void studySlopes(const Options& options);
void studyEnergy(const Options& options);
void studyModes(const Options& options);
void studyNets(const Options& options);
void studyHardSpot(const Options& options);
void studyWind(const Options& options);
void studyGusts(const Options& options);
void studyScaling(const Options& options);
void studyStages(const Options& options);
void studyContact(const Options& options);
void studyContactFrames(const Options& options);
void studyGathered(const Options& options);
void studyFabric(const Options& options);
void studyClosedForms(const Options& options);
void studyContactPeers(const Options& options);
void studyCcd(const Options& options);
void studyFeatures(const Options& options);
void studySensing(const Options& options);

/// All of them, in the order of the page.
const std::vector<Study>& studies();

}  // namespace curtain_bench
