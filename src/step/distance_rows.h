// SPDX-License-Identifier: BSD-3-Clause
//
// All distances that parts bound, in the solve: one-sided constraints like the weft's strings, between any two nodes.
// They are few, so each is looked at by itself; those that take part are rows of the same solve (Row).
#pragma once

#include <vector>

#include "step/row.h"
#include "step/row_part.h"

namespace curtain {

class DistanceRows final : public RowMaker {
 public:
  /// max_give: bound of the relative overlength by compliance; links: a typical link's length [m]. All arguments must
  /// outlive this.
  DistanceRows(const ClothPattern& pattern, std::vector<RowPart*> parts, double max_give, double links);

  void setMostGive(double max_give) noexcept { max_give_ = max_give; }
  bool any() const noexcept { return !all_.empty(); }
  const std::vector<DistanceRow>& all() const noexcept { return all_; }

  // ---- A substep

  /// Starts with the last substep's multipliers times ratio; true: one is not zero. drives: parts do.
  bool begin(const SubstepStart& start, const ClothState& state, const Field& inverse, bool drives, double ratio,
             Field3& next) noexcept;
  void setDirections(const Field3& position) noexcept;
  /// Moves nodes by the present multipliers.
  void pull(const Field& inverse, Field3& value) const noexcept;
  /// Sets violation and active of each; returns the largest violation over a unit of those that take part, infinite
  /// when a position is not finite.
  double measure(const Field& inverse, const Field3& position) noexcept;
  /// A row for each that holds, of what measure() or measureRates() has found.
  void addRows(const Field3& value, bool rates, Rows& rows) const override;
  void applyChange(const Rows& rows, double share, const Field& inverse, Field3& position) noexcept override;
  void addSquares(const Field3& position, double& sum) const noexcept override;
  void saveIterate() noexcept override;
  void restoreIterate() noexcept override;
  /// Work of the rows that give in a substep to `next` [J], by their present multipliers.
  double elasticWork(const SubstepStart& start, const Field3& next) const noexcept;
  /// The same of the rows whose length a part drives.
  double drivenWork(const SubstepStart& start, const Field3& next) const noexcept;
  /// The largest rate at which parts drive a length [m/s]; 0: none does.
  double speed() const noexcept;

  /// Accepts: parts set their state; adds to the loads of nodes. Returns the largest load over its mass.
  double commit(const SubstepStart& start, const Field3& next, ClothState& state, Field& load) noexcept;
  /// Between substeps: lengths are those of `state`.
  void resume(const ClothState& state) noexcept;

  // ---- The last accepted substep

  /// A row pulled.
  bool pulls() const noexcept;
  /// Sum of multiplier times direction over the rows of a node [kg m].
  Vec3 pullAt(std::size_t node) const noexcept { return sumAt(node, &DistanceRow::last); }
  /// The same of the multipliers being solved for.
  Vec3 presentPullAt(std::size_t node) const noexcept { return sumAt(node, &DistanceRow::multiplier); }
  /// Elastic energy of the rows that give [J].
  double energy(const Field3& position) const noexcept;
  /// RowPart::work() of all parts [J].
  double work(const Field3& before, const Field3& after, double per_h) const noexcept;
  /// Work of the rows that give in that substep [J].
  double elasticWork() const noexcept { return elastic_work_; }
  /// Largest relative overlength of any that holds and does not give.
  double stretch(const Field3& position) const noexcept;

  // ---- Velocities

  /// Those that pulled take part, with dC/dt = d . (v_other - v_node) - length * rate [m^2/s].
  double measureRates(const Field3& velocity) noexcept override;
  void moveBy(const Rows& rows, const Field& inverse, Field3& value) noexcept override;
  void spread(double share, const Field& inverse, Field3& value) const noexcept override;

  struct Memory {
    std::vector<double> last;

    void serialize(Archive& archive);
  };
  void save(Memory& memory) const;
  void restore(const Memory& memory) noexcept;
  void forget() noexcept;
  void serialize(Archive& archive);

 private:
  double unitOf(const DistanceRow& row) const noexcept;
  double givesPerMultiplier(const DistanceRow& row, double distance) const noexcept;
  void move(const DistanceRow& row, double multiplier, const Field& inverse, Field3& value) const noexcept;
  template <typename Wanted>
  double workOf(const Wanted& wanted, const SubstepStart& start, const Field3& next) const noexcept;
  Vec3 sumAt(std::size_t node, double DistanceRow::*multiplier) const noexcept;

  const ClothPattern& pattern_;
  std::vector<RowPart*> parts_;
  double max_give_;
  const double links_;
  std::vector<DistanceRow> all_;  // part by part
  std::vector<double> best_;      // multipliers of the iterate to return to
  double scale_ = 1.0;            // of multipliers in this substep, h * kick [s^2]
  double elastic_work_ = 0.0;     // of the last accepted substep [J]
};

}  // namespace curtain
