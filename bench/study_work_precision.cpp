// SPDX-License-Identifier: BSD-3-Clause
//
// Error after one second against computing time, everyone on the same scenes. First every setting runs once; then the
// settings that are the best of their method at some time (or nearly) run again, round robin, so that a slow minute of
// the machine falls on all of them.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/chain.h"
#include "bench/line_up.h"
#include "bench/measure.h"
#include "bench/studies.h"
#include "bench/table.h"

namespace curtain_bench {
namespace {

constexpr double kSeconds = 1.0;  // simulated
constexpr double kBudget = 3.0;   // [s] of computing for them: who needs more is out of the race
constexpr double kPi = 3.14159265358979323846;

struct Course {
  std::string name;
  int rods;
  int degrees;
};

struct Result {
  const Entry* entry = nullptr;
  double error = std::nan("");
  Run first;
  std::vector<double> times;  // [ms] of all runs
  bool front = false;

  double least() const { return *std::min_element(times.begin(), times.end()); }
};

Run runOnce(const Entry& entry, const curtain::Scene& scene, const ClothStart& start) {
  const auto contestant = entry.make(scene, start);
  return run(start, *contestant, static_cast<int>(std::lround(kSeconds * scene.solver.frame_rate)), kBudget);
}

// True: no other setting of the method is truer in less time. With `doubt` above 1 a setting is kept that a time so
// much more or less would put there, unless another one is much truer for the same time.
bool onFront(const Result& result, const std::vector<Result>& all, double doubt) {
  if (!std::isfinite(result.error)) return false;
  return std::none_of(all.begin(), all.end(), [&](const Result& other) {
    if (other.entry->method != result.entry->method) return false;
    const bool beaten = other.error < result.error && doubt * other.least() < result.least();
    const bool far_beaten = doubt * other.error < result.error && other.least() < result.least() * std::sqrt(doubt);
    return beaten || far_beaten;
  });
}

std::vector<Result> sweep(const std::vector<Entry>& entries, const curtain::Scene& scene, const ClothStart& start,
                          const Points& truth) {
  std::vector<Result> results;
  for (const Entry& entry : entries) {
    Result result;
    result.entry = &entry;
    result.first = runOnce(entry, scene, start);
    if (result.first.cut) continue;
    if (result.first.sound) result.error = rmsDistance(start, result.first.end, truth);
    result.times.push_back(result.first.ms);
    results.push_back(std::move(result));
  }
  return results;
}

void race(const Course& course, const std::vector<Entry>& entries, const Options& options, Table& table) {
  const curtain::Scene scene = chainScene(course.rods, course.degrees * kPi / 180.0);
  const ClothStart start = clothStart(scene);
  std::vector<Result> results = sweep(entries, scene, start, chainTruth(start, course.degrees, kSeconds));
  constexpr double kNearly = 1.3;  // a single run's time is that uncertain
  std::vector<Result*> again;
  for (Result& result : results) {
    if (onFront(result, results, kNearly)) again.push_back(&result);
  }
  for (int repeat = 1; repeat < options.repeats; ++repeat) {
    for (Result* const result : again) result->times.push_back(runOnce(*result->entry, scene, start).ms);
  }
  for (const Result& result : results) {
    table.row({course.name, result.entry->method, result.entry->setting, number(result.error),
               number(result.first.sound ? result.first.stretch : std::nan("")), number(result.least()),
               number(median(result.times)), number(static_cast<int>(result.times.size())),
               onFront(result, results, 1.0) ? "1" : "0"});
  }
  std::fprintf(stderr, "work_precision %s: %zu settings, %zu of them on fronts\n", course.name.c_str(), results.size(),
               again.size());
}

}  // namespace

void studyWorkPrecision(const Options& options) {
  std::vector<Entry> entries = ourEntries({1, 2, 4, 8, 16, 32, 64});
  for (Entry& entry : rivalEntries(options.quick)) entries.push_back(std::move(entry));
  Table table(options.folder, "work_precision.csv",
              {"scene", "method", "setting", "error_m", "stretch", "ms_min", "ms_median", "runs", "front"});
  race({"swing", 43, 45}, entries, options, table);
  race({"drop", 10, 90}, entries, options, table);
  std::vector<Entry> fewer = ourEntries({1, 2, 4, 8, 16, 32, 64});
  for (Entry& entry : rivalEntries(true)) fewer.push_back(std::move(entry));
  Options twice = options;
  twice.repeats = std::min(options.repeats, 3);
  for (const int rods : {1, 2, 5, 10, 20}) {
    if (options.quick && rods != 5) continue;
    race({"chain_" + std::to_string(rods), rods, 45}, fewer, twice, table);
  }
}

}  // namespace curtain_bench
