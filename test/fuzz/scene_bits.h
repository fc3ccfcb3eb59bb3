// SPDX-License-Identifier: BSD-3-Clause
//
// All that a scene says as one string of bytes, to compare two of them: a visitor of fields.h, so that no key is left
// out.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "scene/fields.h"

namespace curtain_test {

class SceneBits {
 public:
  using Key = curtain::Key;
  using Range = curtain::Range;
  using IntRange = curtain::IntRange;

  static std::string of(const curtain::Scene& scene) {
    SceneBits bits;
    curtain::visitFields(bits, scene);
    return bits.bytes_;
  }

  void integer(Key, const int& value, IntRange) { add(value); }
  void integerOr(Key, const int& value, IntRange, const char*, int) { add(value); }
  void seed(Key, const std::uint64_t& value) { add(value); }
  void number(Key, const double& value, Range) { add(value); }
  void optionalNumber(Key, const std::optional<double>& value, Range) { addOptional(value); }
  void numberOrUnset(Key, const double& value, Range) { add(value == value ? value : -1.0); }
  void flag(Key, const bool& value) { add(value); }
  void text(Key, const std::string& value) { addText(value); }
  void optionalText(Key, const std::optional<std::string>& value) { addText(value.value_or("")); }
  void vector(Key, const curtain::Vec3& value, Range) { addVector(value); }
  void optionalVector(Key, const std::optional<curtain::Vec3>& value, Range) { addOptional(value); }
  void scale(Key, const curtain::Vec3& value, Range) { addVector(value); }
  void rotation(Key, const curtain::Rotation& value) {
    for (int i = 0; i < 4; ++i) add(value.coeffs()[i]);
  }
  void node(Key, const std::optional<curtain::NodeIndex>& value) { addOptional(value); }
  void nodes(Key, const std::vector<curtain::NodeIndex>& values) {
    add(values.size());
    for (const curtain::NodeIndex& node : values) addOne(node);
  }
  void numbers(Key, const std::vector<double>& values, Range) {
    add(values.size());
    for (const double value : values) add(value);
  }
  void integers(Key, const std::vector<int>& values, IntRange) {
    add(values.size());
    for (const int value : values) add(value);
  }
  void path(Key, const std::vector<curtain::RailPiece>& pieces, Range) {
    add(pieces.size());
    for (const curtain::RailPiece& piece : pieces) {
      addVector(piece.to);
      addOptional(piece.centre);
    }
  }
  void pins(Key, const curtain::PinParams& value) {
    add(value.kind);
    nodes("nodes", value.nodes);
  }
  void slits(Key, const std::vector<curtain::SlitParams>& values) {
    add(values.size());
    for (const curtain::SlitParams& slit : values) {
      add(slit.column);
      add(slit.from_row);
    }
  }
  bool belongs(Key, bool yes, const curtain::Chosen&) { return yes; }

  template <typename Enum>
  void choice(Key, const Enum& value, const std::vector<std::string>&) {
    add(value);
  }

  template <typename T>
  void map(Key, const T& value) {
    curtain::visitFields(*this, value);
  }

  template <typename T>
  void list(Key, const std::vector<T>& values, const T& = {}) {
    add(values.size());
    for (const T& value : values) curtain::visitFields(*this, value);
  }

 private:
  template <typename T>
  void add(const T& value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    bytes_.append(bytes, sizeof value);
  }
  void addText(const std::string& value) {
    add(value.size());
    bytes_ += value;
  }
  void addVector(const curtain::Vec3& value) {
    for (int i = 0; i < 3; ++i) add(value[i]);
  }
  void addOne(double value) { add(value); }
  void addOne(const curtain::Vec3& value) { addVector(value); }
  void addOne(const curtain::NodeIndex& value) {
    add(value.row);
    add(value.column);
  }
  template <typename T>
  void addOptional(const std::optional<T>& value) {
    add(value.has_value());
    if (value) addOne(*value);
  }

  std::string bytes_;
};

}  // namespace curtain_test
