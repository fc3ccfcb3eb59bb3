// SPDX-License-Identifier: BSD-3-Clause
//
// Candidates for contact with one obstacle: all in the obstacle's frame, where it rests.
//
//      expected path          nodes    those that may come within nodeReach()
//   A ------------> B         faces    triangles that may come within elementReach() (convex shapes)
//      ( obstacle )           pairs    cloth edge x obstacle edge, cloth triangle x obstacle corner that may (meshes)
//
// Near a convex shape they are found anew for every way. Near a mesh nodes are expected to go straight on, and the lists serve
// while none is further than a slack from its expected path, which is measured in every substep. Either way they hold all
// that comes within reach, and who takes them asks each candidate for its own distance: nothing tells how old they are.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"
#include "cloth/coarse_mesh.h"
#include "contact/shapes/obstacle_set.h"
#include "contact/shapes/rough_features.h"

namespace curtain {

/// A cloth edge (2 nodes) and an obstacle edge, or a cloth triangle (3 nodes) and an obstacle corner.
struct FeaturePair {
  std::array<std::uint32_t, 3> node{};
  std::uint32_t feature = 0;  ///< index of the edge or the corner in the obstacle's features
  bool edges = false;
  bool smooth = false;        ///< a cloth whose nodes keep their distance can't come near it: see RoughFeatures
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
};

class Vicinity {
 public:
  /// A face of the cloth, and its own number.
  struct Face {
    MeshTriangle node;
    std::uint32_t index;
  };

  /// thickness: kept between nodes and obstacle [m]; core: between faces and obstacle; pattern and shape must outlive this.
  /// Allocates all there is to.
  Vicinity(const ClothPattern& pattern, const ObstacleShape& shape, double thickness, double core);

  /// Makes sure that the lists hold for a substep of h [s] from start to predicted, and takes these positions over.
  void prepare(const MovingObstacle& moving, const Field3& start, const Field3& predicted, double h) noexcept;
  /// The same for another end of the same substep: where nodes really go.
  void follow(const MovingObstacle& moving, const Field3& start, const Field3& end, double h) noexcept;
  /// The substep was accepted: the next one is expected further on the path.
  void advance(double h) noexcept { elapsed_ += h; }
  void forget() noexcept;

  const std::vector<std::uint32_t>& nodes() const noexcept { return nodes_; }
  const std::vector<Face>& faces() const noexcept { return faces_; }
  const std::vector<FeaturePair>& pairs() const noexcept { return pairs_; }

  /// Of a listed node (or one of a listed element), in the obstacle's frame [m].
  Vec3 startOf(std::size_t node) const noexcept { return start_.at(node); }
  Vec3 endOf(std::size_t node) const noexcept { return end_.at(node); }
  NodePlane& plane(std::size_t node) noexcept { return planes_[node]; }
  const NodePlane& plane(std::size_t node) const noexcept { return planes_[node]; }

  /// The plane at a face's nearest point, once that is known.
  NodePlane& facePlane(const Face& face) noexcept { return face_planes_[face.index]; }
  const NodePlane& facePlane(const Face& face) const noexcept { return face_planes_[face.index]; }

  /// Signed distance at the start of the substep, or the thickness when it is more [m].
  double distanceOf(std::size_t node) const noexcept { return distance_[node]; }
  /// The node starts the substep inside the obstacle; what has such a node is on its way out, and nothing may stop it.
  bool isInside(std::size_t node) const noexcept { return distance_[node] < 0.0 && !isPinned(node); }
  /// The node starts the substep nearer than nodes are kept.
  bool isClose(std::size_t node) const noexcept { return distance_[node] < kept_; }
  bool isPinned(std::size_t node) const noexcept { return pattern_.inverse_mass[node] <= 0.0; }

  const ObstacleShape& shape() const noexcept { return shape_; }
  double thickness() const noexcept { return thickness_; }
  double core() const noexcept { return core_; }
  /// What comes nearer in a substep is listed, for certain [m].
  double nodeReach() const noexcept { return 1.5 * thickness_; }
  double elementReach() const noexcept { return 0.5 * thickness_; }
  /// What comes nearer would go through, with room for what times of impact are early by [m].
  double crossingReach() const noexcept { return 2.0 * kLeast * thickness_; }
  /// Over the thickness: nearer than this is through.
  static constexpr double kLeast = 0.02;
  /// A list had no room for all there was: what is near is not known.
  bool full() const noexcept { return full_; }

 private:
  void rebuild(const MovingObstacle& moving, const Field3& start, const Field3& end, double h) noexcept;
  void look(const MovingObstacle& moving, const Field3& start, const Field3& predicted, double h) noexcept;
  bool measureStart() noexcept;
  void lookAtNodes() noexcept;
  void lookAtElements() noexcept;
  static void toLocal(const Transform& place, const Field3& position, Field3& out) noexcept;
  void startConvex(const MovingObstacle& moving, const Field3& start) noexcept;
  void listConvex(const MovingObstacle& moving, const Field3& end, double reach) noexcept;
  void listNodes(const Eigen::AlignedBox3d& box) noexcept;
  void listFaces(const Eigen::AlignedBox3d& box, double reach) noexcept;
  void lookAtStart(std::size_t node) noexcept;
  bool staysOver(const Face& face, double reach) noexcept;
  template <typename Features>
  void addPairs(const QuadElements& quad, const Features& features) noexcept;
  template <typename Features>
  void addEdgePairs(const MeshEdge& edge, const Features& features) noexcept;
  template <typename Features>
  void addCornerPairs(const MeshTriangle& triangle, const Features& features) noexcept;
  void addPair(const FeaturePair& pair) noexcept;
  void takeNodes(const std::uint32_t* first, std::size_t count) noexcept;
  void takeOver(const MovingObstacle& moving, const Field3& start, const Field3& end) noexcept;
  double strayed(const Transform& place, const Field3& position, double h) const noexcept;

  const ClothPattern& pattern_;
  const ObstacleShape& shape_;
  double thickness_, core_, kept_;
  double longest_ = 0.0;  // edge of the cloth's mesh on the expected path [m]
  bool elements_wanted_;
  RoughFeatures rough_;  // of a mesh, while the nodes keep their distance
  double slack_;     // [m]
  double length_ = 0.0, elapsed_ = 0.0;  // of the expected path, and gone of it [s]; length 0: there is none
  Field3 from_, to_;                     // its ends, obstacle's frame [m]
  Field3 start_, end_;                   // of this substep, of the nodes in taken_
  std::vector<NodePlane> planes_;        // by node
  std::vector<double> bound_;            // by node: nearest that it may come on its way; of a convex shape: its distance where it starts [m]
  std::vector<double> distance_;         // by node, see distanceOf(); the thickness for those not listed
  std::vector<std::uint8_t> keeps_;      // by node: the lists count on it not to be close
  std::uint32_t substep_ = 0;
  std::vector<std::uint32_t> looked_at_;   // by node: the substep at whose start its plane was found, of a convex shape
  std::vector<Eigen::AlignedBox3d> row_boxes_;  // around the nodes' ways, of a convex shape [m]
  bool full_ = false;
  std::vector<std::uint8_t> is_taken_;   // by node
  std::vector<std::uint32_t> taken_;     // nodes whose positions are taken over
  std::vector<std::uint32_t> nodes_;     // pinned ones too
  std::vector<Face> faces_;
  std::vector<NodePlane> face_planes_;     // by the faces' numbers, of a convex shape
  std::vector<FeaturePair> pairs_;
};

}  // namespace curtain
