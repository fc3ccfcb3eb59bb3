// SPDX-License-Identifier: BSD-3-Clause
//
// The cloths of a scene, side by side in one grid: the first, and its layers (LayerParams).
//
//        first        layers[0]   layers[1]
//     +-----------+  +--------+  +----------+
//     |           |  |        |  |          |       between neighbours a slit from row 0 on
//     +-----------+  +--------+  +----------+
#pragma once

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include "scene/fabric.h"

namespace curtain {

/// Which columns are of which cloth. What it was made of must outlive it.
class Layers {
 public:
  struct Layer {
    int first, end;             ///< its columns are [first, end)
    const ClothParams* cloth;   ///< its fabric and size
    const LayerAirParams* air;  ///< its drag; none: that of the scene's air
  };

  /// One cloth.
  Layers(const ClothParams& cloth) : layers_{{0, cloth.columns, &cloth, nullptr}} {}
  explicit Layers(const Scene& scene);

  std::vector<Layer>::const_iterator begin() const noexcept { return layers_.begin(); }
  std::vector<Layer>::const_iterator end() const noexcept { return layers_.end(); }
  std::size_t size() const noexcept { return layers_.size(); }
  const Layer& operator[](std::size_t number) const noexcept { return layers_[number]; }
  /// Number of the one that has the column, which must be of the grid.
  std::size_t numberOf(int column) const noexcept;
  /// Fabric of a node.
  Fabric fabricAt(int row, int column) const noexcept;
  /// One of the cloths has fabric of this kind somewhere.
  template <typename Is>
  bool anyFabric(const Is& is) const {
    return std::any_of(layers_.begin(), layers_.end(),
                       [&](const Layer& layer) { return curtain::anyFabric(*layer.cloth, is); });
  }
  const Layer& at(int column) const noexcept { return layers_[numberOf(column)]; }

 private:
  std::vector<Layer> layers_;
};

/// A value of all cloths, as text: "40", "40, 110", or "40 and patches".
template <typename Value>
std::string listOf(const Layers& layers, const Value& value) {
  std::ostringstream text;
  for (const Layers::Layer& layer : layers) {
    text << (layer.first > 0 ? ", " : "") << value(fabricOf(*layer.cloth));
    if (!layer.cloth->patches.empty()) text << " and patches";
  }
  return text.str();
}

/// A scene of one of the cloths alone, 0 being the first: without what is of all of them (lines, winds, hands, ...).
Scene layerScene(const Scene& scene, std::size_t number);

/// A cloth starts somewhere else than hung by its edge (hang.start).
bool startsElsewhere(const Scene& scene);

/// Length of the longest warp [m].
double longestWarp(const Scene& scene);

}  // namespace curtain
