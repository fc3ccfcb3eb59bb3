// SPDX-License-Identifier: BSD-3-Clause
//
// Proof that a cloth is too flat for self-contact, from few of its nodes: links do not get longer, so a line of
// links whose ends are as far apart as it is long is straight, and the nodes between need not be read.
//
// Let m links of lengths l span c m l, 0 < c <= 1, along the unit vector n, none longer than (1 + e) l. Their vectors r
// sum to c m l n, so the others can make up only so much for one that deviates:
//
//     r . n >= c m l - (m - 1) (1 + e) l = (1 - s) l,   s = m (1 - c) + (m - 1) e,
//     |r / l - c n|^2 <= (1 + e)^2 - 2 c (1 - s) + c^2.
//
// Rods are checked in strips of a few rows, in every column; weft links in a few spans of columns, in every row. All
// slopes then lie in balls around those of the lines, and the bound of contact/narrow_phase/flatness.h applies: along
// two fixed orthonormal directions a (weft) and b (warp) no eigenvalue of the symmetric part of the slopes is below
// reach / (least altitude of a triangle). The condition is concave: if it holds at both ends of a straight motion, it
// holds in between.
#pragma once

#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// Not thread-safe.
class ClothFlatness {
 public:
  /// Of the cloth whose columns are [first, end). overlong: largest strain of a link [1].
  ClothFlatness(const ClothPattern& pattern, int first, int end, double overlong);

  /// The pattern's pins have changed.
  void pinsChanged() noexcept;

  /// True: any two elements of the cloth without a common node are further apart than `reach` [m]; false: unknown. No
  /// link, except between pins, may be longer than `overlong` allows. Allocates nothing.
  bool isFlat(const Field3& position, double reach) noexcept;

  /// After isFlat() returned true for the start: the same during a straight motion of all nodes from there to `end`.
  bool staysFlat(const Field3& end, double reach) noexcept;
  /// Across the cloth, of about unit length; after isFlat() returned true.
  Vec3 normal() const { return start_.a.cross(start_.b); }

  /// The end of the last staysFlat() is the start of the next isFlat(), whose measurement is kept.
  void advance() noexcept {
    start_ = end_;
    end_.known = false;
  }
  void invalidate() noexcept { start_.known = end_.known = false; }
  /// Sets the largest strain of a link [1].
  void setOverlong(double overlong) noexcept {
    overlong_ = overlong;
    invalidate();
  }

 private:
  // Bounds of the slopes along a and b, over all links.
  struct Slopes {
    double min_u, max_u_across;  // of weft links: least along a; largest |.| along b
    double min_v, max_v_across;  // of rods: least along b; largest |.| along a
    void merge(const Slopes& other) noexcept;
  };
  struct Span {
    std::size_t first, last;  // first and last row (of a strip) or column
    double per_length;        // 1 / rest length [1/m]
    double links;             // number of links
  };
  static std::vector<Span> spansOf(const Field& coordinate, int max_links);
  bool isRegular() const;
  Vec3 warpDirection(const Field3& position) const noexcept;
  // Slopes of the cloth along directions that suit it.
  struct Projection {
    bool known = false, has_directions = false;
    Vec3 a, b;
    Slopes slopes;
  };
  bool chooseDirections(const Field3& position, Projection& projection) const noexcept;
  void measure(const Field3& position, Projection& projection) const noexcept;
  Slopes slopesOf(const Field3& position, const Projection& projection) const noexcept;
  double slopeDeviation(double min_square, const Span& span) const noexcept;
  bool areFlat(const Slopes& slopes, double reach) const noexcept;
  bool topRowHolds(const Field3& position) const noexcept;

  const ClothPattern& pattern_;
  int first_, end_column_;
  double overlong_;
  bool regular_;
  bool usable_ = false;
  bool checks_top_ = false;  // pins are side by side in the top row, and may be moved apart
  std::vector<Span> strips_, spans_;
  double per_altitude_ = 0.0;  // [1/m]
  Projection start_, end_;
};

}  // namespace curtain
