// SPDX-License-Identifier: BSD-3-Clause
//
// Scenes in which cloth touches: for what contact costs, and for what its frames take.
#pragma once

#include "curtain_sim/scene.h"

namespace curtain_bench {

/// 2 m x 1 m, hung by its top edge between hooks `gathered` [m] apart, turned out of the vertical by `tilt` [rad]; one
/// core.
curtain::Scene curtainOf(int rows, int columns, double gathered, double tilt);
curtain::Scene with(curtain::Scene scene, const curtain::ObstacleParams& obstacle);
curtain::Scene touchingItself(curtain::Scene scene);
curtain::Scene dampedBy(curtain::Scene scene, double air);
/// A fan of 6 Pa that gusts, at one side of it.
curtain::Scene blown(curtain::Scene scene);
/// 6 Pa everywhere, three times the cloth's weight, for good.
curtain::Scene inSteadyWind(curtain::Scene scene);
curtain::ObstacleParams ballAt(const curtain::Vec3& position, double radius = 0.3);
/// A ball that moves into a curtain of 1 m for a second, and stays there.
curtain::ObstacleParams ballThatComes();
/// A ball that swings through a curtain of 0.6 m.
curtain::ObstacleParams swingingBall();
/// A ball, or a plate edge-on, through the middle of a curtain of 1 m at a speed [m/s].
curtain::ObstacleParams ballShotAt(double speed);
curtain::ObstacleParams plateShotAt(double speed);
/// Let go above a floor: it crumples.
curtain::Scene falling(int rows, int columns);
/// A square of 1 m that falls flat on a mesh of 49 920 triangles, round with a radius of 0.4 m, smooth or bumpy.
curtain::Scene draped(int rows, int columns, bool bumpy);

}  // namespace curtain_bench
