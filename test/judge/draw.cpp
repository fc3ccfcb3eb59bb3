// SPDX-License-Identifier: BSD-3-Clause
#include "judge/draw.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "cloth/cloth.h"
#include "curtain_sim/simulator.h"
#include "judge/dice.h"
#include "step/weft_links.h"

namespace curtain_test {
namespace {

using namespace curtain;

const Ranges& rangesOf(Kind kind) {
  return kind == Kind::kEveryday ? kEverydayRanges : kind == Kind::kWild ? kWildRanges : kSuddenRanges;
}

void drawCloth(Dice& dice, const Ranges& ranges, bool wild, Scene& scene) {
  ClothParams& cloth = scene.cloth;
  cloth.rows = dice.integer(ranges.size[0], ranges.size[1]);
  cloth.columns = dice.integer(ranges.size[0], ranges.size[1]);
  cloth.height = dice.between(0.5, 2.5);
  cloth.width = dice.between(0.5, 2.5);
  if (wild && dice.chance(0.2)) cloth.height *= dice.magnitude(0.02, 50.0);
  if (wild && dice.chance(0.2)) cloth.width *= dice.magnitude(0.02, 50.0);
  if (dice.chance(0.15)) cloth.hem_width = dice.between(0.4, 1.6) * cloth.width;
  cloth.surface_density = dice.magnitude(ranges.density[0], ranges.density[1]);
  if (dice.chance(0.3)) cloth.lumping = Lumping::kUniform;
  cloth.porosity = dice.between(0.0, 0.5);
  const auto factors = [&](int count, double most) {
    std::vector<double> all(static_cast<std::size_t>(count));
    for (double& factor : all) factor = dice.magnitude(1.0 / most, most);
    return all;
  };
  const double uneven = wild ? 5.0 : 1.5;
  if (dice.chance(0.2)) cloth.row_spacing = factors(cloth.rows - 1, uneven);
  if (dice.chance(0.2)) cloth.column_spacing = factors(cloth.columns - 1, uneven);
  if (dice.chance(0.2)) cloth.row_mass = factors(cloth.rows, uneven);
  if (dice.chance(0.2)) cloth.column_mass = factors(cloth.columns, uneven);
}

NodeIndex anyNode(Dice& dice, const ClothParams& cloth) {
  return {dice.integer(0, cloth.rows - 1), dice.integer(0, cloth.columns - 1)};
}

void hang(Dice& dice, Scene& scene) {
  const double fullness = dice.chance(0.5) ? dice.between(0.9, 1.0) : dice.between(0.3, 0.9);
  const double heading = dice.between(-kPi, kPi);
  const Vec3 along(std::cos(heading), std::sin(heading), dice.chance(0.3) ? dice.between(-0.5, 0.5) : 0.0);
  scene.hang.from = dice.inBox(1.0) + Vec3(0.0, 0.0, 2.5);
  scene.hang.to = scene.hang.from + fullness * scene.cloth.width * along.normalized();
  scene.hang.tilt = dice.chance(0.4) ? 0.0 : dice.between(-kPi, kPi);
  switch (dice.integer(0, 5)) {
    case 0:
      scene.pins.kind = PinKind::kTop;
      break;
    case 1:
      scene.pins.kind = PinKind::kLeft;
      break;
    case 2:
      scene.pins.kind = PinKind::kTopCorners;
      break;
    case 3:
      scene.pins.kind = PinKind::kNone;
      break;
    default:
      scene.pins.kind = PinKind::kList;
      for (int count = dice.integer(1, 2); count > 0; --count) scene.pins.nodes.push_back(anyNode(dice, scene.cloth));
  }
}

void drawForces(Dice& dice, const Ranges& ranges, Drawn& drawn) {
  Scene& scene = drawn.scene;
  const auto force = [&] {
    return dice.chance(0.5) ? dice.between(ranges.force[0], ranges.force[1])
                            : dice.magnitude(ranges.force[0], ranges.force[1]);
  };
  const auto begin = [&] { return dice.chance(0.5) ? 0.0 : dice.between(0.0, 0.5 * drawn.seconds); };
  for (int count = dice.integer(0, 2); count > 0; --count) {
    DragParams drag;
    drag.id = "hand" + std::to_string(count);
    drag.node = anyNode(dice, scene.cloth);
    if (dice.chance(0.3)) drag.radius = dice.between(0.0, 0.5);
    if (dice.chance(0.6)) {
      drag.force = force() * dice.direction();
    } else {
      drag.target = scene.hang.from + dice.inBox(2.0);
      drag.stiffness = dice.magnitude(1.0, 1e3);
      drag.max_force = force();
    }
    drag.start = begin();
    drag.end = drag.start + 0.5;
    scene.drag.push_back(drag);
  }
  for (int count = dice.integer(0, 2); count > 0; --count) {
    WindParams wind;
    wind.id = "wind" + std::to_string(count);
    wind.direction = dice.direction();
    wind.position = 0.5 * (scene.hang.from + scene.hang.to) - dice.between(0.5, 3.0) * wind.direction;
    wind.radius = dice.between(0.3, 3.0);
    wind.half_angle = dice.chance(0.5) ? 0.0 : dice.between(0.0, 0.8);
    wind.pressure = dice.magnitude(ranges.pressure[0], ranges.pressure[1]);
    if (dice.chance(0.4)) wind.unsteadiness = dice.between(0.0, ranges.gust);
    wind.start = begin();
    if (dice.chance(0.5)) wind.end = wind.start + dice.between(0.1, 0.5) * drawn.seconds;
    scene.wind.push_back(wind);
  }
  if (dice.chance(0.5)) {
    scene.air.inside = dice.between(0.0, 1.0);
    scene.air.border = dice.between(0.0, 1.5);
    scene.air.corner = dice.between(0.0, 2.0);
    scene.air.fast_gain = dice.between(0.0, 0.3);
    if (dice.chance(0.2)) scene.air.law = AirLaw::kPrinted;
  }
}

void drawHappenings(Dice& dice, bool wild, Drawn& drawn) {
  Happenings& happenings = drawn.happenings;
  happenings.at = dice.between(0.1, 0.6) * drawn.seconds;
  if (drawn.scene.pins.kind != PinKind::kNone && dice.chance(0.3)) {
    happenings.pin_frequency = dice.magnitude(0.2, wild ? 20.0 : 3.0);
    happenings.pin_swing = dice.between(0.0, wild ? 1.0 : 0.3) * dice.direction();
  }
  if (wild && dice.chance(0.15)) happenings.pin_jerk = dice.magnitude(0.01, 10.0) * dice.direction();
  if (wild && dice.chance(0.2)) happenings.gravity = dice.magnitude(0.1, 1e4) * dice.direction();
  if (wild && dice.chance(0.1)) happenings.other_rate = dice.magnitude(5.0, 1000.0);
}

// A ring instead, as far open or spread as its rows are long.
void close(Dice& dice, Scene& scene) {
  scene.cloth.closed = true;
  scene.cloth.columns = std::max(3, scene.cloth.columns);
  for (std::vector<double>* const factors : {&scene.cloth.column_spacing, &scene.cloth.column_mass}) factors->clear();
  scene.hang.radius = dice.between(0.3, 1.0) * scene.cloth.width / (2.0 * kPi);
  scene.hang.tilt = dice.chance(0.5) ? 0.0 : dice.between(0.0, 1.0);
  if (!validate(scene).empty()) scene.hang.tilt = 0.0;
  if (!validate(scene).empty()) scene.cloth.hem_width.reset();
}

// A trapezium whose rods all have one length is not flat. It begins flat all the same, with wefts that the first
// substeps take up; not where that is more than a tenth of a link.
bool beginsTorn(const Scene& scene) {
  if (!scene.cloth.hem_width) return false;
  const ClothPattern pattern = makePattern(scene);
  return weftStretch(pattern, makeInitialState(scene, pattern).position) > 0.1;
}

// What came to be drawn later, by dice of its own: the scenes of seeds keep all the rest. The paper's method keeps its
// rods where nothing touches.
void drawMore(Drawn& drawn) {
  Dice dice(3 * drawn.seed + static_cast<std::uint64_t>(drawn.kind) + (1ULL << 60));
  Scene& scene = drawn.scene;
  const bool wild = drawn.kind == Kind::kWild;
  if (dice.chance(0.15)) close(dice, scene);
  for (int more = dice.chance(0.3) ? dice.integer(1, 2) : 0; more > 0; --more) {
    const Shapes shapes = dice.chance(0.6) ? Shapes::kMeshes : wild ? Shapes::kAny : Shapes::kMostlyBalls;
    addObstacle(dice, rangesOf(drawn.kind), shapes, "other" + std::to_string(more), drawn);
  }
  if (!dice.chance(0.1)) return;
  scene.solver.method = Method::kPaper;
  if (dice.chance(0.3)) return;
  scene.obstacles.clear();
  scene.contact.self = false;
}

// The same, later still.
void drawSlits(Drawn& drawn) {
  Dice dice(3 * drawn.seed + static_cast<std::uint64_t>(drawn.kind) + (1ULL << 61));
  if (!dice.chance(0.1)) return;
  ClothParams& cloth = drawn.scene.cloth;
  const double share = dice.between(0.0, 0.5);
  for (int column = 1; column < weftLinkCount(cloth) - 1; ++column) {
    const bool after_another = !cloth.slits.empty() && cloth.slits.back().column == column - 1;
    if (dice.chance(share) && !after_another)
      cloth.slits.push_back({column, dice.chance(0.7) ? 0 : dice.integer(0, cloth.rows - 1)});
  }
}

// Air by its relative velocity, by dice of its own again.
void drawAir(Drawn& drawn) {
  Dice dice(3 * drawn.seed + static_cast<std::uint64_t>(drawn.kind) + (3ULL << 60));
  Scene& scene = drawn.scene;
  const bool wild = drawn.kind == Kind::kWild;
  if (scene.solver.method == Method::kPaper || !dice.chance(0.2)) return;
  scene.air = AirParams();
  scene.air.law = AirLaw::kRelative;
  scene.air.normal_drag = dice.between(0.0, 2.0);
  scene.air.tangential_drag = dice.between(0.0, 0.1);
  if (dice.chance(0.7)) scene.ambient.velocity = dice.magnitude(0.3, wild ? 100.0 : 15.0) * dice.direction();
  if (dice.chance(0.5)) scene.ambient.intensity = dice.between(0.0, wild ? 1.0 : 0.4);
  scene.ambient.length_scale = dice.magnitude(0.1, 100.0);
  if (dice.chance(0.5)) scene.ambient.spectrum = GustSpectrum::kDryden;
  scene.ambient.seed = drawn.seed;
  for (WindParams& wind : scene.wind) {
    wind.shadow = dice.chance(0.3);
    if (dice.chance(0.3)) wind.profile = WindProfile::kRingJet;
  }
}

// Bending, from voile to strips of PVC.
void drawBending(Drawn& drawn) {
  Dice dice(3 * drawn.seed + static_cast<std::uint64_t>(drawn.kind) + (5ULL << 59));
  if (drawn.scene.solver.method == Method::kPaper || !dice.chance(0.2)) return;
  const double most = drawn.kind == Kind::kWild ? 1.0 : 1e-2;
  if (dice.chance(0.8)) drawn.scene.cloth.bending_warp = dice.magnitude(1e-7, most);
  if (dice.chance(0.8)) drawn.scene.cloth.bending_weft = dice.magnitude(1e-7, most);
}

// Fabric that resists shear and twist, and rubs within itself.
void drawFabric(Drawn& drawn) {
  Dice dice(3 * drawn.seed + static_cast<std::uint64_t>(drawn.kind) + (15ULL << 59));
  ClothParams& cloth = drawn.scene.cloth;
  if (drawn.scene.solver.method == Method::kPaper || !dice.chance(0.2)) return;
  const bool wild = drawn.kind == Kind::kWild, bends = cloth.bending_warp > 0.0 || cloth.bending_weft > 0.0;
  if (dice.chance(0.8)) cloth.shear = dice.magnitude(0.3, wild ? 1e5 : 300.0);
  if (dice.chance(0.5)) cloth.bending_bias = dice.magnitude(1e-7, wild ? 1.0 : 1e-2);
  if (dice.chance(0.3) && bends) cloth.bending_hysteresis = dice.magnitude(1e-5, wild ? 10.0 : 0.1);
}

// Pleats, some of them pressed in.
void drawHeading(Drawn& drawn) {
  Dice dice(3 * drawn.seed + static_cast<std::uint64_t>(drawn.kind) + (9ULL << 59));
  Scene& scene = drawn.scene;
  if (scene.cloth.closed || !dice.chance(0.15)) return;
  const Scene before = scene;
  scene.cloth.hem_width.reset();
  scene.hang.heading = static_cast<Heading>(dice.integer(1, 5));
  if (scene.cloth.bending_weft > 0.0 && dice.chance(0.7))
    scene.hang.pressed = dice.between(0.01, 1.0) * scene.cloth.height;
  if (!validate(scene).empty()) scene.hang.pressed = 0.0;
  if (!validate(scene).empty()) scene = before;
}

// A rail instead of pins, by dice of its own for the same reason: one to three pieces, straight ones and arcs, from
// where the cloth hung.
void putOnRail(Drawn& drawn) {
  Dice dice(3 * drawn.seed + static_cast<std::uint64_t>(drawn.kind) + (7ULL << 59));
  Scene& scene = drawn.scene;
  if (scene.cloth.closed || scene.solver.method == Method::kPaper || !dice.chance(0.1)) return;
  RailParams& rail = scene.rail;
  rail.path.push_back({scene.hang.from, {}});
  double heading = dice.between(-kPi, kPi);
  for (int pieces = dice.integer(1, 3); pieces > 0; --pieces) {
    const double length = scene.cloth.width * dice.between(0.2, 0.8), turn = dice.between(-1.5, 1.5);
    const Vec3 from = rail.path.back().to, along(std::cos(heading), std::sin(heading), 0.0);
    heading += turn;
    if (dice.chance(0.6)) {
      rail.path.push_back({from + length * along, {}});
      continue;
    }
    const double radius = length / turn;  // negative: to the right
    const Vec3 centre = from + radius * Vec3(-along.y(), along.x(), 0.0);
    rail.path.push_back({centre + radius * Vec3(std::sin(heading), -std::cos(heading), 0.0), centre});
  }
  const bool wild = drawn.kind == Kind::kWild;
  rail.carriers.every = dice.integer(1, std::max(1, scene.cloth.columns / 3));
  rail.carriers.mass = dice.chance(0.2) ? 0.0 : dice.magnitude(1e-3, wild ? 10.0 : 0.1);
  rail.carriers.friction = dice.chance(0.2) ? 0.0 : dice.between(0.0, wild ? 2.0 : 0.4);
  rail.carriers.gap = dice.between(0.02, 0.2) * scene.cloth.width / scene.cloth.columns;
  rail.opening = dice.chance(0.5) ? 0.0 : dice.between(0.0, 1.0);
  rail.drive = {dice.magnitude(0.1, wild ? 10.0 : 1.0), dice.magnitude(1.0, wild ? 1e3 : 30.0)};
  if (dice.chance(0.7)) drawn.happenings.opening = dice.between(0.0, 1.0);
  drawn.happenings.pin_swing = drawn.happenings.pin_jerk = Vec3::Zero();
  scene.pins = PinParams();
  scene.cloth.hem_width.reset();
  if (!validate(scene).empty()) rail = RailParams();
}

LineParams drawLine(Dice& dice, bool wild, const std::string& id, const Scene& scene) {
  LineParams line;
  line.id = id;
  const int row = dice.chance(0.6) ? scene.cloth.rows - 1 : dice.integer(0, scene.cloth.rows - 1);
  const int step = dice.integer(1, scene.cloth.columns);
  for (int column = dice.integer(0, step - 1); column < scene.cloth.columns; column += step)
    line.nodes.push_back({row, column});
  const double size = scene.cloth.width + scene.cloth.height;
  line.to = scene.hang.from - scene.cloth.height * Vec3::UnitZ() + dice.between(0.05, 1.0) * size * dice.direction();
  if (dice.chance(0.6))
    line.mass =
        dice.magnitude(1e-3, wild ? 1e2 : 10.0) * scene.cloth.surface_density * scene.cloth.width * scene.cloth.height;
  return line;
}

// Loads, guy lines and tie-backs.
void drawLines(Drawn& drawn) {
  Dice dice(3 * drawn.seed + static_cast<std::uint64_t>(drawn.kind) + (11ULL << 59));
  Scene& scene = drawn.scene;
  const bool wild = drawn.kind == Kind::kWild;
  if (scene.solver.method == Method::kPaper || !dice.chance(0.15)) return;
  for (int left = dice.integer(0, 2); left > 0; --left)
    scene.lines.push_back(drawLine(dice, wild, "line" + std::to_string(left), scene));
  if (scene.lines.empty() || dice.chance(0.3)) {
    TieBackParams loop;
    loop.id = "tie";
    loop.row = dice.integer(1, scene.cloth.rows - 1);
    loop.first_column = dice.integer(0, scene.cloth.columns - 1);
    loop.last_column = dice.integer(loop.first_column, scene.cloth.columns - 1);
    loop.radius = dice.between(0.05, 0.5) * scene.cloth.width;
    loop.speed = dice.magnitude(0.1, wild ? 10.0 : 1.0);
    const double depth = scene.cloth.height * loop.row / (scene.cloth.rows - 1);
    loop.point = 0.5 * (scene.hang.from + (scene.cloth.closed ? scene.hang.from : scene.hang.to)) -
                 dice.between(0.3, 0.9) * depth * Vec3::UnitZ() +
                 0.3 * scene.cloth.width * dice.between(-1.0, 1.0) * Vec3::UnitX();
    scene.tie_back.push_back(loop);
    drawn.happenings.pin_swing = drawn.happenings.pin_jerk = Vec3::Zero();
    if (dice.chance(0.6)) drawn.happenings.tie_back = dice.chance(0.5) ? 0 : 1;
    scene.tie_back[0].closed = drawn.happenings.tie_back != 1;
  }
  if (validate(scene).empty() && problemsAtStart(scene, makePattern(scene)).empty()) return;
  scene.lines.clear();
  scene.tie_back.clear();
}

// A second cloth of other fabric and size before or behind the first, so near that they touch, by dice of its own.
void drawLayer(Drawn& drawn) {
  Dice dice(3 * drawn.seed + static_cast<std::uint64_t>(drawn.kind) + (17ULL << 59));
  Scene& scene = drawn.scene;
  const bool wild = drawn.kind == Kind::kWild, self = scene.contact.self;
  if (scene.cloth.closed || scene.solver.method == Method::kPaper || !dice.chance(0.15)) return;
  LayerParams layer;
  layer.name = "second";
  layer.cloth.rows = scene.cloth.rows;
  layer.cloth.columns = dice.integer(2, scene.cloth.columns);
  layer.cloth.height = dice.between(0.5, 1.5) * scene.cloth.height;
  layer.cloth.width = dice.between(0.5, 1.5) * scene.cloth.width;
  layer.cloth.surface_density = dice.magnitude(0.2, 5.0) * scene.cloth.surface_density;
  if (dice.chance(0.5)) layer.cloth.shear = dice.magnitude(0.3, wild ? 1e5 : 300.0);
  if (dice.chance(0.5)) layer.cloth.bending_warp = layer.cloth.bending_weft = dice.magnitude(1e-7, wild ? 1.0 : 1e-3);
  const Vec3 along = (scene.hang.to - scene.hang.from).normalized();
  const Rotation tilt(Eigen::AngleAxisd(scene.hang.tilt, along));
  const Vec3 across = tilt * along.cross(Vec3::UnitZ()).normalized();
  layer.hang = scene.hang;
  layer.hang.heading = Heading::kGathered;
  layer.hang.pressed = 0.0;
  layer.hang.from += (dice.chance(0.5) ? 1.0 : -1.0) * dice.magnitude(2.0, 20.0) * scene.contact.thickness * across;
  layer.hang.to = layer.hang.from + dice.between(0.6, 1.0) * layer.cloth.width * along;
  const PinKind kinds[] = {PinKind::kTop, PinKind::kTopCorners, PinKind::kLeft, PinKind::kNone};
  layer.pins.kind = kinds[dice.integer(0, 3)];
  scene.layers.push_back(layer);
  scene.contact.self = true;
  try {
    const Simulator begins(scene, resolveTrialMesh);
  } catch (const std::invalid_argument&) {  // it begins in the first, or in itself
    scene.layers.clear();
    scene.contact.self = self;
  }
}

// A part of the cloth that is of another fabric, by dice of its own.
void drawPatch(Drawn& drawn) {
  Dice dice(3 * drawn.seed + static_cast<std::uint64_t>(drawn.kind) + (19ULL << 59));
  Scene& scene = drawn.scene;
  ClothParams& cloth = scene.cloth;
  const bool wild = drawn.kind == Kind::kWild;
  if (scene.solver.method == Method::kPaper || !dice.chance(0.15)) return;
  PatchParams patch;
  const auto block = [&](int count) {
    const int first = dice.integer(0, count - 1);
    return std::vector<int>{first, dice.integer(first, count - 1)};
  };
  patch.rows = block(cloth.rows);
  if (dice.chance(0.5)) patch.columns = block(cloth.columns);
  if (dice.chance(0.7)) patch.surface_density = dice.magnitude(0.2, 5.0) * cloth.surface_density;
  if (dice.chance(0.5)) patch.porosity = dice.between(0.0, 1.0);
  if (dice.chance(0.5)) patch.shear = dice.magnitude(0.3, wild ? 1e5 : 300.0);
  if (dice.chance(0.5)) patch.bending_warp = patch.bending_weft = dice.magnitude(1e-7, wild ? 1.0 : 1e-3);
  cloth.patches.push_back(patch);
  try {
    const Simulator begins(scene, resolveTrialMesh);
  } catch (const std::invalid_argument&) {  // its links are too short to bend, or it begins in itself
    cloth.patches.clear();
  }
}

// Hands, by dice of their own. Two that do not give could be drawn through each other with what they hold: of those,
// and beside pins that move, there is one.
void drawHands(Drawn& drawn) {
  Dice dice(3 * drawn.seed + static_cast<std::uint64_t>(drawn.kind) + (13ULL << 59));
  const Scene& scene = drawn.scene;
  const bool wild = drawn.kind == Kind::kWild, paper = scene.solver.method == Method::kPaper;
  if (!dice.chance(0.2)) return;
  const double size = std::min(scene.cloth.height, scene.cloth.width);
  const double weight = scene.cloth.surface_density * scene.cloth.height * scene.cloth.width * 9.81;
  bool rigid = !scene.lines.empty() || !scene.tie_back.empty();
  for (int more = dice.integer(1, 3); more > 0; --more) {
    Hand hand;
    hand.node = anyNode(dice, scene.cloth);
    hand.radius = dice.between(0.02, 0.2) * size;
    hand.from = dice.between(0.0, 0.5) * drawn.seconds;
    hand.until = hand.from + dice.between(0.1, 1.0) * drawn.seconds;
    hand.frequency = dice.magnitude(0.3, wild ? 10.0 : 2.0);
    hand.swing = dice.between(0.0, wild ? 1.0 : 0.2) * size * dice.direction();
    hand.turn = dice.between(0.0, wild ? 2.0 : 0.5);
    if (!paper && dice.chance(0.4)) hand.stiffness = dice.magnitude(0.1, wild ? 1e4 : 1e2) * weight / size;
    if (!paper && dice.chance(0.4)) hand.pinch_force = dice.magnitude(0.05, 10.0) * weight;
    if (!paper && dice.chance(0.4)) hand.break_force = dice.magnitude(0.3, 30.0) * weight;
    const bool gives = hand.stiffness > 0.0 || hand.pinch_force > 0.0;
    if (!gives && rigid) continue;
    rigid = rigid || !gives;
    drawn.happenings.hands.push_back(hand);
  }
}

}  // namespace

const char* kindName(Kind kind) {
  return kind == Kind::kEveryday ? "everyday" : kind == Kind::kWild ? "wild" : "sudden";
}

Drawn draw(Kind kind, std::uint64_t seed) {
  Dice dice(3 * seed + static_cast<std::uint64_t>(kind));
  const Ranges& ranges = rangesOf(kind);
  const bool wild = kind == Kind::kWild;
  Drawn drawn;
  drawn.kind = kind;
  drawn.seed = seed;
  drawn.seconds = wild ? dice.between(0.3, 1.0) : dice.between(0.5, 2.0);
  Scene& scene = drawn.scene;
  drawCloth(dice, ranges, wild, scene);
  scene.solver.frame_rate = dice.magnitude(ranges.rate[0], ranges.rate[1]);
  hang(dice, scene);
  if (dice.chance(0.1)) scene.gravity = dice.magnitude(0.1, wild ? 1e3 : 20.0) * dice.direction();
  drawForces(dice, ranges, drawn);
  if (dice.chance(0.5)) addObstacle(dice, ranges, wild ? Shapes::kAny : Shapes::kMostlyBalls, "obstacle", drawn);
  drawHappenings(dice, wild, drawn);
  scene.contact.thickness = dice.between(0.002, 0.01);
  scene.contact.friction = dice.between(0.0, 0.6);
  scene.contact.self = dice.chance(0.35);
  if (wild && dice.chance(0.3)) {
    // Implicit twice, in place of a scheme that is gone: seeds keep their scenes.
    const Method methods[] = {Method::kLeapfrog, Method::kLeapfrog4, Method::kImplicit, Method::kImplicit};
    scene.solver.method = methods[dice.integer(0, 3)];
  }
  if (wild && dice.chance(0.1)) scene.solver.substeps = dice.integer(1, 8);
  scene.solver.threads = 1;
  scene.solver.seed = seed;
  if (kind == Kind::kSudden)
    drawPlate(dice, drawn);
  else
    drawMore(drawn);
  drawSlits(drawn);
  if (kind != Kind::kSudden) drawAir(drawn);
  if (kind != Kind::kSudden) drawBending(drawn);
  if (kind != Kind::kSudden) drawFabric(drawn);
  if (kind != Kind::kSudden) drawHeading(drawn);
  if (kind != Kind::kSudden) putOnRail(drawn);
  if (!validate(scene).empty()) scene.cloth.hem_width.reset();  // tapered more than its rods can slant
  if (beginsTorn(scene)) scene.cloth.hem_width.reset();
  if (kind != Kind::kSudden) drawLines(drawn);
  if (kind != Kind::kSudden) drawHands(drawn);
  if (kind != Kind::kSudden) drawLayer(drawn);
  if (kind != Kind::kSudden) drawPatch(drawn);
  return drawn;
}

}  // namespace curtain_test
