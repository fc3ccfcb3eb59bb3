// SPDX-License-Identifier: BSD-3-Clause
//
// Which part of a run is taken, and how often.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

namespace curtain {

struct Excerpt {
  double start = 0.0;         ///< [s], >= 0
  std::optional<double> end;  ///< [s], > start; none: as far as it goes
  double rate = 30.0;         ///< frames a second, > 0
};

/// Ticks of a frame rate, each served by the first frame that does not come before it.
class Ticks {
 public:
  explicit Ticks(double rate) : rate_(rate) {}

  /// Whether ticks up to this time [s] can be counted.
  bool reach(double time) const { return time * rate_ < std::numeric_limits<int>::max() - 1; }

  /// Ticks that a frame at this time [s], within reach(), is for: none where the next is still to come.
  int advance(double time) {
    const long due = static_cast<long>(std::floor(time * rate_ + kRounding)) + 1;
    if (due <= written_) return 0;
    const long count = due - written_;
    written_ = due;
    return static_cast<int>(count);
  }

 private:
  // Stamps have whole nanoseconds: up to 1e6 Hz a frame that falls on a tick is not late for it.
  static constexpr double kRounding = 1e-3;

  double rate_;
  long written_ = 0;
};

}  // namespace curtain
