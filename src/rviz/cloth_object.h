// SPDX-License-Identifier: BSD-3-Clause
//
// The cloth in Ogre's scene: hardware buffers that are written in place, and an index buffer that stays as it is as
// long as the cloth is the same.
#pragma once

#include <OgreSimpleRenderable.h>

#include <vector>

#include "rviz/surface/curtain_surface.h"

namespace curtain_rviz {

/// GUI thread only.
class ClothObject : public Ogre::SimpleRenderable {
 public:
  explicit ClothObject(const Ogre::MaterialPtr& material);
  ~ClothObject() override;

  /// New buffers for another cloth.
  void setCloth(const CurtainSurface& surface);
  /// The present vertices of that cloth.
  void move(const CurtainSurface& surface);
  /// The vertices' values, for the layers' colours.
  void setValues(const std::vector<float>& values);

  Ogre::Real getBoundingRadius() const override { return radius_; }
  Ogre::Real getSquaredViewDepth(const Ogre::Camera* camera) const override;

 private:
  // Sources of the vertex declaration.
  enum Source : unsigned short { kMoving, kCoordinates, kValues };

  Ogre::HardwareVertexBufferSharedPtr buffer(Source source) const;

  Ogre::VertexData vertices_;
  Ogre::IndexData indices_;
  Ogre::Real radius_ = 0.0F;
};

}  // namespace curtain_rviz
