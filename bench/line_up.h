// SPDX-License-Identifier: BSD-3-Clause
//
// Who takes part, at which settings: our methods by their names, so that new ones take part by themselves, and the
// rivals over the settings that matter to each.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/contestant.h"
#include "curtain_sim/scene.h"

namespace curtain_bench {

/// The start of a scene as the simulator makes it. The scene must be open, of equal links, without wind and drags: that
/// is what the rivals know. `damping` is theirs, ours have the scene's air.
ClothStart clothStart(const curtain::Scene& scene, double damping = 0.0);
/// The ball of a scene whose first obstacle is one; none, if it has no obstacle.
Solid solidOf(const curtain::Scene& scene);

/// The simulator itself, at the scene's own solver settings.
std::unique_ptr<Contestant> makeOurs(const curtain::Scene& scene);

/// The same, from where `start` has its nodes, at rest.
std::unique_ptr<Contestant> makeOurs(const curtain::Scene& scene, const ClothStart& start);

/// A method at a setting, to be put on any scene.
struct Entry {
  std::string method;
  std::string setting;  ///< no commas
  std::function<std::unique_ptr<Contestant>(const curtain::Scene& scene, const ClothStart& start)> make;
  bool holds_slack = true;  ///< knows links that hold against stretch only
};

/// One of our methods at a number of substeps a frame; 0: the number is the method's choice.
Entry ourEntry(const std::string& method, int substeps);

/// Every method of curtain::methodNames() at the solver's own choice and at `substeps` each.
std::vector<Entry> ourEntries(const std::vector<int>& substeps);

/// Every rival over its sweep; `thin` leaves out the settings between.
std::vector<Entry> rivalEntries(bool thin);

}  // namespace curtain_bench
