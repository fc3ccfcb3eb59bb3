// SPDX-License-Identifier: BSD-3-Clause
//
// Another visitor of fields.h: what the keys of a wind or of a drag say, to be compared.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/fields.h"

namespace curtain {

class KeyValues {
 public:
  template <typename T>
  explicit KeyValues(const T& value) {
    visitFields(*this, value);
  }
  bool operator==(const KeyValues& other) const { return numbers_ == other.numbers_ && texts_ == other.texts_; }

  void number(Key, double value, Range) { numbers_.push_back(value); }
  void flag(Key, bool value) { numbers_.push_back(value ? 1.0 : 0.0); }
  void text(Key, const std::string& value) { texts_.push_back(value); }
  void vector(Key, const Vec3& value, Range) { numbers_.insert(numbers_.end(), {value.x(), value.y(), value.z()}); }
  void optionalVector(Key key, const std::optional<Vec3>& value, Range range) {
    flag(key, value.has_value());
    if (value) vector(key, *value, range);
  }
  void node(Key key, const std::optional<NodeIndex>& value) {
    flag(key, value.has_value());
    if (value) numbers_.insert(numbers_.end(), {static_cast<double>(value->row), static_cast<double>(value->column)});
  }
  template <typename T>
  void list(Key, const std::vector<T>& values) {
    numbers_.push_back(static_cast<double>(values.size()));
    for (const T& value : values) visitFields(*this, value);
  }
  template <typename Enum>
  void choice(Key, Enum value, const std::vector<std::string>&) {
    numbers_.push_back(static_cast<double>(value));
  }

 private:
  std::vector<double> numbers_;
  std::vector<std::string> texts_;
};

}  // namespace curtain
