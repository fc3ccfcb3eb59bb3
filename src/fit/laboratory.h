// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 8: from what a textile laboratory writes down of a fabric to keys of a scene.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "curtain_sim/scene.h"
#include "fit/quantity.h"

namespace curtain_fit {

/// How the sample was held that was bent along the bias.
enum class BiasSample {
  kWide,   ///< wider than long, as KES-F has it: it bends as a cylinder
  kNarrow  ///< a strip longer than wide, as a cantilever's: it is free to twist
};

/// What was measured; what was not has no value.
struct Laboratory {
  std::optional<Quantity> weight;            ///< [kg/m^2]
  std::optional<Quantity> warp, weft, bias;  ///< bending length [m] or bending rigidity [N m], see isLength()
  bool overhangs = false;                    ///< lengths are overhangs, twice the bending lengths
  std::optional<BiasSample> bias_sample;     ///< none: wide where bias is of KES-F, else narrow
  std::optional<Quantity> hysteresis;        ///< 2HB [N]
  std::optional<Quantity> shear;             ///< G [N/m]
  std::optional<Quantity> thickness;         ///< [m]
};

/// A key of the preset, with what its value came from.
struct PresetKey {
  std::string name;
  double value = 0.0;
  std::string comment;
};

/// Keys of a scene that say what fabric it is.
struct Preset {
  curtain::ClothParams cloth;          ///< with these keys
  std::vector<PresetKey> keys;         ///< of `cloth`
  std::optional<PresetKey> thickness;  ///< of `contact`
  std::vector<std::string> notes;      ///< what the reader must know beside
};

/// The base's fabric with what was measured in its place. source: what the base is, in words; empty: it is none, and
/// weight, warp and weft are needed. Throws std::invalid_argument naming the option that is missing.
Preset presetOf(const curtain::ClothParams& base, const std::string& source, const Laboratory& laboratory);

bool isLength(const Quantity& bending);

/// Bending rigidity [N m] of cloth of a weight [kg/m^2] from its bending length [m]: B = w g c^3 (Peirce 1930).
double rigidityOf(double weight, double bending_length);

/// Rigidity against twist D_t [N m] from the bending rigidities along warp, weft and bias [N m]. Below 0, or not
/// finite: no stiffness to twist gives such a rigidity along the bias.
double twistOf(double warp, double weft, double bias, BiasSample sample);

}  // namespace curtain_fit
