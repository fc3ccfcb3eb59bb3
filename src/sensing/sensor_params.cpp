// SPDX-License-Identifier: BSD-3-Clause
#include "sensing/sensor_params.h"

#include "sensing/ray_caster.h"
#include "sensing/rays.h"

namespace curtain {

const std::vector<std::string>& sensorNames() {
  static const std::vector<std::string> names = {"all_round", "camera", "lidar"};
  return names;
}

const std::vector<std::string>& rangeNoiseNames() {
  static const std::vector<std::string> names = {"none", "gaussian", "khoshelham_2012", "nguyen_2012"};
  return names;
}

namespace {

void checkNoise(const SensorParams& params, ProblemLog& log) {
  const std::string noise = rangeNoiseNames()[static_cast<std::size_t>(params.noise)];
  const bool of_cameras = params.noise == RangeNoise::kKhoshelham2012 || params.noise == RangeNoise::kNguyen2012;
  if (params.sensor == SensorKind::kLidar && of_cameras)
    log.add("noise", "must be none or gaussian for a lidar, is " + noise + ", which is of a camera");
  if (params.sensor != SensorKind::kAllRound) return;
  const std::string why = ": all_round is no sensor, it has every point where it is";
  if (params.noise != RangeNoise::kNone) log.add("noise", "must be none, is " + noise + why);
  if (params.dropout > 0.0) log.add("dropout", "must be 0, is " + formatNumber(params.dropout) + why);
}

}  // namespace

void checkSensor(const SensorParams& params, ProblemLog& log) {
  if (params.sensor != SensorKind::kAllRound && !RayCaster::available())
    log.add("sensor",
            "is a camera or a lidar, which this build is without: it was made where Embree was not found "
            "(Debian: libembree-dev); all_round needs none");
  if (log.good("sensor") && log.good("noise") && log.good("dropout")) checkNoise(params, log);
  if (log.good("min_range") && log.good("max_range") && params.min_range >= params.max_range) {
    log.add("min_range", "must be less than max_range, is " + formatNumber(params.min_range) + ", max_range is " +
                             formatNumber(params.max_range));
  }
  if (log.good("lidar.lowest") && log.good("lidar.highest") && params.lidar.lowest > params.lidar.highest) {
    log.add("lidar.lowest", "must be at most lidar.highest, is " + formatNumber(params.lidar.lowest) +
                                ", lidar.highest is " + formatNumber(params.lidar.highest));
  }
  const long rays = static_cast<long>(params.lidar.rings) * params.lidar.columns;
  if (log.good("lidar.rings") && log.good("lidar.columns") && rays > kMaxRays) {
    log.add("lidar.rings",
            "times lidar.columns must be at most " + std::to_string(kMaxRays) + ", is " + std::to_string(rays));
  }
  if (log.good("camera.distortion") && params.camera.distortion.size() > 5) {
    log.add("camera.distortion", "must have at most 5 numbers, k1, k2, p1, p2, k3 of plumb_bob, has " +
                                     std::to_string(params.camera.distortion.size()));
  }
  if (params.sensor != SensorKind::kCamera || params.camera.from_camera_info || !log.good("camera")) return;
  std::vector<Problem> problems;
  cameraRays(cameraModel(params.camera), problems);
  for (const Problem& problem : problems) log.add("camera." + problem.key, problem.text);
}

}  // namespace curtain
