// SPDX-License-Identifier: BSD-3-Clause
//
// The wind sources in Ogre's scene, as moving arrows.
#pragma once

#include <OgreMaterial.h>

#include <string>
#include <vector>

#include "rviz/surface/fabric.h"
#include "rviz/surface/wind_flow.h"

namespace Ogre {
class ManualObject;
class SceneNode;
}  // namespace Ogre

namespace curtain_rviz {

/// GUI thread only.
class WindArrows {
 public:
  /// parent: outlives this; the sources are in its frame. name: unlike that of any other resource in rviz.
  WindArrows(Ogre::SceneNode* parent, const std::string& name);
  ~WindArrows();
  WindArrows(const WindArrows&) = delete;
  WindArrows& operator=(const WindArrows&) = delete;

  /// What is to be seen now; nothing: nothing is.
  ///   winds    nothing wrong with them
  ///   target   where they blow to [m]
  ///   seconds  time that has passed, >= 0
  void show(const std::vector<curtain_sim::WindSource>& winds, const curtain::Vec3& target, double seconds,
            const Colour& colour);

 private:
  Ogre::SceneNode* parent_;
  Ogre::MaterialPtr material_;
  Ogre::ManualObject* object_;
  std::vector<FlowVertex> vertices_;
};

}  // namespace curtain_rviz
