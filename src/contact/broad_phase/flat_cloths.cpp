// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/flat_cloths.h"

#include <algorithm>

#include "cloth/wide.h"

namespace curtain {
namespace {

struct Heights {
  double lowest, highest;
};

// Of nodes in a row above a plane through the origin.
CURTAIN_WIDE Heights heightsOf(const ConstFieldView& nodes, std::size_t count, const Vec3& normal) noexcept {
  const double *const x = nodes.x, *const y = nodes.y, *const z = nodes.z;
  const double nx = normal.x(), ny = normal.y(), nz = normal.z();
  double lowest = 1e300, highest = -1e300;
#pragma omp simd reduction(min : lowest) reduction(max : highest)
  for (std::size_t n = 0; n < count; ++n) {
    const double height = x[n] * nx + y[n] * ny + z[n] * nz;
    lowest = lowest < height ? lowest : height;
    highest = highest > height ? highest : height;
  }
  return {lowest, highest};
}

Heights heightsOf(const Grid& grid, std::size_t first, std::size_t end, const Field3& position,
                  const Vec3& normal) noexcept {
  Heights all{1e300, -1e300};
  for (int i = 0; i < grid.rows; ++i) {
    const Heights row = heightsOf({position, grid.row(i) + first}, end - first, normal);
    all = {std::min(all.lowest, row.lowest), std::max(all.highest, row.highest)};
  }
  return all;
}

}  // namespace

FlatCloths::FlatCloths(const ClothPattern& pattern, double overlong) : pattern_(pattern) {
  for (auto first = pattern.layer.begin(); first != pattern.layer.end();) {
    const auto end = std::upper_bound(first, pattern.layer.end(), *first);
    const auto from = first - pattern.layer.begin(), to = end - pattern.layer.begin();
    cloths_.push_back({{pattern, static_cast<int>(from), static_cast<int>(to), overlong},
                       static_cast<std::size_t>(from),
                       static_cast<std::size_t>(to)});
    first = end;
  }
  for (std::size_t other = 1; other < cloths_.size(); ++other) {
    for (std::size_t one = 0; one < other; ++one) planes_.push_back({one, other});
  }
}

// Room along the plane's normal from the one cloth up to the other, and from that up to the one [m].
FlatCloths::Gaps FlatCloths::gapsAlong(const Plane& plane, const Field3& position) const noexcept {
  const Cloth &one = cloths_[plane.one], &other = cloths_[plane.other];
  const Heights a = heightsOf(pattern_.grid, one.first, one.end, position, plane.normal);
  const Heights b = heightsOf(pattern_.grid, other.first, other.end, position, plane.normal);
  return {b.lowest - a.highest, a.lowest - b.highest};
}

bool FlatCloths::isFlat(const Field3& position, double reach) noexcept {
  if (!std::all_of(cloths_.begin(), cloths_.end(),
                   [&](Cloth& cloth) { return cloth.flatness.isFlat(position, reach); }))
    return false;
  return std::all_of(planes_.begin(), planes_.end(), [&](Plane& plane) {
    plane.normal = cloths_[plane.one].flatness.normal().normalized();
    const Gaps gaps = gapsAlong(plane, position);
    if (gaps.down > gaps.up) plane.normal = -plane.normal;
    return std::max(gaps.up, gaps.down) > reach;
  });
}

bool FlatCloths::staysFlat(const Field3& end, double reach) noexcept {
  return std::all_of(cloths_.begin(), cloths_.end(),
                     [&](Cloth& cloth) { return cloth.flatness.staysFlat(end, reach); }) &&
         std::all_of(planes_.begin(), planes_.end(),
                     [&](const Plane& plane) { return gapsAlong(plane, end).up > reach; });
}

void FlatCloths::pinsChanged() noexcept {
  for (Cloth& cloth : cloths_) cloth.flatness.pinsChanged();
}

void FlatCloths::advance() noexcept {
  for (Cloth& cloth : cloths_) cloth.flatness.advance();
}

void FlatCloths::invalidate() noexcept {
  for (Cloth& cloth : cloths_) cloth.flatness.invalidate();
}

void FlatCloths::setOverlong(double overlong) noexcept {
  for (Cloth& cloth : cloths_) cloth.flatness.setOverlong(overlong);
}

}  // namespace curtain
