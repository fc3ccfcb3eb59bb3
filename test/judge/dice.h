// SPDX-License-Identifier: BSD-3-Clause
//
// What the judge draws scenes with.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "judge/draw.h"
#include "testing.h"

namespace curtain_test {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed * 0x9E3779B97F4A7C15ULL + 1) {}
  double between(double low, double high) { return random_.between(low, high); }
  /// Evenly in the logarithm.
  double magnitude(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  int integer(int low, int high) { return low + static_cast<int>(between(0.0, 1.0) * (high - low + 1)); }
  bool chance(double share) { return between(0.0, 1.0) < share; }
  curtain::Vec3 direction() { return random_.direction(); }
  curtain::Vec3 inBox(double half) { return random_.inBox(half); }

 private:
  Random random_;
};

struct Ranges {
  double density[2], force[2], pressure[2], gust, speed[2], rate[2];
  int size[2];
};
constexpr Ranges kEverydayRanges = {{0.05, 1.0}, {0.1, 30.0}, {1.0, 100.0}, 20.0, {0.2, 5.0}, {10.0, 240.0}, {4, 60}};
constexpr Ranges kWildRanges = {{1e-3, 10.0}, {1.0, 1e6}, {1.0, 1e5}, 1e3, {0.2, 50.0}, {5.0, 1000.0}, {2, 100}};
constexpr Ranges kSuddenRanges = {{0.05, 0.5}, {1.0, 1e3}, {50.0, 1e4}, 0.0, {0.2, 5.0}, {10.0, 240.0}, {2, 40}};

/// Adds an obstacle that goes through the cloth's middle, from outside all that it can reach at the start: one of
/// test/meshes, or any simple shape (wild), or mostly a ball.
enum class Shapes { kMeshes, kAny, kMostlyBalls };
void addObstacle(Dice& dice, const Ranges& ranges, Shapes shapes, const std::string& name, Drawn& drawn);
/// Hangs the cloth before a plate that is as large as what can get there, and lets something set in.
void drawPlate(Dice& dice, Drawn& drawn);

}  // namespace curtain_test
