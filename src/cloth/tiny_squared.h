// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace curtain {

/// Added to a squared length, it avoids a division by a zero length, and changes no other value [m^2].
constexpr double kTinySquared = 1e-300;

}  // namespace curtain
