// SPDX-License-Identifier: BSD-3-Clause
//
// What the node's ~points asks for: points all over the cloth, or what a camera or a lidar sees of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "curtain_sim/scene.h"
#include "scene/fields.h"
#include "scene/problem_log.h"

namespace curtain {

enum class SensorKind {
  kAllRound,  ///< no sensor: points all over the cloth
  kCamera,    ///< depth camera: a pinhole with or without distortion, z forward, x right
  kLidar      ///< spinning lidar: x forward, z up
};

/// How readings differ from the distance; formulas in range_noise.cpp.
enum class RangeNoise { kNone, kGaussian, kKhoshelham2012, kNguyen2012 };

const std::vector<std::string>& sensorNames();      ///< spelling, in the enum's order
const std::vector<std::string>& rangeNoiseNames();  ///< the same

/// A depth camera, as sensor_msgs/CameraInfo describes it.
struct CameraParams {
  bool from_camera_info = false;   ///< what follows comes by messages instead
  int width = 640;                 ///< [pixel]
  int height = 480;                ///< [pixel]
  double fx = 525.0;               ///< focal length [pixel], > 0
  std::optional<double> fy;        ///< none: fx
  std::optional<double> cx, cy;    ///< principal point [pixel], pixel centres are whole numbers; none: the middle
  std::vector<double> distortion;  ///< k1, k2, p1, p2, k3 of plumb_bob; fewer: the others are 0
};

/// A spinning lidar: rings of rays at even angles from the highest to the lowest, columns at even angles all round.
struct LidarParams {
  int rings = 16;
  int columns = 1800;
  double lowest = -0.2618;  ///< [rad] of the lowest ring, up is positive
  double highest = 0.2618;  ///< [rad] of the highest
};

struct SensorParams {
  SensorKind sensor = SensorKind::kAllRound;
  double rate = 10.0;        ///< [1/s of simulated time]; the frame rate is its cap
  double density = 10000.0;  ///< points per m^2 of the flat cloth, all round
  std::uint64_t seed = 1;
  std::string frame;               ///< tf2 frame of the sensor; empty: the world's, or camera_info's
  double timeout = 0.5;            ///< [s] a frame that is older is not looked from
  double min_range = 0.1;          ///< [m] what is nearer is not there
  double max_range = 10.0;         ///< [m] what is further gives no reading. Camera: depths, lidar: distances
  std::optional<double> porosity;  ///< share of the rays that pass a layer of cloth; none: cloth.porosity
  RangeNoise noise = RangeNoise::kNone;
  double sigma = 0.01;      ///< [m] standard deviation of gaussian
  double dropout = 0.0;     ///< share of the readings that are lost
  bool lambertian = false;  ///< max_range is that of a surface seen straight on; less where it is seen aslant
  CameraParams camera;
  LidarParams lidar;
};

/// Most rays of a sensor, and points all round: more is a mistake in a number, at 40 bytes a point.
constexpr int kMaxRays = 1 << 22;

/// What is wrong with values together; each by itself has its range below.
void checkSensor(const SensorParams& params, ProblemLog& log);

template <>
struct Fields<CameraParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& camera) {
    v.flag("from_camera_info", camera.from_camera_info);
    v.integer("width", camera.width, IntRange{1, 8192});
    v.integer("height", camera.height, IntRange{1, 8192});
    v.number("fx", camera.fx, between(1e-3, 1e6));
    v.optionalNumber("fy", camera.fy, between(1e-3, 1e6));
    v.optionalNumber("cx", camera.cx, between(-1e6, 1e6));
    v.optionalNumber("cy", camera.cy, between(-1e6, 1e6));
    v.numbers("distortion", camera.distortion, between(-1e3, 1e3));
  }
};

template <>
struct Fields<LidarParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& lidar) {
    v.integer("rings", lidar.rings, IntRange{1, 1024});
    v.integer("columns", lidar.columns, IntRange{1, 65536});
    v.number("lowest", lidar.lowest, between(-1.58, 1.58));
    v.number("highest", lidar.highest, between(-1.58, 1.58));
  }
};

template <>
struct Fields<SensorParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& params) {
    v.choice("sensor", params.sensor, sensorNames());
    v.number("rate", params.rate, between(kSmallest, 10000.0));
    v.number("density", params.density, positive());
    v.seed("seed", params.seed);
    v.textOrNone("frame", params.frame);
    v.number("timeout", params.timeout, between(kSmallest, 3600.0));
    v.number("min_range", params.min_range, notNegative());
    v.number("max_range", params.max_range, positive());
    v.optionalNumber("porosity", params.porosity, between(0.0, 1.0));
    v.choice("noise", params.noise, rangeNoiseNames());
    v.number("sigma", params.sigma, between(0.0, 1000.0));
    v.number("dropout", params.dropout, between(0.0, 1.0));
    v.flag("lambertian", params.lambertian);
    v.map("camera", params.camera);
    v.map("lidar", params.lidar);
  }
};

}  // namespace curtain
