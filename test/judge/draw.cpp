// SPDX-License-Identifier: BSD-3-Clause
#include "judge/draw.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "drawn/scene_maker.h"

namespace curtain_test {
namespace {

using namespace curtain;

Scene drawScene(Choices& choices, Manner manner, int most) {
  for (;;) {
    std::optional<Scene> scene = makeScene(choices, manner, most);
    if (!scene) continue;
    if (scene->solver.method == Method::kPaper && choices.chance(0.7)) {  // it keeps its rods where nothing touches
      scene->obstacles.clear();
      scene->contact.self = false;
    }
    if (mayBegin(*scene)) return *scene;
  }
}

// Hands of those who look on. Two that do not give could be drawn through each other with what they hold: of those, and
// beside pins that move, there is one.
void drawHands(Choices& choices, bool wild, Drawn& drawn) {
  const Scene& scene = drawn.scene;
  const bool paper = scene.solver.method == Method::kPaper;
  if (!choices.chance(0.2)) return;
  const double size = std::min(scene.cloth.height, scene.cloth.width);
  const double weight = scene.cloth.surface_density * scene.cloth.height * scene.cloth.width * 9.81;
  bool rigid = !scene.lines.empty() || !scene.tie_back.empty() || !scene.hands.empty();
  for (int more = choices.integer(1, 3); more > 0; --more) {
    Hand hand;
    hand.node = {choices.integer(0, scene.cloth.rows - 1), choices.integer(0, scene.cloth.columns - 1)};
    hand.radius = choices.between(0.02, 0.2) * size;
    hand.from = choices.between(0.0, 0.5) * drawn.seconds;
    hand.until = hand.from + choices.between(0.1, 1.0) * drawn.seconds;
    hand.frequency = choices.magnitude(0.3, wild ? 10.0 : 2.0);
    hand.swing = choices.between(0.0, wild ? 1.0 : 0.2) * size * choices.direction();
    hand.turn = choices.between(0.0, wild ? 2.0 : 0.5);
    if (!paper && choices.chance(0.4)) hand.stiffness = choices.magnitude(0.1, wild ? 1e4 : 1e2) * weight / size;
    if (!paper && choices.chance(0.4)) hand.pinch_force = choices.magnitude(0.05, 10.0) * weight;
    if (!paper && choices.chance(0.4)) hand.break_force = choices.magnitude(0.3, 30.0) * weight;
    const bool gives = hand.stiffness > 0.0 || hand.pinch_force > 0.0;
    if (!gives && rigid) continue;
    rigid = rigid || !gives;
    drawn.happenings.hands.push_back(hand);
  }
}

void drawHappenings(Choices& choices, bool wild, Drawn& drawn) {
  const Scene& scene = drawn.scene;
  Happenings& happenings = drawn.happenings;
  happenings.at = choices.between(0.1, 0.6) * drawn.seconds;
  if (wild && choices.chance(0.2)) happenings.gravity = choices.magnitude(0.1, 1e4) * choices.direction();
  if (wild && choices.chance(0.1)) happenings.other_rate = choices.magnitude(5.0, 1000.0);
  if (!scene.rail.path.empty() && choices.chance(0.7)) happenings.opening = choices.between(0.0, 1.0);
  if (!scene.tie_back.empty() && choices.chance(0.6)) happenings.tie_back = scene.tie_back[0].closed ? 0 : 1;
  drawHands(choices, wild, drawn);
  const auto slides = [](const LayerParams& layer) { return !layer.rail.path.empty(); };
  const bool rails = !scene.rail.path.empty() || std::any_of(scene.layers.begin(), scene.layers.end(), slides);
  if (rails || !scene.tie_back.empty()) return;  // what holds there stays
  if (scene.pins.kind != PinKind::kNone && choices.chance(0.3)) {
    happenings.pin_frequency = choices.magnitude(0.2, wild ? 20.0 : 3.0);
    happenings.pin_swing = choices.between(0.0, wild ? 1.0 : 0.3) * choices.direction();
  }
  if (wild && choices.chance(0.15)) happenings.pin_jerk = choices.magnitude(0.01, 10.0) * choices.direction();
}

// Of a drawn scene its cloth, before a plate that is as large as what can get there; something sets in.
void putBeforePlate(Choices& choices, Drawn& drawn) {
  const Scene all = drawn.scene;
  Scene& scene = drawn.scene = Scene();
  scene.cloth = all.cloth;
  scene.cloth.patches.clear();
  if (scene.cloth.bending_warp == 0.0 && scene.cloth.bending_weft == 0.0) scene.cloth.bending_hysteresis = 0.0;
  scene.cloth.surface_density = choices.magnitude(0.05, 0.5);
  scene.hang.from = all.hang.from;
  scene.hang.to = {all.hang.to.x(), all.hang.to.y(), all.hang.from.z()};
  scene.air = all.air;
  scene.contact = all.contact;
  scene.solver.frame_rate = all.solver.frame_rate;
  if (!validate(scene).empty()) scene.cloth.hem_width.reset();
  const Vec3 along = (scene.hang.to - scene.hang.from).normalized(), normal = along.cross(Vec3::UnitZ());
  const double side = choices.oneIn(2) ? 1.0 : -1.0, away = choices.between(0.02, 0.8),
               thick = choices.between(0.005, 0.01);
  ObstacleParams plate;
  plate.name = "plate";
  plate.shape = ShapeKind::kBox;
  const double size = 4.0 * (scene.cloth.width + scene.cloth.height) + 4.0;
  plate.size = Vec3(thick, size, size);
  // No further out than where the hem reaches it well below its upper edge.
  plate.pose.position = 0.5 * (scene.hang.from + scene.hang.to) + side * (away + 0.5 * thick) * normal;
  plate.pose.orientation = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), normal);
  scene.obstacles.assign(1, plate);
  drawn.happenings.at = choices.between(0.05, 0.4);
  const Vec3 push = side * normal;
  switch (choices.integer(0, 3)) {
    case 0: {
      WindParams wind;
      wind.id = "gust";
      wind.direction = push;
      wind.position = 0.5 * (scene.hang.from + scene.hang.to) - 1.5 * push;
      wind.radius = 20.0;
      wind.pressure = choices.magnitude(50.0, 1e4);
      wind.start = drawn.happenings.at;
      scene.wind.push_back(wind);
      break;
    }
    case 1: {
      DragParams drag;
      drag.id = "pull";
      drag.node = NodeIndex{choices.integer(1, scene.cloth.rows - 1), choices.integer(0, scene.cloth.columns - 1)};
      drag.force = choices.magnitude(1.0, 1e3) * push;
      drag.start = drawn.happenings.at;
      scene.drag.push_back(drag);
      break;
    }
    case 2:
      drawn.happenings.gravity = choices.magnitude(20.0, 1000.0) * (push + 0.2 * choices.inBox(1.0));
      break;
    default:  // to the plate but not into it: pins may do what they like, a pinned node in the plate is no fault of the
              // cloth
      drawn.happenings.pin_jerk = std::min(std::max(0.0, away - 0.01), 50.0 / scene.solver.frame_rate) * push;
  }
  drawn.seconds = drawn.happenings.at + 0.5;
}

}  // namespace

const char* kindName(Kind kind) {
  return kind == Kind::kEveryday ? "everyday" : kind == Kind::kWild ? "wild" : "sudden";
}

Drawn draw(Kind kind, std::uint64_t seed) {
  Random random((3 * seed + static_cast<std::uint64_t>(kind)) * 0x9E3779B97F4A7C15ULL + 1);
  const bool wild = kind == Kind::kWild;
  Drawn drawn;
  drawn.kind = kind;
  drawn.seed = seed;
  drawn.seconds = wild ? random.between(0.3, 1.0) : random.between(0.5, 2.0);
  do {
    drawn.scene = drawScene(random, wild ? Manner::kWild : Manner::kEveryday, kind == Kind::kSudden ? 40 : 100);
  } while (kind == Kind::kSudden && drawn.scene.cloth.closed);
  if (kind == Kind::kSudden)
    putBeforePlate(random, drawn);
  else
    drawHappenings(random, wild, drawn);
  drawn.scene.solver.threads = 1;
  drawn.scene.solver.seed = seed;
  return drawn;
}

}  // namespace curtain_test
