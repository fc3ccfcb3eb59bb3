// SPDX-License-Identifier: BSD-3-Clause
//
// The curtain's nodes and fine mesh, which several outputs need. Each is copied when the first of them asks for it, and
// again only when the cloth may have moved.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain_ros {

/// The source blows at this time [s].
inline bool blows(const curtain::WindParams& wind, double time) { return wind.start <= time && time < wind.end; }

/// Simulation thread only.
class GeometryCache {
 public:
  /// simulator must outlive this.
  explicit GeometryCache(const curtain::Simulator& simulator) : simulator_(simulator) {}

  const curtain::Simulator& simulator() const { return simulator_; }

  /// The simulator's, which the others are of.
  std::uint64_t revision() const { return simulator_.revision(); }

  /// First-layer nodes [m], row-major; valid until the next call.
  const std::vector<curtain::Vec3>& nodes() {
    if (nodes_revision_ != revision()) simulator_.copyPositions(nodes_);
    nodes_revision_ = revision();
    return nodes_;
  }

  /// Both layers; valid until the next call.
  const curtain::FineMesh& fineMesh() {
    if (mesh_revision_ != revision()) simulator_.copyFineMesh(mesh_);
    mesh_revision_ = revision();
    return mesh_;
  }

 private:
  const curtain::Simulator& simulator_;
  std::optional<std::uint64_t> nodes_revision_, mesh_revision_;
  std::vector<curtain::Vec3> nodes_;
  curtain::FineMesh mesh_;
};

}  // namespace curtain_ros
