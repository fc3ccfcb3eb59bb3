// SPDX-License-Identifier: BSD-3-Clause
#include "ros/sensors/read_camera_info.h"

#include <sensor_msgs/distortion_models.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ros/inputs/read_messages.h"
#include "scene/ranges.h"

namespace curtain_ros {

using curtain::Problem;

namespace {

bool isZero(double value) { return value == 0.0; }

template <typename Numbers>
bool areFinite(const Numbers& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
}

std::vector<Problem> checkKind(const sensor_msgs::CameraInfo& message) {
  std::vector<Problem> problems;
  const auto require = [&](bool good, const char* key, const std::string& text) {
    if (!good) problems.push_back({key, text});
  };
  require(message.header.frame_id.size() <= kLongestName, "header.frame_id", "is too long");
  const bool distorted = !std::all_of(message.D.begin(), message.D.end(), isZero);
  const std::string& model = message.distortion_model;
  require(!distorted || (model == sensor_msgs::distortion_models::PLUMB_BOB && message.D.size() <= 5),
          "distortion_model",
          "must be plumb_bob, with at most 5 numbers in D, where D is not 0: is '" + forLog(model) + "' with " +
              std::to_string(message.D.size()));
  require(isZero(message.K[1]) && isZero(message.K[3]), "K", "must have no skew");
  require(message.binning_x <= 1 && message.binning_y <= 1, "binning_x", "and binning_y must be 0 or 1");
  const auto& roi = message.roi;
  const bool whole = roi.x_offset == 0 && roi.y_offset == 0 && (roi.width == 0 || roi.width == message.width) &&
                     (roi.height == 0 || roi.height == message.height);
  require(whole, "roi", "must be the whole image");
  require(areFinite(message.R), "R", "must be finite");
  require(areFinite(message.P), "P", "must be finite");
  require(isZero(message.P[3]) && isZero(message.P[7]), "P",
          "is of the second camera of a stereo pair, whose frame is the first one's: give the first one's");
  return problems;
}

}  // namespace

std::vector<Problem> toCamera(const sensor_msgs::CameraInfo& message, curtain::CameraModel& camera) {
  const auto pixels = [](std::uint32_t count) { return static_cast<int>(std::min<std::uint32_t>(count, 1U << 20U)); };
  camera = curtain::CameraModel();
  camera.width = pixels(message.width);
  camera.height = pixels(message.height);
  camera.fx = message.K[0];
  camera.cx = message.K[2];
  camera.fy = message.K[4];
  camera.cy = message.K[5];
  std::copy_n(message.D.begin(), std::min(message.D.size(), camera.distortion.size()), camera.distortion.begin());
  return checkKind(message);
}

void toMessage(const curtain::CameraModel& camera, sensor_msgs::CameraInfo& message) {
  message.width = static_cast<std::uint32_t>(camera.width);
  message.height = static_cast<std::uint32_t>(camera.height);
  message.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  message.D.assign(camera.distortion.begin(), camera.distortion.end());
  message.K = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  message.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  completeProjection(message);
}

void completeProjection(sensor_msgs::CameraInfo& message) {
  if (!isZero(message.P[0])) return;
  const auto& k = message.K;
  message.P = {k[0], k[1], k[2], 0.0, k[3], k[4], k[5], 0.0, k[6], k[7], k[8], 0.0};
}

}  // namespace curtain_ros
