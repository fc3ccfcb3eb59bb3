// SPDX-License-Identifier: BSD-3-Clause
//
// A part whose forces have a potential of the positions alone, and what the solver asks of it. Its forces are added to
// all others before the links are solved for. It says how stiff it may be in a step, and is no stiffer.
#pragma once

#include <vector>

#include "step/node_inertia.h"
#include "step/warp_solver.h"

namespace curtain {

/// Not thread-safe. Allocates only in its constructor.
class ElasticPart {
 public:
  virtual ~ElasticPart() = default;

  /// It has a force; false: nothing below is asked.
  virtual bool any() const noexcept = 0;
  /// Bound of the squares of its frequencies, by its nodes' masses, that steps are to follow [1/s^2]. 0: it is as
  /// implicit as they need.
  virtual double omegaSquared() const noexcept { return 0.0; }

  /// The pattern's pins have changed.
  virtual void pinsChanged() noexcept = 0;

  /// What a substep bears: |scale| = h * kick [s^2], inverse inertia [1/kg]. explicit_links: links pull along their
  /// directions at the start of the step, and their tensions take a part.
  virtual void begin(const NodeInertia& inertia, const Field& inverse, double scale, bool explicit_links) noexcept = 0;

  /// The force and its own at these positions [N]; valid until the next call of one of these.
  virtual const Field3& addTo(const Field3& force, const Field3& position) noexcept = 0;
  /// The same where a substep leads to with this force and without links. inverse: inertia of the substep [1/kg].
  virtual const Field3& addAhead(const SubstepStart& start, const Field& inverse) noexcept = 0;
  /// Its own alone. energy: elastic energy, as the steps after begin() see it [J].
  virtual const Field3& forceAt(const Field3& position, double& energy) noexcept = 0;
  /// What the last of them returned.
  virtual const Field3& sum() const noexcept = 0;
  /// Elastic energy that leapfrog keeps with that of motion [J]: after addTo(outer, ...) moved the cloth to `position`,
  /// x_n A x_(n-1) / 2 beside the velocities between them.
  virtual double energyAfter(const Field3& outer, const Field3& position) const noexcept = 0;

  /// A substep has led to these positions: what depends on the path follows. Returns what friction within took [J].
  virtual double commit(const Field3& /*position*/) noexcept { return 0.0; }
  /// Appends what depends on the path; takes it back from there, and returns what comes after it.
  virtual void save(std::vector<double>& /*memory*/) const {}
  virtual const double* restore(const double* memory) noexcept { return memory; }
};

/// Where a substep leads to with its force and without links [m].
inline void setAhead(const SubstepStart& start, const Field& inverse, Field3& ahead) noexcept {
  const ClothState& from = start.state;
  for (std::size_t n = 0; n < inverse.size(); ++n) {
    const double keep = start.keep != nullptr ? (*start.keep)[n] : 1.0;
    const Vec3 velocity = keep * from.velocity.at(n) + (start.kick * inverse[n]) * start.force.at(n);
    ahead.set(n, from.position.at(n) + start.h * velocity);
  }
}

}  // namespace curtain
