// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/wind_arrows.h"

#include <OgreManualObject.h>
#include <OgreMaterialManager.h>
#include <OgrePass.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreTechnique.h>

namespace curtain_rviz {

WindArrows::WindArrows(Ogre::SceneNode* parent, const std::string& name) : parent_(parent) {
  material_ =
      Ogre::MaterialManager::getSingleton().create(name, Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
  Ogre::Pass* const pass = material_->getTechnique(0)->getPass(0);
  pass->setLightingEnabled(false);
  pass->setCullingMode(Ogre::CULL_NONE);
  pass->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
  pass->setDepthWriteEnabled(false);
  object_ = parent_->getCreator()->createManualObject(name);
  object_->setDynamic(true);
  parent_->attachObject(object_);
}

WindArrows::~WindArrows() {
  parent_->detachObject(object_);
  parent_->getCreator()->destroyManualObject(object_);
  Ogre::MaterialManager::getSingleton().remove(material_);
}

void WindArrows::show(const std::vector<curtain_sim::WindSource>& winds, const curtain::Vec3& target, double seconds,
                      const Colour& colour) {
  vertices_.clear();
  for (const curtain_sim::WindSource& wind : winds) addWindFlow(wind, target, seconds, vertices_);
  object_->setVisible(!vertices_.empty());
  if (vertices_.empty()) return;
  if (object_->getSections().empty()) {
    object_->begin(material_->getName(), Ogre::RenderOperation::OT_TRIANGLE_LIST, material_->getGroup());
  } else {
    object_->beginUpdate(0);
  }
  for (const FlowVertex& vertex : vertices_) {
    const curtain::Vec3& at = vertex.position;
    object_->position(static_cast<Ogre::Real>(at.x()), static_cast<Ogre::Real>(at.y()),
                      static_cast<Ogre::Real>(at.z()));
    object_->colour(colour[0], colour[1], colour[2], vertex.alpha);
  }
  object_->end();
}

}  // namespace curtain_rviz
