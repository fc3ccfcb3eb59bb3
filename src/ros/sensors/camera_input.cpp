// SPDX-License-Identifier: BSD-3-Clause
#include "ros/sensors/camera_input.h"

#include <exception>
#include <utility>

#include "ros/inputs/mailbox.h"
#include "ros/sensors/read_camera_info.h"

namespace curtain_ros {

using sensor_msgs::CameraInfo;

CameraInput::CameraInput(ros::NodeHandle& node, Inputs& inputs, Worker& worker)
    : inputs_(inputs), worker_(worker), letters_(1) {
  const boost::function<void(const CameraInfo::ConstPtr&)> on_message = [this](const CameraInfo::ConstPtr& message) {
    letters_.post(message);
  };
  subscriber_ = node.subscribe<CameraInfo>("camera_info", kQueueSize, on_message, ros::VoidConstPtr(),
                                           ros::TransportHints().tcpNoDelay());
}

void CameraInput::apply() {
  std::deque<CameraInfo::ConstPtr> letters;
  letters_.collect(letters);
  for (const CameraInfo::ConstPtr& letter : letters) receive(*letter);
  work();
}

void CameraInput::receive(const CameraInfo& message) {
  Camera camera;
  std::vector<curtain::Problem> problems = toCamera(message, camera.model);
  if (problems.empty()) problems = curtain::checkCamera(camera.model);
  if (problems.empty() && !refused_for_.empty() && camera.model == refused_) problems = refused_for_;
  if (!problems.empty()) return inputs_.refuse("camera_info", problems);
  camera.message = message;
  completeProjection(camera.message);
  if (std::exchange(next_, std::nullopt)) inputs_.countAccepted();  // this one has overtaken it
  // Its frame and its projection may be others without other rays.
  if (making_ && camera.model == making_->model) {
    making_ = std::move(camera);
  } else if (!making_ && info_ && camera.model == model_) {
    info_ = std::move(camera.message);
  } else {
    next_ = std::move(camera);
    return;  // counted when its rays are made
  }
  inputs_.countAccepted();
}

bool CameraInput::work() {
  if (worker_.busy()) return false;
  if (making_) settle();
  if (!next_) return false;
  making_ = std::exchange(next_, std::nullopt);
  worker_.begin([this, model = making_->model] {
    try {
      made_ = curtain::cameraRays(model, problems_);
    } catch (const std::exception& error) {  // no memory
      problems_ = {{"width", std::string("and height are too large: ") + error.what()}};
    }
  });
  return true;
}

void CameraInput::settle() {
  const Camera camera = *std::exchange(making_, std::nullopt);
  if (!problems_.empty()) {
    refused_ = camera.model;
    refused_for_ = problems_;
    return inputs_.refuse("camera_info", problems_);
  }
  model_ = camera.model;
  info_ = camera.message;
  rays_ = std::move(made_);
  inputs_.countAccepted();
}

std::optional<curtain::RayGrid> CameraInput::newRays() { return std::exchange(rays_, std::nullopt); }

}  // namespace curtain_ros
