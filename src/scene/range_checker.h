// SPDX-License-Identifier: BSD-3-Clause
//
// The visitor of fields.h that checks each value by itself; validate.cpp checks them together.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/fields.h"
#include "scene/problem_log.h"

namespace curtain {

/// "[x, y, z]"
std::string formatVector(const Vec3& vector);

class RangeChecker {
 public:
  RangeChecker(std::string key, ProblemLog& log) : prefix_(std::move(key)), log_(log) {}

  void integer(Key key, const int& value, IntRange range);
  void integerOr(Key key, const int& value, IntRange range, const char* word, int word_value);
  void seed(Key, const std::uint64_t&) {}
  void number(Key key, const double& value, Range range);
  void optionalNumber(Key key, const std::optional<double>& value, Range range);
  void numberOrUnset(Key key, const double& value, Range range);
  void flag(Key, const bool&) {}
  void text(Key key, const std::string& value);
  void optionalText(Key key, const std::optional<std::string>& value) {
    if (value) text(key, *value);
  }
  void texts(Key, const std::vector<std::string>&) {}
  void vector(Key key, const Vec3& value, Range range);
  void optionalVector(Key key, const std::optional<Vec3>& value, Range range);
  void scale(Key key, const Vec3& value, Range range) { vector(key, value, range); }
  void rotation(Key key, const Rotation& value);
  void node(Key, const std::optional<NodeIndex>&) {}  // its range depends on the cloth: checkNodeOnGrid()
  void nodes(Key, const std::vector<NodeIndex>&) {}   // the same
  void numbers(Key key, const std::vector<double>& values, Range range);
  void integers(Key key, const std::vector<int>& values, IntRange range);
  void path(Key key, const std::vector<RailPiece>& pieces, Range range);
  void pins(Key, const PinParams&) {}                 // the same
  void slits(Key, const std::vector<SlitParams>&) {}  // the same: checkSlits()
  bool belongs(Key, bool yes, const Chosen& chosen) {
    return yes && log_.good(joinKey(prefix_, chosen.key));  // with an unknown choice nothing is known of its keys
  }

  template <typename Enum>
  void choice(Key key, const Enum& value, const std::vector<std::string>& names) {
    // Only a program can make a value outside of the enum.
    if (static_cast<std::size_t>(value) >= names.size()) log_.add(keyOf(key), "must be " + alternatives(names));
  }

  template <typename T>
  void map(Key key, const T& value) {
    RangeChecker checker(keyOf(key), log_);
    visitFields(checker, value);
  }

  template <typename T>
  void list(Key key, const std::vector<T>& values, const T& = {}) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      RangeChecker checker(itemKey(keyOf(key), i), log_);
      visitFields(checker, values[i]);
    }
  }

 private:
  std::string keyOf(Key key) const { return joinKey(prefix_, key.name); }
  void check(const std::string& key, double value, const Range& range);

  std::string prefix_;
  ProblemLog& log_;
};

}  // namespace curtain
