// SPDX-License-Identifier: BSD-3-Clause
//
// Random numbers of a sensor, by seed, frame of the simulation and ray: neither the order of rays nor the number of
// threads changes them.
#pragma once

#include <cmath>
#include <cstdint>

#include "scene/pi.h"
#include "scene/splitmix.h"

namespace curtain {

/// What a number is for: numbers of different purposes are independent.
enum class Purpose : std::uint64_t { kPlace, kPlaceAcross, kPore, kDropout, kNoiseRadius, kNoiseAngle };

/// A key of its own for each frame and purpose.
inline std::uint64_t randomKey(std::uint64_t seed, std::uint64_t frame, Purpose purpose) {
  return splitmix(splitmix(splitmix(seed) ^ frame) ^ static_cast<std::uint64_t>(purpose));
}

/// Uniform in (0, 1), both ends excluded: the middle of one of 2^52 equal parts.
inline double hashedUniform(std::uint64_t key, std::uint64_t index) {
  return (static_cast<double>(splitmix(key ^ index) >> 12U) + 0.5) * 0x1p-52;
}

/// Normal, of mean 0 and variance 1, from two uniform numbers in (0, 1) (Box, Muller 1958).
inline double normalFrom(double radius, double angle) {
  return std::sqrt(-2.0 * std::log(radius)) * std::cos(2.0 * kPi * angle);
}

}  // namespace curtain
