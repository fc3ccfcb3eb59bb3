// SPDX-License-Identifier: BSD-3-Clause
//
// What of the cloth is near one obstacle, for some time: all in the obstacle's frame, where it rests. Nodes are expected to
// go straight on; as long as none strays from its way by more than a slack, the lists hold all that can touch.
//
//      expected way           nodes    those that may come within the thickness
//   A ------------> B         faces    triangles that may come nearer than the core (convex shapes)
//      ( obstacle )           pairs    cloth edge x obstacle edge, cloth triangle x obstacle corner that may (meshes)
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"
#include "cloth/coarse_mesh.h"
#include "contact/obstacle_set.h"
#include "contact/rough_features.h"

namespace curtain {

/// A cloth edge (2 nodes) and an obstacle edge, or a cloth triangle (3 nodes) and an obstacle corner.
struct FeaturePair {
  std::array<std::uint32_t, 3> node{};
  std::uint32_t feature = 0;  ///< index of the edge or the corner in the obstacle's features
  bool edges = false;
};

/// The surface as it was found from a point.
struct NodePlane {
  Vec3 at = Vec3::Zero();                  ///< that point [m]
  SurfacePoint surface;                    ///< distance: at least that when not found
  enum class Kind : std::uint8_t { kUnknown, kFar, kFound } kind = Kind::kUnknown;

  /// No point of the surface is nearer to p than this, for certain [m]; of use outside.
  double lowerBound(const Vec3& p) const noexcept { return surface.distance - (p - at).norm(); }
  /// Height over the tangent plane [m]; of a convex shape a lower bound of the distance.
  double height(const Vec3& p) const noexcept { return surface.distance + surface.normal.dot(p - at); }
  void carry(Archive& archive);
};

class Vicinity {
 public:
  /// thickness: kept between nodes and obstacle [m]; core: between faces and obstacle; pattern and shape must outlive this.
  /// Allocates all there is to.
  Vicinity(const ClothPattern& pattern, const ObstacleShape& shape, double thickness, double core);

  /// Makes sure that the lists hold for a substep of h [s] from start to predicted, and takes these positions over.
  /// frame: about for how long lists shall hold [s].
  void prepare(const MovingObstacle& moving, const Field3& start, const Field3& predicted, double h, double frame) noexcept;
  /// The same after the solve: where nodes really go.
  void follow(const MovingObstacle& moving, const Field3& start, const Field3& end, double h) noexcept;
  /// Time goes on.
  void advance(double h) noexcept { elapsed_ += h; }
  void forget() noexcept;
  void carry(Archive& archive);

  const std::vector<std::uint32_t>& nodes() const noexcept { return nodes_; }
  const std::vector<MeshTriangle>& faces() const noexcept { return faces_; }
  const std::vector<FeaturePair>& pairs() const noexcept { return pairs_; }

  /// Of a listed node (or one of a listed element), in the obstacle's frame [m].
  Vec3 startOf(std::size_t node) const noexcept { return start_.at(node); }
  Vec3 endOf(std::size_t node) const noexcept { return end_.at(node); }
  NodePlane& plane(std::size_t node) noexcept { return planes_[node]; }
  const NodePlane& plane(std::size_t node) const noexcept { return planes_[node]; }

  /// The node starts the substep inside the obstacle; what has such a node is on its way out, and nothing may stop it.
  void setInside(std::size_t node, bool inside) noexcept { inside_[node] = inside ? 1 : 0; }
  bool isInside(std::size_t node) const noexcept { return inside_[node] != 0; }
  /// The node starts the substep this far out [m]: lists that count on more end with it.
  void setDistance(std::size_t node, double distance) noexcept;

  const ObstacleShape& shape() const noexcept { return shape_; }
  double thickness() const noexcept { return thickness_; }
  double core() const noexcept { return core_; }
  /// Faces and edges can come nearer than the core while the nodes keep the thickness.
  bool elementsWanted() const noexcept { return elements_wanted_; }

 private:
  void look(const MovingObstacle& moving, const Field3& start, const Field3& predicted, double h, double frame) noexcept;
  void adaptSlack(bool early) noexcept;
  void lookAtNodes() noexcept;
  void lookAtElements() noexcept;
  void addFace(const MeshTriangle& triangle) noexcept;
  template <typename Features>
  void addPairs(const QuadElements& quad, const Features& features) noexcept;
  template <typename Features>
  void addEdgePairs(const MeshEdge& edge, const Features& features) noexcept;
  template <typename Features>
  void addCornerPairs(const MeshTriangle& triangle, const Features& features) noexcept;
  void takeNodes(const std::uint32_t* first, std::size_t count) noexcept;
  void takeOver(const MovingObstacle& moving, const Field3& start, const Field3& end) noexcept;
  double strayed(const Transform& place, const Field3& position, double h) const noexcept;

  const ClothPattern& pattern_;
  const ObstacleShape& shape_;
  double thickness_, core_;
  double longest_;   // edge of the cloth's mesh [m]
  bool elements_wanted_;
  RoughFeatures rough_;  // of a mesh, while the nodes keep their distance
  double slack_;     // [m]
  double length_ = 0.0, elapsed_ = 0.0;  // [s]; length 0: there is none
  Field3 from_, to_;                     // expected way, obstacle's frame [m]
  Field3 start_, end_;                   // of this substep, of the nodes in taken_
  std::vector<NodePlane> planes_;        // by node
  std::vector<double> bound_;            // by node: nearest that it may come on its way [m]
  std::vector<std::uint8_t> inside_;     // by node
  std::vector<std::uint8_t> keeps_;      // by node: it was far enough out when the lists were made
  bool outdated_ = false;                // a node is nearer than the lists count on
  std::vector<std::uint8_t> is_taken_;   // by node
  std::vector<std::uint32_t> taken_;     // nodes whose positions are taken over
  std::vector<std::uint32_t> nodes_;
  std::vector<MeshTriangle> faces_;
  std::vector<FeaturePair> pairs_;
};

}  // namespace curtain
