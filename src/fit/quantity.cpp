// SPDX-License-Identifier: BSD-3-Clause
#include "fit/quantity.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "batch/command_line.h"
#include "scene/pi.h"

namespace curtain_fit {
namespace {

constexpr double kGramForce = 9.80665e-3;  // [N], by the standard gravity
constexpr double kDegree = curtain::kPi / 180.0;

std::string listOf(const std::vector<Unit>& units) {
  std::string list;
  for (const Unit& unit : units) {
    if (!list.empty()) list += ", ";
    list += unit.name;
    if (*unit.method != '\0') list += std::string(" (") + unit.method + ")";
  }
  return list;
}

}  // namespace

const std::vector<Unit> kWeights = {{"g/m2", 1e-3, ""}, {"kg/m2", 1.0, ""}};
const std::vector<Unit> kLengths = {{"mm", 1e-3, ""}, {"cm", 1e-2, ""}, {"m", 1.0, ""}};
// gf cm^2/cm is a gram force times a centimetre.
const std::vector<Unit> kBendings = {
    {"gf.cm2/cm", kGramForce * 1e-2, "KES-F"}, {"uN.m", 1e-6, "FAST"}, {"N.m", 1.0, ""}};
const std::vector<Unit> kHystereses = {{"gf.cm/cm", kGramForce, "KES-F"}, {"N", 1.0, ""}};
const std::vector<Unit> kShears = {{"gf/cm.deg", kGramForce / (1e-2 * kDegree), "KES-F"}, {"N/m", 1.0, ""}};
const std::vector<Unit> kShares = {{"%", 1e-2, ""}};

Quantity readQuantity(const std::string& option, const std::string& text, const std::vector<Unit>& units,
                      bool zero_too) {
  std::string plain;
  for (const char letter : text) {
    if (letter != ' ' && letter != '^') plain += letter;
  }
  for (const Unit& unit : units) {
    const std::string name = unit.name;
    if (plain.size() <= name.size() || plain.compare(plain.size() - name.size(), name.size(), name) != 0) continue;
    const double number = curtain_batch::numberOf(plain.substr(0, plain.size() - name.size()));
    if (!std::isfinite(number)) continue;
    if (number > 0.0 || (zero_too && number == 0.0)) return {number * unit.si, unit, text};
  }
  throw std::invalid_argument(option + ": must be a number " + (zero_too ? ">= 0" : "> 0") +
                              " and a unit: " + listOf(units) + "; is '" + text + "'");
}

}  // namespace curtain_fit
