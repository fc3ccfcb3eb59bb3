// SPDX-License-Identifier: BSD-3-Clause
//
// What the cloth can be coloured by: a number at every node, its unit, and the range of the colours.
#pragma once

#include <string>
#include <vector>

#include "curtain_sim/CurtainState.h"
#include "curtain_sim/Loads.h"

namespace curtain_rviz {

enum class Layer { kPlain, kSpeed, kStrain, kTension, kContact };

/// Name and unit for people: "Speed", "m/s".
struct LayerText {
  const char* name;
  const char* unit;
};
LayerText textOf(Layer layer);

/// Needs a Loads message beside the state.
inline bool needsLoads(Layer layer) { return layer == Layer::kTension || layer == Layer::kContact; }

/// The nodes' values, row-major, >= 0; out is resized.
///   kSpeed    [m/s]
///   kStrain   [%] overlength of the most stretched link at the node; 0: none is longer than at rest
///   kTension  [N] of the link at the node that bears most
///   kContact  [N] what obstacles and the cloth itself press on it
/// state, loads: nothing wrong with them (state_check.h); loads may be null unless the layer needs them.
void valuesOf(Layer layer, const curtain_sim::CurtainState& state, const curtain_sim::Loads* loads,
              std::vector<float>& out);

/// The range of the colours: at once as large as the largest value, and slowly smaller again.
class LayerRange {
 public:
  void reset() { peak_ = 0.0; }

  /// Takes note of the values, after so many seconds; returns the range's upper end: 1, 2 or 5 times a power of ten.
  double follow(const std::vector<float>& values, double seconds);

 private:
  double peak_ = 0.0;
};

/// The smallest number not below x > 0 that is 1, 2 or 5 times a power of ten.
double roundUp(double x);

/// A number of the legend: "0.05", "20".
std::string legendNumber(double x);

}  // namespace curtain_rviz
