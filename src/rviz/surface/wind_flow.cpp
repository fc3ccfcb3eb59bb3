// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/surface/wind_flow.h"

#include <algorithm>
#include <cmath>

#include "rviz/surface/pi.h"

namespace curtain_rviz {

using curtain::Vec3;

namespace {

constexpr double kGoldenAngle = 2.39996322972865332;  // [rad] fills a disc evenly with points
constexpr int kArrows = 16;
constexpr int kRimParts = 48;
constexpr double kAirDensity = 1.2;    // [kg/m^3]
constexpr double kShortestWay = 0.5;   // [m]
constexpr double kArrowLength = 0.16;  // of the way
constexpr double kArrowWidth = 0.13;   // of its length: the head; the shaft has a quarter of it
constexpr double kRimWidth = 0.03;     // of the disc's radius

/// The disc and its cone.
struct Cone {
  Vec3 position, axis, u, v;  // u, v: axes of the disc
  double radius, widening;    // widening: of the radius, per metre

  Vec3 rim(double angle, double distance) const {
    return position + distance * (std::cos(angle) * u + std::sin(angle) * v);
  }
};

Cone coneOf(const curtain_sim::WindSource& wind) {
  const auto& q = wind.pose.orientation;
  const Eigen::Quaterniond turn = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  return {Vec3(wind.pose.position.x, wind.pose.position.y, wind.pose.position.z),
          turn * Vec3::UnitX(),
          turn * Vec3::UnitY(),
          turn * Vec3::UnitZ(),
          wind.radius,
          std::tan(wind.half_angle)};
}

// A flat dart from tail to tip, `side` wide at its head; it fades towards its tail.
void addDart(const Vec3& tail, const Vec3& tip, const Vec3& side, float alpha, std::vector<FlowVertex>& out) {
  const Vec3 neck = tip + 0.35 * (tail - tip);
  const Vec3 shaft = 0.25 * side;
  out.insert(out.end(), {{tail, 0.0F}, {neck - shaft, alpha}, {neck + shaft, alpha}});
  out.insert(out.end(), {{neck - side, alpha}, {tip, alpha}, {neck + side, alpha}});
}

// Brightness along the way, 0 to 1: fades in and out.
double fade(double share) { return std::min(1.0, share / 0.12) * std::min(1.0, (1.0 - share) / 0.30); }

void addRim(const Cone& cone, std::vector<FlowVertex>& out) {
  for (int part = 0; part < kRimParts; ++part) {
    const double from = 2.0 * kPi * part / kRimParts, to = 2.0 * kPi * (part + 1) / kRimParts;
    const double inner = cone.radius * (1.0 - kRimWidth);
    const Vec3 a = cone.rim(from, inner), b = cone.rim(to, inner);
    const Vec3 c = cone.rim(from, cone.radius), d = cone.rim(to, cone.radius);
    for (const Vec3& corner : {a, b, c, c, b, d}) out.push_back({corner, 0.8F});
  }
}

}  // namespace

void addWindFlow(const curtain_sim::WindSource& wind, const Vec3& target, double seconds,
                 std::vector<FlowVertex>& out) {
  const Cone cone = coneOf(wind);
  addRim(cone, out);
  const double way = std::max(kShortestWay, cone.axis.dot(target - cone.position));
  // Dynamic pressure: p = 1/2 rho u^2.
  const double speed = std::sqrt(2.0 * wind.pressure / kAirDensity);
  if (!(speed > 0.0)) return;
  const double length = kArrowLength * way;
  for (int k = 0; k < kArrows; ++k) {
    const double outward = std::sqrt((k + 0.5) / kArrows);  // share of the radius
    const double angle = k * kGoldenAngle;
    const double start = std::fmod(k * 0.6180339887498949, 1.0);
    const double share = std::fmod(start + seconds * speed / way, 1.0);
    const Vec3 ray = cone.axis + outward * cone.widening * (std::cos(angle) * cone.u + std::sin(angle) * cone.v);
    const Vec3 tip = cone.rim(angle, outward * cone.radius) + share * way * ray;
    const Vec3 along = ray.normalized();
    const Vec3 side = along.unitOrthogonal() * (kArrowWidth * length);
    const Vec3 tail = tip - std::min(length, share * way) * along;
    const auto alpha = static_cast<float>(fade(share));
    addDart(tail, tip, side, alpha, out);
    addDart(tail, tip, along.cross(side), alpha, out);
  }
}

}  // namespace curtain_rviz
