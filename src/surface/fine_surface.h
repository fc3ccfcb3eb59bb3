// SPDX-License-Identifier: BSD-3-Clause
//
// The displayed mesh, from the nodes and the obstacles. The contact solver keeps the first layer's triangles outside of
// obstacles, but not the strips of fine triangles between the folds of two rows. Until no strip is nearer to an
// obstacle than a share of the thickness its folds are, from the least change to the most,
//
//   turned     about the chord: every rod keeps its length
//   lifted     the nodes are pushed out along the obstacle's normals: rods change their length
//   gathered   all nodes are put at the link's right end. A strip between two such folds is the first layer's quad:
//
//        a----------b = all nodes of the upper fold       a,c,b and b,c,d are the quad's two triangles, all others of
//        |       /  |                                     the strip have no area. So this always ends with no triangle
//        |    /     |                                     in an obstacle, if the quad is outside.
//        c----------d = all nodes of the lower fold
//
// Where the quad itself is in an obstacle only the strip's nodes are kept outside.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cloth/folds.h"
#include "contact/narrow_phase/element_clearance.h"
#include "curtain_sim/fine_mesh.h"
#include "obstacles/obstacle_set.h"

namespace curtain {

/// Not thread-safe. Same nodes and obstacles: same bits. Allocates nothing once the cloth was near its obstacles.
class FineSurface {
 public:
  FineSurface(const ClothParams& cloth, const ClothPattern& pattern);

  const FineMeshTopology& topology() const { return *topology_; }
  /// Takes another one's, which is the same: references to it stay good.
  void shareTopology(const FineSurface& other) { topology_ = other.topology_; }

  /// thickness [m], > 0: of the contact; the fine mesh keeps a share of it.
  void build(const Field3& position, ObstacleSet& obstacles, double thickness, FineMesh& out);

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
    double clearance = 0.0;  ///< to keep [m]; negative: none
  };

  void findNear(const Field3& position, ObstacleSet& obstacles);
  void findStrips();
  void settleFold(int row, int link);
  void settleStrips();
  bool turn(Strip& strip);
  bool lift(const Strip& strip);
  bool gather(const Strip& strip);
  /// Rows of the folds of one link to move.
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
  void liftFolds(const Strip& strip, Rows rows, double lift);
  bool allFree(Rows rows, int link, Stage most);
  bool isClear(int row, int link, double clearance);
  bool isRodClear(int row, int link, double clearance);
  bool keeps(const std::vector<MeshTriangle>& triangles, double clearance);
  double clearanceOf(int row, int link);
  const Strip* stripAt(int row, int link) const;

  const ClothPattern& pattern_;
  FoldShape shape_;
  std::shared_ptr<const FineMeshTopology> topology_;
  int links_;
  std::vector<MeshTriangle> strip_triangles_;  // points: the upper fold, left to right, then the lower one
  std::vector<MeshTriangle> rods_;             // of one fold
  std::vector<MeshTriangle> quad_triangles_;   // points: the corners
  Field3 area_vectors_;
  std::vector<Fold> folds_;
  std::vector<Strip> strips_;                // near obstacles, row by row
  std::vector<std::int32_t> strip_at_;       // of a quad, in strips_; -1: no obstacle near
  std::vector<const MovingObstacle*> near_;  // obstacles whose box meets the cloth's
  std::vector<Vec3> points_, kept_;
  ElementClearance clearance_;
  // Of the present build.
  const Field3* position_ = nullptr;
  FineMesh* mesh_ = nullptr;
  double wanted_ = 0.0;  // clearance [m]
  double least_ = 0.0;   // clearance that will do [m]
};

}  // namespace curtain
