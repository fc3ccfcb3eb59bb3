// SPDX-License-Identifier: BSD-3-Clause
//
// The rivals, each made by one function from the scene and its settings. All in double precision, but Bullet as it is
// installed.
#pragma once

#include <memory>
#include <string>

#include "bench/contestant.h"

namespace curtain_bench {

/// Mass-spring cloth stepped explicitly. The springs are as stiff as dt * omega_max = `limit` allows
/// (omega_max = 2 sqrt(k/m) of a chain of equal masses): stiffer is truer, beyond the method's limit it blows up.
struct ExplicitSettings {
  int substeps = 1;
  double limit = 1.0;    ///< dt * omega_max; stable below 2 (symplectic Euler), 2.8 (RK4)
  double dashpot = 0.0;  ///< share of critical damping of the fastest mode, in every spring
};
std::unique_ptr<Contestant> makeSymplecticEuler(const ClothStart& start, const ExplicitSettings& settings);
std::unique_ptr<Contestant> makeRungeKutta(const ClothStart& start, const ExplicitSettings& settings);

/// Baraff, Witkin 1998: one linearised backward Euler step by conjugate gradients.
struct ImplicitSettings {
  int substeps = 1;
  double stiffness = 1e4;   ///< [N/m] of every spring
  double tolerance = 1e-4;  ///< of the residual, relative to the right-hand side's
  int iterations = 400;     ///< cap
};
std::unique_ptr<Contestant> makeBaraffWitkin(const ClothStart& start, const ImplicitSettings& settings);

/// Mueller et al. 2007 with stiffness 1.
struct PositionSettings {
  int substeps = 1;
  int iterations = 1;
  double compliance = 0.0;  ///< [m/N], XPBD only; at 0 XPBD is PBD of stiffness 1
};
std::unique_ptr<Contestant> makePbd(const ClothStart& start, const PositionSettings& settings);

/// Macklin, Mueller, Chentanez 2016; iterations = 1 is Macklin et al. 2019, "Small Steps in Physics Simulation".
std::unique_ptr<Contestant> makeXpbd(const ClothStart& start, const PositionSettings& settings);

/// btSoftBody of the Bullet that is installed: kLST 1, the links of the grid, nothing else.
struct BulletSettings {
  int substeps = 1;
  int position_iterations = 1;
  int velocity_iterations = 0;
};
bool bulletInstalled();
std::string bulletDescription();  ///< version and precision
/// Null without Bullet.
std::unique_ptr<Contestant> makeBullet(const ClothStart& start, const BulletSettings& settings);

}  // namespace curtain_bench
