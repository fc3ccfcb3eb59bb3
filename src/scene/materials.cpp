// SPDX-License-Identifier: BSD-3-Clause
//
// The table of materials. Where each number comes from, and how sure it is: docs/materials.md, which a test compares
// with this table.
#include <array>

#include "curtain_sim/scene.h"

namespace curtain {
namespace {

struct Properties {
  double density;       // [kg/m^2]
  double bending_warp;  // [N m]
  double bending_weft;  // [N m]
  double bending_bias;  // [N m]
  double shear;         // [N/m]
  double porosity;
  double friction;
  double thickness;  // [m]
};

// In the order of the enum.
constexpr std::array<Properties, 11> kTable = {{
    {0.0673, 1.78e-6, 3.076e-6, 2.331e-6, 40.0, 0.2, 0.5, 0.25e-3},     // cotton_voile
    {0.1834, 6.121e-5, 2.412e-5, 3.04e-5, 40.0, 0.05, 0.5, 0.5e-3},     // linen
    {0.0585, 2.977e-6, 4.967e-6, 6.618e-6, 20.0, 0.02, 0.25, 0.2e-3},   // silk
    {0.0974, 1.138e-6, 1.899e-6, 1.678e-6, 20.0, 0.03, 0.3, 0.2e-3},    // polyester
    {0.4773, 3.278e-5, 2.21e-5, 1.909e-5, 50.0, 0.015, 0.6, 1.5e-3},    // velvet
    {0.3111, 6.067e-5, 4.285e-5, 3.55e-5, 110.0, 0.0, 0.4, 0.5e-3},     // blackout
    {0.1972, 9.183e-6, 7.598e-6, 5.407e-6, 20.0, 0.04, 0.3, 0.35e-3},   // hospital
    {0.14, 2.1e-5, 2.1e-5, 2.1e-5, 110.0, 0.0, 0.4, 0.15e-3},           // shower_peva
    {2.44, 1.3e-2, 1.3e-2, 1.3e-2, 110.0, 0.0, 0.6, 2.0e-3},            // pvc_strip
    {0.3374, 1.89e-4, 3.722e-5, 7.361e-5, 110.0, 0.002, 0.5, 0.7e-3},   // canvas
    {0.0373, 3.367e-7, 2.23e-7, 5.593e-7, 20.0, 0.035, 0.25, 0.076e-3}  // parachute_nylon
}};

// Of a flat plate across the flow: Hoerner, Fluid-Dynamic Drag (1965), Sect. 3.
constexpr double kPlateDrag = 1.17;

// None: the material has no properties.
const Properties* propertiesOf(Material material) {
  return material == Material::kNone ? nullptr : &kTable.at(static_cast<std::size_t>(material) - 1);
}

template <typename Cloth>
void setFabric(const Properties& properties, Cloth& cloth) {
  cloth.surface_density = properties.density;
  cloth.bending_warp = properties.bending_warp;
  cloth.bending_weft = properties.bending_weft;
  cloth.bending_bias = properties.bending_bias;
  cloth.shear = properties.shear;
  cloth.porosity = properties.porosity;
}

// Eq. (4) is linear up to the threshold; there it is the plate's drag, rho / 2 C v^2, and beyond it stays that.
// Relative air has no use for its coefficients.
template <typename Air>
void setDrag(const Properties& properties, const AirParams& law, Air& air) {
  if (law.law == AirLaw::kRelative) return;
  air.inside = air.border = air.corner = 0.5 * kPlateDrag * (1.0 - properties.porosity) * law.threshold;
}

}  // namespace

void applyMaterial(Material material, Scene& scene) {
  scene.cloth.material = material;
  const Properties* const properties = propertiesOf(material);
  if (properties == nullptr) return;
  setFabric(*properties, scene.cloth);
  scene.contact.friction = properties->friction;
  scene.contact.thickness = properties->thickness;
  setDrag(*properties, scene.air, scene.air);
}

void applyMaterial(Material material, const Scene& scene, LayerParams& layer) {
  layer.cloth.material = material;
  const Properties* const properties = propertiesOf(material);
  if (properties == nullptr) return;
  setFabric(*properties, layer.cloth);
  setDrag(*properties, scene.air, layer.air);
}

void applyMaterial(Material material, PatchParams& patch) {
  patch.material = material;
  if (const Properties* const properties = propertiesOf(material)) setFabric(*properties, patch);
}

}  // namespace curtain
