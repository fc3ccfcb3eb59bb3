// SPDX-License-Identifier: BSD-3-Clause
#include "ros/tuning/live_values.h"

#include <algorithm>

#include "scene/names.h"

namespace curtain_ros {

using curtain::Problem;
using curtain_sim::CurtainConfig;

namespace {

// Visits pairs of a value of the configuration and one of ours, both const or one of them not.
template <typename Config, typename Params, typename Visit>
void visitNode(Config& config, Params& params, const Visit& visit) {
  visit(config.state_rate, params.state_rate);
  visit(config.state_rest_rate, params.state_rest_rate);
  visit(config.mesh_rate, params.mesh_rate);
  visit(config.mesh_tolerance, params.mesh_tolerance);
  visit(config.mesh_viewer_tolerance, params.mesh_viewer_tolerance);
  visit(config.markers_rate, params.markers_rate);
  visit(config.obstacle_timeout, params.obstacle_timeout);
}

template <typename Config, typename Air, typename Visit>
void visitAir(Config& config, Air& air, const Visit& visit) {
  visit(config.air_density, air.density);
  visit(config.air_threshold, air.threshold);
  visit(config.air_inside, air.inside);
  visit(config.air_border, air.border);
  visit(config.air_corner, air.corner);
  visit(config.air_fast_gain, air.fast_gain);
  visit(config.air_normal_drag, air.normal_drag);
  visit(config.air_tangential_drag, air.tangential_drag);
}

template <typename Config, typename Cloth, typename Visit>
void visitCloth(Config& config, Cloth& cloth, const Visit& visit) {
  visit(config.cloth_surface_density, cloth.surface_density);
  visit(config.cloth_bending_warp, cloth.bending_warp);
  visit(config.cloth_bending_weft, cloth.bending_weft);
  visit(config.cloth_bending_bias, cloth.bending_bias);
  visit(config.cloth_bending_hysteresis, cloth.bending_hysteresis);
  visit(config.cloth_shear, cloth.shear);
  visit(config.cloth_porosity, cloth.porosity);
}

const auto kToConfig = [](double& config, const double& ours) { config = ours; };
const auto kFromConfig = [](const double& config, double& ours) { ours = config; };

std::vector<Problem> setAir(const CurtainConfig& values, curtain::Simulator& simulator) {
  const std::vector<std::string>& laws = curtain::airLawNames();
  const auto law = std::find(laws.begin(), laws.end(), values.air_law);
  if (law == laws.end())
    return {{"air.law", "must be " + curtain::alternatives(laws) + ", is '" + values.air_law + "'"}};
  curtain::AirParams air = simulator.scene().air;
  bool same = air.law == static_cast<curtain::AirLaw>(law - laws.begin());
  visitAir(values, air, [&same](double wanted, double present) { same = same && wanted == present; });
  if (same) return {};  // setting it would wake the cloth
  visitAir(values, air, kFromConfig);
  air.law = static_cast<curtain::AirLaw>(law - laws.begin());
  return simulator.setAir(air);
}

std::vector<Problem> setNode(const CurtainConfig& values, NodeParams& params) {
  NodeParams wanted = params;
  visitNode(values, wanted, kFromConfig);
  std::vector<Problem> problems = validate(wanted);
  if (problems.empty()) params = wanted;
  return problems;
}

}  // namespace

CurtainConfig liveValues(const curtain::Scene& scene, const NodeParams& params) {
  CurtainConfig values = CurtainConfig::__getDefault__();
  visitNode(values, params, kToConfig);
  visitAir(values, scene.air, kToConfig);
  visitCloth(values, scene.cloth, kToConfig);
  values.air_law = curtain::airLawNames().at(static_cast<std::size_t>(scene.air.law));
  values.gravity_x = scene.gravity.x();
  values.gravity_y = scene.gravity.y();
  values.gravity_z = scene.gravity.z();
  values.contact_friction = scene.contact.friction;
  values.solver_frame_rate = scene.solver.frame_rate;
  values.solver_stretch_tolerance = scene.solver.stretch_tolerance;
  values.solver_position_tolerance = scene.solver.position_tolerance;
  values.solver_budget_ms = scene.solver.budget_ms;
  return values;
}

std::vector<Problem> applyLiveValues(const CurtainConfig& values, curtain::Simulator& simulator, NodeParams& params) {
  std::vector<Problem> all;
  const auto add = [&all](const std::vector<Problem>& problems) {
    all.insert(all.end(), problems.begin(), problems.end());
  };
  add(simulator.setGravity({values.gravity_x, values.gravity_y, values.gravity_z}));
  add(setAir(values, simulator));
  curtain::ClothParams cloth = simulator.scene().cloth;
  visitCloth(values, cloth, kFromConfig);
  add(simulator.setCloth(cloth));
  add(simulator.setFriction(values.contact_friction));
  add(simulator.setFrameRate(values.solver_frame_rate));
  add(simulator.setStretchTolerance(values.solver_stretch_tolerance));
  add(simulator.setPositionTolerance(values.solver_position_tolerance));
  add(simulator.setBudget(values.solver_budget_ms));
  add(setNode(values, params));
  return all;
}

std::vector<Problem> applyMaterial(const curtain_sim::SetMaterialRequest& wanted, curtain::Simulator& simulator) {
  const std::string &name = wanted.material, &layer = wanted.layer;
  const std::vector<std::string>& names = curtain::materialNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return {{"material", "must be " + curtain::alternatives(names) + ", is '" + name + "'"}};
  const auto material = static_cast<curtain::Material>(found - names.begin());
  curtain::Scene scene = simulator.scene();
  const bool part = !wanted.rows.empty() || !wanted.columns.empty();
  curtain::PatchParams patch;
  patch.rows.assign(wanted.rows.begin(), wanted.rows.end());
  patch.columns.assign(wanted.columns.begin(), wanted.columns.end());
  curtain::applyMaterial(material, patch);
  if (!layer.empty() && layer != curtain::kFirstCloth) {
    const auto one = std::find_if(scene.layers.begin(), scene.layers.end(),
                                  [&](const curtain::LayerParams& params) { return params.name == layer; });
    if (one == scene.layers.end())
      return {{"layer", "must be empty, \"cloth\" or the name of a layer, is '" + layer + "'"}};
    if (part)
      addPatch(patch, one->cloth);
    else
      curtain::applyMaterial(material, scene, *one);
    return simulator.setCloth(one->cloth, layer);
  }
  if (part) {
    addPatch(patch, scene.cloth);
    return simulator.setCloth(scene.cloth);
  }
  curtain::applyMaterial(material, scene);
  std::vector<Problem> problems = simulator.setCloth(scene.cloth);
  if (problems.empty()) problems = simulator.setAir(scene.air);
  if (problems.empty()) problems = simulator.setFriction(scene.contact.friction);
  return problems;
}

}  // namespace curtain_ros
