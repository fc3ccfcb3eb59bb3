// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/surface/fabric.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "rviz/surface/pi.h"

namespace curtain_rviz {

namespace {

constexpr int kPixelsPerThread = kFabricSize / kThreadsAcross;

// A number in [-1, 1] for a whole number: threads differ, but always in the same way.
double noise(std::uint32_t seed, std::uint32_t n) {
  std::uint32_t x = n * 0x9E3779B9U + seed * 0x85EBCA6BU;
  x ^= x >> 15U;
  x *= 0x2C1B3C6DU;
  x ^= x >> 12U;
  x *= 0x297A2D39U;
  x ^= x >> 15U;
  return static_cast<double>(x) / 2147483647.5 - 1.0;
}

// How thick a thread is spun, relative to the mean: single threads, and slow drifts over 8 of them. Periodic.
double slub(std::uint32_t seed, int thread) {
  const auto n = static_cast<std::uint32_t>(thread);
  const double at = thread / 8.0;
  const auto from = static_cast<std::uint32_t>(at);
  const double part = at - from;
  const double drift = (1.0 - part) * noise(seed + 7, from) + part * noise(seed + 7, (from + 1) % (kThreadsAcross / 8));
  return 0.6 * noise(seed, n) + 0.4 * drift;
}

/// A place in the weave: which threads cross there, and where on them (0 … 1 across).
struct Crossing {
  int warp, weft;
  double across_warp, across_weft;
};

Crossing crossingAt(int x, int y) {
  return {x / kPixelsPerThread, y / kPixelsPerThread, (x % kPixelsPerThread + 0.5) / kPixelsPerThread,
          (y % kPixelsPerThread + 0.5) / kPixelsPerThread};
}

// The warp thread is on top: tabby over and under by turns, twill over two and under two with a step to the side.
bool warpOnTop(Pattern pattern, const Crossing& c) {
  return pattern == Pattern::kTwill ? (c.warp + c.weft) % 4 < 2 : (c.warp + c.weft) % 2 == 0;
}

// Brightness of a round thread seen from above: it turns away at its sides, and dips at its ends where it goes under.
double threadLight(Pattern pattern, const Crossing& c) {
  const bool warp = warpOnTop(pattern, c);
  const double side = warp ? c.across_warp : c.across_weft;
  const double end = warp ? c.across_weft : c.across_warp;
  const double round = std::sin(kPi * side), dip = std::sin(kPi * end);
  const double spun = warp ? slub(1, c.warp) : slub(2, c.weft);
  return (0.80 + 0.20 * round) * (0.92 + 0.08 * dip) * (1.0 + 0.10 * spun);
}

double smoothStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// 1 in the middle `width` of the unit interval.
double band(double x, double width) { return std::abs(x - 0.5) < 0.5 * width ? 1.0 : 0.0; }

// Ogee: wavy lines that meet and part, with a bud in each eye. The figure is woven, so it follows whole threads.
double ogee(double u, double v) {
  const double wave = 0.25 * std::cos(2.0 * kPi * v);
  const auto line = [&](double centre) {
    double d = u - centre;
    d -= std::floor(d + 0.5);
    return 1.0 - smoothStep(0.020, 0.045, std::abs(d));
  };
  const auto bud = [&](double cu, double cv) {
    double du = u - cu, dv = v - cv;
    du -= std::floor(du + 0.5);
    dv -= std::floor(dv + 0.5);
    const double r = std::hypot(du / 0.10, dv / 0.20);
    return (1.0 - smoothStep(0.9, 1.1, r)) * smoothStep(0.45, 0.60, r) + (1.0 - smoothStep(0.18, 0.30, r));
  };
  return std::min(1.0, line(0.25 + wave) + line(0.75 - wave) + bud(0.5, 0.5) + bud(0.0, 0.0));
}

// Share of the figure's colour at a crossing.
double figureAt(Pattern pattern, const Crossing& c) {
  const double u = (c.warp + 0.5) / kThreadsAcross, v = (c.weft + 0.5) / kThreadsAcross;
  switch (pattern) {
    case Pattern::kStripes: {
      const double broad = band(u, 0.34), fine = band(u - 0.27, 0.035) + band(u + 0.27, 0.035);
      return std::min(1.0, broad + fine);
    }
    case Pattern::kChecks:
      return 0.5 * (band(u, 0.5) + band(v, 0.5));
    case Pattern::kOgee:
      return ogee(u, v);
    default:
      return 0.0;
  }
}

}  // namespace

const std::vector<std::string>& patternNames() {
  static const std::vector<std::string> names = {"None", "Linen", "Twill", "Stripes", "Checks", "Ogee"};
  return names;
}

Pixels drawFabric(Pattern pattern, const Colour& ground, const Colour& figure) {
  Pixels pixels;
  pixels.size = kFabricSize;
  pixels.rgba.reserve(4 * pixels.size * pixels.size);
  for (int y = 0; y < kFabricSize; ++y) {
    for (int x = 0; x < kFabricSize; ++x) {
      const Crossing crossing = crossingAt(x, y);
      const double light = pattern == Pattern::kNone ? 1.0 : threadLight(pattern, crossing);
      const double share = figureAt(pattern, crossing);
      for (std::size_t k = 0; k < 3; ++k) {
        const double value = light * (ground[k] + share * (figure[k] - ground[k]));
        pixels.rgba.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0))));
      }
      pixels.rgba.push_back(255);
    }
  }
  return pixels;
}

Colour scaleColour(double share) {
  static const std::array<Colour, 6> kStops = {{{0.22F, 0.17F, 0.48F},
                                                {0.20F, 0.38F, 0.70F},
                                                {0.12F, 0.60F, 0.66F},
                                                {0.42F, 0.76F, 0.45F},
                                                {0.90F, 0.86F, 0.32F},
                                                {1.00F, 0.97F, 0.78F}}};
  const double at = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
  const auto from = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const auto part = static_cast<float>(at - static_cast<double>(from));
  Colour colour;
  for (std::size_t k = 0; k < 3; ++k) colour[k] = kStops[from][k] + part * (kStops[from + 1][k] - kStops[from][k]);
  return colour;
}

}  // namespace curtain_rviz
