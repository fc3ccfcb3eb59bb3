// SPDX-License-Identifier: BSD-3-Clause
//
// Leapfrog with constraints (SHAKE: Ryckaert, Ciccotti, Berendsen 1977): links pull along their directions at the start
// of the step, velocities lag half a step behind. Order 2, symplectic, stable for h * omega_max < 2. Tensions that set
// in suddenly may exceed that; EnergyAccount detects it.
#pragma once

#include "step/scheme.h"

namespace curtain {

class Leapfrog final : public Scheme {
 public:
  Leapfrog() noexcept : Scheme({false, false, 0.5}) {}
};

}  // namespace curtain
