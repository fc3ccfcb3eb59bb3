// SPDX-License-Identifier: BSD-3-Clause
//
// Forces of linear springs along the links, for the explicit methods.
#pragma once

#include "bench/rivals/grid_state.h"

namespace curtain_bench {

/// Writes gravity plus spring forces [N] into force: stiffness [N/m], dashpot [N s/m] along the link. Strings push
/// nothing.
void springForces(const GridState& state, const Triple& position, const Triple& velocity, double stiffness,
                  double dashpot, Triple& force);

}  // namespace curtain_bench
