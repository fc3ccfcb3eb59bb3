// SPDX-License-Identifier: BSD-3-Clause
//
// What a view of a curtain costs: hierarchy, rays, readings, points, on one core. The curtain that ships, 20 124
// triangles with its folds, after two seconds in its wind.
#include <chrono>
#include <cmath>
#include <limits>

#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/scene_yaml.h"
#include "sensing/cloth_sampler.h"
#include "sensing/hashed_random.h"
#include "sensing/sensor_view.h"

namespace curtain_bench {
namespace {

using curtain::SensorKind;
using curtain::SensorParams;

/// Least time of some calls [ms].
template <typename Call>
double least(int repeats, Call call) {
  double best = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const auto begin = std::chrono::steady_clock::now();
    call();
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
    best = std::min(best, time.count());
  }
  return best;
}

struct Case {
  std::string name;
  SensorParams params;
};

std::vector<Case> cases() {
  SensorParams camera;
  camera.sensor = SensorKind::kCamera;
  SensorParams noisy = camera, porous = camera, lidar = camera, fine_lidar = camera;
  noisy.noise = curtain::RangeNoise::kNguyen2012;
  noisy.dropout = 0.02;
  porous.porosity = 0.2;
  lidar.sensor = fine_lidar.sensor = SensorKind::kLidar;
  fine_lidar.lidar.rings = 64;
  fine_lidar.lidar.columns = 2048;
  return {{"camera 640 x 480", camera},
          {"camera 640 x 480; nguyen_2012 and dropouts", noisy},
          {"camera 640 x 480; porosity 0.2", porous},
          {"lidar 16 x 1800", lidar},
          {"lidar 64 x 2048", fine_lidar}};
}

/// Two metres before the curtain's middle, as a camera looks, or as a lidar stands.
curtain::Pose poseOf(const curtain::Simulator& simulator, SensorKind kind) {
  const curtain::Scene& scene = simulator.scene();
  curtain::Pose pose;
  pose.position = 0.5 * (scene.hang.from + scene.hang.to) - curtain::Vec3(0.0, 2.0, 0.5 * scene.cloth.height);
  if (kind == SensorKind::kCamera) pose.orientation = Eigen::AngleAxisd(-0.5 * curtain::kPi, curtain::Vec3::UnitX());
  return pose;
}

}  // namespace

void studySensing(const Options& options) {
  const auto reading = curtain::readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/config/scenes/curtain.yaml");
  if (!reading.problems.empty()) throw std::runtime_error(curtain::describe(reading.problems));
  curtain::Simulator simulator(reading.scene);
  for (int frame = 0; frame < 120; ++frame) simulator.step();
  std::vector<double> warp, weft;
  simulator.copyRestLengths(warp, weft);
  const curtain::FlatCloth flat(simulator.fineMeshTopology(), warp, weft);
  curtain::Moment moment;
  curtain::readMoment(simulator, moment);
  const int repeats = (options.quick ? 5 : 20) * options.repeats;
  Table table(options.folder, "sensing.csv",
              {"view", "rays", "hits", "triangles", "ms_hierarchy", "ms_look", "ms_points"});
  for (const Case& one : cases()) {
    const curtain::Pose pose = poseOf(simulator, one.params.sensor);
    curtain::RayCaster caster(simulator, 0.0);
    const double hierarchy = least(repeats, [&] { caster.place(moment, pose); });
    curtain::SensorView view(simulator, flat, one.params);
    std::vector<curtain::Problem> problems;
    view.setRays(one.params.sensor == SensorKind::kCamera
                     ? curtain::cameraRays(curtain::cameraModel(one.params.camera), problems)
                     : curtain::lidarRays(one.params.lidar));
    const double look = least(repeats, [&] { view.render(moment, pose); });
    std::vector<curtain::CloudPoint> points;
    const double cloud = least(repeats, [&] { view.points(moment, points); });
    int hits = 0;
    for (const float distance : view.readings()) hits += std::isfinite(distance) ? 1 : 0;
    table.row({one.name, number(static_cast<int>(view.rays().size())), number(hits), number(flat.triangleCount()),
               number(hierarchy), number(look), number(cloud)});
  }
  const curtain::ClothSampler sampler(flat, 10000.0, 1);
  std::vector<curtain::CloudPoint> points;
  const double cloud = least(repeats, [&] { sampler.sample(moment, points); });
  table.row({"all round; 10 000 points a m^2", "0", number(static_cast<int>(points.size())),
             number(flat.triangleCount()), "nan", "nan", number(cloud)});
}

}  // namespace curtain_bench
