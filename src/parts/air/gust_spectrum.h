// SPDX-License-Identifier: BSD-3-Clause
//
// A gust along a line: a stationary random velocity with a given spectrum, as a periodic table. It is the sum of
// harmonics with the spectrum's amplitudes and random phases (Shinozuka, Deodatis 1991).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// One-sided spectra of a component of the gusts by the angle per length k [rad/m]; their integral over k is the
/// square of sigma [m/s]. MIL-F-8785C, Sect. 3.7.1, with one sigma and one L for all components, as it has them at
/// medium altitude (3.7.2).
double alongSpectrum(GustSpectrum kind, double sigma, double length_scale, double k);   ///< along the mean wind
double acrossSpectrum(GustSpectrum kind, double sigma, double length_scale, double k);  ///< each of the others

class GustLine {
 public:
  /// Harmonics have the spectrum's content up to k = kFinest / L: 97 % of the variance, Dryden's 99 %.
  static constexpr double kFinest = 100.0;
  static constexpr int kHarmonics = 4096;
  static constexpr int kSamples = 8 * kHarmonics;

  GustLine(GustSpectrum kind, double sigma, double length_scale, std::uint64_t seed);

  /// Length after which it repeats [m]: 257 length scales.
  double period() const noexcept { return kSamples * spacing_; }
  double spacing() const noexcept { return spacing_; }

  /// Along the mean wind and in two directions across it [m/s].
  using Components = std::array<double, 3>;
  /// At a place in units of spacing(), |place| < 2^62.
  Components at(double place) const noexcept;

 private:
  double spacing_;  // between samples [m]
  std::vector<Components> samples_;
};

}  // namespace curtain
