// SPDX-License-Identifier: BSD-3-Clause
//
// Leapfrog with constraints (SHAKE: Ryckaert, Ciccotti, Berendsen 1977): forces act along the links' directions at the
// start of the step, velocities live half a step behind. Order 2, symplectic, needs dt * omega_max < 2. Where strings
// become taut, or a pull sets in, links may pull harder than the step is stable for: KineticGuard finds it.
#pragma once

#include "solver/scheme.h"

namespace curtain {

class Leapfrog final : public Scheme {
 public:
  Leapfrog() noexcept : Scheme({false, false, 0.5, false}) {}
};

}  // namespace curtain
