// SPDX-License-Identifier: BSD-3-Clause
//
// curtain_fit: a scene's fabric from what a textile laboratory measured, and the drape test of it.
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "fit/options.h"
#include "fit/report.h"
#include "fit/shear_search.h"

namespace {

using curtain_fit::DrapeReading;
using curtain_fit::Options;
using curtain_fit::Preset;

constexpr int kBadInput = 2;

// The computed coefficient beside the measured one. Without a measured shear, the one that drapes nearest.
void compare(const Options& options, Preset& preset) {
  const curtain_fit::Quantity& measured = *options.drape_coefficient;
  std::vector<DrapeReading> readings;
  if (options.laboratory.shear) {
    readings = drape(preset.cloth, options.test);
  } else {
    const curtain_fit::ShearFound found = findShear(preset.cloth, measured.value, options.test);
    preset.cloth.shear = found.shear;
    const auto old = [](const curtain_fit::PresetKey& key) { return key.name == "shear"; };
    preset.keys.erase(std::remove_if(preset.keys.begin(), preset.keys.end(), old), preset.keys.end());
    preset.keys.push_back({"shear", found.shear, "N/m: of 17 to 110 the one that drapes nearest to " + measured.text});
    readings = found.readings;
  }
  const double off = summaryOf(readings).mean - measured.value;
  preset.notes.push_back("drape coefficient: measured " + measured.text + ", computed " +
                         describe(readings, options.test.nodes) + ": off by " + curtain_fit::percent(off));
}

int answer(const Options& options) {
  if (options.help) {
    std::cout << curtain_fit::kUsage;
    return EXIT_SUCCESS;
  }
  if (options.version) {
    std::cout << "curtain_fit " CURTAIN_VERSION "\n";
    return EXIT_SUCCESS;
  }
  Preset preset = presetOf(options);
  if (options.drape) {
    std::cout << yamlOf(drape(preset.cloth, options.test), options.test.nodes);
    return EXIT_SUCCESS;
  }
  if (options.drape_coefficient) compare(options, preset);
  std::cout << yamlOf(preset);
  for (const std::string& note : preset.notes) std::cerr << "curtain_fit: " << note << '\n';
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return answer(curtain_fit::readOptions(argc, argv));
  } catch (const std::exception& error) {
    std::cerr << "curtain_fit: " << error.what() << '\n';
    return kBadInput;
  }
}
