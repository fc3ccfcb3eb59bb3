// SPDX-License-Identifier: BSD-3-Clause
#include "sensing/flat_cloth.h"

#include <utility>

namespace curtain {

FlatCloth::FlatCloth(const FineMeshTopology& topology, std::vector<double> warp_rest, std::vector<double> weft_rest)
    : topology_(topology),
      links_((topology.closed ? topology.columns : topology.columns - 1) / topology.folds),
      node_columns_(topology.closed ? links_ : links_ + 1),
      warp_rest_(std::move(warp_rest)),
      weft_rest_(std::move(weft_rest)),
      by_column_(warp_rest_.size() != static_cast<std::size_t>(topology.rows - 1)),
      warp_begin_(weft_rest_.size(), 0.0),
      weft_begin_(weft_rest_.size(), 0.0) {
  for (int i = 1; i < topology.rows; ++i) {
    for (int link = 0; link < links_; ++link)
      warp_begin_[linkAt(i, link)] = warp_begin_[linkAt(i - 1, link)] + rod(i - 1, link);
  }
  for (int i = 0; i < topology.rows; ++i) {
    for (int link = 1; link < links_; ++link)
      weft_begin_[linkAt(i, link)] = weft_begin_[linkAt(i, link - 1)] + weft_rest_[linkAt(i, link - 1)];
  }
}

// Of both triangles of a quad the second corner is in the row below: of the first one at the left, of the second, too.
FlatCloth::Cell FlatCloth::cellOf(int triangle) const {
  const auto& corners = topology_.triangles[static_cast<std::size_t>(triangle)];
  const int below = static_cast<int>(corners[1]);
  Cell cell{below / topology_.columns - 1, below % topology_.columns, false};
  cell.second = static_cast<int>(corners[0]) != cell.row * topology_.columns + cell.column;
  return cell;
}

double FlatCloth::area(int triangle) const {
  const Cell cell = cellOf(triangle);
  const int base_row = cell.second ? cell.row + 1 : cell.row;
  const double base = weft_rest_[linkAt(base_row, cell.column / topology_.folds)] / topology_.folds;
  return 0.5 * base * rod(cell.row, cell.column / topology_.folds);
}

double FlatCloth::area() const {
  double sum = 0.0;
  for (int triangle = 0; triangle < triangleCount(); ++triangle) sum += area(triangle);
  return sum;
}

ClothPlace FlatCloth::place(int triangle, double b1, double b2) const {
  const Cell cell = cellOf(triangle);
  // Corners: first triangle (0, 0), (0, 1), (1, 0); second (1, 0), (0, 1), (1, 1); right and down in the quad.
  const double right = cell.second ? 1.0 - b1 : b2;
  const double down = cell.second ? b1 + b2 : b1;
  ClothPlace place;
  place.row = cell.row;
  place.link = cell.column / topology_.folds;
  place.across = static_cast<float>((cell.column % topology_.folds + right) / topology_.folds);
  place.down = static_cast<float>(down);
  return place;
}

Eigen::Vector2d FlatCloth::coordinates(const ClothPlace& place) const {
  const std::size_t above = linkAt(place.row, place.link), below = linkAt(place.row + 1, place.link);
  const double u_above = weft_begin_[above] + place.across * weft_rest_[above];
  const double u_below = weft_begin_[below] + place.across * weft_rest_[below];
  return {u_above + place.down * (u_below - u_above), warp_begin_[above] + place.down * rod(place.row, place.link)};
}

std::int32_t FlatCloth::nearestNode(const ClothPlace& place) const {
  return node(place.row + (place.down < 0.5F ? 0 : 1), place.link + (place.across < 0.5F ? 0 : 1));
}

Vec3 FlatCloth::velocity(const ClothPlace& place, const std::vector<Vec3>& velocities) const {
  const auto of = [&](int row, int column) -> const Vec3& {
    return velocities[static_cast<std::size_t>(node(row, column))];
  };
  const double right = place.across, down = place.down;
  const Vec3 above = (1.0 - right) * of(place.row, place.link) + right * of(place.row, place.link + 1);
  const Vec3 below = (1.0 - right) * of(place.row + 1, place.link) + right * of(place.row + 1, place.link + 1);
  return (1.0 - down) * above + down * below;
}

}  // namespace curtain
