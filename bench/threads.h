// SPDX-License-Identifier: BSD-3-Clause
//
// The one place that knows how a scene asks for threads: a member `threads` of its solver parameters, if there is one.
#pragma once

#include <thread>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain_bench {

template <typename Solver>
auto setThreads(Solver& solver, int count, int) -> decltype(solver.threads = count, bool()) {
  solver.threads = count;
  return true;
}
template <typename Solver>
bool setThreads(Solver&, int count, long) {
  return count == 1;
}

/// False: the solver can't be given this many.
inline bool setThreads(curtain::Scene& scene, int count) { return setThreads(scene.solver, count, 0); }

/// 1, 2, 4, … up to what the machine has, as far as the solver can be given them.
inline std::vector<int> threadCounts() {
  std::vector<int> counts;
  curtain::Scene probe;
  const int most = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  for (int count = 1; count <= most && setThreads(probe, count); count *= 2) counts.push_back(count);
  return counts;
}

}  // namespace curtain_bench
