// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/surface/fabric.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

namespace curtain_rviz {
namespace {

constexpr Colour kGround = {0.2F, 0.4F, 0.6F}, kFigure = {0.9F, 0.8F, 0.7F};

double brightness(const Pixels& pixels, std::size_t x, std::size_t y) {
  const std::size_t at = 4 * (y % pixels.size * pixels.size + x % pixels.size);
  return pixels.rgba[at] + pixels.rgba[at + 1] + pixels.rgba[at + 2];
}

std::vector<Pattern> patterns() {
  std::vector<Pattern> all;
  for (std::size_t i = 0; i < patternNames().size(); ++i) all.push_back(static_cast<Pattern>(i));
  return all;
}

// The step from the last pixel of a repeat to the first of the next is no larger than the largest inside.
TEST(Fabric, RepeatsFitTogether) {
  for (const Pattern pattern : patterns()) {
    const Pixels pixels = drawFabric(pattern, kGround, kFigure);
    ASSERT_EQ(pixels.rgba.size(), 4u * kFabricSize * kFabricSize);
    double inside = 0.0, across = 0.0;
    for (std::size_t y = 0; y < pixels.size; y += 7) {
      for (std::size_t x = 0; x + 1 < pixels.size; ++x) {
        inside = std::max(inside, std::abs(brightness(pixels, x, y) - brightness(pixels, x + 1, y)));
        inside = std::max(inside, std::abs(brightness(pixels, y, x) - brightness(pixels, y, x + 1)));
      }
      across = std::max(across, std::abs(brightness(pixels, pixels.size - 1, y) - brightness(pixels, 0, y)));
      across = std::max(across, std::abs(brightness(pixels, y, pixels.size - 1) - brightness(pixels, y, 0)));
    }
    EXPECT_LE(across, inside) << patternNames()[static_cast<std::size_t>(pattern)];
  }
}

TEST(Fabric, NoneIsOneColour) {
  const Pixels pixels = drawFabric(Pattern::kNone, kGround, kFigure);
  for (std::size_t at = 0; at < pixels.rgba.size(); at += 4) {
    ASSERT_EQ(pixels.rgba[at], 51);
    ASSERT_EQ(pixels.rgba[at + 1], 102);
    ASSERT_EQ(pixels.rgba[at + 2], 153);
    ASSERT_EQ(pixels.rgba[at + 3], 255);
  }
}

// With a black ground all light is the figure's: there is some, but not everywhere.
TEST(Fabric, FiguresHaveTheSecondColour) {
  for (const Pattern pattern : patterns()) {
    const Pixels pixels = drawFabric(pattern, {}, {1.0F, 0.0F, 0.0F});
    std::size_t red = 0, green = 0;
    for (std::size_t at = 0; at < pixels.rgba.size(); at += 4) {
      red += pixels.rgba[at] > 60;
      green += pixels.rgba[at + 1] > 0;
    }
    const double share = static_cast<double>(red) / (kFabricSize * kFabricSize);
    const bool has_figure = pattern == Pattern::kStripes || pattern == Pattern::kChecks || pattern == Pattern::kOgee;
    EXPECT_EQ(green, 0u);
    if (has_figure) {
      EXPECT_TRUE(share > 0.1 && share < 0.8) << share;
    } else {
      EXPECT_EQ(red, 0u);
    }
  }
}

TEST(Fabric, ScaleGetsBrighter) {
  const auto light = [](double share) {
    const Colour c = scaleColour(share);
    return 0.2126F * c[0] + 0.7152F * c[1] + 0.0722F * c[2];
  };
  for (int step = 0; step < 100; ++step) EXPECT_LT(light(0.01 * step), light(0.01 * (step + 1))) << step;
  EXPECT_EQ(scaleColour(-1.0), scaleColour(0.0));
  EXPECT_EQ(scaleColour(2.0), scaleColour(1.0));
}

}  // namespace
}  // namespace curtain_rviz
