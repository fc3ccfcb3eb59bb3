// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/cloth_material.h"

#include <OgreHardwarePixelBuffer.h>
#include <OgreHighLevelGpuProgram.h>
#include <OgreHighLevelGpuProgramManager.h>
#include <OgreMaterialManager.h>
#include <OgrePass.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>

#include <stdexcept>

#include "rviz/cloth_shader.h"

namespace curtain_rviz {
namespace {

const Ogre::String& kMaterialGroup = Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME;
constexpr std::size_t kScaleSize = 256;

void makeProgram(const std::string& name, Ogre::GpuProgramType type, const char* source) {
  const auto program =
      Ogre::HighLevelGpuProgramManager::getSingleton().createProgram(name, kMaterialGroup, "glsl", type);
  program->setSource(source);
  program->load();
  if (!program->isSupported()) throw std::runtime_error("its GLSL does not take the display's shader");
}

Ogre::TexturePtr makeTexture(const std::string& name, std::size_t width, std::size_t height, int mip_maps) {
  return Ogre::TextureManager::getSingleton().createManual(
      name, kMaterialGroup, Ogre::TEX_TYPE_2D, static_cast<Ogre::uint>(width), static_cast<Ogre::uint>(height),
      mip_maps, Ogre::PF_BYTE_RGBA,
      mip_maps > 0 ? Ogre::TU_STATIC_WRITE_ONLY | Ogre::TU_AUTOMIPMAP : Ogre::TU_STATIC_WRITE_ONLY);
}

void fillTexture(const Ogre::TexturePtr& texture, std::vector<std::uint8_t>& rgba) {
  const Ogre::PixelBox pixels(texture->getWidth(), texture->getHeight(), 1, Ogre::PF_BYTE_RGBA, rgba.data());
  texture->getBuffer()->blitFromMemory(pixels);
}

}  // namespace

ClothMaterial::ClothMaterial(const std::string& name) : name_(name) {
  makeProgram(name + "/vertex", Ogre::GPT_VERTEX_PROGRAM, kVertexShader);
  makeProgram(name + "/fragment", Ogre::GPT_FRAGMENT_PROGRAM, kFragmentShader);
  material_ = Ogre::MaterialManager::getSingleton().create(name, kMaterialGroup);
  Ogre::Pass* const pass = material_->getTechnique(0)->getPass(0);
  pass->setCullingMode(Ogre::CULL_NONE);
  pass->setManualCullingMode(Ogre::MANUAL_CULL_NONE);
  pass->setVertexProgram(name + "/vertex");
  pass->setFragmentProgram(name + "/fragment");
  lighting()->setNamedAutoConstant("world_view_projection", Ogre::GpuProgramParameters::ACT_WORLDVIEWPROJ_MATRIX);
  lighting()->setNamedAutoConstant("world_view", Ogre::GpuProgramParameters::ACT_WORLDVIEW_MATRIX);
  lighting()->setNamedAutoConstant("view", Ogre::GpuProgramParameters::ACT_VIEW_MATRIX);
  const auto pixels = pass->getFragmentProgramParameters();
  pixels->setNamedAutoConstant("upright", Ogre::GpuProgramParameters::ACT_RENDER_TARGET_FLIPPING);
  pixels->setNamedConstant("colours", 0);

  fabric_ = makeTexture(name + "/fabric", kFabricSize, kFabricSize, Ogre::MIP_UNLIMITED);
  scale_ = makeTexture(name + "/scale", kScaleSize, 1, 0);
  std::vector<std::uint8_t> colours;
  for (std::size_t i = 0; i < kScaleSize; ++i) {
    for (const float part : scaleColour(static_cast<double>(i) / (kScaleSize - 1)))
      colours.push_back(static_cast<std::uint8_t>(255.0F * part + 0.5F));
    colours.push_back(255);
  }
  fillTexture(scale_, colours);
  pass->createTextureUnitState(fabric_->getName());
  setLayerRange(0.0);
}

ClothMaterial::~ClothMaterial() {
  Ogre::MaterialManager::getSingleton().remove(material_);
  Ogre::TextureManager::getSingleton().remove(fabric_);
  Ogre::TextureManager::getSingleton().remove(scale_);
  Ogre::HighLevelGpuProgramManager::getSingleton().remove(name_ + "/vertex", kMaterialGroup);
  Ogre::HighLevelGpuProgramManager::getSingleton().remove(name_ + "/fragment", kMaterialGroup);
}

Ogre::GpuProgramParametersSharedPtr ClothMaterial::lighting() const {
  return material_->getTechnique(0)->getPass(0)->getVertexProgramParameters();
}

void ClothMaterial::setAppearance(const ClothAppearance& appearance) {
  const bool same = has_fabric_ && appearance.pattern == drawn_.pattern && appearance.ground == drawn_.ground &&
                    appearance.figure == drawn_.figure;
  if (!same) {
    Pixels pixels = drawFabric(appearance.pattern, appearance.ground, appearance.figure);
    fillTexture(fabric_, pixels.rgba);
    has_fabric_ = true;
  }
  drawn_ = appearance;
  lighting()->setNamedConstant("repeats_per_metre", 1.0F / appearance.repeat);
  lighting()->setNamedConstant("sheen", appearance.sheen);
  lighting()->setNamedConstant("translucency", appearance.translucency);
}

void ClothMaterial::setLayerRange(double range) {
  const bool layer = range > 0.0;
  material_->getTechnique(0)->getPass(0)->getTextureUnitState(0)->setTexture(layer ? scale_ : fabric_);
  lighting()->setNamedConstant("ranges_per_value", layer ? static_cast<Ogre::Real>(1.0 / range) : 0.0F);
}

}  // namespace curtain_rviz
