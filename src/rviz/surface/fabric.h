// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures that are computed, not loaded: one repeat of a fabric, thread by thread, and the scale of colours of the
// layers.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace curtain_rviz {

/// Red, green, blue as on the screen, in [0, 1].
using Colour = std::array<float, 3>;

enum class Pattern { kNone, kLinen, kTwill, kStripes, kChecks, kOgee };

/// All of them with their names for people, in the order of the enum.
const std::vector<std::string>& patternNames();

/// Pixels of a picture, row by row from the top: red, green, blue, 255.
struct Pixels {
  std::size_t size = 0;  ///< width and height
  std::vector<std::uint8_t> rgba;
};

/// Of drawFabric()'s picture: threads of a repeat, along either side; and pixels.
constexpr int kThreadsAcross = 128;
constexpr int kFabricSize = 8 * kThreadsAcross;

/// One repeat of a fabric (kFabricSize), which fits to itself on all sides; right: along the weft, down: along the
/// warp.
///   ground   colour of the cloth
///   figure   second colour of stripes, checks and ogees
Pixels drawFabric(Pattern pattern, const Colour& ground, const Colour& figure);

/// The colour for a share of the range, in [0, 1]; brighter the larger it is.
Colour scaleColour(double share);

}  // namespace curtain_rviz
