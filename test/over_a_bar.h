// SPDX-License-Identifier: BSD-3-Clause
//
// Straps that lie over a round bar, at rest.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"
#include "scene/pi.h"

namespace curtain_test {

/// Of a strap two columns wide that hangs over a bar, `left` [m] on one side and `right` on the other.
struct Strap {
  int rows = 61;
  double left = 0.3, right = 0.3;            ///< below the bar's axis [m]
  double radius = 0.1;                       ///< of the bar [m]
  double first_load = 0.0, last_load = 0.0;  ///< at the left and the right end [kg]; 0: the strap's own
  bool pinned = false;                       ///< at the left end

  static constexpr double kThickness = 0.004, kPerLength = 0.008;  // [m], [kg/m]
  double held() const { return radius + kThickness; }              ///< distance from the axis [m]
  double length() const { return left + right + curtain::kPi * held(); }
  double link() const { return length() / (rows - 1); }
};

inline curtain::Scene strapScene(const Strap& strap) {
  curtain::Scene scene;
  scene.cloth.rows = strap.rows;
  scene.cloth.columns = 2;
  scene.cloth.height = strap.length();
  scene.cloth.width = 0.04;
  scene.cloth.surface_density = Strap::kPerLength / 0.04;
  scene.cloth.row_mass.assign(static_cast<std::size_t>(strap.rows), 1.0);
  const double own = 0.5 * Strap::kPerLength * strap.link();  // of an end's row [kg]
  if (strap.first_load > 0.0) scene.cloth.row_mass.front() = strap.first_load / own;
  if (strap.last_load > 0.0) scene.cloth.row_mass.back() = strap.last_load / own;
  scene.hang.from = curtain::Vec3(0.0, -0.02, 2.0);
  scene.hang.to = curtain::Vec3(0.0, 0.02, 2.0);
  scene.pins.kind = strap.pinned ? curtain::PinKind::kTop : curtain::PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = 0.0;
  scene.contact.self = false;
  scene.contact.thickness = Strap::kThickness;
  curtain::ObstacleParams bar;
  bar.name = "bar";
  bar.shape = curtain::ShapeKind::kCylinder;
  bar.radius = strap.radius;
  bar.length = 0.5;
  bar.friction = 0.0;
  bar.pose.position = curtain::Vec3(0.0, 0.0, 1.0);
  bar.pose.orientation = curtain::Rotation(Eigen::AngleAxisd(0.5 * curtain::kPi, curtain::Vec3::UnitX()));
  scene.obstacles = {bar};
  return scene;
}

/// Lays it over the bar, link by link along the way that it takes. Returns how far the right end hangs [m].
inline double layOver(curtain::Simulator& simulator, const Strap& strap) {
  const double radius = strap.held(), half_turn = curtain::kPi * radius;
  const auto at = [&](double way) -> curtain::Vec3 {  // from where the strap meets the bar
    if (way < 0.0) return {-radius, 0.0, 1.0 + way};
    if (way > half_turn) return {radius, 0.0, 1.0 - (way - half_turn)};
    return {-radius * std::cos(way / radius), 0.0, 1.0 + radius * std::sin(way / radius)};
  };
  std::vector<curtain::Vec3> positions;
  double way = -strap.left;
  for (int row = 0; row < strap.rows; ++row) {
    if (row > 0) {
      double low = way, high = way + 2.0 * strap.link();
      const curtain::Vec3 from = at(way);
      for (int halving = 0; halving < 60; ++halving) {
        const double middle = 0.5 * (low + high);
        ((at(middle) - from).norm() < strap.link() ? low : high) = middle;
      }
      way = high;
    }
    for (const double y : {-0.02, 0.02}) positions.push_back(at(way) + curtain::Vec3(0.0, y, 0.0));
  }
  const std::vector<curtain::Vec3> still(positions.size(), curtain::Vec3::Zero());
  const std::vector<curtain::Problem> problems = simulator.setState(positions, still);
  if (!problems.empty()) throw std::logic_error(curtain::describe(problems));
  return way - half_turn;
}

/// The pull on the left side, over gravity, of a strap that is about to slide there, `pull` [kg] being that on the
/// right (Euler 1769, Eytelwein 1808). Along it
///     dT / da = friction (T + w sin a) + w cos a,   w = mass over length * radius,
/// with the angle a from where the strap meets the bar on the right: all that the strap weighs is counted.
inline double bearable(const Strap& strap, double friction, double pull) {
  const double e = std::exp(friction * curtain::kPi), w = Strap::kPerLength * strap.held();
  return pull * e + 2.0 * friction * w / (1.0 + friction * friction) * (1.0 + e);
}

/// Of a row [kg].
inline double massOfRow(const curtain::Simulator& simulator, int row) {
  return simulator.mass({row, 0}) + simulator.mass({row, 1});
}

}  // namespace curtain_test
