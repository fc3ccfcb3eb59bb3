// SPDX-License-Identifier: BSD-3-Clause
#include "properties/similarity.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "testing.h"

namespace curtain_test {
namespace {

// The cloth hangs down from its line, turned about it by tilt: which tilt brings it where the similarity does?
double tiltOf(const Scene& scene, const Similarity& s) {
  if (s.direction(Vec3::UnitZ()) == Vec3::UnitZ())
    return s.mirror == Across::kNone ? scene.hang.tilt : -scene.hang.tilt;
  const auto axes = [](const Vec3& along, Vec3& normal, Vec3& plumb) {
    normal = along.cross(Vec3::UnitZ()).normalized();
    plumb = along.cross(normal);
  };
  Vec3 normal, plumb;
  const Vec3 along = (scene.hang.to - scene.hang.from).normalized();
  axes(along, normal, plumb);
  const Vec3 down = s.direction(std::cos(scene.hang.tilt) * plumb + std::sin(scene.hang.tilt) * normal);
  axes(s.direction(along), normal, plumb);
  return std::atan2(down.dot(normal), down.dot(plumb));
}

void see(const Similarity& s, curtain::WindParams& wind) {
  wind.position = s.point(wind.position);
  wind.direction = s.direction(wind.direction);
  wind.radius *= s.length;
  wind.pressure *= s.pressure();
  wind.node_force *= s.force();
  wind.unsteadiness *= s.pressure();
  wind.correlation_time *= s.time;
  wind.correlation_length *= s.length;
  wind.reference_length *= s.length;
  wind.start *= s.time;
  wind.end *= s.time;
}

void see(const Similarity& s, curtain::DragParams& drag) {
  if (drag.point) drag.point = s.point(*drag.point);
  drag.force = s.force() * s.direction(drag.force);
  if (drag.target) drag.target = s.point(*drag.target);
  drag.stiffness *= s.mass / (s.time * s.time);
  drag.max_force *= s.force();
  drag.radius *= s.length;
  drag.start *= s.time;
  drag.end *= s.time;
}

void see(const Similarity& s, curtain::ObstacleParams& obstacle) {
  obstacle.radius *= s.length;
  obstacle.length *= s.length;
  obstacle.size *= s.length;
  obstacle.scale *= s.length;
  obstacle.padding *= s.length;
  obstacle.scale = s.mirrored(obstacle.scale);
  obstacle.pose = s.pose(obstacle.pose);
  for (curtain::PoseKey& key : obstacle.motion) {
    key.time *= s.time;
    key.pose = s.pose(key.pose);
  }
}

}  // namespace

Vec3 Similarity::mirrored(const Vec3& d) const {
  return {mirror == Across::kX ? -d.x() : d.x(), mirror == Across::kY ? -d.y() : d.y(), d.z()};
}

Vec3 Similarity::direction(const Vec3& d) const { return turn.toRotationMatrix() * mirrored(d); }

Vec3 Similarity::point(const Vec3& p) const { return length * direction(p) + shift; }

Vec3 Similarity::back(const Vec3& p) const {
  return mirrored(turn.toRotationMatrix().transpose() * Vec3((p - shift) / length));
}

Vec3 Similarity::velocityBack(const Vec3& v) const {
  return mirrored(turn.toRotationMatrix().transpose() * Vec3(v * (time / length)));
}

Pose Similarity::pose(const Pose& p) const {
  Eigen::Quaterniond q = p.orientation;
  if (mirror == Across::kX) q = Eigen::Quaterniond(q.w(), q.x(), -q.y(), -q.z());
  if (mirror == Across::kY) q = Eigen::Quaterniond(q.w(), -q.x(), q.y(), -q.z());
  return {point(p.position), turn * q};
}

Scene seen(const Similarity& s, Scene scene) {
  scene.hang.tilt = scene.cloth.closed ? scene.hang.tilt : tiltOf(scene, s);
  scene.hang.from = s.point(scene.hang.from);
  scene.hang.to = s.point(scene.hang.to);
  if (scene.hang.radius) *scene.hang.radius *= s.length;
  scene.cloth.height *= s.length;
  scene.cloth.width *= s.length;
  if (scene.cloth.hem_width) *scene.cloth.hem_width *= s.length;
  scene.cloth.surface_density *= s.mass / (s.length * s.length);
  const double energy = s.force() * s.length;
  for (double* const rigidity : {&scene.cloth.bending_warp, &scene.cloth.bending_weft, &scene.cloth.bending_bias})
    *rigidity *= energy;
  scene.cloth.bending_hysteresis *= s.force();
  scene.cloth.shear *= s.force() / s.length;
  scene.gravity = (s.length / (s.time * s.time)) * s.direction(scene.gravity);
  scene.air.density *= s.mass / (s.length * s.length * s.length);
  for (double* const speed : {&scene.air.threshold, &scene.air.inside, &scene.air.border, &scene.air.corner})
    *speed *= s.speed();
  scene.air.fast_gain /= s.speed();
  scene.ambient.velocity = s.speed() * s.direction(scene.ambient.velocity);
  scene.ambient.length_scale *= s.length;
  for (auto& wind : scene.wind) see(s, wind);
  for (auto& drag : scene.drag) see(s, drag);
  for (auto& obstacle : scene.obstacles) see(s, obstacle);
  scene.contact.thickness *= s.length;
  scene.contact.recovery_speed *= s.speed();
  scene.solver.frame_rate /= s.time;
  scene.solver.rest_speed *= s.speed();
  return scene;
}

Motion seenBack(const Similarity& s, Motion motion) {
  for (auto& at : motion.positions) {
    for (Vec3& p : at) p = s.back(p);
  }
  for (auto& at : motion.velocities) {
    for (Vec3& v : at) v = s.velocityBack(v);
  }
  return motion;
}

Scene reversed(Scene scene) {
  const int last = scene.cloth.columns - 1;
  std::swap(scene.hang.from, scene.hang.to);
  scene.hang.tilt = -scene.hang.tilt;
  std::reverse(scene.cloth.column_spacing.begin(), scene.cloth.column_spacing.end());
  std::reverse(scene.cloth.column_mass.begin(), scene.cloth.column_mass.end());
  for (curtain::NodeIndex& node : scene.pins.nodes) node.column = last - node.column;
  for (curtain::DragParams& drag : scene.drag) {
    if (drag.node) drag.node->column = last - drag.node->column;
  }
  return scene;
}

Scene cycled(Scene scene, int by, Similarity& turn) {
  const int columns = scene.cloth.columns;
  const double angle = 2.0 * kPi * by / columns;
  turn = Similarity();
  turn.turn = Eigen::AngleAxisd(angle, Vec3::UnitZ());
  turn.shift = scene.hang.from - turn.direction(scene.hang.from);
  scene = seen(turn, scene);
  auto& masses = scene.cloth.column_mass;
  if (!masses.empty()) std::rotate(masses.begin(), masses.end() - by, masses.end());
  const auto move = [&](curtain::NodeIndex& node) { node.column = (node.column + by) % columns; };
  for (curtain::NodeIndex& node : scene.pins.nodes) move(node);
  for (curtain::DragParams& drag : scene.drag) {
    if (drag.node) move(*drag.node);
  }
  return scene;
}

}  // namespace curtain_test
