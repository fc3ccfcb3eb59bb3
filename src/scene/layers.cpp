// SPDX-License-Identifier: BSD-3-Clause
#include "scene/layers.h"

#include <algorithm>

namespace curtain {

Layers::Layers(const Scene& scene) : Layers(scene.cloth) {
  for (const LayerParams& layer : scene.layers) {
    const int first = layers_.back().end;
    layers_.push_back({first, first + layer.cloth.columns, &layer.cloth, &layer.air});
  }
}

std::size_t Layers::numberOf(int column) const noexcept {
  std::size_t number = 0;
  while (number + 1 < layers_.size() && column >= layers_[number].end) ++number;
  return number;
}

Fabric Layers::fabricAt(int row, int column) const noexcept {
  const Layer& layer = at(column);
  return curtain::fabricAt(*layer.cloth, row, column - layer.first);
}

ClothParams wholeCloth(const Scene& scene) {
  ClothParams whole = scene.cloth;
  if (scene.layers.empty()) return whole;
  whole.column_spacing.clear();
  whole.column_mass.clear();
  whole.patches.clear();
  for (const LayerParams& layer : scene.layers) {
    whole.slits.push_back({whole.columns - 1, 0});
    for (const SlitParams& slit : layer.cloth.slits)
      whole.slits.push_back({whole.columns + slit.column, slit.from_row});
    whole.columns += layer.cloth.columns;
  }
  return whole;
}

Scene layerScene(const Scene& scene, std::size_t number) {
  Scene one;
  one.gravity = scene.gravity;
  one.air = scene.air;
  one.obstacles = scene.obstacles;
  one.contact = scene.contact;
  one.solver = scene.solver;
  const auto copyFrom = [&one](const auto& cloth_of) {
    one.cloth = cloth_of.cloth;
    one.hang = cloth_of.hang;
    one.hem = cloth_of.hem;
    one.pins = cloth_of.pins;
    one.rail = cloth_of.rail;
  };
  number == 0 ? copyFrom(scene) : copyFrom(scene.layers[number - 1]);
  return one;
}

bool startsElsewhere(const Scene& scene) {
  const auto elsewhere = [](const auto& one) { return one.hang.start.over || one.hang.start.file; };
  return elsewhere(scene) || std::any_of(scene.layers.begin(), scene.layers.end(), elsewhere);
}

double longestWarp(const Scene& scene) {
  double longest = scene.cloth.height;
  for (const LayerParams& layer : scene.layers) longest = std::max(longest, layer.cloth.height);
  return longest;
}

}  // namespace curtain
