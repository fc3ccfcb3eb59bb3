// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace curtain {

/// Capacity of a worker's share of the pairs, over its fair part.
constexpr std::size_t kRoomOverPart = 2;

}  // namespace curtain
