// SPDX-License-Identifier: BSD-3-Clause
//
// ~points, and of a camera ~depth/image and ~depth/camera_info. The simulation thread copies what there is to see; a
// thread of its own looks at it and publishes, so that no frame waits for a view. While it is busy the next view waits
// for a later frame. Nothing is copied, looked up or built while nobody listens.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"
#include "ros/frames/followed_frame.h"
#include "ros/frames/frames.h"
#include "ros/inputs/inputs.h"
#include "ros/outputs/reused_message.h"
#include "ros/parameters/parameters.h"
#include "ros/sensors/camera_input.h"
#include "ros/sensors/worker.h"
#include "ros/time/pace.h"
#include "sensing/cloth_sampler.h"
#include "sensing/sensor_view.h"

namespace curtain_ros {

/// Simulation thread only.
class SensorOutputs {
 public:
  /// The others must outlive this.
  ///   node          camera_info is in its namespace
  ///   private_node  what is published
  ///   params        valid
  /// Throws ParameterError for a density of too many points.
  SensorOutputs(ros::NodeHandle node, ros::NodeHandle private_node, const curtain::SensorParams& params,
                const curtain::Simulator& simulator, Frames& frames, Inputs& inputs);
  SensorOutputs(const SensorOutputs&) = delete;
  SensorOutputs& operator=(const SensorOutputs&) = delete;

  /// Takes the newest camera_info, once a frame's time.
  void apply();

  /// A frame was made: the rate is counted in them.
  void tick() { pace_.tick(); }

  /// The next view is due at once.
  void hurry() { pace_.hurry(); }

  /// Begins a view of the present state, if one is due and wanted, and the last one is published.
  ///   stamp  of the state
  ///   now    of the node's clock, which the sensor's frame is compared with
  void publish(const ros::Time& stamp, const ros::Time& now);

  /// The same in a pause, once for each listener: nothing changes.
  void showAgain(const ros::Time& now);

  /// Waits until the view that was begun is published, and the newest camera_info is the camera's.
  void finish();

  /// The frame rate has changed. [1/s]
  void setFrameRate(double frame_rate) { pace_.setRates(params_.rate, restRate(), frame_rate); }

  /// Why nothing is seen although somebody listens; empty: it is seen, or nobody listens.
  const std::string& error() const { return error_; }

  /// Resolved names of the topics that are listened to.
  std::vector<std::string> topics() const;

 private:
  struct View {
    ros::Time stamp;
    std::string frame;
    curtain::Pose sensor;
    bool cloud, image, labels, nodes;  // somebody listens
    curtain::Moment moment;
  };

  bool isCamera() const { return params_.sensor == curtain::SensorKind::kCamera; }
  bool isSensor() const { return params_.sensor != curtain::SensorKind::kAllRound; }
  double restRate() const;
  void updateCamera();
  std::uint32_t listeners();
  void beginView(const ros::Time& stamp, const ros::Time& now);
  bool findSensor(const ros::Time& stamp, const ros::Time& now);
  void prepare();
  void show(const View& view);
  void showCloud(const View& view, std::uint32_t height, std::uint32_t width);
  void showDepths(const View& view);
  template <typename Value>
  void showImage(const View& view, const std::vector<Value>& values, ReusedMessage<sensor_msgs::Image>& reused,
                 const ros::Publisher& publisher);

  curtain::SensorParams params_;
  const curtain::Simulator& simulator_;
  Frames& frames_;
  curtain::FlatCloth flat_;
  Pace pace_;
  ros::Publisher points_, image_, info_, labels_, nodes_, names_;
  std::optional<FollowedFrame> frame_;  // none: not known which
  curtain::Pose pose_;                  // of the sensor
  std::string error_;
  std::optional<curtain::RayGrid> rays_;           // for the next view; none: those of the last one
  std::optional<sensor_msgs::CameraInfo> camera_;  // of rays_, or of the view's
  std::unique_ptr<curtain::ClothSampler> sampler_;
  std::unique_ptr<curtain::SensorView> sensor_;

  // Of the view that is being made; the simulation thread's when there is none.
  View view_;
  std::vector<curtain::CloudPoint> cloud_;
  std::vector<std::uint16_t> seen_labels_;
  std::vector<std::int32_t> seen_nodes_;
  ReusedMessage<sensor_msgs::PointCloud2> cloud_message_;
  ReusedMessage<sensor_msgs::Image> image_message_, labels_message_, nodes_message_;
  ReusedMessage<sensor_msgs::CameraInfo> info_message_;
  sensor_msgs::CameraInfo view_camera_;

  std::unique_ptr<CameraInput> camera_input_;  // none unless from_camera_info
  Worker worker_;                              // last: its job uses the others
};

}  // namespace curtain_ros
