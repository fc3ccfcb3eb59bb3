// SPDX-License-Identifier: BSD-3-Clause
#include "fit/report.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace curtain_fit {
namespace {

// Six digits: more than anything of a fabric is known by.
std::string sixDigits(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

void write(const PresetKey& key, std::ostringstream& out) {
  out << "  " << key.name << ": " << sixDigits(key.value) << "  # " << key.comment << '\n';
}

}  // namespace

std::string percent(double share) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << 100.0 * share;
  return text.str();
}

std::string yamlOf(const Preset& preset) {
  std::ostringstream out;
  out << "cloth:\n";
  for (const PresetKey& key : preset.keys) write(key, out);
  if (preset.thickness) {
    out << "contact:\n";
    write(*preset.thickness, out);
  }
  for (const std::string& note : preset.notes) out << "# " << note << '\n';
  return out.str();
}

std::string describe(const std::vector<DrapeReading>& readings, int nodes) {
  const DrapeSummary summary = summaryOf(readings);
  const auto moving = std::count_if(readings.begin(), readings.end(), [](const DrapeReading& r) { return !r.at_rest; });
  std::ostringstream out;
  out << percent(summary.mean) << " % +- " << percent(summary.spread) << ", " << sixDigits(summary.folds) << " folds ("
      << readings.size() << " starts, " << nodes << " x " << nodes << " nodes";
  if (moving > 0) out << ", " << moving << " not at rest";
  out << ")";
  return out.str();
}

std::string yamlOf(const std::vector<DrapeReading>& readings, int nodes) {
  const DrapeSummary summary = summaryOf(readings);
  std::ostringstream out;
  out << "nodes: " << nodes << "\ncoefficient: " << percent(summary.mean)
      << "  # %, mean of the starts\nspread: " << percent(summary.spread)
      << "  # standard deviation\nfolds: " << sixDigits(summary.folds)
      << "\nstarts:  # rim's height where it meets the warp and weft through the middle, and time until it is at "
         "rest\n";
  for (const DrapeReading& reading : readings) {
    out << "  - {coefficient: " << percent(reading.coefficient) << ", folds: " << reading.folds << std::fixed
        << std::setprecision(1) << ", warp_mm: " << 1e3 * reading.warp_height
        << ", weft_mm: " << 1e3 * reading.weft_height << ", seconds: " << reading.seconds
        << ", at_rest: " << (reading.at_rest ? "true" : "false") << "}\n";
  }
  return out.str();
}

}  // namespace curtain_fit
