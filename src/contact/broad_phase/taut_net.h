// SPDX-License-Identifier: BSD-3-Clause
//
// Is the cloth so flat that no two parts of it can come close? Told from few of its nodes: links do not get longer, so
// a line of links whose ends are as far apart as it is long is straight, and nothing between them needs to be looked
// at.
//
// Let m links of lengths l reach over c m l, 0 < c <= 1, along the unit vector n, none being longer than (1 + e) l.
// Their vectors r add up to c m l n, so each goes on along n by what the others can't make up for:
//
//     r . n >= c m l - (m - 1) (1 + e) l = (1 - s) l,   s = m (1 - c) + (m - 1) e,
//     |r / l - c n|^2 <= (1 + e)^2 - 2 c (1 - s) + c^2.
//
// Rods are looked at in strips of a few rows, in every column; weft links in a few spans of columns, in every row. With
// all slopes known to lie in balls around those of the lines, the bound of contact/narrow_phase/flatness.h says what is
// flat: along two fixed orthonormal directions a (weft) and b (warp) the symmetric part of the slopes has no eigenvalue
// below reach / (least altitude of a triangle). It is concave, so what holds where a straight way starts and ends holds
// between.
#pragma once

#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// Not thread-safe.
class TautNet {
 public:
  /// overlong: what links may be longer, over their length.
  TautNet(const ClothPattern& pattern, double overlong);

  /// True: any two elements of the cloth that share no node are further apart than `reach` [m]; false: who knows. All
  /// links but those between pins must be no more overlong than said. Allocates nothing.
  bool isFlat(const Field3& position, double reach) noexcept;

  /// After isFlat() has said so of the start: the same while all nodes move straight from there to `end`.
  bool staysFlat(const Field3& end, double reach) noexcept;

  /// isFlat() will be asked next of the end that staysFlat() was asked of last, and needs not look at it again; else
  /// forget().
  void goOn() noexcept {
    start_ = end_;
    end_.known = false;
  }
  void forget() noexcept { start_.known = end_.known = false; }

 private:
  // Of the slopes along a and b, what the links between the nodes looked at may add to them included.
  struct Slopes {
    double least_u, most_u_across;  // of weft links: along a at least; along b at most, either way
    double least_v, most_v_across;  // of rods: along b at least, along a at most
    void merge(const Slopes& other) noexcept;
  };
  struct Span {
    std::size_t first, last;  // rows (of the strip) or columns
    double per_length;        // [1/m] of the links between
    double links;             // how many
  };
  static std::vector<Span> spansOf(const Field& coordinate, int most_links);
  bool isEven(const ClothPattern& pattern) const;
  Vec3 middleOfWarp(const Field3& position) const noexcept;
  // The cloth as seen along directions of its own.
  struct View {
    bool known = false, aimed = false;
    Vec3 a, b;
    Slopes slopes;
  };
  bool aim(const Field3& position, View& view) const noexcept;
  void see(const Field3& position, View& view) const noexcept;
  Slopes slopesOf(const Field3& position, const View& view) const noexcept;
  double straying(double least_square, const Span& span) const noexcept;
  bool areFlat(const Slopes& slopes, double reach) const noexcept;
  bool topHolds(const Field3& position) const noexcept;

  const ClothPattern& pattern_;
  double overlong_;
  bool usable_;
  bool checks_top_;  // its links are between pins, who may be moved apart
  std::vector<Span> strips_, spans_;
  double per_altitude_ = 0.0;  // [1/m]
  View start_, end_;
};

}  // namespace curtain
