// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 8: numbers with the units of textile tables.
#pragma once

#include <string>
#include <vector>

namespace curtain_fit {

/// A unit that an option knows.
struct Unit {
  const char* name;    ///< as it is written behind a number: "g/m2"
  double si;           ///< one of it in SI units
  const char* method;  ///< what is measured in it: "KES-F", or "" where that says nothing
};

/// A number as somebody wrote it.
struct Quantity {
  double value = 0.0;  ///< in SI units
  Unit unit{};         ///< that it was written in
  std::string text;    ///< as it was written
};

/// Reads NUMBER and a unit of a list, "183g/m2"; blanks and ^ do not count. Throws std::invalid_argument naming the
/// option unless the number is finite and > 0, or >= 0 where zero is allowed, and the unit is of the list.
Quantity readQuantity(const std::string& option, const std::string& text, const std::vector<Unit>& units,
                      bool zero_too = false);

// What fabrics are measured in, by what is measured.
extern const std::vector<Unit> kWeights;     ///< mass per area [kg/m^2]
extern const std::vector<Unit> kLengths;     ///< [m]
extern const std::vector<Unit> kBendings;    ///< bending rigidity per width [N m]
extern const std::vector<Unit> kHystereses;  ///< of bending, moment per width [N]
extern const std::vector<Unit> kShears;      ///< shear rigidity, force per width and angle [N/m]
extern const std::vector<Unit> kShares;      ///< [1]

}  // namespace curtain_fit
