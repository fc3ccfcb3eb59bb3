// SPDX-License-Identifier: BSD-3-Clause
#include "ros/sensors/sensor_outputs.h"

#include <ros/console.h>

#include <cmath>
#include <stdexcept>

#include "curtain_sim/Labels.h"
#include "ros/sensors/read_camera_info.h"
#include "ros/sensors/sensor_messages.h"
#include "ros/time/warn_period.h"
#include "scene/ranges.h"

namespace curtain_ros {

using curtain::SensorKind;
using sensor_msgs::CameraInfo;

namespace {

constexpr double kCloudsAtRest = 1.0;  // [1/s] all round

curtain_sim::Labels namesOf(const curtain::Scene& scene) {
  curtain_sim::Labels labels;
  labels.names = {"background", "cloth"};
  for (const curtain::ObstacleParams& obstacle : scene.obstacles) labels.names.push_back(obstacle.name);
  for (const curtain::LayerParams& layer : scene.layers) labels.names.push_back(layer.name);
  return labels;
}

curtain::FlatCloth flatCloth(const curtain::Simulator& simulator) {
  std::vector<double> warp, weft;
  simulator.copyRestLengths(warp, weft);
  if (simulator.layers().size() > 1) simulator.copyRods(warp);
  return {simulator.fineMeshTopology(), std::move(warp), std::move(weft)};
}

}  // namespace

// Short queues: late listeners want the newest view, not the ones they missed.
SensorOutputs::SensorOutputs(ros::NodeHandle node, ros::NodeHandle private_node, const curtain::SensorParams& params,
                             const curtain::Simulator& simulator, Frames& frames, Inputs& inputs)
    : params_(params),
      simulator_(simulator),
      frames_(frames),
      flat_(flatCloth(simulator)),
      pace_(params.rate, restRate(), simulator.scene().solver.frame_rate),
      cloud_message_(emptyCloud()),
      image_message_(sensor_msgs::Image()),
      labels_message_(sensor_msgs::Image()),
      nodes_message_(sensor_msgs::Image()),
      info_message_(CameraInfo()) {
  const double count = flat_.area() * params_.density;
  if (!isSensor() && count > curtain::kMaxRays) {
    throw ParameterError("can't start, a problem with " + private_node.getNamespace() + "/points/density: gives " +
                         curtain::formatNumber(std::round(count)) + " points on " +
                         curtain::formatNumber(flat_.area()) + " m^2 of cloth, must give at most " +
                         std::to_string(curtain::kMaxRays));
  }
  if (isCamera() && params_.camera.from_camera_info) {
    camera_input_ = std::make_unique<CameraInput>(node, inputs, worker_);
  } else if (isCamera()) {
    const curtain::CameraModel camera = curtain::cameraModel(params_.camera);
    toMessage(camera, camera_.emplace());
    std::vector<curtain::Problem> problems;  // the parameters have none
    rays_ = curtain::cameraRays(camera, problems);
  } else if (isSensor()) {
    rays_ = curtain::lidarRays(params_.lidar);
  }
  if (!params_.frame.empty() || !camera_input_) frame_.emplace(params_.frame, params_.timeout, "~points/timeout");
  points_ = private_node.advertise<sensor_msgs::PointCloud2>("points", 2);
  if (!isCamera()) return;
  image_ = private_node.advertise<sensor_msgs::Image>("depth/image", 2);
  info_ = private_node.advertise<CameraInfo>("depth/camera_info", 2);
  labels_ = private_node.advertise<sensor_msgs::Image>("depth/labels", 2);
  nodes_ = private_node.advertise<sensor_msgs::Image>("depth/nodes", 2);
  names_ = private_node.advertise<curtain_sim::Labels>("depth/label_names", 1, true);  // latched
  names_.publish(namesOf(simulator.scene()));
}

// A sensor's noise is new in every frame, whether anything moves or not.
double SensorOutputs::restRate() const { return isSensor() ? 0.0 : kCloudsAtRest; }

std::vector<std::string> SensorOutputs::topics() const {
  if (!camera_input_) return {};
  return {camera_input_->topic()};
}

void SensorOutputs::apply() {
  if (!camera_input_) return;
  camera_input_->apply();
  updateCamera();
}

void SensorOutputs::updateCamera() {
  camera_ = camera_input_->info();
  std::optional<curtain::RayGrid> rays = camera_input_->newRays();
  if (rays) rays_ = std::move(rays);
  if (camera_ && params_.frame.empty() && !(frame_ && frame_->name() == camera_->header.frame_id))
    frame_.emplace(camera_->header.frame_id, params_.timeout, "~points/timeout");
}

void SensorOutputs::finish() {
  worker_.finish();
  if (!camera_input_) return;
  while (camera_input_->work()) worker_.finish();
  updateCamera();
}

// False: it can't see now. Where it was at the stamp is known if a later transform is here already.
bool SensorOutputs::findSensor(const ros::Time& stamp, const ros::Time& now) {
  const std::string before = error_;
  error_.clear();
  if (!isSensor()) return true;
  if (isCamera() && !camera_) {
    error_ = "no camera_info has come on " + camera_input_->topic();
  } else {
    const FollowedFrame::Standing standing = frame_->update(frames_, now, 0.0);
    if (standing == FollowedFrame::Standing::kFresh) {
      const FrameLookup then = frames_.lookup(frame_->name(), stamp);
      pose_ = then.known ? then.pose : *frame_->pose();
      return true;
    }
    if (standing == FollowedFrame::Standing::kLost)
      error_ = "the sensor's frame '" + frame_->name() + "' " + frame_->error();
  }
  if (!error_.empty()) ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "~points sees nothing: " << error_);
  return false;
}

// What is only needed where somebody listens.
void SensorOutputs::prepare() {
  if (!isSensor()) {
    if (!sampler_) sampler_ = std::make_unique<curtain::ClothSampler>(flat_, params_.density, params_.seed);
    return;
  }
  if (!sensor_) sensor_ = std::make_unique<curtain::SensorView>(simulator_, flat_, params_);
  if (rays_) sensor_->setRays(std::move(*rays_));
  rays_.reset();
}

std::uint32_t SensorOutputs::listeners() {
  std::uint32_t all = 0;
  for (const ros::Publisher* const topic : {&points_, &image_, &info_, &labels_, &nodes_})
    all += *topic ? topic->getNumSubscribers() : 0;
  if (all == 0) error_.clear();
  return all;
}

void SensorOutputs::publish(const ros::Time& stamp, const ros::Time& now) {
  const std::uint32_t count = listeners();
  if (!worker_.busy() && pace_.due(count)) beginView(stamp, now);
}

void SensorOutputs::showAgain(const ros::Time& now) {
  const std::uint32_t count = listeners();
  if (!worker_.busy() && pace_.lacks(simulator_.revision(), count)) beginView(now, now);
}

void SensorOutputs::beginView(const ros::Time& stamp, const ros::Time& now) {
  if (!findSensor(stamp, now) || !pace_.send(simulator_.revision())) return;
  try {
    prepare();
    view_.stamp = stamp;
    view_.frame = isSensor() ? frames_.resolve(frame_->name()) : frames_.world();
    view_.sensor = pose_;
    view_.cloud = points_.getNumSubscribers() > 0;
    view_.image = isCamera() && image_.getNumSubscribers() + info_.getNumSubscribers() > 0;
    view_.labels = isCamera() && labels_.getNumSubscribers() > 0;
    view_.nodes = isCamera() && nodes_.getNumSubscribers() > 0;
    if (camera_) view_camera_ = *camera_;
    curtain::readMoment(simulator_, view_.moment);
    worker_.begin([this] { show(view_); });
  } catch (const std::exception& error) {  // no memory, no thread
    ROS_ERROR_STREAM_THROTTLE(kWarnPeriod, "~points can't be made: " << error.what());
  }
}

// On a thread of its own.
void SensorOutputs::show(const View& view) {
  try {
    if (!isSensor()) {
      sampler_->sample(view.moment, cloud_);
      return showCloud(view, 1, static_cast<std::uint32_t>(cloud_.size()));
    }
    sensor_->render(view.moment, view.sensor);
    if (view.image) showDepths(view);
    if (view.labels) {
      sensor_->labels(seen_labels_);
      showImage(view, seen_labels_, labels_message_, labels_);
    }
    if (view.nodes) {
      sensor_->nodes(seen_nodes_);
      showImage(view, seen_nodes_, nodes_message_, nodes_);
    }
    if (!view.cloud) return;
    sensor_->points(view.moment, cloud_);
    showCloud(view, static_cast<std::uint32_t>(sensor_->rays().height),
              static_cast<std::uint32_t>(sensor_->rays().width));
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM_THROTTLE(kWarnPeriod, "~points can't be made: " << error.what());
  }
}

void SensorOutputs::showCloud(const View& view, std::uint32_t height, std::uint32_t width) {
  const auto message = cloud_message_.edit();
  message->header.stamp = view.stamp;
  message->header.frame_id = view.frame;
  fillCloud(cloud_, height, width, !isSensor(), *message);
  points_.publish(message);
}

template <typename Value>
void SensorOutputs::showImage(const View& view, const std::vector<Value>& values,
                              ReusedMessage<sensor_msgs::Image>& reused, const ros::Publisher& publisher) {
  const auto image = reused.edit();
  image->header.stamp = view.stamp;
  image->header.frame_id = view.frame;
  fillImage(values, static_cast<std::uint32_t>(sensor_->rays().height),
            static_cast<std::uint32_t>(sensor_->rays().width), *image);
  publisher.publish(image);
}

void SensorOutputs::showDepths(const View& view) {
  showImage(view, sensor_->readings(), image_message_, image_);
  const auto info = info_message_.edit();
  *info = view_camera_;
  info->header.stamp = view.stamp;
  info->header.frame_id = view.frame;
  info_.publish(info);
}

}  // namespace curtain_ros
