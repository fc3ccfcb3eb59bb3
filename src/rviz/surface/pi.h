// SPDX-License-Identifier: BSD-3-Clause
//
// C++17 has no std::numbers::pi, and the engine's own is none of its public headers.
#pragma once

#include <Eigen/Core>

namespace curtain_rviz {

constexpr double kPi = static_cast<double>(EIGEN_PI);

}  // namespace curtain_rviz
