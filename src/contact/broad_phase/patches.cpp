// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/patches.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "contact/narrow_phase/simd8.h"

namespace curtain {
namespace {

using Lanes = Simd8::Lanes;

constexpr float kNowhere = 1e30f;

// Bits of eight boxes that are within reach of a box.
CURTAIN_INTO_WIDE std::uint32_t nearBits(const float* const (&lows)[3], const float* const (&highs)[3],
                                         const float* low, const float* high, float reach) {
  Lanes widest = Lanes{} - kNowhere;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Lanes from, to;
    Simd8::load(lows[axis], from);
    Simd8::load(highs[axis], to);
    Simd8::raise(widest, from - high[axis]);
    Simd8::raise(widest, low[axis] - to);
  }
  return Simd8::bitsOf(widest <= reach);
}

// Bits of the quads of a patch that are within reach of a box.
CURTAIN_INTO_WIDE std::uint32_t nearQuads(const float (&lows)[3][Patches::kQuads],
                                          const float (&highs)[3][Patches::kQuads], const float* low, const float* high,
                                          float reach) {
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < Patches::kQuads; k += Simd8::kCount) {
    bits |=
        nearBits({&lows[0][k], &lows[1][k], &lows[2][k]}, {&highs[0][k], &highs[1][k], &highs[2][k]}, low, high, reach)
        << k;
  }
  return bits;
}

// Bits of the numbers 0 to 3 that are `at` or next to it.
std::uint32_t nextTo(int at) { return at < -1 || at > 4 ? 0U : (0x7U << (at + 1)) >> 2 & 0xFU; }

// Bits 0 to 3, four apart.
std::uint32_t spread(std::uint32_t bits) {
  return (bits & 1U) | (bits & 2U) << 3 | (bits & 4U) << 6 | (bits & 8U) << 9;
}

struct LaneRange {
  Lanes low, high;
};

CURTAIN_INTO_WIDE void merge(const LaneRange& other, LaneRange& range) {
  Simd8::lower(range.low, other.low);
  Simd8::raise(range.high, other.high);
}

// Of eight weft links of a row during the motion.
CURTAIN_INTO_WIDE void rangeOfLinks(const float* start, const float* end, LaneRange& range) {
  Simd8::load(start, range.low);
  range.high = range.low;
  for (const float* const place : {start + 1, end, end + 1}) {
    Lanes value;
    Simd8::load(place, value);
    Simd8::lower(range.low, value);
    Simd8::raise(range.high, value);
  }
}

// Four lanes each; of a single patch the first four.
CURTAIN_INTO_WIDE void store(const Lanes& value, bool single, float* first, float* second) {
  float values[8];
  Simd8::store(value, values);
  std::memcpy(first, values, sizeof values / 2);
  if (!single) std::memcpy(second, values + 4, sizeof values / 2);
}

}  // namespace

Patches::Patches(const Grid& grid, const Gaps& gaps)
    : grid_(grid), rows_((grid.rows - 1 + kAlong - 1) / kAlong), columns_((grid.linkCount() + kAlong - 1) / kAlong) {
  const auto count = static_cast<std::size_t>(rows_ * columns_);
  for (int patch = 0; patch < rows_ * columns_; ++patch) {
    const int row = patch / columns_ * kAlong, column = patch % columns_ * kAlong;
    first_.push_back(static_cast<std::uint32_t>(grid.index(row, column)));
    there_.push_back(0);
    for (int k = 0; k < kQuads; ++k) {
      const int i = row + k / kAlong, j = column + k % kAlong;
      const bool is_there = i < grid.rows - 1 && j < grid.linkCount() && !gaps.at(j);
      there_.back() |= (is_there ? 1U : 0U) << k;
    }
  }
  for (int k = 0; k < kQuads; ++k)
    quad_[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(grid.index(k / kAlong, k % kAlong));
  boxes_.assign(count, Boxes{});
  deviations_.assign(count, Eigen::Array4f::Zero());
  order_.resize(count);
  lows_.assign(static_cast<std::size_t>(grid.stride) + 2 * Simd8::kCount, 0.0f);
  highs_ = lows_;
  for (SweptNodes::Floats& ends : sorted_) ends.assign(count + Simd8::kCount, 0.0f);
}

// Eight columns of quads at a time, two patches; what is beyond the grid is left out by there_.
CURTAIN_WIDE void Patches::fitRow(const SweptNodes& nodes, int row) noexcept {
  const int count = std::min(kAlong, grid_.rows - 1 - row * kAlong);
  for (int first = 0; first < columns_; first += 2) {
    Boxes* const boxes = &boxes_[static_cast<std::size_t>(row * columns_ + first)];
    const bool single = first + 1 == columns_;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::size_t from = static_cast<std::size_t>(row * kAlong) * static_cast<std::size_t>(grid_.stride) +
                         static_cast<std::size_t>(first * kAlong);
      LaneRange above, below;
      rangeOfLinks(&nodes.start()[axis][from], &nodes.end()[axis][from], above);
      for (int i = 0; i < count; ++i) {
        from += static_cast<std::size_t>(grid_.stride);
        rangeOfLinks(&nodes.start()[axis][from], &nodes.end()[axis][from], below);
        merge(below, above);
        const std::size_t to = static_cast<std::size_t>(kAlong * i);
        store(above.low, single, &boxes[0].low[axis][to], &boxes[single ? 0 : 1].low[axis][to]);
        store(above.high, single, &boxes[0].high[axis][to], &boxes[single ? 0 : 1].high[axis][to]);
        above = below;
      }
    }
  }
}

// Ranges of deviations over four columns of nodes from each on, in the rows of a row of patches and the next.
CURTAIN_WIDE void Patches::rangeOfColumns(const SweptNodes& nodes, std::size_t axis, int row) noexcept {
  const int first = row * kAlong, last = std::min(first + kAlong + 1, grid_.rows - 1);
  for (std::size_t j = 0; j < static_cast<std::size_t>(grid_.stride); j += Simd8::kCount) {
    LaneRange all{Lanes{} + kNowhere, Lanes{} - kNowhere};
    for (int i = first; i <= last; ++i) {
      Lanes end, expected;
      Simd8::load(&nodes.end()[axis][grid_.row(i) + j], end);
      Simd8::load(&nodes.expected()[axis][grid_.row(i) + j], expected);
      const Lanes deviation = end - expected;
      merge({deviation, deviation}, all);
    }
    Simd8::store(all.low, &lows_[j]);
    Simd8::store(all.high, &highs_[j]);
  }
  const auto count = static_cast<std::size_t>(grid_.linkCount() + (grid_.closed ? 2 : 1));
  Simd8::reduceFours(lows_.data(), count, true);
  Simd8::reduceFours(highs_.data(), count, false);
}

float Patches::measureDeviations(const SweptNodes& nodes) noexcept {
  using Eigen::Array4f;
  const auto last = static_cast<std::size_t>(grid_.linkCount() + (grid_.closed ? 1 : 0));
  Array4f least = Array4f::Zero(), most = Array4f::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    for (int row = 0; row < rows_; ++row) {
      rangeOfColumns(nodes, axis, row);
      for (int column = 0; column < columns_; ++column) {
        const auto from = static_cast<std::size_t>(column * kAlong), next = std::min(from + 2, last);
        const float low = std::min(lows_[from], lows_[next]), high = std::max(highs_[from], highs_[next]);
        Array4f& deviation = deviations_[static_cast<std::size_t>(row * columns_ + column)];
        if (axis == 0) deviation[3] = 0.0f;
        deviation[k] = 0.5f * (low + high);
        deviation[3] += 0.25f * (high - low) * (high - low);
        least[k] = row + column == 0 ? low : std::min(least[k], low);
        most[k] = row + column == 0 ? high : std::max(most[k], high);
      }
    }
  }
  // Ends and their differences are rounded.
  const float rounding = 2.0f * nodes.rounding() + 1e-6f * least.abs().max(most.abs()).maxCoeff();
  for (Array4f& deviation : deviations_) deviation[3] = std::sqrt(deviation[3]) * (1.0f + 1e-5f) + rounding;
  return std::sqrt((most - least).square().sum()) * (1.0f + 1e-5f) + 2.0f * rounding;
}

void Patches::sort(const FlatPatches& boxes) noexcept {
  MovingBox all = boxes.box(0);
  for (std::size_t k = 0; k < boxes_.size(); ++k) {
    const MovingBox& box = boxes.box(static_cast<int>(k));
    all.merge(box);
    for (int axis = 0; axis < 3; ++axis) {
      boxes_[k].least[axis] = box.low[axis];
      boxes_[k].most[axis] = box.high[axis];
    }
  }
  Eigen::Index widest = 0;
  (all.high - all.low).head<3>().maxCoeff(&widest);
  axis_ = static_cast<std::size_t>(widest);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const float low = boxes_[k].least[axis_];
    order_[k] = {low > -kNowhere ? low : -kNowhere, static_cast<int>(k)};  // what is no number must not be sorted
  }
  std::sort(order_.begin(), order_.end());
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const Boxes& sorted = boxes_[static_cast<std::size_t>(order_[k].second)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sorted_[axis][k] = sorted.least[axis];
      sorted_[3 + axis][k] = sorted.most[axis];
    }
  }
}

// Bits of the patches first to first + 7 in order that the k-th meets.
CURTAIN_WIDE std::uint32_t Patches::meeting(std::size_t k, std::size_t first, float reach) const noexcept {
  const float low[3] = {sorted_[0][k], sorted_[1][k], sorted_[2][k]};
  const float high[3] = {sorted_[3][k], sorted_[4][k], sorted_[5][k]};
  return nearBits({&sorted_[0][first], &sorted_[1][first], &sorted_[2][first]},
                  {&sorted_[3][first], &sorted_[4][first], &sorted_[5][first]}, low, high, reach);
}

// By quad of the first patch: bits of the quads of the other one whose boxes are within reach. Returns the bits of
// those that have some; the others' are undefined.
CURTAIN_WIDE std::uint32_t Patches::findNear(int a, int b, float reach, std::uint32_t (&near)[kQuads]) const noexcept {
  const Boxes &one = boxes_[static_cast<std::size_t>(a)], &other = boxes_[static_cast<std::size_t>(b)];
  std::uint32_t some = 0;
  const std::uint32_t mine = there_[static_cast<std::size_t>(a)], its = there_[static_cast<std::size_t>(b)];
  std::uint32_t rows = nearQuads(one.low, one.high, other.least, other.most, reach) & mine;
  for (; rows != 0; rows &= rows - 1) {
    const auto p = static_cast<std::uint32_t>(__builtin_ctz(rows));
    const float low[3] = {one.low[0][p], one.low[1][p], one.low[2][p]};
    const float high[3] = {one.high[0][p], one.high[1][p], one.high[2][p]};
    near[p] = nearQuads(other.low, other.high, low, high, reach) & its;
    some |= (near[p] != 0 ? 1U : 0U) << p;
  }
  return some;
}

Patches::Beside Patches::besideOf(int a, int b) const noexcept {
  const int down = (b / columns_ - a / columns_) * kAlong, right = (b % columns_ - a % columns_) * kAlong;
  Beside beside{};
  for (int k = 0; k < kAlong; ++k) {
    beside.rows[k] = spread(nextTo(k - down)) * 0xFU;
    beside.columns[k] = nextTo(k - right) * 0x1111U;
    if (grid_.closed)
      beside.columns[k] |= (nextTo(k - right - grid_.columns) | nextTo(k - right + grid_.columns)) * 0x1111U;
  }
  return beside;
}

}  // namespace curtain
