// SPDX-License-Identifier: BSD-3-Clause
#include "scene/range_checker.h"

#include <cmath>

#include "scene/orientation.h"

namespace curtain {

std::string formatVector(const Vec3& vector) {
  return "[" + formatNumber(vector.x()) + ", " + formatNumber(vector.y()) + ", " + formatNumber(vector.z()) + "]";
}

void RangeChecker::check(const std::string& key, double value, const Range& range) {
  if (!range.contains(value)) log_.add(key, "must be " + range.text() + ", is " + formatNumber(value));
}

void RangeChecker::integer(Key key, const int& value, IntRange range) {
  if (!range.contains(value)) log_.add(keyOf(key), "must be " + range.text() + ", is " + std::to_string(value));
}

void RangeChecker::integerOr(Key key, const int& value, IntRange range, const char* word, int word_value) {
  if (value == word_value || range.contains(value)) return;
  log_.add(keyOf(key), "must be " + std::string(word) + " or " + range.text() + ", is " + std::to_string(value));
}

void RangeChecker::number(Key key, const double& value, Range range) { check(keyOf(key), value, range); }

void RangeChecker::optionalNumber(Key key, const std::optional<double>& value, Range range) {
  if (value) check(keyOf(key), *value, range);
}

void RangeChecker::numberOrUnset(Key key, const double& value, Range range) {
  if (!std::isnan(value)) check(keyOf(key), value, range);
}

void RangeChecker::text(Key key, const std::string& value) {
  if (value.empty()) log_.add(keyOf(key), "must be text that is not empty");
}

void RangeChecker::vector(Key key, const Vec3& value, Range range) {
  for (std::size_t i = 0; i < 3; ++i) check(itemKey(keyOf(key), i), value[static_cast<Eigen::Index>(i)], range);
}

void RangeChecker::optionalVector(Key key, const std::optional<Vec3>& value, Range range) {
  if (value) vector(key, *value, range);
}

void RangeChecker::rotation(Key key, const Rotation& value) {
  if (isNearlyUnit(value)) return;
  log_.add(keyOf(key), "must be a unit quaternion [x, y, z, w] (norm within 0.001 of 1), is [" +
                           formatNumber(value.x()) + ", " + formatNumber(value.y()) + ", " + formatNumber(value.z()) +
                           ", " + formatNumber(value.w()) + "] (norm " + formatNumber(value.norm()) + ")");
}

void RangeChecker::numbers(Key key, const std::vector<double>& values, Range range) {
  for (std::size_t i = 0; i < values.size(); ++i) check(itemKey(keyOf(key), i), values[i], range);
}

void RangeChecker::integers(Key key, const std::vector<int>& values, IntRange range) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (range.contains(values[i])) continue;
    log_.add(itemKey(keyOf(key), i), "must be " + range.text() + ", is " + std::to_string(values[i]));
  }
}

void RangeChecker::path(Key key, const std::vector<RailPiece>& pieces, Range range) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    RangeChecker piece(itemKey(keyOf(key), i), log_);
    piece.vector("to", pieces[i].to, range);
    if (pieces[i].centre) piece.vector("centre", *pieces[i].centre, range);
  }
}

}  // namespace curtain
