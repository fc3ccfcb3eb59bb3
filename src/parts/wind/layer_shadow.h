// SPDX-License-Identifier: BSD-3-Clause
//
// The shadow that cloths cast on each other in the wind of a source (WindParams::shadow). The pores of a cloth let the
// share c_mu mu of the pressure through (Cheng 2000, Eq. (3)); that share continues along the line from the node's
// place on the disc (WindSource::origin()). The share of the wind that reaches a node is the product over all sheets of
// other cloths that its line crosses: none behind a dense one, all of it beside. Sheets that reach through the disc's
// plane may be missed there.
//
//     disc |        | sheer    | blackout
//        B *--------|----------|--- C        mu_sheer mu_blackout of the wind, with c_mu = 1
//          |        |          |
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/coarse_mesh.h"
#include "parts/wind/wind_source.h"

namespace curtain {

/// Not thread-safe. Allocates only in the constructor, and nothing for one cloth.
class LayerShadow {
 public:
  /// pattern must outlive this.
  explicit LayerShadow(const ClothPattern& pattern);

  /// There are other cloths that may shade.
  bool any() const noexcept { return !triangles_.empty(); }

  /// Multiplies the source's shade by what other cloths leave of its wind.
  void cast(const Field3& position, WindSource& wind) noexcept;

 private:
  // On the disc's plane.
  struct Place {
    double u, v;
  };
  struct Triangle {
    std::uint32_t corners[3];
    int layer;
  };
  Place placeOf(const Vec3& point, const WindSource& wind) const noexcept;
  int cellAlong(double place, double from) const noexcept;
  void sortIntoCells(const Field3& position, const WindSource& wind) noexcept;
  double shareAt(std::size_t node, int layer, const Field3& position, const WindSource& wind) const noexcept;

  const ClothPattern& pattern_;
  std::vector<Triangle> triangles_;
  // Triangles by the cell of their box's lower corner. Cells are as large as the largest box, so that those which may
  // cover a point begin in its cell or in the one before, either way.
  std::vector<Place> places_;          // of the nodes
  std::vector<Place> lows_;            // of the triangles' boxes
  std::vector<std::uint32_t> sorted_;  // triangles, cell by cell
  std::vector<std::uint32_t> begins_;  // of each cell in sorted_
  Place low_{0.0, 0.0};                // of all boxes
  double size_ = 1.0;                  // of a cell [m]
};

}  // namespace curtain
