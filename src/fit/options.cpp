// SPDX-License-Identifier: BSD-3-Clause
#include "fit/options.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "batch/command_line.h"
#include "curtain_sim/scene_yaml.h"
#include "scene/names.h"

namespace curtain_fit {

const char* const kUsage =
    "usage: curtain_fit [SCENE.yaml] [options]\n"
    "What a textile laboratory measured of a fabric, as keys of a scene on stdout. Values have units.\n"
    "  --weight W         mass per area: 183g/m2 or kg/m2\n"
    "  --warp B           bending along the warp: bending length c in mm, cm, m, or rigidity B in gf.cm2/cm (KES-F),\n"
    "                     uN.m (FAST), N.m\n"
    "  --weft B           the same along the weft\n"
    "  --bias B           the same at 45 degrees\n"
    "  --overhang         lengths are overhangs of a cantilever at 41.5 degrees: c is half of them\n"
    "  --bias-sample S    wide or narrow (a strip that is free to twist); default: wide for KES-F, else narrow\n"
    "  --hysteresis H     of bending, 2HB: gf.cm/cm (KES-F) or N\n"
    "  --shear G          shear rigidity: gf/cm.deg (KES-F) or N/m\n"
    "  --thickness T      mm, cm or m\n"
    "  --dc D             Cusick's drape coefficient in %, sample of 30 cm: the computed one is printed beside it; \n"
    "                     without --shear the shear is sought that drapes nearest\n"
    "  --material NAME    a fabric to start from, of cloth.material; or SCENE.yaml: its cloth\n"
    "  --drape            make the drape test of the fabric, and print that alone\n"
    "  --nodes N          along a side of the sample's grid (default 48)\n"
    "  --starts N         how often the test is made, from other starts (default 5)\n"
    "  --version          of the program, then exit\n"
    "exit code: 0; 2 = bad input\n";

namespace {

const std::map<std::string, std::optional<Quantity> Laboratory::*> kQuantities = {
    {"--weight", &Laboratory::weight},
    {"--warp", &Laboratory::warp},
    {"--weft", &Laboratory::weft},
    {"--bias", &Laboratory::bias},
    {"--shear", &Laboratory::shear},
    {"--thickness", &Laboratory::thickness},
    {"--hysteresis", &Laboratory::hysteresis},
};

std::vector<Unit> unitsOf(const std::string& option) {
  if (option == "--weight") return kWeights;
  if (option == "--shear") return kShears;
  if (option == "--thickness") return kLengths;
  if (option == "--hysteresis") return kHystereses;
  std::vector<Unit> units = kLengths;
  units.insert(units.end(), kBendings.begin(), kBendings.end());
  return units;
}

int readCount(const std::string& option, const std::string& text, int least, int most) {
  const double value = curtain_batch::numberOf(text);
  if (!(value >= least && value <= most && value == std::floor(value))) {
    throw std::invalid_argument(option + ": must be a whole number in [" + std::to_string(least) + ", " +
                                std::to_string(most) + "], is '" + text + "'");
  }
  return static_cast<int>(value);
}

BiasSample readSample(const std::string& option, const std::string& text) {
  if (text == "wide") return BiasSample::kWide;
  if (text == "narrow") return BiasSample::kNarrow;
  throw std::invalid_argument(option + ": must be wide or narrow, is '" + text + "'");
}

void check(const Options& options) {
  const Laboratory& laboratory = options.laboratory;
  if (!options.material.empty() && !options.scene.empty())
    throw std::invalid_argument("--material: there is a scene, too; leave one out");
  if (options.drape && options.drape_coefficient)
    throw std::invalid_argument("--dc: is computed beside the keys; leave out --drape");
  if (laboratory.bias_sample && !laboratory.bias)
    throw std::invalid_argument("--bias-sample: of what? it needs --bias");
  bool lengths = false;
  for (const auto* const bending : {&laboratory.warp, &laboratory.weft, &laboratory.bias})
    lengths = lengths || (*bending && isLength(**bending));
  if (laboratory.overhangs && !lengths)
    throw std::invalid_argument("--overhang: of what? no bending is given as a length");
  if (options.drape_coefficient && options.drape_coefficient->value > 1.0)
    throw std::invalid_argument("--dc: must be at most 100%, is '" + options.drape_coefficient->text + "'");
}

curtain::ClothParams clothOf(const std::string& material) {
  const std::vector<std::string>& names = curtain::materialNames();
  const auto found = std::find(names.begin(), names.end(), material);
  if (found == names.end()) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    throw std::invalid_argument("--material: must be one of " + list + "; is '" + material + "'");
  }
  curtain::Scene scene;
  applyMaterial(static_cast<curtain::Material>(found - names.begin()), scene);
  return scene.cloth;
}

// Keys of the fabric alone are a scene, too: rows and columns are not read.
curtain::ClothParams clothOfScene(const std::string& path) {
  curtain::SceneReading reading = curtain::readSceneFile(path);
  std::vector<curtain::Problem>& problems = reading.problems;
  const auto isSize = [](const curtain::Problem& problem) {
    return problem.key == "cloth.rows" || problem.key == "cloth.columns";
  };
  problems.erase(std::remove_if(problems.begin(), problems.end(), isSize), problems.end());
  if (!problems.empty()) throw std::invalid_argument(describe(problems, path));
  return reading.scene.cloth;
}

}  // namespace

Options readOptions(int argc, char** argv) {
  Options options;
  for (int a = 1; a < argc; ++a) {
    const std::string option = argv[a];
    const auto value = [&]() -> std::string {
      if (a + 1 >= argc) throw std::invalid_argument(option + ": needs a value");
      return argv[++a];
    };
    if (const auto quantity = kQuantities.find(option); quantity != kQuantities.end())
      options.laboratory.*(quantity->second) = readQuantity(option, value(), unitsOf(option), option == "--hysteresis");
    else if (option == "--dc")
      options.drape_coefficient = readQuantity(option, value(), kShares, true);
    else if (option == "--overhang")
      options.laboratory.overhangs = true;
    else if (option == "--bias-sample")
      options.laboratory.bias_sample = readSample(option, value());
    else if (option == "--material")
      options.material = value();
    else if (option == "--drape")
      options.drape = true;
    else if (option == "--nodes")
      options.test.nodes = readCount(option, value(), 8, 512);
    else if (option == "--starts")
      options.test.starts = readCount(option, value(), 1, 1000);
    else if (option == "--version")
      options.version = true;
    else if (option == "--help" || option == "-h")
      options.help = true;
    else if (option.size() > 1 && option[0] == '-')
      throw std::invalid_argument(option + ": unknown option");
    else if (!options.scene.empty())
      throw std::invalid_argument(option + ": one scene at a time");
    else
      options.scene = option;
  }
  if (!options.version && !options.help) check(options);
  return options;
}

Preset presetOf(const Options& options) {
  if (!options.material.empty())
    return presetOf(clothOf(options.material), "material " + options.material, options.laboratory);
  if (!options.scene.empty()) return presetOf(clothOfScene(options.scene), options.scene, options.laboratory);
  return presetOf(curtain::ClothParams(), "", options.laboratory);
}

}  // namespace curtain_fit
