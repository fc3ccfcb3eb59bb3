// SPDX-License-Identifier: BSD-3-Clause
//
// A quad's corners on their straight ways, and whether a plane keeps two quads apart all the time: along a fixed
// direction places are linear in time, so it is enough that it does at both instants, on the same side.
#pragma once

#include <algorithm>

#include "contact/narrow_phase/lanes.h"
#include "contact/narrow_phase/staying_apart.h"

namespace curtain {

class QuadWays {
 public:
  void fill(const std::array<std::uint32_t, 4>& corners, const NodeWays& ways) noexcept {
    fill(corners, ways.start, start_);
    fill(corners, ways.end, end_);
    const LaneVectors all = start_ + end_;
    const auto sum = [](const Lanes& l) { return (l[0] + l[1]) + (l[2] + l[3]); };
    sum_ = {sum(all.x), sum(all.y), sum(all.z)};
    const auto between = [](const LaneVectors& v, std::size_t k, std::size_t l) { return Eigen::Vector3f(v.x[l] - v.x[k], v.y[l] - v.y[k], v.z[l] - v.z[k]); };
    normal_ = between(all, 0, 3).cross(between(all, 2, 1));
  }

  /// Whether the quads are certain to stay further apart than `reach` [m]; differences of two coordinates may be rounded
  /// by `rounding` [m].
  bool staysApart(const QuadWays& other, float reach, float rounding) const noexcept {
    // Coordinates are rounded, and so are three products and sums of each: a multiple stands for all.
    const float beyond = (reach + 16.0f * rounding) * (1.0f + 1e-5f);
    const Eigen::Vector3f between = other.sum_ - sum_;
    const auto along = [&](const Eigen::Vector3f& direction) {
      return separates(direction.dot(between) < 0.0f ? Eigen::Vector3f(-direction) : direction, other, beyond);
    };
    return separates(between, other, beyond) || along(normal_) || along(other.normal_) || separatesClosest(other, beyond);
  }

 private:
  static constexpr int kSteps = 6;

  using Corners = std::array<std::uint32_t, 4>;
  static void fill(const Corners& corners, const Eigen::Array4f* places, LaneVectors& at) noexcept {
    const Eigen::Array4f &a = places[corners[0]], &b = places[corners[1]], &c = places[corners[2]], &d = places[corners[3]];
    at = LaneVectors{Lanes{a[0], b[0], c[0], d[0]}, Lanes{a[1], b[1], c[1], d[1]}, Lanes{a[2], b[2], c[2], d[2]}};
  }

  // Whether the other quad is beyond this one along a direction, by so much [m] and more.
  bool separates(const Eigen::Vector3f& direction, const QuadWays& other, float beyond) const noexcept {
    const LaneVectors d{lanesOf(direction.x()), lanesOf(direction.y()), lanesOf(direction.z())};
    const Lanes least = leastOfEach(dot(d, other.start_), -dot(d, start_), dot(d, other.end_), -dot(d, end_));
    const float apart = std::min(least[0] + least[1], least[2] + least[3]);
    return apart > 0.0f && apart * apart > beyond * beyond * direction.squaredNorm();
  }

  // Along the way between the closest points half way, found step by step (Gilbert 1966).
  bool separatesClosest(const QuadWays& other, float beyond) const noexcept {
    const LaneVectors mine = start_ + end_, others = other.start_ + other.end_;
    Eigen::Vector3f way = 0.25f * (other.sum_ - sum_);
    for (int step = 0; step < kSteps; ++step) {
      const LaneVectors d{lanesOf(way.x()), lanesOf(way.y()), lanesOf(way.z())};
      const Lanes my_heights = dot(d, mine), their_heights = dot(d, others);
      std::size_t furthest = 0, nearest = 0;
      for (std::size_t k = 1; k < 4; ++k) {
        if (my_heights[k] > my_heights[furthest]) furthest = k;
        if (their_heights[k] < their_heights[nearest]) nearest = k;
      }
      const Eigen::Vector3f corner(others.x[nearest] - mine.x[furthest], others.y[nearest] - mine.y[furthest], others.z[nearest] - mine.z[furthest]);
      const Eigen::Vector3f towards = corner - way;
      const float squared = towards.squaredNorm();
      if (!(squared > 0.0f)) break;
      way += std::clamp(-way.dot(towards) / squared, 0.0f, 1.0f) * towards;
      if (step > 0 && separates(way, other, beyond)) return true;
    }
    return false;
  }

  LaneVectors start_, end_;  // [m] of the corners
  Eigen::Vector3f sum_;      // of the corners at both instants [m]
  Eigen::Vector3f normal_;   // no unit
};

}  // namespace curtain
