// SPDX-License-Identifier: BSD-3-Clause
//
// Where carriers are on their rail for an opening. Of a curtain, or each half of a pair, the carrier at the rail's end
// stays there, and neighbours are
//     d = gap + spread (r - gap),
// apart along the rail, r being the length of cloth between them. So d lies between the gap (spread 0: open) and r.
// Shut, the curtain is as wide as its part of the rail, or as its cloth almost allows.
#pragma once

#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

class RailLayout {
 public:
  RailLayout() = default;
  /// For a scene whose rail has no problem.
  explicit RailLayout(const Scene& scene);

  /// Columns of the scene's carriers.
  static std::vector<int> columnsOf(const Scene& scene);
  /// Length of cloth from each carrier to the next, along the top row [m].
  static std::vector<double> clothBetween(const Scene& scene, const std::vector<int>& columns);

  /// Carriers of the curtain, or of half of a pair, in the order of the columns: [first, end).
  struct Half {
    std::size_t first, end;
    bool from_end;     ///< it gathers at the rail's end, not at its beginning
    double cloth;      ///< length of its cloth between carriers [m]
    double widest;     ///< length of rail that it covers when shut, if its cloth reaches so far [m]
    double narrowest;  ///< when open: its gaps [m]
  };
  /// The halves of these carriers on a rail of this length [m].
  static std::vector<Half> halvesOf(const RailParams& rail, const std::vector<int>& columns,
                                    const std::vector<double>& cloth, double length);

  /// Places of all carriers along the rail [m].
  std::vector<double> placesFor(double opening) const;
  /// Carriers that the drive moves.
  const std::vector<std::size_t>& masters() const noexcept { return masters_; }
  /// Mean opening of the masters at these places of theirs [m].
  double openingOf(const double* places) const noexcept;

 private:
  std::vector<double> cloth_;
  std::vector<Half> halves_;
  double gap_ = 0.0, length_ = 0.0;
  std::vector<std::size_t> masters_;
  std::vector<double> shut_, open_;  // of all carriers
};

}  // namespace curtain
