// SPDX-License-Identifier: BSD-3-Clause
//
// Columns that sleep while others move. They are held like pinned nodes, and the blocks of columns that hold nothing
// else are left out of the solve. What the strings at their borders pull is compared with what they pulled when the
// columns fell asleep: more than a trifle, and the substep is to be made again with them awake.
#pragma once

#include "cloth/cloth.h"
#include "cloth/column_set.h"
#include "solver/contacts.h"
#include "solver/links.h"

namespace curtain {

class HeldColumns {
 public:
  explicit HeldColumns(const ClothPattern& pattern);

  bool any() const noexcept { return !held_.empty(); }
  const ColumnSet& columns() const noexcept { return held_; }
  bool has(int column) const noexcept { return held_.has(column); }
  /// Nothing in this block of columns moves: all are held, or padding.
  bool skips(int block) const noexcept { return skips_[static_cast<std::size_t>(block)] != 0; }

  /// All that moves is within.
  const ColumnSpan& movingSpan() const noexcept { return span_; }

  /// Takes over which columns are held. weft: the strings' multipliers, per_scale: 1 / (h kick) of them [1/s^2].
  void set(const ColumnSet& held, const Field3& position, const Field& weft, double per_scale) noexcept;

  void carry(Archive& archive);
  /// These are held, and were when the borders' pulls were loaded.
  void resume(const ColumnSet& held) noexcept;

  /// Finds the held columns that strings, or contacts that push, would move. weft: null when no string pulls; contacts:
  /// or null. gravity: its size [m/s^2]; stuck: what moves does not get on, which may be for those that don't: all of
  /// them.
  bool disturbedBy(const LinkSet* weft, const Contacts* contacts, double per_scale, double gravity,
                   bool stuck) noexcept;
  const ColumnSet& disturbed() const noexcept { return disturbed_; }

 private:
  void take(const ColumnSet& held) noexcept;
  int leftOf(int column) const noexcept { return column > 0 ? column - 1 : pattern_.grid.columns - 1; }
  double changeAtBorder(int column, const LinkSet* weft, double per_scale) const noexcept;

  const ClothPattern& pattern_;
  std::vector<double> mass_;  // of each column [kg]
  ColumnSet held_, disturbed_;
  ColumnSet borders_;  // columns whose strings to the left join a held column and one that moves
  std::vector<std::uint8_t> skips_;
  ColumnSpan span_;
  Field3 pull_;  // of the strings at borders, when they became borders [N]
};

}  // namespace curtain
