// SPDX-License-Identifier: BSD-3-Clause
//
// The cloth's surface as it is drawn, from the nodes of ~state: both layers, smooth normals, the cloth's own
// coordinates for its pattern, and how deep each point lies in a fold, which decides how much light gets there.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "curtain_sim/CurtainState.h"
#include "curtain_sim/drawn_mesh.h"
#include "curtain_sim/fine_mesh.h"

namespace curtain_rviz {

using curtain::ClothCoordinate;

/// What moves of a vertex, as it lies in the vertex buffer.
struct SurfaceVertex {
  std::array<float, 3> position;  ///< [m]
  std::array<float, 3> normal;    ///< unit
  float hollow;                   ///< in [-1, 1]: > 0 in a fold's hollow as seen from where the normal points to
};

/// One thread at a time. Allocates only for another grid.
class CurtainSurface {
 public:
  /// state: nothing wrong with it (state_check.h). Returns whether it is of another cloth than the last one: then
  /// triangles and coordinates are new.
  bool update(const curtain_sim::CurtainState& state);

  const std::vector<SurfaceVertex>& vertices() const { return vertices_; }  ///< row by row
  const std::vector<ClothCoordinate>& coordinates() const { return drawn_.coordinates; }
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return drawn_.topology.triangles; }

  /// Values of the nodes at the vertices, in between linear; out is resized. nodes: row-major, of the state's grid.
  void spread(const std::vector<float>& nodes, std::vector<float>& out) const;

  /// Mean of the drawn positions [m].
  const curtain::Vec3& centre() const { return centre_; }
  /// Corners of the box around them [m].
  const curtain::Vec3& lowest() const { return lowest_; }
  const curtain::Vec3& highest() const { return highest_; }

 private:
  bool isOfThisCloth(const curtain_sim::CurtainState& state) const;
  void setCloth(const curtain_sim::CurtainState& state);
  void setNodes(const curtain_sim::CurtainState& state);
  void setVertices();
  const curtain::Vec3& beside(int row, int column, int rightwards) const;
  float hollowAt(int row, int column, const curtain::Vec3& normal) const;
  const curtain::Vec3& fine(int row, int column) const {
    return mesh_.positions[static_cast<std::size_t>(row) * static_cast<std::size_t>(topology_.columns) +
                           static_cast<std::size_t>(column)];
  }

  curtain::FineMeshTopology topology_;  // of the nodes
  curtain::DrawnMesh drawn_;            // with the first column again
  std::optional<curtain::FineMeshBuilder> builder_;
  std::vector<float> warp_rest_, weft_rest_;  // of this cloth
  std::vector<std::uint32_t> slit_columns_, slit_rows_;
  std::vector<curtain::Vec3> nodes_, normals_;
  curtain::FineMesh mesh_;
  std::vector<SurfaceVertex> vertices_;
  double link_length_ = 1.0;  // mean [m]
  curtain::Vec3 centre_ = curtain::Vec3::Zero(), lowest_ = centre_, highest_ = centre_;
};

}  // namespace curtain_rviz
