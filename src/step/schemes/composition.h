// SPDX-License-Identifier: BSD-3-Clause
//
// Order 4 from a symmetric scheme of order 2: five of its steps, gamma_k h long, gamma = (a, a, 1 - 4a, a, a) with
// a = 1 / (4 - 4^(1/3)) (Suzuki 1990). The third runs backwards in time. Its error constant is about a fiftieth of that
// of the composition of three (Yoshida 1990).
#pragma once

#include <array>

namespace curtain {

constexpr double kSuzuki = 0.41449077179437573714;
constexpr std::array<double, 5> kStages = {kSuzuki, kSuzuki, 1.0 - 4.0 * kSuzuki, kSuzuki, kSuzuki};
/// The longest stage over the substep, for stability.
constexpr double kLongestStage = 4.0 * kSuzuki - 1.0;

}  // namespace curtain
