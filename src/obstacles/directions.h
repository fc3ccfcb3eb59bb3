// SPDX-License-Identifier: BSD-3-Clause
//
// Directions of vectors that may be zero. Vectors are scaled before they are squared, so no finite input over- or
// underflows to NaN.
#pragma once

namespace curtain {

/// Unit vector along v and its length; the fallback for v = 0.
template <typename Vector>
Vector unitOr(const Vector& v, const Vector& fallback, double& length) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) {
    length = 0.0;
    return fallback;
  }
  const Vector scaled = v / largest;
  const double norm = scaled.norm();
  length = largest * norm;
  return scaled / norm;
}

/// Unit vector along v and its length; for v = 0 along `beside`, if that has a direction.
template <typename Vector>
Vector unitBeside(const Vector& v, const Vector& beside, const Vector& fallback, double& length) {
  Vector unit = unitOr<Vector>(v, fallback, length);
  if (length > 0.0) return unit;
  double far = 0.0;
  return unitOr<Vector>(beside, fallback, far);
}

inline double signOf(double x) { return x < 0.0 ? -1.0 : 1.0; }

/// Sign of x; for 0 that of `beside`.
inline double sideOf(double x, double beside) { return signOf(x != 0.0 ? x : beside); }

}  // namespace curtain
