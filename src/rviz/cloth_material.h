// SPDX-License-Identifier: BSD-3-Clause
//
// How the cloth looks: a material with a shader of ours (GLSL 1.20, which rviz's own point clouds need too), the
// fabric's texture and the scale of colours of the layers.
#pragma once

#include <OgreMaterial.h>
#include <OgreTexture.h>

#include <string>

#include "rviz/surface/fabric.h"

namespace curtain_rviz {

/// What the user chooses.
struct ClothAppearance {
  Pattern pattern = Pattern::kNone;
  Colour ground{}, figure{};
  float repeat = 0.25F;       ///< of the pattern [m], > 0
  float sheen = 0.0F;         ///< in [0, 1], light that grazes the fibres
  float translucency = 0.0F;  ///< in [0, 1], light that comes through
};

/// GUI thread only; as long as rviz's render system lives.
class ClothMaterial {
 public:
  /// name: unlike that of any other resource in rviz. Throws std::exception where this computer's OpenGL can't draw it.
  explicit ClothMaterial(const std::string& name);
  ~ClothMaterial();
  ClothMaterial(const ClothMaterial&) = delete;
  ClothMaterial& operator=(const ClothMaterial&) = delete;

  const Ogre::MaterialPtr& material() const { return material_; }

  void setAppearance(const ClothAppearance& appearance);
  /// range: of the vertices' values that the colours are for, > 0; 0: the fabric itself is shown.
  void setLayerRange(double range);

 private:
  Ogre::GpuProgramParametersSharedPtr lighting() const;

  std::string name_;
  Ogre::MaterialPtr material_;
  Ogre::TexturePtr fabric_, scale_;
  ClothAppearance drawn_;  // in the texture
  bool has_fabric_ = false;
};

}  // namespace curtain_rviz
