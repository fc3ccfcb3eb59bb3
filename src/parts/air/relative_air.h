// SPDX-License-Identifier: BSD-3-Clause
//
// The air's force by its velocity u relative to the cloth, of a node with the area vector S = S n and the area A:
//
//   F = 1/2 rho |u| (c_n S (u . n) n + c_t A (u - (u . n) n))
//
// The normal part is |u| u_n, the sine of the angle of attack, and not |u_n| u_n, its square: the load of plates is
// linear in small angles (Rayleigh 1876, pi sin / (4 + pi sin); Duchemin 1842, 2 sin / (1 + sin^2), which Langley 1891
// measured), while Newton's square gives a tenth of it at 6 degrees. c_n = 1.2 is that of square plates across the
// wind, 1.17 (Hoerner 1965, Ch. 3); c_t = 0.02 that of both sides of a plate in turbulent flow at a Reynolds number of
// 1e5, 2 x 0.0074 (Prandtl's 0.074 Re^-1/5; Hoerner 1965, Ch. 2), and a third for the roughness of cloth.
//
// The force grows with the speed, so it must not depend on the velocity at the start of a long step; but its matrix B
// differs from node to node and along the normal and across, which the solver's scalar inertia can't take up. So it is
// evaluated at the velocity that the node would have without new pulls: with the forces, with what the links pulled by
// in the last substep, and with the air itself, implicitly. With the solve of the links that follows this is the
// splitting of Douglas and Rachford (1956; Lions and Mercier 1979), of which two properties matter here:
//   - the error does not grow at any length of step, since the resolvents of B >= 0 and of the links are firmly
//     nonexpansive;
//   - where forces, links and air are in balance nothing changes: terminal speeds and rest are exact.
#pragma once

#include "cloth/cloth.h"
#include "parts/air/ambient_wind.h"
#include "step/part.h"

namespace curtain {

class RelativeAir final : public Part {
 public:
  /// All that the arguments refer to but ambient must outlive this. The porosity of a cloth lowers its c_n by its
  /// share.
  RelativeAir(const AirParams& air, const Layers& layers, const ClothPattern& pattern,
              const AmbientParams& ambient = {});

  /// False: another law is asked for, or no coefficient is above zero.
  bool active() const noexcept { return largest_ > 0.0; }

  void resume() override;
  bool explain(const ClothState& state, double time, Plan& plan) const override;
  bool keepsAwake(const ClothState&, double) const noexcept override { return active() && ambient_.gusty(); }
  double dampingPerMass(double& air_speed) const noexcept override;
  /// The air moves as the ambient wind does, until others add to it.
  void announce(const ClothState& state, ForceSum& sum) noexcept override;
  /// To be asked after the parts whose forces it reads. It leaves out nodes that are led: it would take what pulls at
  /// them for what moves them.
  void addForces(const ClothState& state, ForceSum& sum) noexcept override;

 private:
  struct Drag {
    double normal, tangential;  // 1/2 rho c [kg/m^3]
  };
  Drag dragOf(const Layers::Layer& layer) const noexcept;

  const AirParams& air_;
  const Layers layers_;
  const ClothPattern& pattern_;
  const AmbientWind ambient_;
  double largest_ = 0.0;  // 1/2 rho c of all [kg/m^3]
  Field3 area_vectors_;
  Field solid_;             // by node, the share that is no pore
  std::vector<Vec3> kept_;  // forces on the nodes that are led [N]
};

}  // namespace curtain
