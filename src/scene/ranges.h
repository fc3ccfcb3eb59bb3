// SPDX-License-Identifier: BSD-3-Clause
//
// Ranges that a scene's numbers must lie in, and how they and the numbers are spelled in problems and in YAML.
#pragma once

#include <limits>
#include <string>

namespace curtain {

/// A range of finite numbers; the ends belong to it unless open.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool not_zero = false;
  bool or_infinite = false;  ///< +infinity belongs to it too

  bool contains(double value) const;  ///< false for NaN
  std::string text() const;           ///< e.g. "a finite number > 0"
};

inline Range finite() { return {}; }
inline Range positive() {
  Range range;
  range.low = 0.0;
  range.low_open = true;
  return range;
}
inline Range notNegative() {
  Range range;
  range.low = 0.0;
  return range;
}
inline Range between(double low, double high) {
  Range range;
  range.low = low;
  range.high = high;
  return range;
}
inline Range notZero() {
  Range range;
  range.not_zero = true;
  return range;
}
inline Range orInfinite() {
  Range range;
  range.or_infinite = true;
  return range;
}

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
