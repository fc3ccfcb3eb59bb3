// SPDX-License-Identifier: BSD-3-Clause
//
// Trust radius of the last resort, in lengths of a node's shortest link: unbounded until a solve at the smallest step
// fails, smaller after every failure, larger after every success. Where the last resort fails in contact, the scheme
// itself is tried again in the next frame: cloth at rest on something needs no bound, and the scheme's solve converges
// where a monotone one stalls.
#pragma once

#include <algorithm>
#include <limits>

#include "cloth/archive.h"
#include "step/constants.h"

namespace curtain {

class TrustRegion {
 public:
  double reach() const noexcept { return reach_; }  ///< infinite: no bound
  bool bounded() const noexcept { return reach_ < std::numeric_limits<double>::infinity(); }
  /// The next substep is a last resort.
  bool rules(bool frame_begins) const noexcept { return bounded() && !(frame_begins && retry_); }
  /// The scheme itself has failed.
  void schemeFailed() noexcept {
    reach_ = std::min(reach_, kFirstReach);
    retry_ = false;
  }
  /// The last resort has failed; touches: in contact.
  void failed(bool touches) noexcept {
    reach_ = std::max(kMinReach, kReachShrink * reach_);
    retry_ = touches;
  }
  void succeeded() noexcept {
    reach_ *= kReachGrowth;
    retry_ = false;
    if (reach_ > kUnbounded) reset();
  }
  void reset() noexcept { *this = TrustRegion(); }
  void serialize(Archive& archive) {
    archive.within("reach", reach_, 0.0, std::numeric_limits<double>::infinity());
    archive.flag("retry", retry_);
  }

 private:
  double reach_ = std::numeric_limits<double>::infinity();
  bool retry_ = false;
};

}  // namespace curtain
