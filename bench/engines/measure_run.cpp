// SPDX-License-Identifier: BSD-3-Clause
#include "bench/engines/measure_run.h"

#include <algorithm>
#include <chrono>

#include "bench/engines/air.h"
#include "bench/measure.h"
#include "simulator/self_crossings.h"

namespace curtain_bench {
namespace {

// Squares of misfits, as largestStretch() has them, of links that are not between two pins, and how many there are.
class MeanSquare {
 public:
  void add(const ClothStart& start, const Points& p) {
    const auto columns = static_cast<std::size_t>(start.columns);
    const auto length = [&p](std::size_t a, std::size_t b) {
      return std::hypot(p.x[a] - p.x[b], p.y[a] - p.y[b], p.z[a] - p.z[b]);
    };
    for (std::size_t n = 0; n < start.count(); ++n) {
      if (n >= columns && moves(start, n, n - columns)) count(length(n, n - columns) / start.warp_rest - 1.0);
      if (n % columns > 0 && moves(start, n, n - 1)) count(std::max(0.0, length(n, n - 1) / start.weft_rest - 1.0));
    }
  }
  double root() const { return std::sqrt(sum_ / links_); }

 private:
  static bool moves(const ClothStart& start, std::size_t a, std::size_t b) {
    return start.pinned[a] == 0 || start.pinned[b] == 0;
  }
  void count(double misfit) {
    sum_ += misfit * misfit;
    links_ += 1.0;
  }
  double sum_ = 0.0, links_ = 0.0;
};

std::int64_t crossingsOf(const ClothStart& start, const Points& positions) {
  const curtain::Grid grid(start.rows, start.columns, false);
  curtain::Field3 field;
  field.assign(grid.size(), 0.0);
  std::size_t n = 0;
  for (int i = 0; i < start.rows; ++i) {
    for (int j = 0; j < start.columns; ++j, ++n)
      field.set(grid.index(i, j), {positions.x[n], positions.y[n], positions.z[n]});
  }
  return curtain::countSelfCrossings(grid, field);
}

// Makes an engine's accelerations for its next frame. Velocities are means over the last one: at its end those of stiff
// links ring.
class Blower {
 public:
  Blower(const curtain::Scene& scene, Engine& engine, double frame_seconds)
      : air_(scene), engine_(engine), frame_seconds_(frame_seconds) {}
  void blow(double time) {
    engine_.copyPositions(positions_);
    velocities_.resize(positions_.x.size());
    for (std::size_t n = 0; n < before_.x.size(); ++n) {
      velocities_.x[n] = (positions_.x[n] - before_.x[n]) / frame_seconds_;
      velocities_.y[n] = (positions_.y[n] - before_.y[n]) / frame_seconds_;
      velocities_.z[n] = (positions_.z[n] - before_.z[n]) / frame_seconds_;
    }
    before_ = positions_;
    air_.accelerations(positions_, velocities_, time, accelerations_);
    engine_.accelerate(accelerations_);
  }

 private:
  Air air_;
  Engine& engine_;
  const double frame_seconds_;
  Points positions_, before_, velocities_, accelerations_;
};

double millisecondsOf(Contestant& contestant) {
  const auto begin = std::chrono::steady_clock::now();
  contestant.frame();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

Figures figuresOf(const ClothStart& start, const curtain::Scene& scene, int frames, Contestant& contestant,
                  Engine* engine) {
  Figures figures;
  std::unique_ptr<Blower> blower;
  if (engine != nullptr) blower = std::make_unique<Blower>(scene, *engine, start.frame_seconds);
  MeanSquare square;
  std::vector<double> ms;
  Points positions;
  bool is_sound = true;
  for (int frame = 1; frame <= frames && is_sound; ++frame) {
    if (blower != nullptr) blower->blow((frame - 1) * start.frame_seconds);
    ms.push_back(millisecondsOf(contestant));
    contestant.copyPositions(positions);
    is_sound = isSound(positions);
    if (!is_sound) break;
    figures.stretch_max = std::max(figures.stretch_max, largestStretch(start, positions));
    square.add(start, positions);
    const Inside inside = insideOf(start, frame * start.frame_seconds, positions);
    figures.nodes_inside = std::max(figures.nodes_inside, inside.nodes);
    figures.deepest = std::max(figures.deepest, inside.deepest);
  }
  std::sort(ms.begin(), ms.end());
  figures.ms_median = median(ms);
  figures.ms_99 = ms[ms.size() - 1 - ms.size() / 100];
  figures.stretch_rms = square.root();
  if (!is_sound) figures.stretch_max = figures.stretch_rms = std::nan("");
  if (is_sound) figures.crossings = crossingsOf(start, positions);
  return figures;
}

}  // namespace curtain_bench
