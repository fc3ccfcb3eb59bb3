// SPDX-License-Identifier: BSD-3-Clause
//
// C++17 has no std::numbers::pi.
#pragma once

namespace curtain {

constexpr double kPi = 3.14159265358979323846;

}  // namespace curtain
