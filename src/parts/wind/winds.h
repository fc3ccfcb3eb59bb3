// SPDX-License-Identifier: BSD-3-Clause
//
// The winds that blow on a cloth, by id. Where a part reads the air's velocity they move the air, else they press on
// the nodes.
#pragma once

#include "cloth/link_ways.h"
#include "parts/wind/wind_shadow.h"
#include "parts/wind/wind_source.h"
#include "scene/sources.h"
#include "step/part.h"

namespace curtain {

/// Begins with the scene's. Allocates nothing in substeps.
class Winds final : public Part {
 public:
  /// All arguments must outlive this.
  Winds(const Scene& scene, const ClothPattern& pattern, const ObstacleSet& obstacles);

  /// A valid one.
  void set(const WindParams& wind) { winds_.put(made(wind)); }
  bool remove(const std::string& id) { return winds_.remove(id); }
  void clear() { winds_ = {}; }
  const std::vector<WindParams>& params() const noexcept { return winds_.params; }
  /// The wind of this id reaches the cloth, whether it blows or not.
  bool reaches(const std::string& id, const Field3& position) const noexcept;

  void reset(ClothState& state) override;
  void serialize(Archive& archive) override;
  bool explain(const ClothState& state, double time, Plan& plan) const override;
  /// Also where an obstacle moves that may shade the cloth.
  bool wakes(const FrameBegin& begin, const ClothState& state) const noexcept override;
  bool keepsAwake(const ClothState& state, double time) const noexcept override;
  double dampingPerMass(double& air_speed) const noexcept override;
  bool prepareFrame(const FrameBegin& begin, ClothState& state) noexcept override;
  void announce(const ClothState& state, ForceSum& sum) noexcept override;
  void addForces(const ClothState& state, ForceSum& sum) noexcept override;

 private:
  WindSource made(const WindParams& wind) const { return WindSource(wind, pattern_, layers_, scene_.solver.seed); }
  bool isReachedBy(const WindSource& wind, const Field3& position) const noexcept;
  bool shadowMoves(const WindSource& wind, double time) const noexcept;
  PlanEntry planOf(const WindSource& wind, const Field3& position, double time) const;

  const Scene& scene_;
  const Layers layers_;
  const ClothPattern& pattern_;
  const ObstacleSet& obstacles_;
  SampledBounds bounds_;
  WindShadow shadow_{pattern_};
  Sources<WindSource, WindParams> winds_;
  bool reach_ = false;   // a node, in the present substep
  Field3 area_vectors_;  // in rows that a wind reaches
};

}  // namespace curtain
