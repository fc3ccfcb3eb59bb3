// SPDX-License-Identifier: BSD-3-Clause
#include "fit/laboratory.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace curtain_fit {
namespace {

constexpr double kGravity = 9.81;  // [m/s^2], where cloth was measured; what differs from place to place is 0.5 %

std::string fourDigits(double value) {
  std::ostringstream text;
  text.precision(4);
  text << value;
  return text.str();
}

// "KES-F, 0.118gf.cm2/cm": a value and what it was measured with.
std::string said(const Quantity& quantity) {
  return (*quantity.unit.method != '\0' ? std::string(quantity.unit.method) + ", " : std::string()) + quantity.text;
}

class Maker {
 public:
  Maker(const curtain::ClothParams& base, const std::string& source, const Laboratory& laboratory)
      : source_(source), laboratory_(laboratory) {
    preset_.cloth = base;
  }

  Preset make() {
    curtain::ClothParams& cloth = preset_.cloth;
    if (source_.empty()) {
      need("--weight", laboratory_.weight);
      need("--warp", laboratory_.warp);
      need("--weft", laboratory_.weft);
    }
    plain("surface_density", cloth.surface_density, laboratory_.weight, "kg/m^2");
    bending("bending_warp", cloth.bending_warp, laboratory_.warp);
    bending("bending_weft", cloth.bending_weft, laboratory_.weft);
    bias();
    plain("bending_hysteresis", cloth.bending_hysteresis, laboratory_.hysteresis, "N");
    plain("shear", cloth.shear, laboratory_.shear, "N/m");
    if (laboratory_.thickness)
      preset_.thickness = {"thickness", laboratory_.thickness->value, "m: " + said(*laboratory_.thickness)};
    noteFriction();
    return std::move(preset_);
  }

 private:
  static void need(const char* option, const std::optional<Quantity>& quantity) {
    if (!quantity)
      throw std::invalid_argument(std::string(option) + " is needed, or a fabric to start from: --material or a scene");
  }

  void add(const char* key, double& to, double value, const std::string& comment) {
    to = value;
    preset_.keys.push_back({key, value, comment});
  }
  // What the base has stays, if it has it.
  void keep(const char* key, double value, const char* unit) {
    if (value > 0.0) preset_.keys.push_back({key, value, std::string(unit) + ": of " + source_});
  }
  void plain(const char* key, double& to, const std::optional<Quantity>& measured, const char* unit) {
    if (measured)
      add(key, to, measured->value, std::string(unit) + ": " + said(*measured));
    else
      keep(key, to, unit);
  }

  // Overhang is twice the bending length where the strip's end is at 41.5 degrees below its edge (Peirce 1930).
  double rigidity(const Quantity& measured) const {
    if (!isLength(measured)) return measured.value;
    return rigidityOf(preset_.cloth.surface_density, laboratory_.overhangs ? 0.5 * measured.value : measured.value);
  }
  std::string comment(const Quantity& measured) const {
    if (!isLength(measured)) return "N m: " + said(measured);
    return "N m: B = w g c^3 with c = " + measured.text + (laboratory_.overhangs ? " / 2" : "");
  }
  void bending(const char* key, double& to, const std::optional<Quantity>& measured) {
    if (measured)
      add(key, to, rigidity(*measured), comment(*measured));
    else
      keep(key, to, "N m");
  }

  void bias() {
    curtain::ClothParams& cloth = preset_.cloth;
    if (!laboratory_.bias) {
      keep("bending_bias", cloth.bending_bias, "N m");
      return;
    }
    const Quantity& measured = *laboratory_.bias;
    const BiasSample sample = laboratory_.bias_sample.value_or(
        std::string(measured.unit.method) == "KES-F" ? BiasSample::kWide : BiasSample::kNarrow);
    const double rigidity_along = rigidity(measured);
    const double twist = twistOf(cloth.bending_warp, cloth.bending_weft, rigidity_along, sample);
    const std::string of = sample == BiasSample::kWide ? "a wide sample" : "a narrow strip";
    if (twist > 0.0 && std::isfinite(twist)) {
      // Wide cloth bent along the bias: B45 = (B_warp + B_weft) / 4 + D_t.
      add("bending_bias", cloth.bending_bias, 0.25 * (cloth.bending_warp + cloth.bending_weft) + twist,
          comment(measured) + " of " + of + ", twist D_t = " + fourDigits(twist) + " N m");
      return;
    }
    cloth.bending_bias = 0.0;
    preset_.notes.push_back("bending along the bias, " + fourDigits(rigidity_along) + " N m of " + of + ", is " +
                            (sample == BiasSample::kWide ? "less than warp and weft alone give"
                                                         : "more than any stiffness to twist gives") +
                            " (D_t = " + fourDigits(twist) + " N m): no stiffness to twist is set");
  }

  void noteFriction() {
    if (!laboratory_.hysteresis) return;
    for (const std::optional<Quantity>* const measured : {&laboratory_.warp, &laboratory_.weft}) {
      if (!*measured) continue;
      if (isLength(**measured) || std::string((*measured)->unit.method) == "FAST") {
        preset_.notes.push_back(
            "a cantilever's bending contains part of the friction: with --hysteresis that counts twice; give B of "
            "KES-F");
        return;
      }
    }
  }

  const std::string& source_;
  const Laboratory& laboratory_;
  Preset preset_;
};

}  // namespace

bool isLength(const Quantity& bending) {
  for (const Unit& unit : kLengths) {
    if (std::string(unit.name) == bending.unit.name) return true;
  }
  return false;
}

double rigidityOf(double weight, double bending_length) { return weight * kGravity * std::pow(bending_length, 3.0); }

double twistOf(double warp, double weft, double bias, BiasSample sample) {
  if (sample == BiasSample::kWide) return bias - 0.25 * (warp + weft);
  // A moment m along the strip is m / 2 along warp and weft and m / 2 of twist. Their energies together are the
  // strip's: 4 / B45 = 1 / B_warp + 1 / B_weft + 1 / D_t.
  return 1.0 / (4.0 / bias - 1.0 / warp - 1.0 / weft);
}

Preset presetOf(const curtain::ClothParams& base, const std::string& source, const Laboratory& laboratory) {
  return Maker(base, source, laboratory).make();
}

}  // namespace curtain_fit
