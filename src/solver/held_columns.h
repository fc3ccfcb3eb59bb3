// SPDX-License-Identifier: BSD-3-Clause
//
// Columns that sleep while others move. They are fixed like pinned nodes, and blocks of only such columns are left out
// of the solve. The strings' pull at their borders, and what the weft's bending exerts on them, are compared with that
// when they fell asleep: if it has changed by more than kWakeShare of the weight, the substep is repeated with them
// awake.
#pragma once

#include "cloth/cloth.h"
#include "cloth/column_set.h"
#include "solver/bending_lines.h"
#include "solver/contacts.h"
#include "solver/links.h"

namespace curtain {

class HeldColumns {
 public:
  explicit HeldColumns(const ClothPattern& pattern);

  /// The pattern's pins have changed; nothing is held meanwhile.
  void takePins() noexcept { fillWeftLines(pattern_, weft_); }

  bool any() const noexcept { return !held_.empty(); }
  const ColumnSet& columns() const noexcept { return held_; }
  bool has(int column) const noexcept { return held_.has(column); }
  /// Nothing in this block of columns moves: all columns are held or padding.
  bool skips(int block) const noexcept { return skips_[static_cast<std::size_t>(block)] != 0; }

  /// Contains all that moves.
  const ColumnSpan& movingSpan() const noexcept { return span_; }

  /// Takes over which columns are held. weft: the strings' multipliers; per_scale: 1 / (h kick) of them [1/s^2].
  void set(const ColumnSet& held, const Field3& position, const Field& weft, double per_scale) noexcept;

  void carry(Archive& archive);
  /// After carry() has loaded the borders' pulls: these columns are held.
  void resume(const ColumnSet& held) noexcept;

  /// Finds the held columns that strings, bending at these positions or pushing contacts would move. weft: null when no
  /// string pulls; contacts: or null; gravity: its magnitude [m/s^2]; stuck: what moves has stopped, perhaps because of
  /// the held ones: all of them are disturbed.
  bool disturbedBy(const LinkSet* weft, const Field3& position, const Contacts* contacts, double per_scale,
                   double gravity, bool stuck) noexcept;
  const ColumnSet& disturbed() const noexcept { return disturbed_; }

 private:
  void take(const ColumnSet& held) noexcept;
  int leftOf(int column) const noexcept { return column > 0 ? column - 1 : pattern_.grid.columns - 1; }
  bool bendsWithMoving(int column) const noexcept;
  double changeOfBending(int column, const Field3& position) const noexcept;
  double changeAtBorder(int column, const LinkSet* weft, double per_scale) const noexcept;

  const ClothPattern& pattern_;
  BendingLines weft_;
  std::vector<double> mass_;  // of each column [kg]
  ColumnSet held_, disturbed_;
  ColumnSet borders_;  // columns whose left strings join a held and a moving column
  std::vector<std::uint8_t> skips_;
  ColumnSpan span_;
  Field3 pull_;  // of the strings at borders when they became borders [N]
  Field3 bent_;  // force of the weft's bending on held columns when they fell asleep [N]; empty: limp
};

}  // namespace curtain
