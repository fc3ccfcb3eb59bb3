// SPDX-License-Identifier: BSD-3-Clause
//
// Proof that several flat cloths touch neither themselves nor each other: each is flat (cloth_flatness.h), and any two
// have a plane between them.
//
//        /     |        Further than the reach from each other, the cloths are on either side of a plane. On straight
//     a /    b |        ways of the nodes a plane that has them so at both ends, and each on the same side, has them so
//      /   :   |        in between. Its normal is that of the first cloth at the start.
#pragma once

#include <cstddef>
#include <vector>

#include "contact/broad_phase/cloth_flatness.h"

namespace curtain {

/// Not thread-safe. See ClothFlatness, whose functions these are for all cloths of a pattern.
class FlatCloths {
 public:
  /// overlong: largest strain of a link [1].
  FlatCloths(const ClothPattern& pattern, double overlong);

  void pinsChanged() noexcept;
  bool isFlat(const Field3& position, double reach) noexcept;
  bool staysFlat(const Field3& end, double reach) noexcept;
  void advance() noexcept;
  void invalidate() noexcept;
  void setOverlong(double overlong) noexcept;

 private:
  struct Cloth {
    ClothFlatness flatness;
    std::size_t first, end;  // columns
  };
  // What keeps two of them apart.
  struct Plane {
    std::size_t one, other;
    Vec3 normal = Vec3::Zero();  // unit, from the one to the other
  };
  struct Gaps {
    double up, down;
  };
  Gaps gapsAlong(const Plane& plane, const Field3& position) const noexcept;

  const ClothPattern& pattern_;
  std::vector<Cloth> cloths_;
  std::vector<Plane> planes_;  // of all pairs
};

}  // namespace curtain
