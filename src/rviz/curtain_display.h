// SPDX-License-Identifier: BSD-3-Clause
//
// The rviz display curtain_sim/Curtain: a curtain as its node's ~state has it (docs/rviz.md). Messages are checked and
// kept as they come; the picture is made once a frame of rviz, of the newest one. Properties are looked at then, too.
#pragma once

#include <ros/subscriber.h>
#include <rviz/message_filter_display.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rviz/cloth_material.h"
#include "rviz/cloth_object.h"
#include "rviz/legend_overlay.h"
#include "rviz/surface/layers.h"
#include "rviz/wind_arrows.h"

namespace rviz {
class BoolProperty;
class ColorProperty;
class EnumProperty;
class FloatProperty;
}  // namespace rviz

namespace curtain_rviz {

/// GUI thread only, as all displays.
class CurtainDisplay : public rviz::MessageFilterDisplay<curtain_sim::CurtainState> {
 public:
  CurtainDisplay();
  ~CurtainDisplay() override;

  void onInitialize() override;
  void update(float wall_dt, float ros_dt) override;
  void reset() override;

 protected:
  void onDisable() override;
  void processMessage(const curtain_sim::CurtainState::ConstPtr& state) override;

 private:
  void stopDrawingWithTheWindow();
  void tell(const std::string& about, rviz::StatusProperty::Level level, const std::string& text);
  void setLoads(const curtain_sim::Loads::ConstPtr& loads);
  ClothAppearance appearance() const;
  bool follow(const std::string& frame);
  void listenToLoads(bool wanted);
  void showLayer(double seconds);
  const curtain_sim::Loads* loadsOfTheState();

  rviz::EnumProperty* pattern_;
  rviz::ColorProperty *ground_, *figure_;
  rviz::FloatProperty *repeat_, *sheen_, *translucency_;
  rviz::EnumProperty* layer_;
  rviz::FloatProperty* range_;
  rviz::BoolProperty* legend_;
  rviz::BoolProperty* wind_;
  rviz::ColorProperty* wind_colour_;

  curtain_sim::CurtainState::ConstPtr state_, shown_;  // the newest; the one in the picture
  curtain_sim::Loads::ConstPtr loads_;
  ros::Subscriber loads_subscriber_;
  CurtainSurface surface_;
  LayerRange layer_range_;
  Layer shown_layer_ = Layer::kPlain;
  std::vector<float> node_values_, values_;
  std::map<std::string, std::string> told_;  // statuses, as they are shown
  double seconds_ = 0.0;                     // since the display is there

  std::string opengl_error_;  // why there are none of these
  std::unique_ptr<ClothMaterial> material_;
  std::unique_ptr<ClothObject> cloth_;
  std::unique_ptr<WindArrows> arrows_;
  std::unique_ptr<LegendOverlay> legend_overlay_;
};

}  // namespace curtain_rviz
