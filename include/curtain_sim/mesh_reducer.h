// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 1: level of detail for a fine mesh. A fold is drawn by some of its nodes: only its ends where the link is taut,
// all of them where it bows tightly near the viewer. The strips above and below a fold use the same of its nodes, so
// neighbours of different detail leave no crack:
//
//   upper fold   o---.---.---.---.---.---o     A strip between six rods and two. From the left, the fold whose
//                |  / _/  __/|  / _/  __/|     next node comes first advances: triangles stay as narrow as the
//                | /_/__/    | /_/__/    |     coarser fold allows. Between equal folds they are those of the
//   lower fold   o-----------o-----------o     fine mesh.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "curtain_sim/fine_mesh.h"

namespace curtain {

/// How far the drawn mesh may be from the fine mesh: the larger of both tolerances.
struct MeshDetail {
  double tolerance = 0.0;         ///< [m], >= 0
  std::optional<Vec3> viewer;     ///< position of the viewer [m]
  double viewer_tolerance = 0.0;  ///< visual angle of the deviation from there [rad], >= 0

  /// Asks for the same triangles.
  bool operator==(const MeshDetail& other) const {
    return tolerance == other.tolerance && viewer == other.viewer && viewer_tolerance == other.viewer_tolerance;
  }
};

/// Not thread-safe. Same mesh, same detail: same triangles. Allocates only in the constructor.
class MeshReducer {
 public:
  /// Three indices into FineMesh::positions each.
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;

  /// topology must outlive this.
  explicit MeshReducer(const FineMeshTopology& topology);

  /// Triangles over the fine mesh's nodes: every point of its surface has one of theirs within the local tolerance, and
  /// the other way round. They may be that much nearer to an obstacle, or inside. Without a tolerance they are
  /// topology.triangles themselves. Valid until the next call.
  const Triangles& reduce(const FineMesh& mesh, const MeshDetail& detail);

 private:
  /// Nodes that a fold is drawn by, including its ends.
  using Joints = std::vector<int>;

  std::size_t fold(int row, int link) const;
  const Vec3& node(int row, int link, int p) const;
  std::uint32_t index(int row, int link, int p) const;
  void setTolerances(const MeshDetail& detail);
  void chooseLevels();
  void refineStrips();
  double foldError(int row, int link, std::size_t level, double enough) const;
  double stripError(int row, int link) const;
  void drawStrip(int row, int link);

  const FineMeshTopology& topology_;
  int links_;
  std::vector<Joints> levels_;  // from the ends alone to all nodes; each has about twice the rods of the one before
  const FineMesh* mesh_ = nullptr;
  std::vector<double> strip_tolerance_;  // [m], of the strip below each fold
  std::vector<std::size_t> level_;       // of each fold
  std::vector<double> error_;            // [m], of each fold
  std::vector<char> doubtful_;           // strips to check, by their upper fold
  Triangles triangles_;
};

}  // namespace curtain
