// SPDX-License-Identifier: BSD-3-Clause
#include "judge/held_crossings.h"

#include <algorithm>
#include <vector>

#include "cloth/cloth.h"
#include "simulator/self_crossings.h"

namespace curtain_test {

using namespace curtain;

bool heldPartsCross(const Simulator& simulator) {
  const Grid grid = makeGrid(wholeCloth(simulator.scene()));
  Field3 position;
  position.assign(grid.size(), 0.0);
  std::vector<int> held(grid.size(), 0);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      position.set(grid.index(i, j), simulator.position({i, j}));
      held[grid.index(i, j)] = simulator.pinned({i, j}) ? 1 : 0;
    }
  }
  for (const NodeIndex& carrier : simulator.carriers()) held[grid.index(carrier)] = 1;
  const std::vector<SelfCrossing> crossings = findSelfCrossings(grid, position);
  return std::any_of(crossings.begin(), crossings.end(), [&](const SelfCrossing& crossing) {
    const auto& [edge, face] = crossing;
    return held[edge[0]] + held[edge[1]] + held[face[0]] + held[face[1]] + held[face[2]] >= 4;
  });
}

}  // namespace curtain_test
