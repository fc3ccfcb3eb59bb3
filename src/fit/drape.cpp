// SPDX-License-Identifier: BSD-3-Clause
#include "fit/drape.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <stdexcept>
#include <thread>

#include "fit/sample.h"
#include "fit/settling.h"
#include "fit/shadow.h"
#include "scene/pi.h"
#include "scene/splitmix.h"

namespace curtain_fit {
namespace {

using curtain::ClothPattern;
using curtain::Field3;
using curtain::Grid;
using curtain::Scene;
using curtain::Vec3;

// A start's heights: so many waves over the sample, each so high at the rim [m], as long as folds may be [m]. The same
// on every grid, and links keep their lengths.
constexpr int kWaves = 8;
constexpr double kWaveHeight = 1e-4, kShortest = 0.06, kLongest = 0.3;

// Share of the energy that the overhang could lose, below which motion is over: speeds of 0.3 mm/s.
constexpr double kStill = 1e-7;

// Numbers in [0, 1), by splitmix64.
class Randoms {
 public:
  explicit Randoms(std::uint64_t seed) : seed_(curtain::splitmix(seed)) {}
  double next() { return std::ldexp(static_cast<double>(curtain::splitmix(seed_ + count_++) >> 11), -53); }

 private:
  std::uint64_t seed_, count_ = 0;
};

// Makes what is not held uneven.
void makeUneven(const ClothPattern& pattern, std::uint64_t seed, Field3& position) {
  const Grid& grid = pattern.grid;
  Randoms random(seed);
  for (int wave = 0; wave < kWaves; ++wave) {
    const double direction = 2.0 * curtain::kPi * random.next(), phase = 2.0 * curtain::kPi * random.next();
    const double length = kShortest * std::pow(kLongest / kShortest, random.next());
    const Vec3 along = 2.0 * curtain::kPi / length * Vec3(std::cos(direction), std::sin(direction), 0.0);
    for (int i = 0; i < grid.rows; ++i) {
      for (int j = 0; j < grid.columns; ++j) {
        const std::size_t n = grid.index(i, j);
        if (pattern.pinned[n] != curtain::kFree) continue;
        const Vec3 place = flatPlace(grid, i, j);
        const double out = (place.norm() - kDiscRadius) / (kSampleRadius - kDiscRadius);
        position.z[n] += kWaveHeight * out * std::sin(along.dot(place) + phase);
      }
    }
  }
}

DrapeReading sink(const Scene& scene, std::uint64_t seed, double longest) {
  const ClothPattern pattern = roundSample(scene);
  Settling sample(scene, pattern);
  makeUneven(pattern, seed, sample.position());
  double mass = 0.0;
  for (const double m : pattern.mass) mass += m;
  const double still = kStill * mass * scene.gravity.norm() * (kSampleRadius - kDiscRadius);
  DrapeReading reading;
  while (!reading.at_rest && sample.time() < longest) {
    sample.step();
    reading.at_rest = sample.kinetic() < still;
  }
  reading.seconds = sample.time();
  reading.coefficient = drapeCoefficient(pattern, sample.position());
  constexpr int kPoints = 720;
  const std::vector<Vec3> rim = rimOf(pattern.grid, sample.position(), kPoints);
  reading.folds = countFolds(rim);
  const auto height = [&](int degrees) { return rim[static_cast<std::size_t>(kPoints / 360 * degrees)].z(); };
  reading.weft_height = 0.5 * (height(0) + height(180));
  reading.warp_height = 0.5 * (height(90) + height(270));
  return reading;
}

}  // namespace

std::vector<DrapeReading> drape(const curtain::ClothParams& cloth, const DrapeTest& test) {
  Scene scene = sheetOf(cloth, test.nodes);
  scene.solver.method = test.method;
  scene.solver.substeps = test.substeps;
  scene.solver.threads = 1;
  const std::vector<curtain::Problem> problems = validate(scene);
  if (!problems.empty()) throw std::invalid_argument(describe(problems));
  std::vector<DrapeReading> readings(static_cast<std::size_t>(test.starts));
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::future<void>> runs;
  for (std::size_t core = 0; core < std::min(cores, readings.size()); ++core) {
    runs.push_back(std::async(std::launch::async, [&, core] {
      for (std::size_t k = core; k < readings.size(); k += cores)
        readings[k] = sink(scene, test.seed + k, test.longest);
    }));
  }
  for (std::future<void>& run : runs) run.get();
  return readings;
}

DrapeSummary summaryOf(const std::vector<DrapeReading>& readings) {
  DrapeSummary summary;
  const auto count = static_cast<double>(readings.size());
  for (const DrapeReading& reading : readings) {
    summary.mean += reading.coefficient / count;
    summary.folds += reading.folds / count;
  }
  for (const DrapeReading& reading : readings) summary.spread += std::pow(reading.coefficient - summary.mean, 2.0);
  summary.spread = count > 1.0 ? std::sqrt(summary.spread / (count - 1.0)) : 0.0;
  return summary;
}

}  // namespace curtain_fit
