// SPDX-License-Identifier: BSD-3-Clause
//
// Where random values come from: a fuzzer's bytes, or a seeded generator.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <utility>

#include "curtain_sim/scene.h"

namespace curtain_test {

class Choices {
 public:
  virtual ~Choices() = default;

  /// A number in [0, count), count >= 1.
  virtual std::uint64_t below(std::uint64_t count) = 0;
  /// A number in [0, 1).
  virtual double share() = 0;

  bool oneIn(std::uint64_t count) { return below(count) == 0; }
  bool chance(double of) { return share() < of; }
  double between(double low, double high) { return low + (high - low) * share(); }
  /// Evenly in the logarithm.
  double magnitude(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  /// Both ends belong to it.
  int integer(int low, int high) { return low + static_cast<int>(share() * (high - low + 1)); }
  curtain::Vec3 inBox(double half_edge) {
    const double x = between(-half_edge, half_edge);
    const double y = between(-half_edge, half_edge);
    return {x, y, between(-half_edge, half_edge)};
  }
  curtain::Vec3 direction() {
    for (int tries = 0; tries < 1000; ++tries) {  // bytes are used up one day
      const curtain::Vec3 v = inBox(1.0);
      if (v.norm() > 0.1 && v.norm() <= 1.0) return v.normalized();
    }
    return curtain::Vec3::UnitZ();
  }
};

/// Every choice takes as many bytes as it needs; when they are used up, all choices are 0.
class ByteChoices final : public Choices {
 public:
  explicit ByteChoices(std::string bytes) : bytes_(std::move(bytes)) {}

  std::uint64_t below(std::uint64_t count) override {
    std::uint64_t value = 0;
    for (std::uint64_t most = count - 1; most > 0; most >>= 8U) value = value << 8U | next();
    return value % count;
  }
  double share() override { return static_cast<double>(below(65536)) * 0x1.0p-16; }

 private:
  std::uint64_t next() { return at_ < bytes_.size() ? static_cast<unsigned char>(bytes_[at_++]) : 0U; }

  std::string bytes_;
  std::size_t at_ = 0;
};

/// From the bits of std::mt19937_64, which the standard fixes (its distributions it does not).
class Random final : public Choices {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  std::uint64_t below(std::uint64_t count) override { return bits_() % count; }
  double share() override { return static_cast<double>(bits_() >> 11U) * 0x1.0p-53; }

 private:
  std::mt19937_64 bits_;
};

}  // namespace curtain_test
