// SPDX-License-Identifier: BSD-3-Clause
//
// Which features of an obstacle mesh a quad of the cloth may come near in a substep, cached so that the mesh is rarely
// asked:
//
//            o---o  swept quad    A window is a ball around a quad, and a plane above all touchable edges and corners
//        .---|---|---.            of the mesh in the ball. It depends on the mesh only, so it stays valid wherever the
//       /    o---o    \           cloth goes. A quad whose corners stay within the ball and above the plane, each by
//      |===============|  plane   more than the reach, is clear: it lies in the hull of its corners, and everything
//       \  /\_  _/\_  /           outside the ball is further away than the ball's border.
//        '-/---\----'   mesh
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cloth/coarse_mesh.h"
#include "cloth/field.h"
#include "contact/broad_phase/swept_directions.h"
#include "obstacles/contact_shape.h"
#include "obstacles/obstacle_features.h"

namespace curtain {

/// The corners of a quad at the start and at the end of its motion.
class SweptQuad {
 public:
  SweptQuad(const QuadElements& quad, const Field3& start, const Field3& end) noexcept;
  Vec3 middle() const noexcept;
  /// Largest distance of a corner from a point [m].
  double furthest(const Vec3& from) const noexcept;
  /// Least normal . (x - from) [m].
  double lowest(const Vec3& normal, const Vec3& from) const noexcept;

 private:
  std::array<double, 8> x_, y_, z_;
};

/// What a window tells about a quad.
enum class QuadClearance : std::uint8_t {
  kUnknown,  ///< the quad leaves the ball: rebuild()
  kClear,    ///< no feature within reach, for certain
  kNear      ///< features within reach are in the window's list
};

class MeshClearance {
 public:
  MeshClearance() = default;
  /// mesh must outlive this.
  MeshClearance(const Grid& grid, const ContactShape& mesh);

  /// Classifies the quads between rows `row` and `row + 1`, whose corners move straight from start to end (obstacle's
  /// frame), for a reach [m]. Returns one value per column, valid until the row is classified again. Thread-safe for
  /// different rows, as is rebuild().
  const QuadClearance* classify(int row, const Field3& start, const Field3& end, double reach) noexcept;
  /// Makes a new window around a quad's motion.
  QuadClearance rebuild(const QuadElements& quad, const SweptQuad& swept, double reach) noexcept;
  void invalidate() noexcept;

  /// Calls edge(index, edge) and corner(index, vertex) for touchable features, at least all within reach of a quad that
  /// is near and may have its nearest points there by its directions. box: around its motion, grown by the reach.
  template <typename Edge, typename Corner>
  void forEachNear(const QuadElements& quad, const SweptQuad& swept, const SweptDirections& directions, double reach,
                   const Eigen::AlignedBox3d& box, Edge&& edge, Corner&& corner) const {
    const ObstacleFeatures& features = *mesh_->features();
    const auto addEdge = [&](std::uint32_t n, const ObstacleEdge& e) {
      if (e.touchable) edge(n, e);
    };
    const auto addCorner = [&](std::uint32_t n, const ObstacleVertex& v) {
      if (v.touchable) corner(n, v);
    };
    const std::size_t window = quad.corners[0];
    const double least = swept.lowest(normal_.at(window), centre_.at(window)) - reach;
    const HighestFeatures& highest = highest_[window];
    if (highest.rest >= least) {
      const auto edgesMeet = [&](const NormalCone& normals) { return directions.edgesMeet(normals); };
      const auto facesMeet = [&](const NormalCone& normals) { return directions.facesMeet(normals); };
      features.forEachEdgeIn(box, edgesMeet, addEdge);
      features.forEachVertexIn(box, facesMeet, addCorner);
      return;
    }
    for (std::size_t k = 0; k < highest.count && highest.heights[k] >= least; ++k) {
      const std::uint32_t feature = highest.features[k];
      if ((feature & kCorner) != 0)
        features.ifVertexIn(box, feature & ~kCorner, addCorner);
      else
        features.ifEdgeIn(box, feature, addEdge);
    }
  }

 private:
  static constexpr std::uint32_t kCorner = 1U << 31;  // marks the index of a corner

  // The features in a ball that are highest above its plane, the highest first.
  struct HighestFeatures {
    static constexpr std::size_t kMost = 24;
    std::size_t count = 0;
    double rest = 0.0;                  // bound of the heights of all others [m]
    std::array<double, kMost> heights;  // largest normal . (x - centre) [m]
    std::array<std::uint32_t, kMost> features;

    void insert(double height, std::uint32_t feature) noexcept;
  };

  Grid grid_;
  const ContactShape* mesh_ = nullptr;
  Field3 centre_;  // of the balls, by a quad's upper left node [m]
  Field radius_;   // negative: no window yet [m]
  Field3 normal_;  // unit, out of the mesh; zero where it is far
  Field top_;      // height of the highest feature in the ball [m]
  std::vector<HighestFeatures> highest_;
  std::vector<QuadClearance> clearances_;  // by a quad's upper left node
};

}  // namespace curtain
