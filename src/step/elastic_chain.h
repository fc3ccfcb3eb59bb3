// SPDX-License-Identifier: BSD-3-Clause
//
// Several elastic parts as one: each adds its force to what those before it have added.
#pragma once

#include <vector>

#include "step/elastic_part.h"

namespace curtain {

/// Not thread-safe. Allocates only in its constructor.
class ElasticChain final : public ElasticPart {
 public:
  /// They must outlive this; those without a force are left out.
  explicit ElasticChain(const std::vector<ElasticPart*>& parts) {
    for (ElasticPart* const part : parts) {
      if (part->any()) parts_.push_back(part);
    }
  }
  /// The one that has a force, this if there are several; null: there is none.
  ElasticPart* part() noexcept { return parts_.size() > 1 ? this : parts_.empty() ? nullptr : parts_.front(); }

  bool any() const noexcept override { return !parts_.empty(); }
  void pinsChanged() noexcept override {
    for (ElasticPart* const part : parts_) part->pinsChanged();
  }
  void begin(const NodeInertia& inertia, const Field& inverse, double scale, bool explicit_links) noexcept override {
    for (ElasticPart* const part : parts_) part->begin(inertia, inverse, scale, explicit_links);
  }
  const Field3& addTo(const Field3& force, const Field3& position) noexcept override {
    const Field3* sum = &force;
    for (ElasticPart* const part : parts_) sum = &part->addTo(*sum, position);
    return *sum;
  }
  const Field3& addAhead(const SubstepStart& start, const Field& inverse) noexcept override {
    const Field3* sum = &start.force;
    for (ElasticPart* const part : parts_)
      sum = &part->addAhead({start.state, *sum, nullptr, start.keep, start.kick, start.h}, inverse);
    return *sum;
  }
  const Field3& forceAt(const Field3& position, double& energy) noexcept override {
    const Field3* sum = &parts_.front()->forceAt(position, energy);
    for (std::size_t k = 1; k < parts_.size(); ++k) {
      const Field3& before = *sum;
      sum = &parts_[k]->addTo(before, position);
      energy += parts_[k]->energyAfter(before, position);
    }
    return *sum;
  }
  const Field3& sum() const noexcept override { return parts_.back()->sum(); }
  double energyAfter(const Field3& outer, const Field3& position) const noexcept override {
    double energy = 0.0;
    const Field3* before = &outer;
    for (const ElasticPart* const part : parts_) {
      energy += part->energyAfter(*before, position);
      before = &part->sum();
    }
    return energy;
  }
  double commit(const Field3& position) noexcept override {
    double taken = 0.0;
    for (ElasticPart* const part : parts_) taken += part->commit(position);
    return taken;
  }
  void save(std::vector<double>& memory) const override {
    for (const ElasticPart* const part : parts_) part->save(memory);
  }
  const double* restore(const double* memory) noexcept override {
    for (ElasticPart* const part : parts_) memory = part->restore(memory);
    return memory;
  }
  double omegaSquared() const noexcept override {
    double sum = 0.0;
    for (const ElasticPart* const part : parts_) sum += part->omegaSquared();
    return sum;
  }

 private:
  std::vector<ElasticPart*> parts_;
};

}  // namespace curtain
