// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace curtain {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace curtain
