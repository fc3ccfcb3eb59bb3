// SPDX-License-Identifier: BSD-3-Clause
#include "scene/rail_layout.h"

#include <algorithm>
#include <numeric>

#include "scene/rail_path.h"

namespace curtain {
namespace {

// Largest share of its cloth's length that a curtain is drawn to. Drawn straight, its tension would have no bound.
constexpr double kWidest = 0.99;

}  // namespace

std::vector<int> RailLayout::columnsOf(const Scene& scene) {
  if (!scene.rail.carriers.columns.empty()) return scene.rail.carriers.columns;
  std::vector<int> columns;
  for (int j = 0; j + 1 < scene.cloth.columns; j += scene.rail.carriers.every) columns.push_back(j);
  columns.push_back(scene.cloth.columns - 1);
  return columns;
}

std::vector<double> RailLayout::clothBetween(const Scene& scene, const std::vector<int>& columns) {
  const std::vector<double>& spacing = scene.cloth.column_spacing;
  const double links = scene.cloth.columns - 1;
  const double sum = spacing.empty() ? links : std::accumulate(spacing.begin(), spacing.end(), 0.0);
  std::vector<double> cloth;
  for (std::size_t k = 1; k < columns.size(); ++k) {
    double share = columns[k] - columns[k - 1];
    if (!spacing.empty()) share = std::accumulate(spacing.begin() + columns[k - 1], spacing.begin() + columns[k], 0.0);
    cloth.push_back(scene.cloth.width * share / sum);
  }
  return cloth;
}

std::vector<RailLayout::Half> RailLayout::halvesOf(const RailParams& rail, const std::vector<int>& columns,
                                                   const std::vector<double>& cloth, double length) {
  const double gap = rail.carriers.gap;
  const auto half = [&](std::size_t first, std::size_t end, bool from_end) {
    const auto begin = cloth.begin() + static_cast<std::ptrdiff_t>(first);
    const double sum = std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(end - first - 1), 0.0);
    return Half{first, end, from_end, sum, length, gap * static_cast<double>(end - first - 1)};
  };
  if (rail.masters.size() < 2) return {half(0, columns.size(), false)};
  const auto right = std::find(columns.begin(), columns.end(), rail.masters[1]) - columns.begin();
  std::vector<Half> halves = {half(0, static_cast<std::size_t>(right), false),
                              half(static_cast<std::size_t>(right), columns.size(), true)};
  const double all = halves[0].cloth + halves[1].cloth;
  for (Half& one : halves) one.widest = (length - gap) * (all > 0.0 ? one.cloth / all : 0.5);
  return halves;
}

RailLayout::RailLayout(const Scene& scene) {
  const std::vector<int> columns = columnsOf(scene);
  cloth_ = clothBetween(scene, columns);
  gap_ = scene.rail.carriers.gap;
  length_ = RailPath(scene.rail.path).length();
  halves_ = halvesOf(scene.rail, columns, cloth_, length_);
  for (const int column : scene.rail.masters) {
    masters_.push_back(static_cast<std::size_t>(std::find(columns.begin(), columns.end(), column) - columns.begin()));
  }
  if (masters_.empty()) masters_.push_back(columns.size() - 1);
  shut_ = placesFor(0.0);
  open_ = placesFor(1.0);
}

std::vector<double> RailLayout::placesFor(double opening) const {
  std::vector<double> places(cloth_.size() + 1, 0.0);
  for (const Half& half : halves_) {
    const double slack = half.cloth - half.narrowest;
    const double shut = slack > 0.0 ? std::min(kWidest, (half.widest - half.narrowest) / slack) : 0.0;
    const double spread = (1.0 - opening) * shut;
    const auto apart = [&](std::size_t k) { return gap_ + spread * (cloth_[k] - gap_); };
    places[half.from_end ? half.end - 1 : half.first] = half.from_end ? length_ : 0.0;
    for (std::size_t k = half.first; k + 1 < half.end && !half.from_end; ++k) places[k + 1] = places[k] + apart(k);
    for (std::size_t k = half.end - 1; k > half.first && half.from_end; --k) places[k - 1] = places[k] - apart(k - 1);
  }
  return places;
}

double RailLayout::openingOf(const double* places) const noexcept {
  double sum = 0.0;
  for (const std::size_t k : masters_) {
    const double way = open_[k] - shut_[k];
    sum += way != 0.0 ? (places[k] - shut_[k]) / way : 0.0;
  }
  return sum / static_cast<double>(masters_.size());
}

}  // namespace curtain
