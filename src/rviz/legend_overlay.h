// SPDX-License-Identifier: BSD-3-Clause
//
// The legend of a layer's colours, in the lower left corner of the picture: drawn by Qt, shown as an overlay of Ogre's.
#pragma once

#include <OgreMaterial.h>
#include <OgreTexture.h>
#include <Overlay/OgreOverlay.h>
#include <Overlay/OgrePanelOverlayElement.h>

#include <string>

namespace curtain_rviz {

/// GUI thread only.
class LegendOverlay {
 public:
  /// name: unlike that of any other resource in rviz.
  explicit LegendOverlay(const std::string& name);
  ~LegendOverlay();
  LegendOverlay(const LegendOverlay&) = delete;
  LegendOverlay& operator=(const LegendOverlay&) = delete;

  /// Shows the colours from 0 to `range` under this title. Drawn again only when one of them has changed.
  void show(const std::string& title, double range);
  void hide();

 private:
  void draw();

  std::string title_;
  double range_ = 0.0;
  Ogre::TexturePtr texture_;
  Ogre::MaterialPtr material_;
  Ogre::PanelOverlayElement* panel_;
  Ogre::Overlay* overlay_;
};

}  // namespace curtain_rviz
