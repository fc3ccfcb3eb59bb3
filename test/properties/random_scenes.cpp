// SPDX-License-Identifier: BSD-3-Clause
#include "properties/random_scenes.h"

#include <algorithm>
#include <cmath>

#include "cloth/cloth.h"

namespace curtain_test {
namespace {

curtain::Vec3 middleOf(const curtain::Scene& scene) {
  const curtain::ClothPattern pattern = makePattern(scene);
  const curtain::ClothState state = makeInitialState(scene, pattern);
  curtain::Vec3 sum = curtain::Vec3::Zero();
  for (int i = 0; i < pattern.grid.rows; ++i) {
    for (int j = 0; j < pattern.grid.columns; ++j) sum += state.position.at(pattern.grid.index(i, j));
  }
  return sum / static_cast<double>(pattern.grid.nodeCount());
}

}  // namespace

curtain::Scene RandomScenes::make(const Wanted& wanted) {
  curtain::Scene scene;
  makeCloth(wanted, scene);
  hang(wanted, scene);
  scene.gravity = curtain::Vec3(0.0, 0.0, -between(5.0, 12.0)) + random_.inBox(1.0);
  if (wanted.damped) {
    scene.air.inside = between(0.02, 0.3);
    scene.air.border = between(0.02, 0.4);
    scene.air.corner = between(0.02, 0.5);
    scene.air.threshold = between(0.5, 2.0);
    scene.air.fast_gain = between(0.0, 0.3);
  }
  const curtain::Vec3 middle = middleOf(scene);
  if (wanted.wind || wanted.self) addWinds(wanted, middle, scene);
  if (wanted.drags) addDrags(wanted.gentle, scene);
  if (wanted.obstacles) addObstacles(middle, scene);
  if (wanted.mesh) addMesh(scene);
  scene.contact.self = wanted.self;
  scene.contact.friction = between(0.1, 0.6);
  scene.contact.thickness = between(0.003, 0.01);
  scene.solver.rest_speed = 0.0;
  return scene;
}

std::vector<double> RandomScenes::factors(int count, double least, double most) {
  std::vector<double> all(static_cast<std::size_t>(count));
  for (double& factor : all) factor = between(least, most);
  return all;
}

void RandomScenes::makeCloth(const Wanted& wanted, curtain::Scene& scene) {
  curtain::ClothParams& cloth = scene.cloth;
  const int least = wanted.self ? wanted.max_nodes - 2 : 3;
  cloth.rows = integer(least, wanted.max_nodes);
  cloth.columns = integer(least, wanted.max_nodes);
  cloth.height = between(0.6, 1.6);
  cloth.width = between(0.5, 1.4);
  cloth.surface_density = between(0.1, 0.4);
  cloth.lumping = chance(0.5) ? curtain::Lumping::kArea : curtain::Lumping::kUniform;
  cloth.porosity = between(0.0, 0.3);
  if (wanted.fabric) {
    cloth.bending_warp = between(1e-5, 1e-3);
    cloth.bending_weft = between(1e-5, 1e-3);
    cloth.bending_bias = between(1e-4, 1.5e-3);
    cloth.bending_hysteresis = between(1e-4, 1e-2);
    cloth.shear = between(1.0, 50.0);
  }
  cloth.row_spacing = factors(cloth.rows - 1, 0.8, 1.25);
  cloth.column_spacing = factors(cloth.columns - 1, 0.8, 1.25);
  cloth.row_mass = factors(cloth.rows, 0.7, 1.4);
  cloth.column_mass = factors(cloth.columns, 0.7, 1.4);
}

void RandomScenes::hang(const Wanted& wanted, curtain::Scene& scene) {
  const double fullness = wanted.taut ? between(0.9, 0.99) : wanted.self ? between(0.25, 0.4) : between(0.4, 0.6);
  const double heading = between(-kPi, kPi);
  const curtain::Vec3 along(std::cos(heading), std::sin(heading), between(-0.2, 0.2));
  scene.hang.from = random_.inBox(1.0) + curtain::Vec3(0.0, 0.0, 3.0);
  scene.hang.to = scene.hang.from + fullness * scene.cloth.width * along.normalized();
  scene.hang.tilt = between(-1.0, 1.0);
  if (!wanted.taut) return;
  const int kind = integer(0, 2);
  scene.pins.kind = kind == 0   ? curtain::PinKind::kTop
                    : kind == 1 ? curtain::PinKind::kTopCorners
                                : curtain::PinKind::kList;
  if (kind == 2)
    scene.pins.nodes = {
        {0, 0}, {0, scene.cloth.columns - 1}, {integer(1, scene.cloth.rows - 1), integer(1, scene.cloth.columns - 2)}};
}

// All of the cloth is within the cone, whichever way it goes: at its edge the force would jump.
void RandomScenes::addWinds(const Wanted& wanted, const curtain::Vec3& middle, curtain::Scene& scene) {
  const int count = wanted.self ? 2 : integer(1, 2);
  const curtain::Vec3 along = (scene.hang.to - scene.hang.from).normalized();
  for (int n = 0; n < count; ++n) {
    curtain::WindParams wind;
    wind.id = "wind" + std::to_string(n);
    wind.direction =
        wanted.self ? curtain::Vec3((n == 0 ? 1.0 : -1.0) * along + 0.5 * random_.direction()) : random_.direction();
    wind.position = middle - between(3.0, 4.0) * wind.direction.normalized();
    wind.radius = between(4.0, 5.0);
    wind.half_angle = chance(0.3) ? 0.0 : between(0.1, 0.5);
    wind.pressure = between(0.2, 1.0) * scene.cloth.surface_density * (wanted.gentle ? 2.0 : 40.0);
    if (chance(0.3)) wind.node_force = 1e-4 * between(0.0, 1.0);
    wind.porosity_weight = between(0.0, 1.0);
    wind.distance_weight = between(0.1, 0.5);
    wind.reference_length = between(2.0, 4.0);
    scene.wind.push_back(wind);
  }
}

void RandomScenes::addDrags(bool gentle, curtain::Scene& scene) {
  const double share = gentle ? 0.002 : 0.05;
  const double weight = 10.0 * scene.cloth.surface_density * scene.cloth.height * scene.cloth.width;
  for (int n = 0; n < 2; ++n) {
    curtain::DragParams drag;
    drag.id = "drag" + std::to_string(n);
    drag.node = curtain::NodeIndex{integer(1, scene.cloth.rows - 1), integer(0, scene.cloth.columns - 1)};
    drag.radius = chance(0.5) ? 0.0 : between(0.2, 0.6);
    if (n == 0 || gentle) {
      drag.force = share * weight * random_.direction();
    } else {
      drag.target = 0.5 * (scene.hang.from + scene.hang.to) + random_.inBox(0.8) - curtain::Vec3(0.0, 0.0, 0.8);
      drag.stiffness = between(0.5, 2.0) * weight;
      drag.max_force = 2.0 * share * weight;
    }
    drag.end = between(0.2, 1.0);
    scene.drag.push_back(drag);
  }
}

// Round the cloth's middle, clear of it where it starts.
void RandomScenes::addObstacles(const curtain::Vec3& middle, curtain::Scene& scene) {
  using curtain::ShapeKind;
  for (const ShapeKind shape :
       {ShapeKind::kSphere, ShapeKind::kBox, ShapeKind::kCylinder, ShapeKind::kCapsule, ShapeKind::kPlane}) {
    curtain::ObstacleParams obstacle;
    obstacle.name = "obstacle" + std::to_string(static_cast<int>(shape));
    obstacle.shape = shape;
    obstacle.radius = between(0.1, 0.2);
    obstacle.length = between(0.2, 0.5);
    obstacle.size = curtain::Vec3(between(0.2, 0.4), between(0.2, 0.4), between(0.2, 0.4));
    if (shape == ShapeKind::kSphere || shape == ShapeKind::kPlane) obstacle.length = 0.0;
    if (shape == ShapeKind::kPlane || shape == ShapeKind::kBox) obstacle.radius = obstacle.length = 0.0;
    if (shape != ShapeKind::kBox) obstacle.size.setZero();
    if (chance(0.7)) obstacle.friction = between(0.0, 0.8);
    const double reach = 0.5 * obstacle.length + obstacle.radius + 0.5 * obstacle.size.norm();
    place(middle, reach, scene, obstacle);
    scene.obstacles.push_back(obstacle);
  }
}

void RandomScenes::addMesh(curtain::Scene& scene) {
  curtain::ObstacleParams obstacle;
  obstacle.name = "mesh";
  obstacle.shape = curtain::ShapeKind::kMesh;
  obstacle.mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/l_prism.obj";
  obstacle.scale = curtain::Vec3::Constant(between(0.3, 0.5));
  place(middleOf(scene), 0.87 * obstacle.scale.x(), scene, obstacle);
  scene.obstacles.push_back(obstacle);
}

void RandomScenes::place(const curtain::Vec3& middle, double reach, const curtain::Scene& scene,
                         curtain::ObstacleParams& obstacle) {
  const curtain::ClothPattern pattern = makePattern(scene);
  const curtain::Field3 position = makeInitialState(scene, pattern).position;
  if (obstacle.shape == curtain::ShapeKind::kPlane) {  // below, sloping
    curtain::Vec3 up = curtain::Vec3::UnitZ() + random_.inBox(0.4);
    obstacle.pose.orientation = Eigen::Quaterniond::FromTwoVectors(curtain::Vec3::UnitZ(), up.normalized());
    double lowest = 1e300;
    up = obstacle.pose.orientation * curtain::Vec3::UnitZ();
    for (int i = 0; i < pattern.grid.rows; ++i) {
      for (int j = 0; j < pattern.grid.columns; ++j)
        lowest = std::min(lowest, up.dot(position.at(pattern.grid.index(i, j)) - middle));
    }
    obstacle.pose.position = middle + (lowest - between(0.03, 0.2)) * up;
    return;
  }
  obstacle.pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(between(0.0, kPi), random_.direction()));
  for (double distance = reach;; distance += 0.05) {
    const curtain::Vec3 at = middle + distance * random_.direction();
    double nearest = 1e300;
    for (int i = 0; i < pattern.grid.rows; ++i) {
      for (int j = 0; j < pattern.grid.columns; ++j) {
        nearest = std::min(nearest, (position.at(pattern.grid.index(i, j)) - at).norm());
      }
    }
    obstacle.pose.position = at;
    if (nearest > reach + 0.5 * scene.cloth.width / pattern.grid.columns + 0.02) break;
  }
  const bool is_mesh = obstacle.shape == curtain::ShapeKind::kMesh;
  if (!chance(0.7) && !is_mesh) return;
  // Moves towards the cloth's middle, the mesh beyond it, and turns meanwhile.
  curtain::Pose to = obstacle.pose;
  to.position += (is_mesh ? 1.2 : 0.8) * (middle - to.position);
  to.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.5, random_.direction())) * to.orientation;
  obstacle.motion = {{0.0, obstacle.pose}, {between(0.4, 0.7), to}};
}

curtain::Scene randomScene(std::uint64_t seed, const Wanted& wanted) { return RandomScenes(seed).make(wanted); }

}  // namespace curtain_test
