// SPDX-License-Identifier: BSD-3-Clause
#include "bench/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace curtain_bench {
namespace {

double squaredDistance(const Points& a, std::size_t i, const Points& b, std::size_t j) {
  const double dx = a.x[i] - b.x[j], dy = a.y[i] - b.y[j], dz = a.z[i] - b.z[j];
  return dx * dx + dy * dy + dz * dz;
}

}  // namespace

bool isSound(const Points& positions) {
  constexpr double kFar = 1e3;  // [m] no scene is larger; what is further off has blown up
  for (const auto* values : {&positions.x, &positions.y, &positions.z}) {
    for (const double value : *values) {
      if (!(std::abs(value) < kFar)) return false;
    }
  }
  return true;
}

Inside insideOf(const ClothStart& start, double time, const Points& positions) {
  Inside inside;
  if (start.solid.shape != Solid::Shape::kBall) return inside;
  const Solid::Place middle = start.solid.at(time);
  Solid::Place normal{};
  for (std::size_t n = 0; n < start.count(); ++n) {
    const double depth = -start.solid.distance(middle, {positions.x[n], positions.y[n], positions.z[n]}, normal);
    inside.nodes += depth > 0.0;
    inside.deepest = std::max(inside.deepest, depth);
  }
  return inside;
}

double largestStretch(const ClothStart& start, const Points& positions) {
  double worst = 0.0;
  for (int i = 0; i < start.rows; ++i) {
    for (int j = 0; j < start.columns; ++j) {
      const auto n = static_cast<std::size_t>(i * start.columns + j);
      if (i > 0) {
        const auto above = n - static_cast<std::size_t>(start.columns);
        const double length = std::sqrt(squaredDistance(positions, n, positions, above));
        worst = std::max(worst, std::abs(length / start.warp_rest - 1.0));
      }
      if (j > 0) {
        worst = std::max(worst, std::sqrt(squaredDistance(positions, n, positions, n - 1)) / start.weft_rest - 1.0);
      }
    }
  }
  return worst;
}

double rmsDistance(const ClothStart& start, const Points& a, const Points& b) {
  double sum = 0.0;
  double free_nodes = 0.0;
  for (std::size_t n = 0; n < start.count(); ++n) {
    if (start.pinned[n] != 0) continue;
    sum += squaredDistance(a, n, b, n);
    free_nodes += 1.0;
  }
  return std::sqrt(sum / free_nodes);
}

double gravityEnergy(const ClothStart& start, const Points& positions) {
  double energy = 0.0;
  for (std::size_t n = 0; n < start.count(); ++n) {
    energy -= start.mass[n] * (start.gravity[0] * positions.x[n] + start.gravity[1] * positions.y[n] +
                               start.gravity[2] * positions.z[n]);
  }
  return energy;
}

double kineticEnergy(const ClothStart& start, const Points& velocities) {
  double energy = 0.0;
  for (std::size_t n = 0; n < start.count(); ++n) {
    if (start.pinned[n] != 0) continue;
    energy +=
        0.5 * start.mass[n] *
        (velocities.x[n] * velocities.x[n] + velocities.y[n] * velocities.y[n] + velocities.z[n] * velocities.z[n]);
  }
  return energy;
}

double totalEnergy(const ClothStart& start, const Contestant& contestant) {
  Points positions, velocities;
  contestant.copyPositions(positions);
  contestant.copyVelocities(velocities);
  return gravityEnergy(start, positions) + kineticEnergy(start, velocities) + contestant.elasticEnergy();
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

Run run(const ClothStart& start, Contestant& contestant, int frames, double budget_seconds, const FrameCall& call) {
  Run result;
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(frames));
  for (int frame = 1; frame <= frames; ++frame) {
    const auto begin = std::chrono::steady_clock::now();
    contestant.frame();
    const auto end = std::chrono::steady_clock::now();
    times.push_back(std::chrono::duration<double, std::milli>(end - begin).count());
    result.ms += times.back();
    result.frames = frame;
    result.substeps += contestant.substeps();
    contestant.copyPositions(result.end);
    result.sound = isSound(result.end);
    if (!result.sound) break;
    result.stretch = std::max(result.stretch, largestStretch(start, result.end));
    if (call) call(frame, contestant, result.end);
    result.cut = frame < frames && result.ms > 1e3 * budget_seconds;
    if (result.cut) break;
  }
  result.frame_median = median(times);
  result.frame_max = *std::max_element(times.begin(), times.end());
  return result;
}

}  // namespace curtain_bench
