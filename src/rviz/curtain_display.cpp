// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/curtain_display.h"

#include <OgreSceneNode.h>
#include <ros/names.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/color_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/visualization_manager.h>

#include <QGuiApplication>
#include <pluginlib/class_list_macros.hpp>

#include "rviz/surface/state_check.h"

namespace curtain_rviz {
namespace {

using rviz::StatusProperty;

Colour toColour(const rviz::ColorProperty& property) {
  const Ogre::ColourValue colour = property.getOgreColor();
  return {colour.r, colour.g, colour.b};
}

std::string uniqueName() {
  static int count = 0;
  return "curtain_sim/Curtain" + std::to_string(++count);
}

}  // namespace

CurtainDisplay::CurtainDisplay() {
  auto* const fabric = new rviz::Property("Fabric", QVariant(), "How the cloth looks.", this);
  pattern_ = new rviz::EnumProperty("Pattern", "Linen", "What is woven into the cloth.", fabric);
  for (std::size_t i = 0; i < patternNames().size(); ++i)
    pattern_->addOption(QString::fromStdString(patternNames()[i]), static_cast<int>(i));
  ground_ = new rviz::ColorProperty("Color", QColor(176, 52, 56), "Colour of the cloth.", fabric);
  figure_ = new rviz::ColorProperty("Pattern Color", QColor(232, 214, 178),
                                    "Second colour of stripes, checks and ogees.", fabric);
  repeat_ = new rviz::FloatProperty("Pattern Size", 0.25F, "Width of one repeat of the pattern [m].", fabric);
  repeat_->setMin(0.001F);
  sheen_ = new rviz::FloatProperty("Sheen", 0.3F, "Light that grazes the fibres: 0 cotton, 1 velvet.", fabric);
  translucency_ =
      new rviz::FloatProperty("Translucency", 0.3F, "Light that comes through: 0 blackout, 1 voile.", fabric);
  for (rviz::FloatProperty* share : {sheen_, translucency_}) {
    share->setMin(0.0F);
    share->setMax(1.0F);
  }
  layer_ = new rviz::EnumProperty("Layer", "Plain",
                                  "What the cloth is coloured by. Tension and contact force take ~loads, too.", this);
  for (const Layer layer : {Layer::kPlain, Layer::kSpeed, Layer::kStrain, Layer::kTension, Layer::kContact})
    layer_->addOption(textOf(layer).name, static_cast<int>(layer));
  range_ = new rviz::FloatProperty("Range", 0.0F,
                                   "Value of the last colour, in the layer's unit; 0: follows what is there.", this);
  range_->setMin(0.0F);
  legend_ = new rviz::BoolProperty("Legend", true, "Show what the layer's colours mean.", this);
  wind_ = new rviz::BoolProperty("Wind", true, "Show the wind sources that blow.", this);
  wind_colour_ = new rviz::ColorProperty("Wind Color", QColor(150, 205, 245), "Of their arrows.", this);
}

CurtainDisplay::~CurtainDisplay() {
  if (cloth_) scene_node_->detachObject(cloth_.get());
}

void CurtainDisplay::onInitialize() {
  MFDClass::onInitialize();
  stopDrawingWithTheWindow();
  const std::string name = uniqueName();
  try {
    material_ = std::make_unique<ClothMaterial>(name);
  } catch (const std::exception& error) {
    opengl_error_ = error.what();
    return;
  }
  cloth_ = std::make_unique<ClothObject>(material_->material());
  scene_node_->attachObject(cloth_.get());
  arrows_ = std::make_unique<WindArrows>(scene_node_, name + "/wind");
  legend_overlay_ = std::make_unique<LegendOverlay>(name + "/legend");
}

// rviz draws on until its event loop ends, into a window that is gone: Mesa without a graphics card then writes past
// the end of a picture without size, and rviz may abort ("corrupted size vs. prev_size").
void CurtainDisplay::stopDrawingWithTheWindow() {
  auto* const manager = dynamic_cast<rviz::VisualizationManager*>(context_);
  if (manager != nullptr)
    connect(qGuiApp, &QGuiApplication::lastWindowClosed, manager, &rviz::VisualizationManager::stopUpdate);
}

// Drawing a status takes longer than moving the cloth: only where it has changed.
void CurtainDisplay::tell(const std::string& about, StatusProperty::Level level, const std::string& text) {
  const auto [known, is_new] = told_.try_emplace(about, text);
  if (!is_new && known->second == text) return;
  known->second = text;
  setStatusStd(level, about, text);
}

void CurtainDisplay::reset() {
  MFDClass::reset();
  told_.clear();
  state_.reset();
  shown_.reset();
  loads_.reset();
  layer_range_.reset();
  if (!cloth_) return;
  cloth_->setVisible(false);
  arrows_->show({}, curtain::Vec3::Zero(), 0.0, {});
  legend_overlay_->hide();
}

void CurtainDisplay::onDisable() {
  MFDClass::onDisable();
  listenToLoads(false);
}

void CurtainDisplay::processMessage(const curtain_sim::CurtainState::ConstPtr& state) {
  const std::string wrong = whatIsWrong(*state);
  if (wrong.empty()) {
    state_ = state;
    tell("State", StatusProperty::Ok, "OK");
  } else {
    tell("State", StatusProperty::Error, "not shown: " + wrong);
  }
}

void CurtainDisplay::setLoads(const curtain_sim::Loads::ConstPtr& loads) { loads_ = loads; }

ClothAppearance CurtainDisplay::appearance() const {
  return {static_cast<Pattern>(pattern_->getOptionInt()),
          toColour(*ground_),
          toColour(*figure_),
          repeat_->getFloat(),
          sheen_->getFloat(),
          translucency_->getFloat()};
}

// Where the state's frame is in rviz's fixed one, by the newest that tf2 knows.
bool CurtainDisplay::follow(const std::string& frame) {
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (!context_->getFrameManager()->getTransform(frame, ros::Time(), position, orientation)) {
    tell("Transform", StatusProperty::Error, "tf2 knows no way from " + frame + " to the fixed frame");
    return false;
  }
  tell("Transform", StatusProperty::Ok, "OK");
  scene_node_->setPosition(position);
  scene_node_->setOrientation(orientation);
  return true;
}

void CurtainDisplay::update(float wall_dt, float) {
  seconds_ += static_cast<double>(wall_dt);
  if (!cloth_) tell("OpenGL", StatusProperty::Error, opengl_error_ + "; the node's ~mesh can be shown instead");
  if (!cloth_ || !state_) return;
  const bool placed = follow(state_->header.frame_id);
  cloth_->setVisible(placed);
  if (!placed) return;
  material_->setAppearance(appearance());
  if (state_ != shown_) {
    if (surface_.update(*state_)) cloth_->setCloth(surface_);
    cloth_->move(surface_);
    shown_ = state_;
  }
  showLayer(static_cast<double>(wall_dt));
  static const std::vector<curtain_sim::WindSource> kNone;
  arrows_->show(wind_->getBool() ? state_->winds : kNone, surface_.centre(), seconds_, toColour(*wind_colour_));
  context_->queueRender();
}

// ~loads is beside ~state.
void CurtainDisplay::listenToLoads(bool wanted) {
  if (!wanted) {
    loads_subscriber_.shutdown();
    loads_.reset();
    if (told_.erase("Loads") > 0) deleteStatus("Loads");
    return;
  }
  const std::string topic = ros::names::parentNamespace(topic_property_->getTopicStd()) + "/loads";
  if (loads_subscriber_ && loads_subscriber_.getTopic() == topic) return;
  loads_.reset();
  loads_subscriber_ = update_nh_.subscribe(topic, 1, &CurtainDisplay::setLoads, this);
  tell("Loads", StatusProperty::Warn, "nothing on " + topic + " yet");
}

// Null, with a status, where there are none that fit.
const curtain_sim::Loads* CurtainDisplay::loadsOfTheState() {
  if (!loads_) return nullptr;
  const std::string wrong = whatIsWrong(*loads_, *state_);
  if (!wrong.empty()) {
    tell("Loads", StatusProperty::Error, "not shown: " + wrong);
    return nullptr;
  }
  tell("Loads", StatusProperty::Ok, "OK");
  return loads_.get();
}

void CurtainDisplay::showLayer(double seconds) {
  const auto layer = static_cast<Layer>(layer_->getOptionInt());
  if (layer != shown_layer_) layer_range_.reset();
  shown_layer_ = layer;
  listenToLoads(needsLoads(layer));
  const curtain_sim::Loads* const loads = needsLoads(layer) ? loadsOfTheState() : nullptr;
  if (layer == Layer::kPlain || (needsLoads(layer) && loads == nullptr)) {
    material_->setLayerRange(0.0);
    legend_overlay_->hide();
    return;
  }
  valuesOf(layer, *state_, loads, node_values_);
  surface_.spread(node_values_, values_);
  cloth_->setValues(values_);
  const double present = layer_range_.follow(node_values_, seconds);
  const double range = range_->getFloat() > 0.0F ? static_cast<double>(range_->getFloat()) : present;
  material_->setLayerRange(range);
  const LayerText text = textOf(layer);
  if (legend_->getBool())
    legend_overlay_->show(std::string(text.name) + " [" + text.unit + "]", range);
  else
    legend_overlay_->hide();
}

}  // namespace curtain_rviz

PLUGINLIB_EXPORT_CLASS(curtain_rviz::CurtainDisplay, rviz::Display)
