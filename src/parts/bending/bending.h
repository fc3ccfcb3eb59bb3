// SPDX-License-Identifier: BSD-3-Clause
//
// Bending in a substep: a force that is added to the others before the links are solved for.
//
// It is only as implicit as stability requires. A step of `scale` = h * kick tolerates a stiffness of
// limit * m / scale at a node of mass m. The links' tensions use a part of that (Gershgorin, as in NodeInertia), and E
// is the rest. Where the line is stiffer than E, its nodes give way (bending_lines.h) just enough:
//     D = 1 / E - 1 / bound of K,   A = (K^-1 + D)^-1 <= E.
// With D = scale / (4 m) that is the implicit-explicit variational integrator of Stern, Grinspun 2009: midpoint
// bending, explicit everything else. A is symmetric, so the force has a potential (but for what taut weft links are
// spared, see addShears()), and leapfrog stays symplectic with the step it has without bending. The links pull
// unfiltered: at rest, lines that are stiffer than the step bears are softer over lengths of (B scale / density)^(1/4).
#pragma once

#include "cloth/workers.h"
#include "parts/bending/bending_lines.h"
#include "parts/bending/rest_curvature.h"
#include "step/elastic_part.h"
#include "step/part.h"

namespace curtain {

/// Not thread-safe. Allocates only in the constructor, and nothing for limp cloth.
class Bending final : public ElasticPart, public Part {
 public:
  /// All arguments must outlive this.
  Bending(const ClothPattern& pattern, const Workers& workers);

  bool any() const noexcept override { return warp_.bend() || weft_.bend(); }
  void pinsChanged() noexcept override;

  /// After begin(): lines are stiffer than the step bears.
  bool gives() const noexcept { return gives_; }
  bool explain(const ClothState& state, double time, Plan& plan) const override;

  void begin(const NodeInertia& inertia, const Field& inverse, double scale, bool explicit_links) noexcept override;
  const Field3& addTo(const Field3& force, const Field3& position) noexcept override;
  const Field3& addAhead(const SubstepStart& start, const Field& inverse) noexcept override;
  const Field3& forceAt(const Field3& position, double& energy) noexcept override;
  const Field3& sum() const noexcept override { return sum_; }
  /// What it spared of the links on the left of the nodes [N], see addShears().
  const Field3& spared() const noexcept { return shears_.spared; }
  double energyAfter(const Field3& outer, const Field3& position) const noexcept override;

 private:
  void setGive(const NodeInertia& inertia, const Field& inverse, double scale, double per_load, double limit) noexcept;
  void addStraight(const Field3& force, const Field3& position, Field3& sum) noexcept;
  void addWarpGiving(const Field3& position, Field3& sum) noexcept;
  void addWeftGiving(const Field3& position, bool spares, Field3& sum) noexcept;
  template <typename Add>
  double addCouples(const RestCurvature& rest, const Field& give, const Add& add, const Field3& position,
                    Field3& force) noexcept;
  double halfWork(const Field3& outer, const Field3& position) const noexcept;
  double addCurved(const Field3& position, Field3& force) noexcept;

  const ClothPattern& pattern_;
  const Workers& workers_;
  BendingLines warp_, weft_;
  RestCurvature warp_rest_, weft_rest_;
  double stiffest_;              // largest bound of K over mass [1/s^2]
  bool gives_ = false;           // after begin(): lines are stiffer than the step bears
  Field warp_give_, weft_give_;  // [m/N]
  Field3 sum_, ahead_, no_force_;
  Field3 couples_, moved_;  // scratch of addCouples()
  BendingScratch scratch_;
  WeftShears shears_;
};

/// Sum over the nodes of (with - without) . (x - x_0), x_0 the first node's position [J]: what the difference of two
/// forces, which has no sum, does over the cloth's extent.
double workOf(const Field3& with, const Field3& without, const Field3& position) noexcept;

}  // namespace curtain
