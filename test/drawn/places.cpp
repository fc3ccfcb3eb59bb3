// SPDX-License-Identifier: BSD-3-Clause
#include "drawn/places.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "curtain_sim/obstacle_shape.h"
#include "drawn/scene_maker.h"
#include "scene/layers.h"
#include "scene/pi.h"

namespace curtain_test {

using namespace curtain;

namespace {

constexpr const char* kMeshes[] = {"icosphere.stl", "l_prism.obj", "cube_quads.obj", "square_open.obj",
                                   "two_cubes_cm_z_up.dae"};

Vec3 edgeMiddle(const Scene& scene) {
  return scene.cloth.closed ? scene.hang.from : Vec3(0.5 * (scene.hang.from + scene.hang.to));
}

// How far the cloth can reach.
double sizeOf(const Scene& scene) {
  double size = 0.0;
  for (std::size_t k = 0; k <= scene.layers.size(); ++k) {
    const ClothParams cloth = layerScene(scene, k).cloth;
    size = std::max(size, std::hypot(cloth.height, std::max(cloth.width, cloth.hem_width.value_or(0.0))));
  }
  return size;
}

// How far it reaches from its origin [m]. Meshes are made as large as the other shapes.
double reachOf(ObstacleParams& obstacle, Choices& choices) {
  const auto reach = [&] {
    const Eigen::AlignedBox3d box = makeObstacleShape(obstacle, resolveTestMesh)->bounds();
    return box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm();
  };
  if (obstacle.shape != ShapeKind::kMesh) return reach();
  obstacle.mesh = std::string("test/meshes/") + kMeshes[choices.below(std::size(kMeshes))];
  const double wanted = choices.between(0.1, 0.5);
  obstacle.scale *= wanted / reach();
  return wanted;
}

void place(LineParams& line, const Scene& scene, const ClothParams& whole, Choices& choices) {
  const int row = choices.chance(0.6) ? whole.rows - 1 : choices.integer(0, whole.rows - 1);
  const int step = choices.integer(1, whole.columns);
  line.nodes.clear();
  for (int column = choices.integer(0, step - 1); column < whole.columns; column += step)
    line.nodes.push_back({row, column});
  line.to = scene.hang.from - scene.cloth.height * Vec3::UnitZ() +
            choices.between(0.05, 1.0) * (scene.cloth.width + scene.cloth.height) * choices.direction();
}

void place(TieBackParams& loop, const Scene& scene, const ClothParams& whole, Choices& choices) {
  loop.row = choices.integer(1, whole.rows - 1);
  loop.first_column = choices.integer(0, whole.columns - 1);
  loop.last_column = choices.integer(loop.first_column, whole.columns - 1);
  loop.point = edgeMiddle(scene) -
               choices.between(0.3, 0.9) * scene.cloth.height * loop.row / (whole.rows - 1) * Vec3::UnitZ() +
               0.3 * scene.cloth.width * choices.between(-1.0, 1.0) * Vec3::UnitX();
}

void place(DragParams& drag, const Scene& scene, Choices& choices) {
  const auto near = [&](double far) { return Vec3(scene.hang.from + choices.inBox(far)); };
  if (drag.point) drag.point = near(1.0);
  if (!drag.force.isZero()) {
    drag.target.reset();
    drag.path.clear();
  } else {
    drag.target = near(2.0);
  }
  for (PointKey& key : drag.path) key.position = near(1.0);
}

// Sends the obstacle through the cloth's middle, from outside all that the cloth can reach at the start, at `fastest`
// [m/s] at most. A plane is the floor, a way below.
void sendThrough(ObstacleParams& obstacle, const Scene& scene, double fastest, Choices& choices) {
  const double size = sizeOf(scene);
  if (obstacle.shape == ShapeKind::kPlane) {
    obstacle.pose = {scene.hang.from - Vec3(0.0, 0.0, 2.0 * size + 0.1), Rotation::Identity()};
    return;
  }
  const Vec3 middle = edgeMiddle(scene) - choices.between(0.0, 0.8) * scene.cloth.height * Vec3::UnitZ();
  const Vec3 direction = choices.direction();
  const double away = 2.0 * size + reachOf(obstacle, choices) + 0.05;
  obstacle.pose.position = middle - away * direction;
  Pose there = obstacle.pose;
  there.position = middle + away * direction;
  if (choices.oneIn(2)) {
    const Rotation turn(Eigen::AngleAxisd(choices.between(0.0, 3.0), choices.direction()));
    there.orientation = turn * there.orientation;
  }
  // It starts so early that it is there within the first second, but not in the cloth's reach.
  const double half = away / choices.magnitude(0.2, fastest), meets = choices.between(0.1, 0.9);
  const double start = std::max(0.0, meets - half);
  obstacle.motion = {{start, obstacle.pose}, {start + 2.0 * half, there}};
}

}  // namespace

std::string resolveTestMesh(const std::string& url) {
  return url.rfind("test/", 0) == 0 ? CURTAIN_SOURCE_DIR "/" + url : resolveMeshUrl(url);
}

void placeCloth(Scene& scene, Choices& choices) {
  const ClothParams& cloth = scene.cloth;
  const double fullness = choices.oneIn(2) ? choices.between(0.9, 1.0) : choices.between(0.3, 0.9);
  const double heading = choices.between(-kPi, kPi), slope = choices.chance(0.3) ? choices.between(-0.5, 0.5) : 0.0;
  scene.hang.from = choices.inBox(1.0) + Vec3(0.0, 0.0, 2.5);
  scene.hang.to =
      scene.hang.from + fullness * cloth.width * Vec3(std::cos(heading), std::sin(heading), slope).normalized();
}

void placeBeside(const Scene& first, Choices& choices, HangParams& hang, double width) {
  const Vec3 along = (first.hang.to - first.hang.from).normalized();
  const Rotation tilt(Eigen::AngleAxisd(first.hang.tilt, along));
  const Vec3 across = tilt * along.cross(Vec3::UnitZ()).normalized();
  const double away = choices.magnitude(2.0, 20.0) * first.contact.thickness;
  hang.tilt = first.hang.tilt;
  hang.from = first.hang.from + (choices.oneIn(2) ? away : -away) * across;
  hang.to = hang.from + choices.between(0.6, 1.0) * width * along;
}

void placeThings(Scene& scene, Choices& choices, double fastest) {
  const ClothParams whole = wholeCloth(scene);
  for (WindParams& wind : scene.wind) {
    wind.direction = choices.direction();
    wind.position = edgeMiddle(scene) - choices.between(0.5, 3.0) * wind.direction;
  }
  for (LineParams& line : scene.lines) place(line, scene, whole, choices);
  for (TieBackParams& loop : scene.tie_back) place(loop, scene, whole, choices);
  for (DragParams& drag : scene.drag) place(drag, scene, choices);
  for (ObstacleParams& obstacle : scene.obstacles) sendThrough(obstacle, scene, fastest, choices);
}

void placeHands(Scene& scene, Choices& choices, const ClothPattern& pattern, const Field3& start) {
  std::vector<HandParams> hands;
  bool rigid = !scene.lines.empty() || !scene.tie_back.empty();
  for (HandParams& hand : scene.hands) {
    const bool gives = std::isfinite(hand.grasp.stiffness) || std::isfinite(hand.grasp.pinch_force);
    if (!gives && std::exchange(rigid, true)) continue;
    Pose& frame = hand.grasp.frame;
    frame.position = start.at(
        pattern.grid.index(choices.integer(0, pattern.grid.rows - 1), choices.integer(0, pattern.grid.columns - 1)));
    for (PoseKey& key : hand.motion) key.pose = {frame.position + choices.inBox(0.2), frame.orientation};
    if (!hand.motion.empty()) hand.motion.front().pose = frame;
    hands.push_back(hand);
  }
  scene.hands = hands;
}

}  // namespace curtain_test
