// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/legend_overlay.h"

#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgrePass.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>
#include <Overlay/OgreOverlayContainer.h>
#include <Overlay/OgreOverlayManager.h>

#include <QImage>
#include <QLinearGradient>
#include <QPainter>
#include <cmath>

#include "rviz/surface/fabric.h"
#include "rviz/surface/layers.h"

namespace curtain_rviz {
namespace {

// [pixel]
constexpr int kWidth = 260, kHeight = 72, kMargin = 12, kBarTop = 30, kBarHeight = 12;
constexpr int kFromEdge = 14;

const Ogre::String& kOverlayGroup = Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME;

QLinearGradient gradient() {
  QLinearGradient colours(kMargin, 0, kWidth - kMargin, 0);
  constexpr int kStops = 16;
  for (int stop = 0; stop <= kStops; ++stop) {
    const double share = static_cast<double>(stop) / kStops;
    const Colour colour = scaleColour(share);
    const auto level = [&](std::size_t part) { return static_cast<int>(std::lround(255.0F * colour[part])); };
    colours.setColorAt(share, QColor(level(0), level(1), level(2)));
  }
  return colours;
}

}  // namespace

LegendOverlay::LegendOverlay(const std::string& name) {
  texture_ = Ogre::TextureManager::getSingleton().createManual(name, kOverlayGroup, Ogre::TEX_TYPE_2D, kWidth, kHeight,
                                                               0, Ogre::PF_BYTE_BGRA, Ogre::TU_STATIC_WRITE_ONLY);
  material_ = Ogre::MaterialManager::getSingleton().create(name, kOverlayGroup);
  Ogre::Pass* const pass = material_->getTechnique(0)->getPass(0);
  pass->createTextureUnitState(name)->setTextureFiltering(Ogre::TFO_NONE);
  pass->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
  pass->setLightingEnabled(false);
  pass->setDepthCheckEnabled(false);
  pass->setDepthWriteEnabled(false);

  Ogre::OverlayManager& overlays = Ogre::OverlayManager::getSingleton();
  panel_ = static_cast<Ogre::PanelOverlayElement*>(overlays.createOverlayElement("Panel", name));
  panel_->setMetricsMode(Ogre::GMM_PIXELS);
  panel_->setVerticalAlignment(Ogre::GVA_BOTTOM);
  panel_->setPosition(kFromEdge, -kFromEdge - kHeight);
  panel_->setDimensions(kWidth, kHeight);
  panel_->setMaterialName(name, kOverlayGroup);
  overlay_ = overlays.create(name);
  overlay_->add2D(panel_);
}

LegendOverlay::~LegendOverlay() {
  Ogre::OverlayManager& overlays = Ogre::OverlayManager::getSingleton();
  overlay_->remove2D(panel_);
  overlays.destroy(overlay_);
  overlays.destroyOverlayElement(panel_);
  Ogre::MaterialManager::getSingleton().remove(material_);
  Ogre::TextureManager::getSingleton().remove(texture_);
}

void LegendOverlay::show(const std::string& title, double range) {
  if (title != title_ || range != range_) {
    title_ = title;
    range_ = range;
    draw();
  }
  overlay_->show();
}

void LegendOverlay::hide() { overlay_->hide(); }

void LegendOverlay::draw() {
  QImage image(kWidth, kHeight, QImage::Format_ARGB32);
  image.fill(Qt::transparent);
  QPainter painter(&image);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(20, 22, 26, 190));
  painter.drawRoundedRect(image.rect(), 6, 6);
  painter.setBrush(gradient());
  painter.drawRect(kMargin, kBarTop, kWidth - 2 * kMargin, kBarHeight);

  QFont font = painter.font();
  font.setPixelSize(13);
  painter.setFont(font);
  painter.setPen(QColor(235, 236, 238));
  const QRect inside = image.rect().adjusted(kMargin, 7, -kMargin, -7);
  painter.drawText(inside, Qt::AlignLeft | Qt::AlignTop, QString::fromStdString(title_));
  painter.drawText(inside, Qt::AlignLeft | Qt::AlignBottom, "0");
  painter.drawText(inside, Qt::AlignHCenter | Qt::AlignBottom, QString::fromStdString(legendNumber(0.5 * range_)));
  painter.drawText(inside, Qt::AlignRight | Qt::AlignBottom, QString::fromStdString(legendNumber(range_)));
  painter.end();
  texture_->getBuffer()->blitFromMemory(Ogre::PixelBox(kWidth, kHeight, 1, Ogre::PF_BYTE_BGRA, image.bits()));
}

}  // namespace curtain_rviz
