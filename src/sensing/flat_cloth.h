// SPDX-License-Identifier: BSD-3-Clause
//
// Where the fine mesh's triangles lie on the flat cloth, so that a point on one of them has coordinates there, a
// nearest node and a velocity.
//
//   row i       o---.---o      o first-layer node, . second-layer node
//               |0/ |0/ |
//               |/ 1|/ 1|      the two triangles of a quad, as makeFineMeshTopology() lists them
//   row i + 1   o---.---o
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "curtain_sim/fine_mesh.h"

namespace curtain {

/// A place on the cloth, between four first-layer nodes.
struct ClothPlace {
  std::int32_t row = 0;   ///< of the nodes above
  std::int32_t link = 0;  ///< number of the weft link above and below; its left nodes have this column
  float across = 0.0F;    ///< from the left nodes (0) to the right ones (1)
  float down = 0.0F;      ///< from the row above (0) to the one below (1)
};

/// Immutable: any number of threads may use it.
class FlatCloth {
 public:
  /// warp_rest, weft_rest  as Simulator::copyRestLengths() gives them; warp_rest of several cloths: as copyRods() does
  FlatCloth(const FineMeshTopology& topology, std::vector<double> warp_rest, std::vector<double> weft_rest);

  int triangleCount() const { return static_cast<int>(topology_.triangles.size()); }
  const FineMeshTopology& topology() const { return topology_; }

  /// Of a triangle on the flat cloth [m^2].
  double area(int triangle) const;
  /// Of all triangles [m^2].
  double area() const;

  /// The place with weights b1 and b2 of the triangle's second and third corner, 1 - b1 - b2 of its first.
  ClothPlace place(int triangle, double b1, double b2) const;

  /// Coordinates on the flat cloth [m]: u along the weft from column 0, v along the warp from the hung edge.
  Eigen::Vector2d coordinates(const ClothPlace& place) const;

  /// Number of the nearest node on the flat cloth, row * columns + column.
  std::int32_t nearestNode(const ClothPlace& place) const;

  /// Velocity there [m/s], between those of the four nodes. velocities: row-major, of the first-layer nodes
  Vec3 velocity(const ClothPlace& place, const std::vector<Vec3>& velocities) const;

 private:
  struct Cell {
    int row, column;  // fine column of its left corners
    bool second;      // of the quad's two triangles
  };
  Cell cellOf(int triangle) const;
  // Of the rods on the left of a link's cell [m].
  double rod(int row, int link) const {
    const auto at = static_cast<std::size_t>(by_column_ ? row * node_columns_ + link : row);
    return warp_rest_[at];
  }
  std::size_t linkAt(int row, int link) const { return static_cast<std::size_t>(row * links_ + link); }
  std::int32_t node(int row, int column) const { return row * node_columns_ + column % node_columns_; }

  FineMeshTopology topology_;
  int links_, node_columns_;
  std::vector<double> warp_rest_, weft_rest_;
  bool by_column_;                               // warp_rest_ has the rods of all columns
  std::vector<double> warp_begin_, weft_begin_;  // [m] from the hung edge, from column 0; by link
};

}  // namespace curtain
