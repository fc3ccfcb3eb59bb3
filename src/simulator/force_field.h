// SPDX-License-Identifier: BSD-3-Clause
//
// The winds and drags that act on a cloth, by id: the sum of all forces at one time, and which columns a change
// reaches.
#pragma once

#include <string>
#include <vector>

#include "cloth/link_ways.h"
#include "parts/air/air_damping.h"
#include "parts/air/relative_air.h"
#include "parts/drag/drag_force.h"
#include "parts/hands/grasps.h"
#include "parts/wind/ambient_wind.h"
#include "parts/wind/wind_shadow.h"
#include "parts/wind/wind_source.h"
#include "scene/find_by_id.h"
#include "step/substep.h"

namespace curtain {

/// They differ at most in start and end.
bool sameWhileItBlows(const WindParams& a, const WindParams& b);
bool sameWhileItActs(const DragParams& a, const DragParams& b);

/// Sources of one kind, and their parameters in the same order.
template <typename Source, typename Params>
struct Sources {
  std::vector<Source> list;
  std::vector<Params> params;

  /// The one with this id; null: there is none.
  Source* find(const std::string& id) {
    const Params* const found = findById(params, id);
    return found == nullptr ? nullptr : &list[static_cast<std::size_t>(found - params.data())];
  }
  /// Adds the source, or replaces the one with its id.
  void put(Source source) {
    Source* const old = find(source.params().id);
    if (old == nullptr) {
      params.push_back(source.params());
      list.push_back(std::move(source));
    } else {
      params[static_cast<std::size_t>(old - list.data())] = source.params();
      *old = std::move(source);
    }
  }
  /// False: there is none.
  bool remove(const std::string& id) {
    const Source* const old = find(id);
    if (old == nullptr) return false;
    const auto at = old - list.data();
    params.erase(params.begin() + at);
    list.erase(list.begin() + at);
    return true;
  }
  void clear() {
    params.clear();
    list.clear();
  }
};

class ForceField {
 public:
  /// hands: null: there are none; else it must outlive this, as scene and pattern must.
  ForceField(const Scene& scene, const ClothPattern& pattern, Grasps* hands = nullptr);

  /// Back to the scene's winds and drags.
  void reset();

  /// Valid ones.
  void setWind(const WindParams& wind);
  bool removeWind(const std::string& id) { return winds_.remove(id); }
  void clearWinds() { winds_.clear(); }
  const std::vector<WindParams>& winds() const { return winds_.params; }

  void setDrag(const DragParams& drag);
  bool removeDrag(const std::string& id) { return drags_.remove(id); }
  void clearDrags() { drags_.clear(); }
  const std::vector<DragParams>& drags() const { return drags_.params; }

  /// Before the substeps of the frame from .. to [s]: where the obstacles keep the winds from the cloth.
  void castShadows(const ObstacleSet& obstacles, const Field3& position, double from, double to);

  /// Forces at a time [s] on the cloth's present state; dt: how long they will act [s]; ahead: read if readsPulls().
  /// Allocates nothing.
  const NodeForces& evaluate(const ClothState& state, double time, double dt, const SubstepAhead& ahead = {}) noexcept;
  const NodeForces& last() const { return forces_; }

  /// Links are near their lengths: winds may be culled by a few sampled nodes.
  void setLinksHold(bool hold) noexcept { bounds_.setLinksHold(hold); }

  /// The air's force depends on its velocity relative to the cloth.
  bool readsPulls() const noexcept { return relative_air_.active(); }

  /// air: the scene's, which the damping follows. After loading call takeGravity().
  void carry(Archive& archive, AirParams& air);

  /// The scene's gravity, or air, has changed.
  void takeGravity() noexcept;
  void takeAir();
  /// The pattern's pins have changed.
  void takePins() noexcept { relative_air_.takePins(pattern_); }
  /// Largest air damping of a node at rest, over its mass [1/s].
  double dampingPerMass() const noexcept;

  // Whether the cloth is reached now:
  /// by a source that begins or ends within [from, to];
  bool changesWithin(double from, double to, const Field3& position) const noexcept;
  /// by gusts;
  bool gustsAt(double time, const Field3& position) const noexcept;
  /// by the wind of this id, whether it blows or not;
  bool windReaches(const std::string& id, const Field3& position) const noexcept;
  /// by a wind in which an obstacle moves that may shade the cloth.
  bool shadowsMove(const ObstacleSet& obstacles, double time, const Field3& position) const noexcept;
  /// The wind everywhere, and whether it acts.
  const AmbientWind& ambient() const noexcept { return ambient_; }
  /// The wind of this id blows at this time and reaches the cloth.
  bool reaches(const std::string& id, double time, const Field3& position) const;

 private:
  bool isReachedBy(const WindSource& wind, const Field3& position) const noexcept;
  bool findWinds(const Field3& position, double time) noexcept;
  void addWinds(const Field3& position, double time) noexcept;
  void addRelativeAir(const ClothState& state, double time, bool windy, const SubstepAhead& ahead) noexcept;

  const Scene& scene_;
  const ClothPattern& pattern_;
  SampledBounds bounds_;
  AirDamping air_damping_;
  RelativeAir relative_air_;
  AmbientWind ambient_;
  WindShadow shadow_;
  Sources<WindSource, WindParams> winds_;
  Sources<DragForce, DragParams> drags_;
  Grasps* hands_;
  Field3 weight_;
  Field3 sum_;           // with winds and drags, when one acts
  Field3 area_vectors_;  // in rows that a wind reaches, or of all for relative_air_
  Field3 air_velocity_;  // at the nodes, for relative_air_
  NodeForces forces_;
};

}  // namespace curtain
