// SPDX-License-Identifier: BSD-3-Clause
#include "contact/horizon.h"

#include <cmath>
#include <limits>

#include "cloth/wide.h"

namespace curtain {
namespace {

CURTAIN_WIDE void extrapolate(const Field& start, const Field& predicted, double factor, Field& from, Field& to) noexcept {
  const std::size_t size = start.size();
  const double *const a = start.data(), *const b = predicted.data();
  double *const out_a = from.data(), *const out_b = to.data();
#pragma omp simd
  for (std::size_t n = 0; n < size; ++n) {
    out_a[n] = a[n];
    out_b[n] = a[n] + factor * (b[n] - a[n]);
  }
}

// The largest square of position - (start + share (end - start)); infinite when one is not finite.
CURTAIN_WIDE double farthest(const Field3& position, const Field3& start, const Field3& end, double share, std::size_t size) noexcept {
  const double *const px = position.x.data(), *const py = position.y.data(), *const pz = position.z.data();
  const double *const sx = start.x.data(), *const sy = start.y.data(), *const sz = start.z.data();
  const double *const ex = end.x.data(), *const ey = end.y.data(), *const ez = end.z.data();
  double worst = 0.0, finite = 0.0;
#pragma omp simd reduction(max : worst) reduction(+ : finite)
  for (std::size_t n = 0; n < size; ++n) {
    const double x = px[n] - sx[n] - share * (ex[n] - sx[n]);
    const double y = py[n] - sy[n] - share * (ey[n] - sy[n]);
    const double z = pz[n] - sz[n] - share * (ez[n] - sz[n]);
    const double square = x * x + y * y + z * z;
    worst = worst > square ? worst : square;
    finite += 0.0 * square;
  }
  return finite == 0.0 ? worst : std::numeric_limits<double>::infinity();
}

}  // namespace

void Horizon::set(const Field3& start, const Field3& predicted, double h, double length, double slack) noexcept {
  length_ = length;
  elapsed_ = 0.0;
  slack_ = slack;
  const double factor = length / h;
  extrapolate(start.x, predicted.x, factor, start_.x, end_.x);
  extrapolate(start.y, predicted.y, factor, start_.y, end_.y);
  extrapolate(start.z, predicted.z, factor, start_.z, end_.z);
}

double Horizon::strayed(const Field3& position, double h) const noexcept {
  return std::sqrt(farthest(position, start_, end_, (elapsed_ + h) / length_, grid_.size()));
}

}  // namespace curtain
