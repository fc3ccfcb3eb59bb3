// SPDX-License-Identifier: BSD-3-Clause
//
// Values that have a meaning together; what is left over is for validate().
#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/cloth.h"
#include "drawn/places.h"
#include "drawn/scene_maker.h"
#include "scene/heading.h"
#include "scene/layers.h"

namespace curtain_test {
namespace {

using curtain::DragParams;
using curtain::NodeIndex;
using curtain::ObstacleParams;
using curtain::Range;
using curtain::Scene;
using curtain::Vec3;
using curtain::WindParams;

// Rails begin so near that lengths of their pieces count [m].
constexpr double kFarthestRail = 1e6;

void putOnGrid(NodeIndex& node, const curtain::ClothParams& cloth) {
  node.row %= cloth.rows;
  node.column %= cloth.columns;
}

void resizeUnlessEmpty(std::vector<double>& values, int count) {
  if (!values.empty()) values.resize(static_cast<std::size_t>(count), values.front());
}

// The line it hangs from is as long as the cloth is wide, or shorter.
void placeLine(Scene& scene, Choices& choices) {
  const Vec3 way = scene.hang.to - scene.hang.from;
  const double length = way.norm();
  const Vec3 along = length > 0.0 && std::isfinite(length) ? Vec3(way / length) : Vec3(Vec3::UnitX());
  scene.hang.to = scene.hang.from + (1.0 - 0.9 * choices.share()) * scene.cloth.width * along;
}

// A rail that the cloth hangs from: flat pieces a few metres long, and arcs of a quarter of a circle.
void fitRail(Scene& scene, Choices& choices) {
  curtain::RailParams& rail = scene.rail;
  if (!(scene.cloth.width > 1e-6 && scene.cloth.width < kFarthestRail)) rail.path.clear();  // no gap or place fits
  if (rail.path.empty()) return;
  scene.hang.radius.reset();
  if (scene.cloth.hem_width) scene.cloth.hem_width = std::max(*scene.cloth.hem_width, scene.cloth.width);
  if (scene.solver.method == curtain::Method::kPaper) scene.solver.method = curtain::Method::kAuto;
  rail.path[0].centre.reset();
  rail.path[0].to = rail.path[0].to.cwiseMax(-kFarthestRail).cwiseMin(kFarthestRail);
  Vec3 along = Vec3::UnitX();
  for (std::size_t i = 1; i < rail.path.size(); ++i) {
    const double length = scene.cloth.width * choices.between(0.3, 1.0);
    const Vec3 from = rail.path[i - 1].to, across(-along.y(), along.x(), 0.0);
    rail.path[i].to = from + length * along;
    if (!rail.path[i].centre) continue;
    rail.path[i].centre = from + length * across;
    rail.path[i].to = *rail.path[i].centre + length * along;
    along = across;
  }
  rail.carriers.every = std::min(rail.carriers.every, scene.cloth.columns - 1);
  rail.carriers.columns.clear();
  if (!rail.masters.empty()) rail.masters = {0};
  rail.carriers.gap = choices.between(0.01, 0.5) * 0.3 * scene.cloth.width / (scene.cloth.columns - 1);
}

// Times that increase.
template <typename AtTime>
void putInOrder(std::vector<AtTime>& entries) {
  for (std::size_t i = 1; i < entries.size(); ++i) {
    const double before = entries[i - 1].time;
    if (!(entries[i].time > before)) entries[i].time = before + std::max(0.01, 0.01 * std::abs(before));
  }
}

// Each once.
void putOnGrid(std::vector<NodeIndex>& nodes, const curtain::ClothParams& cloth) {
  std::vector<NodeIndex> kept;
  for (NodeIndex& node : nodes) {
    putOnGrid(node, cloth);
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const NodeIndex& other) {
      return other.row == node.row && other.column == node.column;
    });
    if (is_new) kept.push_back(node);
  }
  nodes = kept;
}

// Lines from nodes of the cloth, each once, to an end that they reach.
void fitLines(Scene& scene, const curtain::ClothParams& cloth) {
  for (curtain::LineParams& line : scene.lines) {
    putOnGrid(line.nodes, cloth);
    if (!line.to && (!line.mass || !line.length || scene.gravity.isZero())) line.to = scene.hang.from;
    if (line.to && line.length) line.length = std::max(*line.length, 4.0 * (cloth.width + cloth.height));
  }
  for (curtain::TieBackParams& loop : scene.tie_back) {
    loop.row = std::min(loop.row, cloth.rows - 1);
    loop.last_column = std::min(loop.last_column, cloth.columns - 1);
    loop.first_column = std::min(loop.first_column, loop.last_column);
  }
  if (scene.solver.method == curtain::Method::kPaper && !(scene.lines.empty() && scene.tie_back.empty()))
    scene.solver.method = curtain::Method::kAuto;
}

// Hands that pull where pulls are known; pins that there are.
void fitHands(Scene& scene, const curtain::ClothParams& cloth) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  for (curtain::HandParams& hand : scene.hands) {
    putOnGrid(hand.grasp.nodes, cloth);
    if (hand.grasp.region == curtain::GraspRegion::kNodes) hand.grasp.pinch_force = kNone;
    if (scene.solver.method == curtain::Method::kPaper)
      hand.grasp.stiffness = hand.grasp.break_force = hand.grasp.pinch_force = kNone;
    if (!(hand.end > hand.start)) hand.end = kNone;
    putInOrder(hand.motion);
  }
  putInOrder(scene.pins_motion);
  const bool none = scene.pins.kind == curtain::PinKind::kNone ||
                    (scene.pins.kind == curtain::PinKind::kList && scene.pins.nodes.empty());
  const auto slides = [](const curtain::LayerParams& layer) { return !layer.rail.path.empty(); };
  const bool slide = !scene.rail.path.empty() || std::any_of(scene.layers.begin(), scene.layers.end(), slides);
  if (none || slide) scene.pins_motion.clear();
}

// Blocks on the cloth; what a material says stands in the keys, as a file's reader has it.
void fitPatches(curtain::ClothParams& cloth) {
  const auto fit = [](std::vector<int>& block, int count) {
    if (block.size() != 2) block.clear();
    for (int& place : block) place = std::min(std::max(place, 0), count - 1);
    std::sort(block.begin(), block.end());
  };
  const auto orElse = [](const auto& value, const auto& other) { return value ? value : other; };
  for (curtain::PatchParams& patch : cloth.patches) {
    fit(patch.rows, cloth.rows);
    fit(patch.columns, cloth.columns);
    curtain::PatchParams known;
    applyMaterial(patch.material, known);
    patch.surface_density = orElse(patch.surface_density, known.surface_density);
    patch.porosity = orElse(patch.porosity, known.porosity);
    patch.bending_warp = orElse(patch.bending_warp, known.bending_warp);
    patch.bending_weft = orElse(patch.bending_weft, known.bending_weft);
    patch.bending_bias = orElse(patch.bending_bias, known.bending_bias);
    patch.shear = orElse(patch.shear, known.shear);
  }
}

// Of one cloth, of a scene that has no other.
void fitCloth(Scene& scene, Choices& choices, Manner manner, int most) {
  const bool any = manner == Manner::kAny;
  curtain::ClothParams& cloth = scene.cloth;
  if (!scene.rail.path.empty()) cloth.closed = false;
  cloth.rows = std::min(cloth.rows, any ? kMaxRows : most);
  cloth.columns = std::min(cloth.columns, any ? kMaxColumns : most);
  if (cloth.hem_width && !any)
    cloth.hem_width = std::min(std::max(*cloth.hem_width, 0.4 * cloth.width), 1.6 * cloth.width);
  const int room = (curtain::weftLinkCount(cloth) - 1) / 2;  // strips of two columns
  cloth.slits.resize(std::min(cloth.slits.size(), static_cast<std::size_t>(room)));
  const int strip =
      any || cloth.slits.empty() ? 2 : choices.integer(2, 2 * room / static_cast<int>(cloth.slits.size()));
  for (std::size_t i = 0; i < cloth.slits.size(); ++i) {
    cloth.slits[i] = {strip * static_cast<int>(i) + 1, std::min(std::max(cloth.slits[i].from_row, 0), cloth.rows - 1)};
  }
  resizeUnlessEmpty(cloth.row_spacing, cloth.rows - 1);
  resizeUnlessEmpty(cloth.column_spacing, curtain::weftLinkCount(cloth));
  resizeUnlessEmpty(cloth.row_mass, cloth.rows);
  resizeUnlessEmpty(cloth.column_mass, cloth.columns);
  resizeUnlessEmpty(scene.hem.weights, cloth.columns);
  const bool shows_pleats = curtain::weftLinkCount(cloth) >= curtain::fewestLinks(scene.hang.heading);
  if (cloth.closed || cloth.hem_width || !shows_pleats) scene.hang.heading = curtain::Heading::kGathered;
  scene.hang.pleats %= std::max(curtain::weftLinkCount(cloth) / 9, 1);
  if (cloth.closed) {
    if (scene.hang.radius) scene.hang.radius = choices.between(0.05, 1.0) * cloth.width / (2.0 * std::acos(-1.0));
    if (scene.hang.tilt != 0.0) scene.hang.tilt = -choices.between(0.0, 0.02);
  } else {
    scene.hang.radius.reset();
    if (any) placeLine(scene, choices);
  }
  const double fullness = scene.cloth.width / (scene.hang.to - scene.hang.from).norm();
  if (scene.hang.fullness) scene.hang.fullness = fullness;
  if (cloth.closed || !(fullness >= 1.0 && fullness <= 3.0)) scene.hang.fullness.reset();
  if (!any && !scene.rail.path.empty()) scene.rail.path[0].to = scene.hang.from;
  fitRail(scene, choices);
  for (NodeIndex& pin : scene.pins.nodes) putOnGrid(pin, cloth);
  fitPatches(cloth);
  if (anyFabric(cloth, [](const curtain::Fabric& fabric) { return !fabric.bends(); })) {
    cloth.bending_hysteresis = 0.0;
    for (curtain::PatchParams& patch : cloth.patches) patch.bending_hysteresis.reset();
  }
}

// Beside the first, which is fitted.
void fitLayers(Scene& scene, Choices& choices, Manner manner, int most) {
  if (scene.cloth.closed) scene.layers.clear();
  for (std::size_t k = 0; k < scene.layers.size(); ++k) {
    curtain::LayerParams& layer = scene.layers[k];
    layer.name = "layer" + std::to_string(k);
    layer.cloth.rows = scene.cloth.rows;
    layer.cloth.folds = scene.cloth.folds;
    layer.cloth.closed = false;
    Scene one = curtain::layerScene(scene, k + 1);
    if (manner != Manner::kAny) placeBeside(scene, choices, one.hang, one.cloth.width);
    fitCloth(one, choices, manner, most);
    scene.solver.method = one.solver.method;
    layer = {layer.name, one.cloth, one.hang, one.hem, one.pins, one.rail, layer.air};
  }
  // What goes wrong with them is not to spoil the scene.
  const Scene first = curtain::layerScene(scene, 0);
  Scene all = first;
  all.layers = scene.layers;
  if (curtain::validate(first).empty() && !curtain::validate(all).empty()) scene.layers.clear();
}

}  // namespace

void fitTogether(Scene& scene, Choices& choices, Manner manner, int most) {
  // Together they say how much a frame may take: their product, times the nodes.
  if (manner == Manner::kAny) {
    for (int* count : {&scene.solver.substeps, &scene.solver.max_substeps, &scene.solver.max_sweeps,
                       &scene.contact.zone_iterations}) {
      *count = std::min(*count, kMaxRounds);
    }
    scene.solver.threads = std::min(scene.solver.threads, kMaxThreads);
  } else {
    placeCloth(scene, choices);
  }
  fitCloth(scene, choices, manner, most);
  fitLayers(scene, choices, manner, most);
  if (manner != Manner::kAny) placeThings(scene, choices, manner == Manner::kWild ? 50.0 : 5.0);
  const curtain::ClothParams whole = curtain::wholeCloth(scene);
  fitLines(scene, whole);
  for (curtain::ObstacleParams& obstacle : scene.obstacles) {
    if (!obstacle.motion.empty()) obstacle.velocity = obstacle.spin = obstacle.acceleration = Vec3::Zero();
  }
  if (scene.air.law == curtain::AirLaw::kRelative) {
    scene.air.density = std::max(scene.air.density, 1e-6);
    scene.air.inside = scene.air.border = scene.air.corner = 0.0;
    if (scene.solver.method == curtain::Method::kPaper) scene.solver.method = curtain::Method::kAuto;
  } else {
    scene.ambient.velocity.setZero();
  }
  for (WindParams& wind : scene.wind) {
    const double length = wind.direction.norm();
    if (!(length >= 1e-150 && length <= 1e150)) wind.direction = Vec3::UnitX();
    if (!(wind.end > wind.start)) wind.end = std::numeric_limits<double>::infinity();
  }
  for (DragParams& drag : scene.drag) {
    if (drag.node)
      drag.point.reset();
    else if (!drag.point)
      drag.node = NodeIndex{};
    if (drag.node) putOnGrid(*drag.node, whole);
    if (!(drag.end > drag.start)) drag.end = std::numeric_limits<double>::infinity();
    if (!drag.path.empty()) drag.target.reset();
    putInOrder(drag.path);
  }
  fitHands(scene, whole);
  for (curtain::ObstacleParams& obstacle : scene.obstacles) putInOrder(obstacle.motion);
}

}  // namespace curtain_test
