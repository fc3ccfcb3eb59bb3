// SPDX-License-Identifier: BSD-3-Clause
//
// Lines and tie-backs in the solve: cords, one-sided links between any node and an end beside the cloth.
//
// Loads and fixed ends move here, since no rod or string ends at them. Lengths of closing loops shrink by their speed
// in every substep in which parts drive; in the last resort they wait.
#pragma once

#include <vector>

#include "step/part.h"
#include "step/row_part.h"

namespace curtain {

class Cords final : public RowPart, public Part {
 public:
  /// pattern must outlive this.
  explicit Cords(const ClothPattern& pattern);

  const DistanceRow& row(std::size_t cord) const noexcept { return rows_[cord]; }

  // ---- Tie-backs

  /// Closes a loop from where its nodes are, or opens it. Between substeps.
  void close(std::size_t loop, bool closed, ClothState& state) noexcept;
  bool closed(std::size_t loop) const noexcept { return closed_[loop] != 0; }
  /// As the scene has them at the start.
  void reset(ClothState& state) override;
  /// A load goes along with the mean of its lines' nodes; tie-backs close from where their nodes are.
  void placed(const ClothState& before, ClothState& state) noexcept override;
  /// Which loops are closed.
  void serialize(Archive& archive) override;
  bool explain(const ClothState& state, double time, Plan& plan) const override;
  /// A closed loop has not yet shrunk to its radius.
  bool isUnderWay(const ClothState& state) const noexcept override;
  bool drives(const ClothState& state) const noexcept override { return isUnderWay(state); }
  bool reversible() const noexcept override { return count() == 0; }

  // ---- A substep

  std::size_t count() const noexcept override { return pattern_.cords.cords.size(); }
  void attach(DistanceRow* rows) noexcept override;
  void begin(const SubstepStart& start, const ClothState& state, const Field& inverse, bool drives,
             Field3& next) noexcept override;
  void commit(const SubstepStart& start, const Field3& next, ClothState& state) noexcept override;
  using Part::resume;
  void resume(const ClothState& state) noexcept override;
  double work(const Field3& before, const Field3& after, double per_h) const noexcept override;

 private:
  void predict(const SubstepStart& start, const Field& inverse, Field3& next) const noexcept;
  void setLengths(const ClothState& state) noexcept;
  void setHolds(const Field& inverse) noexcept;

  const ClothPattern& pattern_;
  DistanceRow* rows_ = nullptr;       // in the order of the pattern's cords
  std::vector<std::uint8_t> closed_;  // by loop
  std::vector<double> reach_;         // of the loops at the end of the substep [m]
  bool draws_ = true;                 // loops that are to shrink did so in the last substep
};

}  // namespace curtain
