// SPDX-License-Identifier: BSD-3-Clause
//
// A quad's corners on their straight ways, and whether a plane keeps two quads apart all the time: along a fixed
// direction places are linear in time, so it is enough that it does at both instants, on the same side.
#pragma once

#include "contact/narrow_phase/element_boxes.h"
#include "contact/narrow_phase/lanes.h"

namespace curtain {

class QuadWays {
 public:
  void fill(const std::array<std::uint32_t, 4>& corners, const std::vector<NodeWay>& ways) noexcept {
    const NodeWay &a = ways[corners[0]], &b = ways[corners[1]], &c = ways[corners[2]], &d = ways[corners[3]];
    const auto side = [](const Eigen::Array4f& p, const Eigen::Array4f& q, const Eigen::Array4f& r,
                         const Eigen::Array4f& s) {
      return LaneVectors{{p[0], q[0], r[0], s[0]}, {p[1], q[1], r[1], s[1]}, {p[2], q[2], r[2], s[2]}};
    };
    start_ = side(a.start, b.start, c.start, d.start);
    end_ = side(a.end, b.end, c.end, d.end);
    const Eigen::Array4f falling = d.start + d.end - (a.start + a.end), rising = b.start + b.end - (c.start + c.end);
    normal_ = Eigen::Vector3f(falling.head<3>().matrix().cross(rising.head<3>().matrix()));
    sum_ = (a.start + b.start + (c.start + d.start) + (a.end + b.end + (c.end + d.end))).head<3>().matrix();
  }

  /// Whether the quads are certain to stay further apart than `reach` [m]; differences of two coordinates may be rounded
  /// by `rounding` [m].
  bool staysApart(const QuadWays& other, float reach, float rounding) const noexcept {
    const Eigen::Vector3f way = other.sum_ - sum_;
    const auto along = [&](const Eigen::Vector3f& direction) {
      return separates(direction.dot(way) < 0.0f ? Eigen::Vector3f(-direction) : direction, other, reach, rounding);
    };
    return along(normal_) || along(other.normal_) || separates(way, other, reach, rounding);
  }

 private:
  // Whether the other quad is beyond this one along a direction.
  bool separates(const Eigen::Vector3f& direction, const QuadWays& other, float reach, float rounding) const noexcept {
    const LaneVectors d{lanesOf(direction.x()), lanesOf(direction.y()), lanesOf(direction.z())};
    const Lanes start = -dot(d, start_), end = -dot(d, end_);
    const Lanes other_start = dot(d, other.start_), other_end = dot(d, other.end_);
    const float least_start = leastLane(start) + leastLane(other_start);
    const float least_end = leastLane(end) + leastLane(other_end);
    const float least = least_start < least_end ? least_start : least_end;
    // Coordinates are rounded, and so are three products and sums of each: a multiple stands for all.
    const float beyond = (reach + 16.0f * rounding) * (1.0f + 1e-5f);
    return least > 0.0f && least * least > beyond * beyond * direction.squaredNorm();
  }

  LaneVectors start_, end_;   // [m] of the corners
  Eigen::Vector3f normal_;    // no unit
  Eigen::Vector3f sum_;       // of the corners at both instants [m]
};

}  // namespace curtain
