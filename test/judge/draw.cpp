// SPDX-License-Identifier: BSD-3-Clause
#include "judge/draw.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "curtain_sim/scene_yaml.h"
#include "testing.h"

namespace curtain_test {
namespace {

using namespace curtain;

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed * 0x9E3779B97F4A7C15ULL + 1) {}
  double between(double low, double high) { return random_.between(low, high); }
  /// Evenly in the logarithm.
  double magnitude(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  int integer(int low, int high) { return low + static_cast<int>(between(0.0, 1.0) * (high - low + 1)); }
  bool chance(double share) { return between(0.0, 1.0) < share; }
  Vec3 direction() { return random_.direction(); }
  Vec3 inBox(double half) { return random_.inBox(half); }

 private:
  Random random_;
};

struct Ranges {
  double density[2], force[2], pressure[2], gust, speed[2], rate[2];
  int size[2];
};
constexpr Ranges kEverydayRanges = {{0.05, 1.0}, {0.1, 30.0}, {1.0, 100.0}, 20.0, {0.2, 5.0}, {10.0, 240.0}, {4, 60}};
constexpr Ranges kWildRanges = {{1e-3, 10.0}, {1.0, 1e6}, {1.0, 1e5}, 1e3, {0.2, 50.0}, {5.0, 1000.0}, {2, 100}};
constexpr Ranges kSuddenRanges = {{0.05, 0.5}, {1.0, 1e3}, {50.0, 1e4}, 0.0, {0.2, 5.0}, {10.0, 240.0}, {2, 40}};

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
    case 0: scene.pins.kind = PinKind::kTop; break;
    case 1: scene.pins.kind = PinKind::kLeft; break;
    case 2: scene.pins.kind = PinKind::kTopCorners; break;
    case 3: scene.pins.kind = PinKind::kNone; break;
    default:
      scene.pins.kind = PinKind::kList;
      for (int count = dice.integer(1, 2); count > 0; --count) scene.pins.nodes.push_back(anyNode(dice, scene.cloth));
  }
}

void drawForces(Dice& dice, const Ranges& ranges, Drawn& drawn) {
  Scene& scene = drawn.scene;
  const auto force = [&] {
    return dice.chance(0.5) ? dice.between(ranges.force[0], ranges.force[1]) : dice.magnitude(ranges.force[0], ranges.force[1]);
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
    if (dice.chance(0.2)) scene.air.law = DampingLaw::kPrinted;
  }
}

// Through the cloth's middle, from outside all that it can reach at the start.
void addObstacle(Dice& dice, const Ranges& ranges, bool wild, Drawn& drawn) {
  Scene& scene = drawn.scene;
  ObstacleParams obstacle;
  obstacle.name = "obstacle";
  obstacle.radius = dice.between(0.05, 0.3);
  const int shape = wild || dice.chance(0.4) ? dice.integer(0, 4) : 0;
  obstacle.shape = static_cast<ShapeKind>(shape);
  double reach = obstacle.radius;
  if (obstacle.shape == ShapeKind::kBox || obstacle.shape == ShapeKind::kPlane) obstacle.radius = 0.0;
  if (obstacle.shape == ShapeKind::kBox) {
    obstacle.size = Vec3(dice.between(0.02, 0.5), dice.between(0.02, 0.5), dice.between(0.02, 0.5));
    reach = 0.5 * obstacle.size.norm();
  }
  if (obstacle.shape == ShapeKind::kCylinder || obstacle.shape == ShapeKind::kCapsule) {
    obstacle.length = dice.between(0.1, 1.0);
    reach += 0.5 * obstacle.length;
  }
  obstacle.friction = dice.between(0.0, 0.8);
  const Vec3 middle = 0.5 * (scene.hang.from + scene.hang.to) - Vec3(0.0, 0.0, dice.between(0.0, 0.8) * scene.cloth.height);
  const double size = std::hypot(scene.cloth.height, std::max(scene.cloth.width, scene.cloth.hem_width.value_or(0.0)));
  if (obstacle.shape == ShapeKind::kPlane) {  // the floor, a way below
    obstacle.pose.position = scene.hang.from - Vec3(0.0, 0.0, 2.0 * size + 0.1);
    scene.obstacles.push_back(obstacle);
    return;
  }
  const Vec3 direction = dice.direction();
  const double away = 2.0 * size + reach + 0.05, speed = dice.magnitude(ranges.speed[0], ranges.speed[1]);
  obstacle.pose.position = middle - away * direction;
  obstacle.pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(dice.between(0.0, kPi), dice.direction()));
  // It starts so early that it is there in the middle of the trial.
  Pose there = obstacle.pose;
  there.position = middle + away * direction;
  if (dice.chance(0.5)) there.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(dice.between(0.0, 3.0), dice.direction())) * there.orientation;
  const double half = away / speed, middle_time = dice.between(0.2, 0.7) * drawn.seconds;
  obstacle.motion = {{middle_time - half, obstacle.pose}, {middle_time + half, there}};
  if (middle_time < half) {  // it would start in the cloth's reach
    const double start = middle_time - half;
    for (PoseKey& key : obstacle.motion) key.time -= start;
  }
  scene.obstacles.push_back(obstacle);
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

// Before a plate that is as large as what can get there.
void drawPlate(Dice& dice, Drawn& drawn) {
  Scene& scene = drawn.scene;
  scene.pins.kind = PinKind::kTop;
  scene.pins.nodes.clear();
  scene.hang.tilt = 0.0;
  scene.hang.to.z() = scene.hang.from.z();
  const Vec3 along = (scene.hang.to - scene.hang.from).normalized(), normal = along.cross(Vec3::UnitZ());
  const double side = dice.chance(0.5) ? 1.0 : -1.0, away = dice.between(0.02, 0.8), thick = dice.between(0.005, 0.01);
  ObstacleParams plate;
  plate.name = "plate";
  plate.shape = ShapeKind::kBox;
  const double size = 4.0 * (scene.cloth.width + scene.cloth.height) + 4.0;
  plate.size = Vec3(thick, size, size);
  // No further out than where the hem reaches it well below its upper edge.
  plate.pose.position = 0.5 * (scene.hang.from + scene.hang.to) + side * (away + 0.5 * thick) * normal;
  plate.pose.orientation = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), normal);
  scene.obstacles.assign(1, plate);
  scene.drag.clear();
  scene.wind.clear();
  const Ranges& ranges = kSuddenRanges;
  drawn.happenings = Happenings();
  drawn.happenings.at = dice.between(0.05, 0.4);
  const Vec3 push = side * normal;
  switch (dice.integer(0, 3)) {
    case 0: {
      WindParams wind;
      wind.id = "gust";
      wind.direction = push;
      wind.position = 0.5 * (scene.hang.from + scene.hang.to) - 1.5 * push;
      wind.radius = 20.0;
      wind.pressure = dice.magnitude(ranges.pressure[0], ranges.pressure[1]);
      wind.start = drawn.happenings.at;
      scene.wind.push_back(wind);
      break;
    }
    case 1: {
      DragParams drag;
      drag.id = "pull";
      drag.node = NodeIndex{dice.integer(1, scene.cloth.rows - 1), dice.integer(0, scene.cloth.columns - 1)};
      drag.force = dice.magnitude(ranges.force[0], ranges.force[1]) * push;
      drag.start = drawn.happenings.at;
      scene.drag.push_back(drag);
      break;
    }
    case 2: drawn.happenings.gravity = dice.magnitude(20.0, 1000.0) * (push + 0.2 * dice.inBox(1.0)); break;
    default: {  // to the plate but not into it: pins may do what they like, a pinned node in the plate is no fault of the cloth
      const double room = away - 0.01;
      drawn.happenings.pin_jerk = std::min(std::max(0.0, room), 50.0 / scene.solver.frame_rate) * push;
    }
  }
  drawn.seconds = drawn.happenings.at + 0.5;
}

void put(YAML::Emitter& out, const char* key, const Vec3& v) {
  out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq << v.x() << v.y() << v.z() << YAML::EndSeq;
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
  if (dice.chance(0.5)) addObstacle(dice, ranges, wild, drawn);
  drawHappenings(dice, wild, drawn);
  scene.contact.thickness = dice.between(0.002, 0.01);
  scene.contact.friction = dice.between(0.0, 0.6);
  scene.contact.self = dice.chance(0.35);
  if (wild && dice.chance(0.3)) {
    const Method methods[] = {Method::kLeapfrog, Method::kLeapfrog4, Method::kBdf2, Method::kImplicit};
    scene.solver.method = methods[dice.integer(0, 3)];
  }
  if (wild && dice.chance(0.1)) scene.solver.substeps = dice.integer(1, 8);
  scene.solver.threads = 1;
  scene.solver.seed = seed;
  if (kind == Kind::kSudden) drawPlate(dice, drawn);
  if (!validate(scene).empty()) scene.cloth.hem_width.reset();  // tapered more than its rods can slant
  return drawn;
}

std::string write(const Drawn& drawn) {
  const Happenings& happenings = drawn.happenings;
  YAML::Emitter out;
  out.SetDoublePrecision(17);
  out << YAML::BeginMap;
  out << YAML::Key << "kind" << YAML::Value << kindName(drawn.kind);
  out << YAML::Key << "seed" << YAML::Value << drawn.seed;
  out << YAML::Key << "seconds" << YAML::Value << drawn.seconds;
  put(out, "pin_swing", happenings.pin_swing);
  out << YAML::Key << "pin_frequency" << YAML::Value << happenings.pin_frequency;
  put(out, "pin_jerk", happenings.pin_jerk);
  put(out, "gravity", happenings.gravity);
  out << YAML::Key << "other_rate" << YAML::Value << happenings.other_rate;
  out << YAML::Key << "at" << YAML::Value << happenings.at;
  out << YAML::Key << "scene" << YAML::Value << YAML::Literal << writeScene(drawn.scene);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

Drawn readTrial(const std::string& text) {
  const YAML::Node node = YAML::Load(text);
  const auto vector = [&](const char* key) {
    const auto values = node[key].as<std::vector<double>>();
    return Vec3(values.at(0), values.at(1), values.at(2));
  };
  Drawn drawn;
  const auto kind = node["kind"].as<std::string>();
  for (const Kind one : {Kind::kEveryday, Kind::kWild, Kind::kSudden}) {
    if (kind == kindName(one)) drawn.kind = one;
  }
  drawn.seed = node["seed"].as<std::uint64_t>();
  drawn.seconds = node["seconds"].as<double>();
  drawn.happenings.pin_swing = vector("pin_swing");
  drawn.happenings.pin_frequency = node["pin_frequency"].as<double>();
  drawn.happenings.pin_jerk = vector("pin_jerk");
  drawn.happenings.gravity = vector("gravity");
  drawn.happenings.other_rate = node["other_rate"].as<double>();
  drawn.happenings.at = node["at"].as<double>();
  const SceneReading reading = readSceneText(node["scene"].as<std::string>());
  if (!reading.problems.empty()) throw std::runtime_error(describe(reading.problems));
  drawn.scene = reading.scene;
  return drawn;
}

}  // namespace curtain_test
