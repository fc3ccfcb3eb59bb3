// SPDX-License-Identifier: BSD-3-Clause
//
// Where the values of a made-up scene come from: a fuzzer's bytes, or a seeded generator.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <utility>

namespace curtain_test {

class Choices {
 public:
  virtual ~Choices() = default;

  /// A number in [0, count), count >= 1.
  virtual std::uint64_t below(std::uint64_t count) = 0;

  bool oneIn(std::uint64_t count) { return below(count) == 0; }
  /// A number in [0, 1), in steps of 2^-16.
  double share() { return static_cast<double>(below(65536)) * 0x1.0p-16; }
  double between(double low, double high) { return low + (high - low) * share(); }
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

 private:
  std::uint64_t next() { return at_ < bytes_.size() ? static_cast<unsigned char>(bytes_[at_++]) : 0U; }

  std::string bytes_;
  std::size_t at_ = 0;
};

/// From the bits of std::mt19937_64, which are the same everywhere.
class SeededChoices final : public Choices {
 public:
  explicit SeededChoices(std::uint64_t seed) : bits_(seed) {}
  std::uint64_t below(std::uint64_t count) override { return bits_() % count; }

 private:
  std::mt19937_64 bits_;
};

}  // namespace curtain_test
