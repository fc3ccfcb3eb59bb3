// SPDX-License-Identifier: BSD-3-Clause
#include "bench/rivals/spring_matrix.h"

#include <algorithm>
#include <cmath>

#define CURTAIN_RESTRICT __restrict__

namespace curtain_bench {
namespace {

constexpr double kTiny = 1e-30;  // [m^2]

// K = k ((1 - rest / length) (I - d d^T) + d d^T), d the link's direction (Choi, Ko 2002, Eq. (5)); times h^2.
void blocksOfBatch(const double* CURTAIN_RESTRICT ax, const double* CURTAIN_RESTRICT ay,
                   const double* CURTAIN_RESTRICT az, const double* CURTAIN_RESTRICT bx,
                   const double* CURTAIN_RESTRICT by, const double* CURTAIN_RESTRICT bz, double* CURTAIN_RESTRICT xx,
                   double* CURTAIN_RESTRICT xy, double* CURTAIN_RESTRICT xz, double* CURTAIN_RESTRICT yy,
                   double* CURTAIN_RESTRICT yz, double* CURTAIN_RESTRICT zz, const LinkBatch& batch, double scale) {
  const double rest = batch.rest;
  const double slack = batch.two_sided ? -INFINITY : 0.0;
  for (std::size_t k = 0; k < batch.count; ++k) {
    const double dx = bx[k] - ax[k], dy = by[k] - ay[k], dz = bz[k] - az[k];
    const double length2 = dx * dx + dy * dy + dz * dz + kTiny;
    const double length = std::sqrt(length2);
    const double held = length - rest > slack ? scale : 0.0;
    const double bare = 1.0 - rest / length;
    const double across = held * (bare > 0.0 ? bare : 0.0);
    const double along = (held - across) / length2;
    xx[k] = across + along * dx * dx;
    xy[k] = along * dx * dy;
    xz[k] = along * dx * dz;
    yy[k] = across + along * dy * dy;
    yz[k] = along * dy * dz;
    zz[k] = across + along * dz * dz;
  }
}

// out_a += K (in_a - in_b), out_b -= the same.
void multiplyBatch(const double* CURTAIN_RESTRICT xx, const double* CURTAIN_RESTRICT xy,
                   const double* CURTAIN_RESTRICT xz, const double* CURTAIN_RESTRICT yy,
                   const double* CURTAIN_RESTRICT yz, const double* CURTAIN_RESTRICT zz, const Triple& in, Triple& out,
                   std::size_t a, std::size_t b, std::size_t count) {
  const double *const iax = &in.x[a], *const iay = &in.y[a], *const iaz = &in.z[a];
  const double *const ibx = &in.x[b], *const iby = &in.y[b], *const ibz = &in.z[b];
  double* CURTAIN_RESTRICT const oax = &out.x[a];
  double* CURTAIN_RESTRICT const oay = &out.y[a];
  double* CURTAIN_RESTRICT const oaz = &out.z[a];
  double* CURTAIN_RESTRICT const obx = &out.x[b];
  double* CURTAIN_RESTRICT const oby = &out.y[b];
  double* CURTAIN_RESTRICT const obz = &out.z[b];
#pragma omp simd
  for (std::size_t k = 0; k < count; ++k) {
    const double dx = iax[k] - ibx[k], dy = iay[k] - iby[k], dz = iaz[k] - ibz[k];
    const double gx = xx[k] * dx + xy[k] * dy + xz[k] * dz;
    const double gy = xy[k] * dx + yy[k] * dy + yz[k] * dz;
    const double gz = xz[k] * dx + yz[k] * dy + zz[k] * dz;
    oax[k] += gx;
    oay[k] += gy;
    oaz[k] += gz;
    obx[k] -= gx;
    oby[k] -= gy;
    obz[k] -= gz;
  }
}

}  // namespace

SpringMatrix::SpringMatrix(const GridState& state) {
  for (auto& entries : block_) entries.assign(state.link_count, 0.0);
  for (auto& entries : inverse_) entries.assign(state.count(), 0.0);
}

void SpringMatrix::linearise(const GridState& state, double stiffness, double h) {
  const Triple& x = state.position;
  for (const LinkBatch& batch : state.batches) {
    const std::size_t a = batch.a, b = batch.b, f = batch.first;
    blocksOfBatch(&x.x[a], &x.y[a], &x.z[a], &x.x[b], &x.y[b], &x.z[b], &block_[0][f], &block_[1][f], &block_[2][f],
                  &block_[3][f], &block_[4][f], &block_[5][f], batch, h * h * stiffness);
  }
  invertDiagonal(state);
}

void SpringMatrix::invertDiagonal(const GridState& state) {
  for (std::size_t e = 0; e < 6; ++e) {
    std::vector<double>& sum = inverse_[e];
    const bool diagonal = e == 0 || e == 3 || e == 5;
    for (std::size_t n = 0; n < sum.size(); ++n) sum[n] = diagonal ? state.mass[n] : 0.0;
    for (const LinkBatch& batch : state.batches) {
      const double* const entry = &block_[e][batch.first];
      double* const to_a = &sum[batch.a];
      double* const to_b = &sum[batch.b];
      for (std::size_t k = 0; k < batch.count; ++k) to_a[k] += entry[k];
      for (std::size_t k = 0; k < batch.count; ++k) to_b[k] += entry[k];
    }
  }
#pragma omp simd
  for (std::size_t n = 0; n < state.count(); ++n) {
    const double xx = inverse_[0][n], xy = inverse_[1][n], xz = inverse_[2][n], yy = inverse_[3][n],
                 yz = inverse_[4][n], zz = inverse_[5][n];
    const double cx = yy * zz - yz * yz, cy = xz * yz - xy * zz, cz = xy * yz - xz * yy;
    const double scale = state.free[n] / (xx * cx + xy * cy + xz * cz);
    inverse_[0][n] = scale * cx;
    inverse_[1][n] = scale * cy;
    inverse_[2][n] = scale * cz;
    inverse_[3][n] = scale * (xx * zz - xz * xz);
    inverse_[4][n] = scale * (xy * xz - xx * yz);
    inverse_[5][n] = scale * (xx * yy - xy * xy);
  }
}

void SpringMatrix::multiplyLinks(const GridState& state, const Triple& in, Triple& out) const {
  for (std::vector<double>* entries : {&out.x, &out.y, &out.z}) std::fill(entries->begin(), entries->end(), 0.0);
  for (const LinkBatch& batch : state.batches) {
    const std::size_t f = batch.first;
    multiplyBatch(&block_[0][f], &block_[1][f], &block_[2][f], &block_[3][f], &block_[4][f], &block_[5][f], in, out,
                  batch.a, batch.b, batch.count);
  }
}

void SpringMatrix::multiply(const GridState& state, const Triple& in, Triple& out) const {
  multiplyLinks(state, in, out);
#pragma omp simd
  for (std::size_t n = 0; n < state.count(); ++n) {
    out.x[n] = state.free[n] * (out.x[n] + state.mass[n] * in.x[n]);
    out.y[n] = state.free[n] * (out.y[n] + state.mass[n] * in.y[n]);
    out.z[n] = state.free[n] * (out.z[n] + state.mass[n] * in.z[n]);
  }
}

void SpringMatrix::precondition(const GridState& state, const Triple& in, Triple& out) const {
#pragma omp simd
  for (std::size_t n = 0; n < state.count(); ++n) {
    const double x = in.x[n], y = in.y[n], z = in.z[n];
    out.x[n] = inverse_[0][n] * x + inverse_[1][n] * y + inverse_[2][n] * z;
    out.y[n] = inverse_[1][n] * x + inverse_[3][n] * y + inverse_[4][n] * z;
    out.z[n] = inverse_[2][n] * x + inverse_[4][n] * y + inverse_[5][n] * z;
  }
}

}  // namespace curtain_bench
