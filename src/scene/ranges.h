// SPDX-License-Identifier: BSD-3-Clause
//
// Ranges of a scene's numbers, and the spelling of both in problems and in YAML.
#pragma once

#include <limits>
#include <string>

namespace curtain {

/// Magnitudes in a scene, in any SI unit, from a nanometre to a million kilometres. Within them areas, masses and
/// squares of derived values stay finite, so that every valid scene can be computed.
constexpr double kSmallest = 1e-9;
constexpr double kLargest = 1e9;
/// Of lengths that must fit each other, relative: they are computed elsewhere and typed with some digits. The cloth
/// starts as if they did fit, no link longer than it is.
constexpr double kTypedRounding = 1e-4;
constexpr double kLatest = 1e12;  // of ends [s]
/// Forces may be extreme (the cloth stops while they act), but the squares of their effects must be finite.
constexpr double kStrongest = 1e100;

/// A range of finite numbers; the ends belong to it.
struct Range {
  double low = -kLargest;
  double high = kLargest;
  bool not_zero = false;     ///< at least kSmallest in size
  bool or_infinite = false;  ///< +infinity belongs to it too

  bool contains(double value) const;  ///< false for NaN
  std::string text() const;           ///< e.g. "a number in [0, 1]"
};

inline Range between(double low, double high) { return {low, high}; }
inline Range anywhere() { return {}; }
inline Range positive() { return between(kSmallest, kLargest); }
inline Range notNegative() { return between(0.0, kLargest); }
/// An angle [rad]: a turn either way. What is larger was meant in degrees.
inline Range turn() { return between(-6.3, 6.3); }
inline Range anyForce() { return between(-kStrongest, kStrongest); }
inline Range notZero() { return {-kLargest, kLargest, true}; }
/// What a hand can bear.
inline Range strength() { return {kSmallest, kLargest, false, true}; }
/// An end time.
inline Range orInfinite() { return {-kLargest, kLatest, false, true}; }

/// Integers from low to high, both included.
struct IntRange {
  int low = std::numeric_limits<int>::min();
  int high = std::numeric_limits<int>::max();

  bool contains(int value) const { return value >= low && value <= high; }
  std::string text() const;  ///< e.g. "an integer in [2, 4096]"
};

/// The shortest decimal that reads back to the same bits (at most 17 digits), e.g. "0.1", ".inf", "1e-06".
std::string formatNumber(double value);

/// The same as YAML 1.1 reads it as a number with a fraction: always a dot, e.g. "1.0e-06", "2.0".
std::string formatYamlNumber(double value);

}  // namespace curtain
