// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/swept_nodes.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "cloth/shuffle.h"
#include "cloth/wide.h"

namespace curtain {
namespace {

// The mean motion is taken over every n-th row.
constexpr int kSampledRows = 4;
// Padding [floats] behind the arrays, so that vector loads stay inside.
constexpr std::size_t kBeyond = 16;
// Unit roundoff of single precision.
constexpr float kUnit = 0.5f * std::numeric_limits<float>::epsilon();

CURTAIN_WIDE void subtract(const double* __restrict from, double origin, std::size_t count, float* __restrict to) {
#pragma omp simd
  for (std::size_t j = 0; j < count; ++j) to[j] = static_cast<float>(from[j] - origin);
}

CURTAIN_WIDE double sumOfDifferences(const double* __restrict from, const double* __restrict to, std::size_t count) {
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t j = 0; j < count; ++j) sum += to[j] - from[j];
  return sum;
}

}  // namespace

SweptNodes::SweptNodes(const Grid& grid) : grid_(grid), field_stride_(static_cast<std::size_t>(grid.stride)) {
  if (grid.closed) grid_.stride = Grid::strideFor(grid.columns + 2);
  for (std::array<Floats, 3>* const places : {&start_, &end_, &expected_}) {
    for (Floats& component : *places) component.assign(grid_.row(grid.rows) + kBeyond, 0.0f);
  }
  nodes_.assign(grid_.row(grid.rows), {Eigen::Array4f::Zero(), Eigen::Array4f::Zero()});
}

void SweptNodes::setComponents(const Field3& from, const Vec3& origin, std::array<Floats, 3>& to) const noexcept {
  const auto component = [&](const Field& values, Eigen::Index axis) {
    Floats& floats = to[static_cast<std::size_t>(axis)];
    if (!grid_.closed) {
      subtract(values.data(), origin[axis], grid_.row(grid_.rows), floats.data());
      return;
    }
    for (int i = 0; i < grid_.rows; ++i) {
      float* const row = &floats[grid_.row(i)];
      const auto columns = static_cast<std::size_t>(grid_.columns);
      subtract(&values[static_cast<std::size_t>(i) * field_stride_], origin[axis], columns, row);
      std::copy(row, row + 2, row + columns);
    }
  };
  component(from.x, 0);
  component(from.y, 1);
  component(from.z, 2);
}

double SweptNodes::meanDifference(const Field& from, const Field& to) const noexcept {
  double sum = 0.0, sampled = 0.0;
  for (int i = 0; i < grid_.rows; i += kSampledRows) {
    const std::size_t row = static_cast<std::size_t>(i) * field_stride_;
    sum += sumOfDifferences(&from[row], &to[row], static_cast<std::size_t>(grid_.columns));
    sampled += static_cast<double>(grid_.columns);
  }
  return sum / sampled;
}

// From one array per component to one node after the other, four nodes at a time: rows are padded to a multiple of it.
void SweptNodes::interleaveOne(const std::array<Floats, 3>& from, Eigen::Array4f SweptNode::*to) noexcept {
  using Four = float __attribute__((vector_size(16)));
  for (std::size_t n = 0; n < nodes_.size(); n += 4) {
    Four x, y, z, zero = Four{}, xy, xy_high, z_zero, z_high, out[4];
    std::memcpy(&x, &from[0][n], sizeof x);
    std::memcpy(&y, &from[1][n], sizeof y);
    std::memcpy(&z, &from[2][n], sizeof z);
    shuffle<0, 4, 1, 5>(x, y, xy);
    shuffle<2, 6, 3, 7>(x, y, xy_high);
    shuffle<0, 4, 1, 5>(z, zero, z_zero);
    shuffle<2, 6, 3, 7>(z, zero, z_high);
    shuffle<0, 1, 4, 5>(xy, z_zero, out[0]);
    shuffle<2, 3, 6, 7>(xy, z_zero, out[1]);
    shuffle<0, 1, 4, 5>(xy_high, z_high, out[2]);
    shuffle<2, 3, 6, 7>(xy_high, z_high, out[3]);
    for (std::size_t k = 0; k < 4; ++k) std::memcpy((nodes_[n + k].*to).data(), &out[k], sizeof out[k]);
  }
}

void SweptNodes::set(const Field3& start, const Field3& end) noexcept {
  origin_ = start.at(0);
  origin_at_end_ =
      origin_ + Vec3(meanDifference(start.x, end.x), meanDifference(start.y, end.y), meanDifference(start.z, end.z));
  setComponents(start, origin_, start_);
  setComponents(end, origin_at_end_, end_);
  deviates_ = false;
}

void SweptNodes::setEnd(const Field3& end) noexcept {
  if (!deviates_) std::swap(end_, expected_);
  deviates_ = true;
  setComponents(end, origin_at_end_, end_);
}

// Two coordinates are rounded once each, and so is their difference, which is at most twice as large; the shift to the
// origin rounds in double precision.
void SweptNodes::setLargest(float largest) noexcept {
  const double shift = origin_.cwiseAbs().cwiseMax(origin_at_end_.cwiseAbs()).maxCoeff();
  rounding_ = 4.0f * kUnit * largest + 1e-15f * static_cast<float>(shift);
}

void SweptNodes::interleave() noexcept {
  interleaveOne(start_, &SweptNode::start);
  interleaveOne(end_, &SweptNode::end);
}

}  // namespace curtain
