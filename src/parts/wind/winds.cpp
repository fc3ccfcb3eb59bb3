// SPDX-License-Identifier: BSD-3-Clause
#include "parts/wind/winds.h"

#include <algorithm>
#include <optional>

#include "cloth/archive_params.h"

namespace curtain {

Winds::Winds(const Scene& scene, const ClothPattern& pattern, const ObstacleSet& obstacles)
    : scene_(scene), layers_(scene), pattern_(pattern), obstacles_(obstacles), bounds_(pattern) {
  area_vectors_.assign(pattern.grid.size(), 0.0);
  for (const WindParams& wind : scene.wind) set(wind);
}

void Winds::reset(ClothState&) {
  clear();
  for (const WindParams& wind : scene_.wind) set(wind);
}

// They follow from their parameters and the time.
void Winds::serialize(Archive& archive) {
  std::vector<WindParams> params = winds_.params;
  archive.atOnce([&] { archive.list("winds", params, [&](WindParams& wind) { serializeParams(archive, wind); }); });
  if (!archive.loads()) return;
  Sources<WindSource, WindParams> loaded;
  for (const WindParams& wind : params) loaded.put(made(wind));
  archive.put(winds_, std::move(loaded));
}

bool Winds::isReachedBy(const WindSource& wind, const Field3& position) const noexcept {
  const Grid& grid = pattern_.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      if (wind.reachesPoint(position.at(grid.index(i, j)))) return true;
    }
  }
  return false;
}

bool Winds::reaches(const std::string& id, const Field3& position) const noexcept {
  return std::any_of(winds_.list.begin(), winds_.list.end(),
                     [&](const WindSource& wind) { return wind.params().id == id && isReachedBy(wind, position); });
}

bool Winds::shadowMoves(const WindSource& wind, double time) const noexcept {
  if (!wind.params().shadow || !wind.blowsAt(time)) return false;
  // One that has left the cone, or is gone, still has its shade there.
  bool moves = wind.shaded() && obstacles_.anyMoved();
  for (int index = 0; index < obstacles_.count() && !moves; ++index) {
    moves = obstacles_.moved(index) && mayShade(obstacles_, index, wind);
  }
  return moves;
}

bool Winds::wakes(const FrameBegin& begin, const ClothState& state) const noexcept {
  const auto wakes = [&](const WindSource& wind) {
    return (changesWithin(wind.params(), begin.from, begin.to) || shadowMoves(wind, begin.from)) &&
           isReachedBy(wind, state.position);
  };
  return !winds_.list.empty() && std::any_of(winds_.list.begin(), winds_.list.end(), wakes);
}

// By gusts.
bool Winds::keepsAwake(const ClothState& state, double time) const noexcept {
  return std::any_of(winds_.list.begin(), winds_.list.end(), [&](const WindSource& wind) {
    return wind.params().unsteadiness > 0.0 && wind.blowsAt(time) && isReachedBy(wind, state.position);
  });
}

double Winds::dampingPerMass(double& air_speed) const noexcept {
  for (const WindSource& wind : winds_.list) air_speed += wind.topSpeed(pattern_, scene_.air.density);
  return 0.0;
}

bool Winds::prepareFrame(const FrameBegin& begin, ClothState& state) noexcept {
  bounds_.setLinksHold(begin.links_hold);
  for (WindSource& wind : winds_.list) {
    if (wind.params().start < begin.to && wind.params().end > begin.from)
      shadow_.cast(obstacles_, pattern_.grid, state.position, wind);
  }
  return false;
}

// A source that reaches nothing is left out.
void Winds::announce(const ClothState& state, ForceSum& sum) noexcept {
  std::optional<Eigen::AlignedBox3d> cloth;
  reach_ = false;
  for (WindSource& wind : winds_.list) {
    if (!wind.blowsAt(sum.time)) continue;
    if (!cloth) cloth = bounds_.around(state.position);
    wind.find(pattern_.grid, state.position, *cloth);
    reach_ = reach_ || wind.reaches();
  }
  sum.acts = sum.acts || reach_;
}

void Winds::addForces(const ClothState& state, ForceSum& sum) noexcept {
  if (!reach_) return;
  for (int i = 0; i < pattern_.grid.rows && !sum.reads_air; ++i) {
    const auto reads = [&](const WindSource& wind) {
      return wind.blowsAt(sum.time) && wind.readsNormals() && wind.reachesRow(i);
    };
    if (std::any_of(winds_.list.begin(), winds_.list.end(), reads))
      nodeAreaVectors(pattern_.grid, i, state.position, area_vectors_);
  }
  for (WindSource& wind : winds_.list) {
    if (!wind.blowsAt(sum.time)) continue;
    if (sum.reads_air)
      wind.addVelocities(pattern_, state.position, sum.time, scene_.air.density, sum.air);
    else
      wind.addForces(pattern_, state.position, area_vectors_, sum.time, sum.force);
  }
}

PlanEntry Winds::planOf(const WindSource& wind, const Field3& position, double time) const {
  const WindParams& params = wind.params();
  const std::string stage = "wind '" + params.id + "'", not_now = whyNotAt(params, time);
  if (!not_now.empty()) return {stage, false, not_now};
  if (params.pressure + params.node_force + params.unsteadiness <= 0.0) return {stage, false, "has no pressure"};
  if (!wind.blowsAt(time) || !isReachedBy(wind, position)) return {stage, false, "reaches nothing of the cloth"};
  const bool gusts = params.unsteadiness > 0.0;
  return {stage, true, gusts ? "reaches the cloth, with gusts" : "reaches the cloth; no gusts, so no random numbers"};
}

bool Winds::explain(const ClothState& state, double time, Plan& plan) const {
  if (winds_.list.empty()) plan.push_back({"winds", false, "there are none"});
  bool acts = false, normals = false;
  for (const WindSource& wind : winds_.list) {
    plan.push_back(planOf(wind, state.position, time));
    acts = acts || plan.back().runs;
    normals = normals || (plan.back().runs && wind.readsNormals());
  }
  plan.push_back({"normals", normals, normals ? "a wind needs them, in the rows it reaches" : "no wind reads them"});
  return acts;
}

}  // namespace curtain
