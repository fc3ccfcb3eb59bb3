// SPDX-License-Identifier: BSD-3-Clause
//
// What of a mesh the quads of the cloth may come near in a substep, mostly told without asking the mesh:
//
//            o---o  quad on its way    A window is a ball around a quad, and a plane that the mesh's edges and
//        .---|---|---.                 corners in the ball are under, those that cloth can touch. It tells of the
//       /    o---o    \                mesh alone, so it holds for ever, whatever the cloth does. A quad whose
//      |===============|  plane        corners stay in the ball and over the plane, both by more than a reach,
//       \  /\_  _/\_  /                from where they start to where they end, keeps that reach: it lies within
//        '-/---\----'   mesh           its corners' hull, and what is out of the ball is further off than its border.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cloth/coarse_mesh.h"
#include "cloth/field.h"
#include "contact/shapes/contact_shape.h"
#include "contact/shapes/obstacle_features.h"

namespace curtain {

/// The corners of a quad where they start and where they end.
class SweptQuad {
 public:
  SweptQuad(const QuadElements& quad, const Field3& start, const Field3& end) noexcept;
  Vec3 middle() const noexcept;
  /// How far the furthest of them is from a point [m].
  double furthest(const Vec3& from) const noexcept;
  /// The lowest normal . (x - from) [m].
  double lowest(const Vec3& normal, const Vec3& from) const noexcept;

 private:
  std::array<double, 8> x_, y_, z_;
};

/// What a window tells of a quad.
enum class QuadClearance : std::uint8_t {
  kUnknown,  ///< the quad leaves the ball
  kClear,    ///< it keeps the reach, for certain
  kNear      ///< what is within reach is in the window's list
};

class MeshClearance {
 public:
  MeshClearance() = default;
  /// For a cloth of that grid and a mesh, which must outlive this.
  MeshClearance(const Grid& grid, const ContactShape& mesh);

  /// What the windows tell of the quads between rows `row` and `row + 1` while their corners go straight from start to
  /// end (obstacle's frame), for a reach [m]; by the quad's column. Good until that row is asked again. Thread-safe for
  /// different rows, as is rebuild().
  const QuadClearance* classify(int row, const Field3& start, const Field3& end, double reach) noexcept;
  /// Makes a window for a quad's way.
  QuadClearance rebuild(const QuadElements& quad, const SweptQuad& way, double reach) noexcept;
  void invalidate() noexcept;

  /// Calls edge(index, edge) and corner(index, vertex) for features of the mesh, of a quad that is near all those
  /// within reach of `box`, which is around its way.
  template <typename Edge, typename Corner>
  void forEachNear(const QuadElements& quad, const SweptQuad& way, double reach, const Eigen::AlignedBox3d& box,
                   Edge&& edge, Corner&& corner) const {
    const ObstacleFeatures& features = *mesh_->features();
    const auto takeEdge = [&](std::uint32_t n, const ObstacleEdge& e) {
      if (e.touchable) edge(n, e);
    };
    const auto takeCorner = [&](std::uint32_t n, const ObstacleVertex& v) {
      if (v.touchable) corner(n, v);
    };
    const std::size_t window = quad.corners[0];
    const double least = way.lowest(normal_.at(window), centre_.at(window)) - reach;
    const HighestFeatures& highest = highest_[window];
    if (highest.rest >= least) {
      features.forEachEdgeIn(box, takeEdge);
      features.forEachVertexIn(box, takeCorner);
      return;
    }
    for (std::size_t k = 0; k < highest.count && highest.heights[k] >= least; ++k) {
      const std::uint32_t feature = highest.features[k];
      if ((feature & kCorner) != 0)
        features.ifVertexIn(box, feature & ~kCorner, takeCorner);
      else
        features.ifEdgeIn(box, feature, takeEdge);
    }
  }

 private:
  static constexpr std::uint32_t kCorner = 1U << 31;  // marks one

  // The features in a ball that reach highest over its plane, the highest first.
  struct HighestFeatures {
    static constexpr std::size_t kMost = 24;
    std::size_t count = 0;
    double rest = 0.0;                  // no other is higher [m]
    std::array<double, kMost> heights;  // normal . (x - centre) at most [m]
    std::array<std::uint32_t, kMost> features;

    void insert(double height, std::uint32_t feature) noexcept;
  };

  Grid grid_;
  const ContactShape* mesh_ = nullptr;
  Field3 centre_;  // of the balls, by the quads' upper left nodes [m]
  Field radius_;   // negative: there is no window yet [m]
  Field3 normal_;  // unit, the way out of the mesh; zero where it is far
  Field top_;      // of the highest feature in the ball [m]
  std::vector<HighestFeatures> highest_;
  std::vector<QuadClearance> clearances_;  // of the quads, as the windows
};

}  // namespace curtain
