// SPDX-License-Identifier: BSD-3-Clause
//
// Gusts have the spectra that MIL-F-8785C prints, and travel with the wind.
#include "parts/air/ambient_wind.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::kPi;

constexpr double kSigma = 0.8, kLength = 3.0;

class Gusts : public ::testing::TestWithParam<GustSpectrum> {};
INSTANTIATE_TEST_SUITE_P(Spectra, Gusts, ::testing::Values(GustSpectrum::kVonKarman, GustSpectrum::kDryden));

// Substitution k = tan(a) / L: the whole axis in one finite integral.
template <typename Spectrum>
double variance(const Spectrum& spectrum, GustSpectrum kind) {
  constexpr int kParts = 200000;
  double sum = 0.0;
  for (int n = 0; n < kParts; ++n) {
    const double a = 0.5 * kPi * (n + 0.5) / kParts;
    sum += spectrum(kind, kSigma, kLength, std::tan(a) / kLength) / (kLength * std::cos(a) * std::cos(a));
  }
  return sum * 0.5 * kPi / kParts;
}

// The 1.339 of von Karman's spectra is rounded; and the midpoint rule leaves a part of its tail k^(-5/3).
TEST_P(Gusts, SpectraHoldTheVariance) {
  EXPECT_NEAR(variance(alongSpectrum, GetParam()) / (kSigma * kSigma), 1.0, 2e-3);
  EXPECT_NEAR(variance(acrossSpectrum, GetParam()) / (kSigma * kSigma), 1.0, 2e-3);
}

// Longitudinal and transverse spectra of isotropic turbulence belong together: 2 across = along - k d(along)/dk.
TEST_P(Gusts, SpectraAreIsotropic) {
  for (const double k : {0.01, 0.1, 0.3, 1.0, 4.0}) {
    const auto along = [&](double at) { return alongSpectrum(GetParam(), kSigma, kLength, at); };
    const double slope = (along(k * 1.0001) - along(k * 0.9999)) / (2e-4 * k);
    const double across = acrossSpectrum(GetParam(), kSigma, kLength, k);
    EXPECT_NEAR(0.5 * (along(k) - k * slope), across, 1e-6 * across) << k;
  }
}

AmbientParams gustyWind(GustSpectrum spectrum, std::uint64_t seed = 1) {
  AmbientParams params;
  params.velocity = Vec3(3.0, 0.0, 4.0);
  params.intensity = kSigma / 5.0;
  params.length_scale = kLength;
  params.spectrum = spectrum;
  params.seed = seed;
  return params;
}

// What an anemometer at rest measures in bands of frequency, against the formula. It samples for one period, so its
// harmonics are the gusts' own; each band holds at least 16 of them, with amplitudes that do not scatter. Left are the
// interpolation between samples, a factor sinc^4 >= 0.9 at the highest k, and the spectrum's bend within a band.
TEST_P(Gusts, AnemometerMeasuresTheSpectrum) {
  const AmbientParams params = gustyWind(GetParam());
  const AmbientWind wind(params);
  const double period = 2.0 * kPi * GustLine::kHarmonics * kLength / GustLine::kFinest / 5.0;  // [s]
  const int samples = 4 * GustLine::kHarmonics;
  const Vec3 place(0.3, -2.0, 1.1), along = params.velocity / 5.0, side = Vec3::UnitY();
  std::vector<double> u, v;
  for (int n = 0; n < samples; ++n) {
    const Vec3 gust = wind.at(place, period * n / samples) - params.velocity;
    u.push_back(gust.dot(along));
    v.push_back(gust.dot(side));
  }
  const auto power = [&](const std::vector<double>& series, int harmonic) {  // of k, one-sided
    const std::complex<double> turn = std::polar(1.0, -2.0 * kPi * harmonic / samples);
    std::complex<double> sum = 0.0, phase = 1.0;
    for (const double value : series) {
      sum += value * phase;
      phase *= turn;
    }
    const double step = GustLine::kFinest / (GustLine::kHarmonics * kLength);
    return 2.0 * std::norm(sum / static_cast<double>(samples)) / step;
  };
  for (const int first : {16, 64, 256, 1024, 3000}) {
    double sum_u = 0.0, sum_v = 0.0, expected_u = 0.0, expected_v = 0.0;
    for (int harmonic = first; harmonic < first + 16; ++harmonic) {
      const double k = harmonic * GustLine::kFinest / (GustLine::kHarmonics * kLength);
      sum_u += power(u, harmonic);
      sum_v += power(v, harmonic);
      expected_u += alongSpectrum(GetParam(), kSigma, kLength, k);
      expected_v += acrossSpectrum(GetParam(), kSigma, kLength, k);
    }
    EXPECT_NEAR(sum_u / expected_u, 1.0, 0.1) << first;
    EXPECT_NEAR(sum_v / expected_v, 1.0, 0.1) << first;
  }
}

// The table ends at k = 100 / L: 2.7 % (across: 3.6 %) of von Karman's variance lies beyond, and 0.8 % below the first
// harmonic.
TEST_P(Gusts, AnemometerMeasuresTheVariance) {
  const AmbientWind wind(gustyWind(GetParam(), 9));
  const double period = 2.0 * kPi * GustLine::kHarmonics * kLength / GustLine::kFinest / 5.0;
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
  const int samples = 30000;
  for (int n = 0; n < samples; ++n) {
    const Vec3 gust = wind.at(Vec3::Zero(), period * n / samples) - Vec3(3.0, 0.0, 4.0);
    sum += gust;
    squares += gust.cwiseAbs2();
  }
  EXPECT_LT((sum / samples).norm(), 1e-3) << "the mean is the wind's";
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(std::sqrt(squares[axis] / samples) / kSigma, 1.0, 0.03) << axis;
  }
}

TEST_P(Gusts, TravelWithTheWind) {
  const AmbientWind wind(gustyWind(GetParam()));
  const Vec3 place(0.2, 1.0, -0.7), velocity(3.0, 0.0, 4.0);
  for (const double delay : {0.01, 0.5, 20.0}) {
    const Vec3 now = wind.at(place, 2.0), later = wind.at(place + delay * velocity, 2.0 + delay);
    EXPECT_LT((now - later).norm(), 1e-9) << delay;
    EXPECT_GT((now - wind.at(place, 2.0 + delay)).norm(), 1e-4) << delay;
  }
  EXPECT_LT((wind.at(place, 2.0) - wind.at(place + Vec3(0.0, 5.0, 0.0), 2.0)).norm(), 1e-9) << "alike across it";
}

TEST_P(Gusts, FollowTheSeed) {
  const AmbientWind one(gustyWind(GetParam(), 1)), again(gustyWind(GetParam(), 1)), other(gustyWind(GetParam(), 2));
  EXPECT_EQ(one.at(Vec3::Zero(), 3.3), again.at(Vec3::Zero(), 3.3));
  EXPECT_NE(one.at(Vec3::Zero(), 3.3), other.at(Vec3::Zero(), 3.3));
}

TEST(AmbientWind, IsSteadyWithoutIntensityAndFiniteFarAway) {
  AmbientParams params = gustyWind(GustSpectrum::kDryden);
  const AmbientWind gusty(params);
  EXPECT_TRUE(gusty.at(Vec3(1e9, -1e9, 1e9), 1e12).allFinite());
  params.intensity = 0.0;
  const AmbientWind steady(params);
  EXPECT_FALSE(steady.gusty());
  EXPECT_EQ(steady.at(Vec3(1.0, 2.0, 3.0), 4.0), params.velocity);
  EXPECT_TRUE(AmbientWind(AmbientParams()).still());
}

}  // namespace
}  // namespace curtain
