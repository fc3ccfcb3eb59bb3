// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: what several outputs need of a curtain's shape. Each part is made when the first of them asks for it, and
// again only when the shape may have changed.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain_ros {

/// Simulation thread only.
class Shape {
 public:
  /// simulator must outlive this.
  explicit Shape(const curtain::Simulator& simulator) : simulator_(simulator) {}

  const curtain::Simulator& simulator() const { return simulator_; }

  /// The number of the shape that the others give.
  std::uint64_t revision() const { return simulator_.revision(); }

  /// First-layer nodes [m], row-major; valid until the next call.
  const std::vector<curtain::Vec3>& nodes() {
    if (isNew(nodes_revision_)) simulator_.copyPositions(nodes_);
    return nodes_;
  }

  /// Both layers; valid until the next call.
  const curtain::FineMesh& fineMesh() {
    if (isNew(mesh_revision_)) simulator_.copyFineMesh(mesh_);
    return mesh_;
  }

 private:
  bool isNew(std::optional<std::uint64_t>& known) const {
    if (known == revision()) return false;
    known = revision();
    return true;
  }

  const curtain::Simulator& simulator_;
  std::optional<std::uint64_t> nodes_revision_, mesh_revision_;
  std::vector<curtain::Vec3> nodes_;
  curtain::FineMesh mesh_;
};

}  // namespace curtain_ros
