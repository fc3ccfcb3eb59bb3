// SPDX-License-Identifier: BSD-3-Clause
#include "scene/ranges.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

namespace curtain {
namespace {

// The classic locale: other locales may have a decimal comma, in printf and strtod too.
std::string print(double value, int digits) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(digits);
  out << value;
  return out.str();
}

double readBack(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  double value = 0.0;
  in >> value;
  // Beyond the largest double the stream clamps; readers would see infinity.
  return in.fail() ? std::numeric_limits<double>::infinity() : value;
}

}  // namespace

bool Range::contains(double value) const {
  if (or_infinite && std::isinf(value) && value > 0.0) return true;
  if (!std::isfinite(value) || value < low || value > high) return false;
  return !(not_zero && std::abs(value) < kSmallest);
}

std::string Range::text() const {
  const std::string sizes = "a number in [" + formatNumber(low) + ", " + formatNumber(high) + "]";
  if (not_zero) return sizes + ", at least " + formatNumber(kSmallest) + " in size";
  return or_infinite ? sizes + " or .inf" : sizes;
}

std::string IntRange::text() const {
  return "an integer in [" + std::to_string(low) + ", " + std::to_string(high) + "]";
}

std::string formatNumber(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0.0 ? ".inf" : "-.inf";
  constexpr int kMaxDigits = std::numeric_limits<double>::max_digits10;
  int digits = 1;
  while (digits < kMaxDigits && readBack(print(value, digits)) != value) ++digits;
  // With more places before the dot than digits, streams print 1e+02, which people don't want to read.
  int places = 1;
  for (double rest = std::abs(value); rest >= 10.0 && places < kMaxDigits; rest /= 10.0) ++places;
  return print(value, places < kMaxDigits ? std::max(digits, places) : digits);
}

std::string formatYamlNumber(double value) {
  std::string text = formatNumber(value);
  if (!std::isfinite(value) || text.find('.') != std::string::npos) return text;
  const std::size_t exponent = text.find('e');
  return exponent == std::string::npos ? text + ".0" : text.insert(exponent, ".0");
}

}  // namespace curtain
