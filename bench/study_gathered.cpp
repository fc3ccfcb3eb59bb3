// SPDX-License-Identifier: BSD-3-Clause
//
// A gathered curtain that touches itself, in the wind of a fan, limp and of a fabric that shears and bends: what a
// frame takes, and how far off it is. Its motion is chaotic: paths part from those of our finest run within a second.
// So means over time are compared, too, which do not: the force of the air along the fan's axis, the folds' depth, the
// energy of motion, and how much of that is in waves across the cloth that are shorter than eight links.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/contact_scenes.h"
#include "bench/measure.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/simulator.h"
#include "scene/pi.h"

namespace curtain_bench {
namespace {

using curtain::Scene;
using curtain::Simulator;
using curtain::Vec3;

constexpr int kShortWaves = 5;                          // of 40 columns: waves of at most eight links
constexpr int kWarmUp = 180;                            // frames before means are taken
constexpr std::array<int, 4> kLooks = {6, 15, 30, 60};  // frames after which paths are compared

Scene limp() { return blown(touchingItself(curtainOf(44, 40, 0.5, 0.0))); }

// Weight, shear and bending of a light cotton.
Scene cotton() {
  Scene scene = limp();
  scene.cloth.surface_density = 0.12;
  scene.cloth.shear = 40.0;
  scene.cloth.bending_warp = scene.cloth.bending_weft = 1.2e-5;
  scene.cloth.bending_bias = 1.1e-5;
  return scene;
}

// Of one frame.
struct Sample {
  double drag = 0.0, depth = 0.0, motion = 0.0, fine = 0.0;  // [N], [m], [J], [J]
};

Sample sampleOf(const Simulator& simulator) {
  static std::vector<Vec3> nodes, velocities, forces;
  simulator.copyPositions(nodes);
  simulator.copyVelocities(velocities);
  simulator.copyForces(forces);
  const int rows = simulator.rows(), columns = simulator.columns();
  Sample sample;
  for (int i = 0; i < rows; ++i) {
    const auto first = static_cast<std::size_t>(i * columns);
    double mean = 0.0, square = 0.0;
    for (int j = 0; j < columns; ++j) mean += nodes[first + static_cast<std::size_t>(j)].y() / columns;
    for (int j = 0; j < columns; ++j) {
      const std::size_t n = first + static_cast<std::size_t>(j);
      square += (nodes[n].y() - mean) * (nodes[n].y() - mean) / columns;
      if (simulator.pinned({i, j})) continue;
      sample.drag += forces[n].y();
      sample.motion += 0.5 * simulator.mass({i, j}) * velocities[n].squaredNorm();
    }
    sample.depth += std::sqrt(square) / rows;
    // Cosines across the row (Makhoul 1980): mode k has waves of 2 columns / k links. Parseval's sum is the row's
    // energy.
    for (int k = 2 * kShortWaves; i > 0 && k < columns; ++k) {
      Vec3 part = Vec3::Zero();
      for (int j = 0; j < columns; ++j)
        part += std::cos(curtain::kPi * k * (j + 0.5) / columns) * velocities[first + static_cast<std::size_t>(j)];
      sample.fine += 0.5 * simulator.mass({i, columns / 2}) * 2.0 / columns * part.squaredNorm();
    }
  }
  return sample;
}

// Mean over a run, and its standard error from means of a second each.
struct Mean {
  double mean = 0.0, error = 0.0;
};
Mean meanOf(const std::vector<Sample>& samples, double Sample::*what) {
  std::vector<double> seconds;
  for (std::size_t begin = 0; begin + 60 <= samples.size(); begin += 60) {
    double sum = 0.0;
    for (std::size_t k = begin; k < begin + 60; ++k) sum += samples[k].*what / 60.0;
    seconds.push_back(sum);
  }
  Mean result;
  const auto count = static_cast<double>(seconds.size());
  for (const double second : seconds) result.mean += second / count;
  for (const double second : seconds) result.error += (second - result.mean) * (second - result.mean);
  result.error = std::sqrt(result.error / (count * (count - 1.0)));
  return result;
}

struct Made {
  std::vector<Sample> samples;
  std::vector<std::vector<Vec3>> looks;  // positions at kLooks
  std::vector<double> ms;
  double substeps = 0.0, stretch = 0.0;
};

Made made(const Scene& scene, int frames) {
  Simulator simulator(scene);
  Made all;
  for (int frame = 1; frame <= kWarmUp + frames; ++frame) {
    simulator.step();
    const curtain::Statistics statistics = simulator.statistics();
    all.stretch = std::max(statistics.warp_stretch_max, statistics.weft_stretch_max);
    if (std::find(kLooks.begin(), kLooks.end(), frame) != kLooks.end()) {
      all.looks.emplace_back();
      simulator.copyPositions(all.looks.back());
    }
    if (frame <= kWarmUp) continue;
    all.ms.push_back(1e3 * statistics.step_seconds);
    all.substeps += static_cast<double>(statistics.substeps_last) / frames;
    all.samples.push_back(sampleOf(simulator));
  }
  return all;
}

double apart(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

struct Setting {
  curtain::Method method;
  int substeps;
  double tolerance;  // of links
};

}  // namespace

void studyGathered(const Options& options) {
  const int frames = options.quick ? 120 : 900;
  const Setting finest{curtain::Method::kLeapfrog, options.quick ? 32 : 128, 1e-5};
  std::vector<Setting> settings = {finest, {curtain::Method::kAuto, 0, 1e-3}};
  if (!options.quick) settings.push_back({curtain::Method::kAuto, 0, 1e-4});
  for (const int substeps : {4, 8, 16, 32, 64}) {
    if (options.quick && substeps > 16) continue;
    settings.push_back({curtain::Method::kLeapfrog, substeps, 1e-3});
  }
  settings.push_back({curtain::Method::kImplicit, 0, 1e-3});
  const std::vector<std::pair<std::string, double Sample::*>> kinds = {
      {"drag", &Sample::drag}, {"depth", &Sample::depth}, {"motion", &Sample::motion}, {"fine", &Sample::fine}};
  std::vector<std::string> columns = {"scene",     "method", "substeps",      "tolerance",
                                      "ms_median", "ms_99",  "substeps_mean", "stretch"};
  for (const int look : kLooks) columns.push_back("apart_" + std::to_string(look) + "_m");
  for (const auto& kind : kinds) {
    columns.push_back(kind.first);
    columns.push_back(kind.first + "_error");
  }
  Table table(options.folder, "gathered.csv", columns);
  for (const auto& [name, scene] : {std::pair<std::string, Scene>{"limp", limp()}, {"cotton", cotton()}}) {
    std::vector<std::vector<Vec3>> reference;
    for (const Setting& setting : settings) {
      Scene with = scene;
      with.solver.method = setting.method;
      with.solver.substeps = setting.substeps;
      with.solver.stretch_tolerance = setting.tolerance;
      const Made run = made(with, frames);
      if (reference.empty()) reference = run.looks;
      std::vector<double> sorted = run.ms;
      std::sort(sorted.begin(), sorted.end());
      std::vector<std::string> cells = {name,
                                        toString(setting.method),
                                        number(setting.substeps),
                                        number(setting.tolerance),
                                        number(median(run.ms)),
                                        number(sorted[sorted.size() * 99 / 100]),
                                        number(run.substeps),
                                        number(run.stretch)};
      for (std::size_t look = 0; look < kLooks.size(); ++look)
        cells.push_back(number(apart(run.looks[look], reference[look])));
      for (const auto& kind : kinds) {
        const Mean mean = meanOf(run.samples, kind.second);
        cells.push_back(number(mean.mean));
        cells.push_back(number(mean.error));
      }
      table.row(cells);
      std::fprintf(stderr, "gathered %s %s %d done\n", name.c_str(), toString(setting.method).c_str(),
                   setting.substeps);
    }
  }
}

}  // namespace curtain_bench
