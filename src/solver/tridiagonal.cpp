// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tridiagonal.h"

#include <cmath>

namespace curtain {

TridiagonalSystem::TridiagonalSystem(std::size_t capacity) {
  for (Field* field : {&lower, &diagonal, &upper, &smallest, &rhs, &elimination_, &corner_}) {
    field->assign(capacity, 0.0);
  }
}

// Thomas algorithm on the matrix without its corners.
bool TridiagonalSystem::sweep(std::size_t count, Field& solution) noexcept {
  bool sound = true;
  double e = 0.0;
  double above = 0.0;
  for (std::size_t p = 0; p < count; ++p) {
    const double coupling = p > 0 ? lower[p] : 0.0;
    const double pivot = diagonal[p] - coupling * e;
    const bool good = pivot > smallest[p];
    const double inverse = good ? 1.0 / pivot : 0.0;
    e = upper[p] * inverse;
    above = (solution[p] - coupling * above) * inverse;
    sound = sound && good;
    elimination_[p] = e;
    solution[p] = above;
  }
  for (std::size_t p = count - 1; p-- > 0;) solution[p] -= elimination_[p] * solution[p + 1];
  return sound;
}

bool TridiagonalSystem::solve(std::size_t count, bool cyclic) noexcept {
  if (!cyclic) return sweep(count, rhs);
  // Sherman-Morrison: the corners are a rank-one change of a tridiagonal matrix.
  const std::size_t last = count - 1;
  const double beta = lower[0];
  const double alpha = upper[last];
  const double gamma = -diagonal[0];
  diagonal[0] -= gamma;
  diagonal[last] -= alpha * beta / gamma;
  for (std::size_t p = 0; p < count; ++p) corner_[p] = 0.0;
  corner_[0] = gamma;
  corner_[last] = alpha;
  bool sound = sweep(count, rhs);
  sound = sweep(count, corner_) && sound;
  const double denominator = 1.0 + corner_[0] + beta * corner_[last] / gamma;
  if (!(std::abs(denominator) > 1e-12)) return false;
  const double share = (rhs[0] + beta * rhs[last] / gamma) / denominator;
  for (std::size_t p = 0; p < count; ++p) rhs[p] -= share * corner_[p];
  return sound;
}

}  // namespace curtain
