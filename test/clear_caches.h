// SPDX-License-Identifier: BSD-3-Clause
//
// A simulator that forgets at random what it keeps to save time, within substeps: it comes to the same bits as one that
// does not.
#pragma once

#include <cstdint>

#include "curtain_sim/simulator.h"
#include "simulator/simulator_impl.h"

namespace curtain {

struct CacheClearing {
  /// From now on; 0: no more.
  static void atRandom(Simulator& simulator, std::uint64_t seed) noexcept {
    simulator.impl_->motion.contact.clearCachesAtRandom(seed);
  }
};

}  // namespace curtain
