// SPDX-License-Identifier: BSD-3-Clause
//
// How far nodes may go in a substep at the smallest step, in lengths of their shortest link: without bound until a solve fails, then
// less with every failure, and more again with every success.
#pragma once

#include <algorithm>
#include <limits>

#include "cloth/archive.h"
#include "solver/constants.h"

namespace curtain {

class TrustRegion {
 public:
  double reach() const noexcept { return reach_; }  ///< infinite: no bound
  bool bounded() const noexcept { return reach_ < std::numeric_limits<double>::infinity(); }
  void failed() noexcept { reach_ = bounded() ? std::max(kLeastReach, kReachShrink * reach_) : kFirstReach; }
  void succeeded() noexcept {
    reach_ *= kReachGrowth;
    if (reach_ > kUnbounded) reset();
  }
  void reset() noexcept { reach_ = std::numeric_limits<double>::infinity(); }
  void carry(Archive& archive) { archive.within("reach", reach_, 0.0, std::numeric_limits<double>::infinity()); }

 private:
  double reach_ = std::numeric_limits<double>::infinity();
};

}  // namespace curtain
