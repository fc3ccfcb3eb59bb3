// SPDX-License-Identifier: BSD-3-Clause
#include "parts/air/gust_spectrum.h"

#include <cmath>
#include <complex>
#include <random>
#include <unsupported/Eigen/FFT>

#include "scene/pi.h"

namespace curtain {

double alongSpectrum(GustSpectrum kind, double sigma, double length_scale, double k) {
  const double size = sigma * sigma * 2.0 * length_scale / kPi;
  if (kind == GustSpectrum::kDryden) return size / (1.0 + std::pow(length_scale * k, 2));
  return size / std::pow(1.0 + std::pow(1.339 * length_scale * k, 2), 5.0 / 6.0);
}

double acrossSpectrum(GustSpectrum kind, double sigma, double length_scale, double k) {
  const double size = sigma * sigma * length_scale / kPi;
  if (kind == GustSpectrum::kDryden) {
    const double square = std::pow(length_scale * k, 2);
    return size * (1.0 + 3.0 * square) / std::pow(1.0 + square, 2);
  }
  const double square = std::pow(1.339 * length_scale * k, 2);
  return size * (1.0 + 8.0 / 3.0 * square) / std::pow(1.0 + square, 11.0 / 6.0);
}

GustLine::GustLine(GustSpectrum kind, double sigma, double length_scale, std::uint64_t seed)
    : spacing_(2.0 * kPi * kHarmonics * length_scale / (kFinest * kSamples)), samples_(kSamples) {
  std::mt19937_64 random(seed);
  const double step = kFinest / (kHarmonics * length_scale);
  Eigen::FFT<double> transform;
  std::vector<std::complex<double>> harmonics(kSamples), series;
  for (std::size_t component = 0; component < 3; ++component) {
    const auto spectrum = component == 0 ? alongSpectrum : acrossSpectrum;
    for (int h = 1; h <= kHarmonics; ++h) {
      const double phase = 2.0 * kPi * std::ldexp(static_cast<double>(random() >> 11U), -53);
      const double size = std::sqrt(2.0 * spectrum(kind, sigma, length_scale, h * step) * step);
      harmonics[static_cast<std::size_t>(h)] =
          std::polar(kSamples * size, phase);  // the inverse divides by the samples
    }
    transform.inv(series, harmonics);
    for (std::size_t n = 0; n < samples_.size(); ++n) samples_[n][component] = series[n].real();
  }
}

GustLine::Components GustLine::at(double place) const noexcept {
  const auto towards_zero = static_cast<std::int64_t>(place);  // std::floor() would be a call
  const std::int64_t low = towards_zero - (static_cast<double>(towards_zero) > place ? 1 : 0);
  const double share = place - static_cast<double>(low);
  static_assert((kSamples & (kSamples - 1)) == 0, "the period is cut off by a mask");
  const auto index = static_cast<std::size_t>(low & (kSamples - 1));
  const Components &a = samples_[index], &b = samples_[(index + 1) & (kSamples - 1)];
  return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])};
}

}  // namespace curtain
