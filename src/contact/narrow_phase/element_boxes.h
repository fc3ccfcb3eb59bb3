// SPDX-License-Identifier: BSD-3-Clause
//
// The boxes of a quad's elements side by side, so that all of them are held against another box at once.
//
//   lane   0       1 2        3 4 5   6             7
//          vertex  triangles  edges   added vertex  added edge (of a quad at the border)
//
// The quad in the last row and the last column of open cloth owns two vertices and an edge more: they are in a second
// set, in lanes 0, 6 and 3. Lanes without an element meet nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "cloth/coarse_mesh.h"
#include "contact/narrow_phase/flatness.h"

namespace curtain {

/// Where a node is at both instants [m]; the fourth lane is 0.
struct NodeWay {
  Eigen::Array4f start, end;

  FloatBox box() const noexcept { return {start.min(end), start.max(end)}; }
};

class ElementBoxes {
 public:
  static constexpr std::uint32_t kVertices = 0b01000001, kTriangles = 0b00000110, kEdges = 0b10111000;

  /// Ways of the nodes by their index in a Field; `second`: the second set.
  void fill(const QuadElements& quad, bool second, const std::vector<NodeWay>& nodes) noexcept {
    using Eigen::Array4f;
    constexpr float kFar = 1e30f;
    FloatBox boxes[kLanes];
    for (FloatBox& box : boxes) box = {Array4f::Constant(kFar), Array4f::Constant(-kFar)};
    const std::uint32_t lanes = lanesOf(quad, second);
    const auto merged = [&nodes](const auto& element) {
      FloatBox box = nodes[element[0]].box();
      for (std::size_t k = 1; k < element.size(); ++k) box.merge(nodes[element[k]].box());
      return box;
    };
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t bit = 1U << lane;
      if ((lanes & bit) == 0) continue;
      if ((kVertices & bit) != 0) boxes[lane] = nodes[vertex(quad, second, lane)].box();
      if ((kTriangles & bit) != 0) boxes[lane] = merged(triangle(quad, lane));
      if ((kEdges & bit) != 0) boxes[lane] = merged(edge(quad, second, lane));
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      for (std::size_t k = 0; k < 3; ++k) {
        low_[k][lane] = boxes[lane].low[static_cast<Eigen::Index>(k)];
        high_[k][lane] = boxes[lane].high[static_cast<Eigen::Index>(k)];
      }
    }
  }

  /// Lanes whose box meets `box` within `reach` [m].
  std::uint32_t meeting(const FloatBox& box, float reach) const noexcept {
    return meeting(box.low.data(), box.high.data(), reach);
  }

  /// Lanes whose box meets that of a lane of `other` within `reach` [m].
  std::uint32_t meeting(const ElementBoxes& other, std::size_t lane, float reach) const noexcept {
    const float low[3] = {other.low_[0][lane], other.low_[1][lane], other.low_[2][lane]};
    const float high[3] = {other.high_[0][lane], other.high_[1][lane], other.high_[2][lane]};
    return meeting(low, high, reach);
  }

  static std::uint32_t vertex(const QuadElements& quad, bool second, std::size_t lane) noexcept {
    return quad.vertices[(lane == 0 ? 0U : 1U) + (second ? 2U : 0U)];
  }
  static const MeshTriangle& triangle(const QuadElements& quad, std::size_t lane) noexcept {
    return quad.triangles[lane - 1];
  }
  static const MeshEdge& edge(const QuadElements& quad, bool second, std::size_t lane) noexcept {
    return quad.edges[second ? 4U : lane == 7 ? 3U : lane - 3];
  }

 private:
  static constexpr std::size_t kLanes = 8;

  static std::uint32_t lanesOf(const QuadElements& quad, bool second) noexcept {
    if (second) return 0b01001001;
    return 0b00111111U | (quad.vertex_count > 1 ? 1U << 6U : 0U) | (quad.edge_count > 3 ? 1U << 7U : 0U);
  }

  std::uint32_t meeting(const float* low, const float* high, float reach) const noexcept {
#ifdef __SSE2__
    const __m128 limit = _mm_set1_ps(reach);
    __m128 apart[2] = {_mm_setzero_ps(), _mm_setzero_ps()};
    for (std::size_t k = 0; k < 3; ++k) {
      const __m128 from = _mm_set1_ps(low[k]), to = _mm_set1_ps(high[k]);
      for (std::size_t half = 0; half < 2; ++half) {
        const __m128 below = _mm_sub_ps(_mm_load_ps(low_[k] + 4 * half), to);
        const __m128 above = _mm_sub_ps(from, _mm_load_ps(high_[k] + 4 * half));
        apart[half] = _mm_or_ps(apart[half], _mm_cmpgt_ps(_mm_max_ps(below, above), limit));
      }
    }
    return static_cast<std::uint32_t>(_mm_movemask_ps(apart[0]) | _mm_movemask_ps(apart[1]) << 4) ^ 0xFFU;
#else
    std::uint32_t lanes = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      bool apart = false;
      for (std::size_t k = 0; k < 3; ++k) {
        apart = apart || low_[k][lane] - high[k] > reach || low[k] - high_[k][lane] > reach;
      }
      lanes |= (apart ? 0U : 1U) << lane;
    }
    return lanes;
#endif
  }

  alignas(16) float low_[3][kLanes];   // [m]
  alignas(16) float high_[3][kLanes];  // [m]
};

}  // namespace curtain
