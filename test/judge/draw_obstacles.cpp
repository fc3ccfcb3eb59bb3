// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "curtain_sim/obstacle_shape.h"
#include "judge/dice.h"

namespace curtain_test {

using namespace curtain;

namespace {

constexpr const char* kMeshes[] = {"icosphere.stl", "l_prism.obj", "cube_quads.obj", "square_open.obj",
                                   "two_cubes_cm_z_up.dae"};

// As large as the other shapes. Returns how far it reaches from its origin [m].
double drawMesh(Dice& dice, ObstacleParams& obstacle) {
  obstacle.radius = 0.0;
  obstacle.mesh = std::string("test/meshes/") + kMeshes[dice.integer(0, 4)];
  const Eigen::AlignedBox3d box = makeObstacleShape(obstacle, resolveTrialMesh)->bounds();
  const double reach = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm(), wanted = dice.between(0.1, 0.5);
  obstacle.scale *= wanted / reach;
  return wanted;
}

}  // namespace

std::string resolveTrialMesh(const std::string& url) {
  return url.rfind("test/", 0) == 0 ? CURTAIN_SOURCE_DIR "/" + url : resolveMeshUrl(url);
}

void addObstacle(Dice& dice, const Ranges& ranges, Shapes shapes, const std::string& name, Drawn& drawn) {
  Scene& scene = drawn.scene;
  ObstacleParams obstacle;
  obstacle.name = name;
  obstacle.radius = dice.between(0.05, 0.3);
  const bool meshes = shapes == Shapes::kMeshes, any = shapes == Shapes::kAny;
  obstacle.shape = meshes ? ShapeKind::kMesh : static_cast<ShapeKind>(any || dice.chance(0.4) ? dice.integer(0, 4) : 0);
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
  if (meshes) reach = drawMesh(dice, obstacle);
  obstacle.friction = dice.between(0.0, 0.8);
  const Vec3 middle =
      0.5 * (scene.hang.from + scene.hang.to) - Vec3(0.0, 0.0, dice.between(0.0, 0.8) * scene.cloth.height);
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
  if (dice.chance(0.5))
    there.orientation =
        Eigen::Quaterniond(Eigen::AngleAxisd(dice.between(0.0, 3.0), dice.direction())) * there.orientation;
  const double half = away / speed, middle_time = dice.between(0.2, 0.7) * drawn.seconds;
  obstacle.motion = {{middle_time - half, obstacle.pose}, {middle_time + half, there}};
  if (middle_time < half) {  // it would start in the cloth's reach
    const double start = middle_time - half;
    for (PoseKey& key : obstacle.motion) key.time -= start;
  }
  scene.obstacles.push_back(obstacle);
}

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
    case 2:
      drawn.happenings.gravity = dice.magnitude(20.0, 1000.0) * (push + 0.2 * dice.inBox(1.0));
      break;
    default: {  // to the plate but not into it: pins may do what they like, a pinned node in the plate is no fault of
                // the cloth
      const double room = away - 0.01;
      drawn.happenings.pin_jerk = std::min(std::max(0.0, room), 50.0 / scene.solver.frame_rate) * push;
    }
  }
  drawn.seconds = drawn.happenings.at + 0.5;
}

}  // namespace curtain_test
