// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/start/laid_start.h"

#include <algorithm>
#include <cmath>

#include "contact/broad_phase/self_candidates.h"
#include "scene/layers.h"
#include "scene/pi.h"
#include "scene/problem_log.h"
#include "simulator/self_crossings.h"

namespace curtain {
namespace {

// It falls on the obstacle in air that lets nothing swing for long [m/s], and is where it is after so long [s].
constexpr double kThickAir = 1.0, kLongest = 10.0;
// Cloths that begin nearer have no sides that contact could keep [m].
constexpr double kNearest = 1e-5;

// Spreads cloth out level, so high above the obstacle [m].
void spreadOut(const ObstacleSet& obstacles, int number, double higher, const ClothParams& cloth, HangParams& hang) {
  const Transform place(obstacles.reached(number));
  const Eigen::AlignedBox3d bounds = obstacles.shape(number).bounds();
  Vec3 middle = place.translation;  // of a plane, which has no bounds
  double top = middle.z();
  if (bounds.sizes().allFinite()) {
    middle = place.toWorld(bounds.center());
    top = middle.z() + place.rotation.row(2).cwiseAbs().dot(0.5 * bounds.sizes());
  }
  middle.z() = top + obstacles.padding(number) + higher;
  Vec3 along = hang.to - hang.from;
  along.z() = 0.0;
  along = along.norm() > 0.0 ? Vec3(along.normalized()) : Vec3::UnitX();
  const Vec3 down = along.cross(Vec3::UnitZ());
  hang = HangParams();
  hang.from = middle - 0.5 * cloth.width * along - 0.5 * cloth.height * down;
  hang.to = hang.from + cloth.width * along;
  hang.tilt = 0.5 * kPi;
}

}  // namespace

std::string problemOfLayers(const Scene& scene, const ClothPattern& pattern, const Field3& position) {
  if (scene.layers.empty() || !scene.contact.self) return {};
  if (const std::int64_t crossings = countSelfCrossings(pattern.grid, position); crossings > 0)
    return "the cloths go through each other or themselves in " + std::to_string(crossings) + " places at the start";
  Candidates near;
  SelfCandidates(pattern).collect(position, position, kNearest, near);
  const auto layer_of = [&](std::uint32_t node) {
    return pattern.layer[node % static_cast<std::size_t>(pattern.grid.stride)];
  };
  const bool touch =
      std::any_of(near.vertex_triangles.begin(), near.vertex_triangles.end(),
                  [&](const VertexTriangle& pair) { return layer_of(pair.vertex) != layer_of(pair.triangle[0]); }) ||
      std::any_of(near.edge_edges.begin(), near.edge_edges.end(),
                  [&](const EdgeEdge& pair) { return layer_of(pair.first[0]) != layer_of(pair.second[0]); });
  return touch ? "two cloths begin in the same place: leave contact.thickness and more between them" : "";
}

std::vector<Laid> laidCloths(const Scene& scene) {
  std::vector<Laid> laid;
  const auto add = [&](std::size_t layer, const std::optional<std::string>& over, const std::string& of) {
    if (!over) return;
    const auto is_it = [&](const ObstacleParams& obstacle) { return obstacle.name == *over; };
    const auto found = std::find_if(scene.obstacles.begin(), scene.obstacles.end(), is_it);
    laid.push_back({layer, static_cast<int>(found - scene.obstacles.begin()), joinKey(of, "hang.start.over")});
  };
  add(0, scene.hang.start.over, "");
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    add(k + 1, scene.layers[k].hang.start.over, itemKey("layers", k));
  return laid;
}

Scene settlingScene(const Scene& scene, const ObstacleSet& obstacles, const std::vector<Laid>& laid) {
  Scene settling = layerScene(scene, 0);  // of the rest nothing
  settling.layers = scene.layers;
  for (int k = 0; k < obstacles.count(); ++k) {
    ObstacleParams& obstacle = settling.obstacles[static_cast<std::size_t>(k)];
    obstacle.pose = obstacles.reached(k);
    obstacle.motion.clear();
    obstacle.velocity = obstacle.acceleration = obstacle.spin = Vec3::Zero();
  }
  double higher = 0.0;
  for (const Laid& one : laid) {
    higher += 2.0 * scene.contact.thickness;
    if (one.layer == 0) {
      spreadOut(obstacles, one.obstacle, higher, settling.cloth, settling.hang);
      settling.hem = HemParams();
    } else {
      LayerParams& layer = settling.layers[one.layer - 1];
      spreadOut(obstacles, one.obstacle, higher, layer.cloth, layer.hang);
      layer.hem = HemParams();
    }
  }
  settling.air = AirParams();
  settling.air.inside = settling.air.border = settling.air.corner = kThickAir;
  for (LayerParams& layer : settling.layers) layer.air.inside = layer.air.border = layer.air.corner = kThickAir;
  settling.solver.frame_rate = std::max(60.0, scene.solver.frame_rate);
  settling.solver.budget_ms = 0.0;
  settling.solver.position_tolerance = 0.0;
  return settling;
}

std::vector<Vec3> settle(Simulator& resting) {
  while (!resting.statistics().asleep && resting.time() < kLongest) resting.step();
  std::vector<Vec3> positions;
  resting.copyPositions(positions);
  return positions;
}

}  // namespace curtain
