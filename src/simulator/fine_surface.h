// SPDX-License-Identifier: BSD-3-Clause
//
// The mesh that the eye sees, from the nodes and the obstacles. The first layer's triangles are outside the obstacles
// by the contact solver; a strip of fine triangles, between the folds of two rows, need not be. What is done to a fold,
// from the least to the most, until no strip comes nearer to an obstacle than a share of the thickness:
//
//   turned     about its chord: every rod keeps its length
//   lifted     its nodes are pushed out along the obstacle's normals: rods get longer or shorter
//   gathered   all its nodes at the link's right end. A strip between two such folds is the first layer's quad itself:
//
//        a----------b = all nodes of the upper fold       a,c,b and b,c,d are the quad's two triangles, all other
//        |       /  |                                     triangles of the strip have no area. So this always ends,
//        |    /     |                                     with no triangle in an obstacle, where the quad is outside.
//        c----------d = all nodes of the lower fold
//
// Where the quad itself is in an obstacle the strip is given up: only its nodes are kept outside.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cloth/folds.h"
#include "contact/narrow_phase/element_clearance.h"
#include "contact/shapes/obstacle_set.h"
#include "curtain_sim/fine_mesh.h"

namespace curtain {

/// Not thread-safe. Same nodes and obstacles: same bits. Allocates nothing once it has seen the cloth near its
/// obstacles.
class FineSurface {
 public:
  FineSurface(const ClothParams& cloth, const ClothPattern& pattern);

  const FineMeshTopology& topology() const { return topology_; }

  /// thickness [m], > 0: of the contact; what the fine mesh keeps off obstacles is a share of it.
  void build(const Field3& position, const ObstacleSet& obstacles, double thickness, FineMesh& out);

 private:
  enum class Stage : std::uint8_t { kFree, kLifted, kGathered };
  struct Fold {
    double turn = 0.0;  ///< about the chord, towards the next row [rad]
    Stage stage = Stage::kFree;
    bool near = false;  ///< an obstacle is in its reach
  };
  struct Strip {
    int row;                 ///< of its upper fold
    int link;                ///< of both
    double clearance = 0.0;  ///< to keep [m]; negative: given up
  };

  void findNear(const Field3& position, const ObstacleSet& obstacles);
  void findStrips();
  void settleFold(int row, int link);
  void settleStrips();
  bool turn(Strip& strip);
  bool lift(const Strip& strip);
  bool gather(const Strip& strip);
  /// Rows of the folds to move, of one link.
  struct Rows {
    int first, last;
  };
  std::optional<double> tryTurn(const Strip& strip, Rows rows);
  std::optional<double> tryLift(const Strip& strip, Rows rows);
  template <typename Move>
  auto test(const Strip& strip, Rows rows, Move move);

  Fold& fold(int row, int link) { return folds_[static_cast<std::size_t>(row * links_ + link)]; }
  /// Fine node p of a fold, 0 and k being the link's ends.
  Vec3& node(int row, int link, int p);
  void place(int row, int link, double angle);
  void liftFolds(const Strip& strip, Rows rows, double way);
  bool allFree(Rows rows, int link, Stage most);
  bool isClear(int row, int link, double clearance);
  bool isRodClear(int row, int link, double clearance);
  bool keeps(const std::vector<MeshTriangle>& triangles, double clearance);
  double clearanceOf(int row, int link);
  const Strip* stripAt(int row, int link) const;

  const ClothPattern& pattern_;
  FoldShape shape_;
  FineMeshTopology topology_;
  int links_;
  std::vector<MeshTriangle> strip_triangles_;  // points: the upper fold's, left to right, then the lower one's
  std::vector<MeshTriangle> rods_;             // of one fold
  std::vector<MeshTriangle> quad_triangles_;   // points: the corners
  Field3 area_vectors_;
  std::vector<Fold> folds_;
  std::vector<Strip> strips_;                // near obstacles, row by row
  std::vector<std::int32_t> strip_at_;       // of a quad, in strips_; -1: no obstacle near
  std::vector<const MovingObstacle*> near_;  // obstacles that the cloth's box touches
  std::vector<Vec3> points_, kept_;
  ElementClearance clearance_;
  // Of the present build.
  const Field3* position_ = nullptr;
  FineMesh* mesh_ = nullptr;
  double wanted_ = 0.0;  // clearance [m]
  double least_ = 0.0;   // clearance where that can't be had [m]
};

}  // namespace curtain
