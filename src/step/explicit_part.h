// SPDX-License-Identifier: BSD-3-Clause
//
// An elastic part that acts where the cloth is at the start of a step; steps follow its frequencies.
#pragma once

#include "step/elastic_part.h"

namespace curtain {

/// Not thread-safe. Allocates only in assign().
class ExplicitPart : public ElasticPart {
 public:
  void pinsChanged() noexcept override {}
  void begin(const NodeInertia& inertia, const Field& inverse, double scale, bool explicit_links) noexcept override;
  const Field3& addTo(const Field3& force, const Field3& position) noexcept override;
  const Field3& addAhead(const SubstepStart& start, const Field& inverse) noexcept override;
  const Field3& forceAt(const Field3& position, double& energy) noexcept override;
  const Field3& sum() const noexcept override { return sum_; }
  double energyAfter(const Field3& outer, const Field3& position) const noexcept override;

 protected:
  /// For fields of this size; to be called in the constructor of a part that has a force.
  void assign(std::size_t size);
  /// Share of its stiffness that the step bears. 1 but where steps could not follow the frequencies.
  double share() const noexcept { return share_; }

  /// Adds its force at these positions [N].
  virtual void addOwn(const Field3& position, Field3& sum) noexcept = 0;
  /// [J]
  virtual double energyAt(const Field3& position) const noexcept = 0;

 private:
  double share_ = 1.0;
  Field3 sum_, ahead_;
};

}  // namespace curtain
