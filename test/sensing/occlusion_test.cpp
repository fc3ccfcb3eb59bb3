// SPDX-License-Identifier: BSD-3-Clause
//
// What a sensor sees is what a brute-force caster of rays meets first: 100 000 rays over random scenes, no wrong one.
//
// The caster computes in single precision, in the sensor's frame: let u = 2^-24, and R = kReach the furthest
// coordinate.
//   - A corner is rounded by at most R u in each coordinate: sqrt(3) R u.
//   - A ray passes an edge e = b - a on the side that D . (e x (a + b)) tells, which is 2 |e| times the ray's distance
//     from the edge where they cross at right angles. Sum, difference, product, difference of products, product with D
//     and two sums are seven roundings of terms that sum to at most 2/sqrt(3) |e| 2 R: the largest eigenvalue of the
//     symmetric matrix with D off its diagonal, |D| = 1. So the distance is known to 7 * 2/sqrt(3) R u.
// Together less than kWidth = 10 R u across. Edges nearly along the ray, and rays that are turned into a mesh's frame,
// are not in this bound; the test says that they need no more. Where a ray meets a surface at a slant it is that over
// the cosine along. A reading is right if it is that far from the true first hit, or lies between the first hits of
// rays that are kWidth beside: at the outline of what is in front.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <thread>

#include "sensing/brute_rays.h"
#include "sensing/ray_caster.h"
#include "sensing/sensor_view.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::BruteHit;
using curtain_test::Random;

constexpr double kReach = 8.0;  // [m]
constexpr double kWidth = 10.0 * kReach * 0x1p-24;
constexpr double kNearest = 0.1, kFarthest = 7.0;  // [m]
constexpr int kScenes = 20;
constexpr int kRaysOfScene = 5000;

ObstacleParams randomObstacle(int number, Random& random) {
  ObstacleParams obstacle;
  obstacle.name = std::to_string(number);
  obstacle.shape = static_cast<ShapeKind>(number % 6);
  obstacle.radius = random.between(0.05, 0.3);
  obstacle.length = random.between(0.1, 0.6);
  obstacle.size = Vec3(random.between(0.1, 0.5), random.between(0.1, 0.5), random.between(0.1, 0.5));
  obstacle.pose.position = Vec3(0.5, 0.0, 1.0) + random.inBox(1.2);
  obstacle.pose.orientation = Eigen::AngleAxisd(random.between(0.0, 3.0), random.direction());
  if (obstacle.shape == ShapeKind::kMesh) {
    obstacle.mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/icosphere.stl";
    obstacle.scale = Vec3(0.3, 0.2, 0.4);
  }
  if (obstacle.shape == ShapeKind::kPlane) {  // a floor, nearly
    obstacle.pose.position = Vec3(0.0, 0.0, random.between(-1.0, -0.2));
    obstacle.pose.orientation = Eigen::AngleAxisd(random.between(-0.2, 0.2), Vec3::UnitX());
  }
  return obstacle;
}

/// A curtain with folds, crumpled at random, among obstacles of every shape.
Scene randomScene(Random& random) {
  Scene scene = curtain_test::flatScene(9, 10);
  scene.hang.to = {random.between(0.4, 1.0), 0.0, 1.0};
  scene.cloth.folds = 3;
  scene.cloth.slits = {{4, 2}};
  for (int number = 0; number < 8; ++number) scene.obstacles.push_back(randomObstacle(number, random));
  return scene;
}

/// The moment of a simulator, its nodes thrown about.
Moment randomMoment(const Simulator& simulator, Random& random) {
  Moment moment;
  readMoment(simulator, moment);
  for (Vec3& position : moment.mesh.positions) position += random.inBox(0.04);
  for (char& present : moment.present) present = random.between(0.0, 1.0) < 0.8 ? 1 : 0;
  return moment;
}

bool isInSolid(const Simulator& simulator, const Vec3& point) {
  for (int i = 0; i < simulator.obstacleCount(); ++i) {
    const Pose& pose = simulator.obstaclePose(i);
    const Vec3 inside = pose.orientation.conjugate() * (point - pose.position);
    SurfacePoint surface;
    if (simulator.obstacleShape(i).query(inside, inside, 0.0, surface) && surface.distance < 0.0) return true;
  }
  return false;
}

RayGrid randomRays(Random& random) {
  RayGrid rays;
  rays.width = kRaysOfScene / 50;
  rays.height = 50;
  for (int n = 0; n < kRaysOfScene; ++n) {
    // Most of them to where there is something.
    const Vec3 direction = (Vec3(0.0, 0.0, 1.0) + random.inBox(0.8)).normalized();
    rays.x.push_back(static_cast<float>(direction.x()));
    rays.y.push_back(static_cast<float>(direction.y()));
    rays.z.push_back(static_cast<float>(direction.z()));
  }
  return rays;
}

/// A pose that looks at the curtain, from outside of all solids.
Pose randomSensor(const Simulator& simulator, Random& random) {
  Pose sensor;
  do {
    sensor.position = Vec3(0.5, 0.0, 0.8) + random.between(0.5, 2.5) * random.direction();
  } while (isInSolid(simulator, sensor.position));
  const Vec3 ahead = Vec3(0.5, 0.0, 0.6) - sensor.position;
  sensor.orientation = Rotation::FromTwoVectors(Vec3::UnitZ(), ahead);
  return sensor;
}

struct Judge {
  const Simulator& simulator;
  const Moment& moment;
  const Pose& sensor;
  int beside = 0;  ///< rays for which those beside were asked

  BruteHit first(const Vec3& origin, const Vec3& direction) const {
    return curtain_test::firstThing(simulator, moment, origin, direction, kNearest, kFarthest);
  }

  bool isRight(const Vec3& seen_direction, const RayHit& hit) {
    const double length = seen_direction.norm();
    const Vec3 direction = sensor.orientation * (seen_direction / length);
    const double told =
        hit.triangle == RayHit::kNothing ? std::numeric_limits<double>::infinity() : hit.distance * length;
    const auto agrees = [&](const BruteHit& truth, double slack) {
      if (std::isinf(truth.distance) || std::isinf(told)) return truth.distance == told;
      return std::abs(truth.distance - told) <= slack && truth.label == hit.label;
    };
    if (agrees(first(sensor.position, direction), 2.0 * kWidth)) return true;
    // At a slant, at an outline, or at the end of the range: the rays beside, which also bracket it.
    ++beside;
    const Vec3 across = direction.unitOrthogonal(), up = direction.cross(across);
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
    bool found = false;
    for (int k = 0; k < 8; ++k) {
      const double angle = 0.25 * k * curtain_test::kPi;
      const Vec3 aside = kWidth * (std::cos(angle) * across + std::sin(angle) * up);
      const BruteHit truth = first(sensor.position + aside, direction);
      if (agrees(truth, 2.0 * kWidth)) found = true;
      if (truth.label != hit.label || std::isinf(truth.distance)) continue;
      least = std::min(least, truth.distance);
      most = std::max(most, truth.distance);
    }
    return found || (told >= least - 2.0 * kWidth && told <= most + 2.0 * kWidth);
  }
};

TEST(Occlusion, IsThatOfBruteForce) {
  Random random(20);
  int wrong = 0, beside = 0, of_cloth = 0, of_obstacles = 0;
  for (int s = 0; s < kScenes; ++s) {
    const Simulator simulator(randomScene(random));
    const Moment moment = randomMoment(simulator, random);
    const Pose sensor = randomSensor(simulator, random);
    const RayGrid rays = randomRays(random);
    RayCaster caster(simulator, 0.0);
    caster.place(moment, sensor);
    std::vector<RayHit> hits;
    caster.cast(rays, {static_cast<float>(kNearest), static_cast<float>(kFarthest)}, 0, hits);
    Judge judge{simulator, moment, sensor};
    for (std::size_t ray = 0; ray < hits.size(); ++ray) {
      const Vec3 direction(rays.x[ray], rays.y[ray], rays.z[ray]);
      if (judge.isRight(direction, hits[ray])) continue;
      ++wrong;
      ADD_FAILURE() << "scene " << s << ", ray " << ray << ": met " << hits[ray].label << " at " << hits[ray].distance
                    << ", first is " << judge.first(sensor.position, sensor.orientation * direction).distance;
      if (wrong > 10) return;
    }
    beside += judge.beside;
    for (const RayHit& hit : hits) (hit.triangle >= 0 ? of_cloth : of_obstacles) += hit.triangle != RayHit::kNothing;
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(of_cloth, kScenes * kRaysOfScene / 10);
  EXPECT_GT(of_obstacles, kScenes * kRaysOfScene / 10);
  EXPECT_LT(beside, kScenes * kRaysOfScene / 50) << "few rays are at an outline";
}

// A mesh's normals are those of its facets where the obstacle is: turned with it, in the sensor's frame.
TEST(Occlusion, TurnsNormalsOfMeshesWithThem) {
  Random random(22);
  Scene scene = curtain_test::flatScene(4, 4);
  ObstacleParams none = randomObstacle(static_cast<int>(ShapeKind::kSphere), random);  // ids are not numbers of meshes
  none.pose.position = Vec3(5.0, 5.0, 5.0);
  ObstacleParams ball = randomObstacle(static_cast<int>(ShapeKind::kMesh), random), other = ball;
  ball.pose.position = Vec3(0.2, 2.0, 1.0);
  ball.pose.orientation = Eigen::AngleAxisd(0.5 * curtain_test::kPi, Vec3::UnitX());
  other.name = "other";
  other.pose.position = Vec3(0.8, 2.0, 1.0);
  other.pose.orientation = Eigen::AngleAxisd(1.0, Vec3(1.0, 2.0, 3.0).normalized());
  scene.obstacles = {none, ball, other};
  const Simulator simulator(scene);
  Moment moment;
  readMoment(simulator, moment);
  Pose sensor;  // behind the cloth, a little above
  sensor.position = Vec3(0.5, 0.5, 1.3);
  sensor.orientation = Rotation::FromTwoVectors(Vec3::UnitZ(), Vec3(0.5, 2.0, 1.0) - sensor.position);
  const RayGrid rays = randomRays(random);
  RayCaster caster(simulator, 0.0);
  caster.place(moment, sensor);
  std::vector<RayHit> hits;
  caster.cast(rays, {static_cast<float>(kNearest), static_cast<float>(kFarthest)}, 0, hits);
  std::array<int, 3> met{};
  for (std::size_t ray = 0; ray < hits.size(); ++ray) {
    if (hits[ray].triangle != RayHit::kObstacle) continue;
    const Vec3 direction = sensor.orientation * Vec3(rays.x[ray], rays.y[ray], rays.z[ray]);
    const Vec3 told = sensor.orientation * hits[ray].normal.cast<double>().normalized();
    // Of facets that meet at an edge, either will do.
    double closest = 0.0;
    for (std::size_t i = 1; i < 3; ++i) {
      const Pose& pose = moment.obstacles[i];
      const Vec3 o = pose.orientation.conjugate() * (sensor.position - pose.position);
      const Vec3 d = pose.orientation.conjugate() * direction;
      const ShapeTriangles mesh = simulator.obstacleShape(static_cast<int>(i)).triangles();
      for (const auto& t : mesh.triangles) {
        const auto corner = [&](int k) -> const Vec3& { return mesh.corners[static_cast<std::size_t>(t[k])]; };
        const Vec3 a = corner(0), b = corner(1), c = corner(2);
        if (!(std::abs(curtain_test::meetTriangle(o, d, a, b, c) - hits[ray].distance) < 1e-4)) continue;
        ++met[i];
        closest = std::max(closest, std::abs(told.dot(pose.orientation * (b - a).cross(c - a).normalized())));
      }
    }
    // Edges of 3 cm, their ends rounded by 1e-7 m: the cosine of 1e-5 rad is 1 but for 1e-10, and for single precision.
    ASSERT_NEAR(closest, 1.0, 1e-6) << "ray " << ray;
  }
  EXPECT_GT(met[1], 50);
  EXPECT_GT(met[2], 50);
}

// The cloth's own coordinates of a hit are those of the point on its triangle.
TEST(Occlusion, KnowsWhereOnTheClothItIs) {
  const Simulator simulator(curtain_test::flatScene(6, 5));  // 1 m by 1 m, from (0, 0, 1) along x
  std::vector<double> warp, weft;
  simulator.copyRestLengths(warp, weft);
  const FlatCloth flat(simulator.fineMeshTopology(), warp, weft);
  SensorParams params;
  params.sensor = SensorKind::kCamera;
  SensorView view(simulator, flat, params);
  std::vector<Problem> problems;
  view.setRays(cameraRays(cameraModel(params.camera), problems));
  ASSERT_TRUE(problems.empty());
  Moment moment;
  readMoment(simulator, moment);
  for (std::size_t n = 0; n < moment.velocities.size(); ++n) moment.velocities[n] = Vec3(0.0, 3.0, 0.0);
  Pose sensor;
  sensor.position = Vec3(0.5, -1.5, 0.5);  // looks along +y, x to the right, z up
  sensor.orientation = Eigen::AngleAxisd(-0.5 * curtain_test::kPi, Vec3::UnitX());
  view.render(moment, sensor);
  std::vector<CloudPoint> points;
  view.points(moment, points);
  int seen = 0;
  for (const CloudPoint& point : points) {
    if (point.node < 0) continue;
    ++seen;
    const Vec3 world = sensor.position + sensor.orientation * Vec3(point.x, point.y, point.z);
    // Coordinates of 1.5 m in single precision, a few roundings.
    EXPECT_NEAR(world.x(), point.u, 1e-6);
    EXPECT_NEAR(1.0 - world.z(), point.v, 1e-6);
    EXPECT_NEAR(point.speed, 3.0F, 1e-6F);
    EXPECT_NEAR(point.normal_z, -1.0F, 1e-6F) << "towards the sensor";
    const double row = std::floor(point.v / 0.2 + 0.5), column = std::floor(point.u / 0.25 + 0.5);
    const bool between = std::abs(point.v / 0.2 + 0.5 - std::round(point.v / 0.2 + 0.5)) < 1e-4 ||
                         std::abs(point.u / 0.25 + 0.5 - std::round(point.u / 0.25 + 0.5)) < 1e-4;
    if (!between) {
      EXPECT_EQ(point.node, static_cast<int>(row * 5.0 + column));
    }
    if (::testing::Test::HasFailure()) return;
  }
  // 525 pixels a metre at 1 m, so 350 at 1.5 m.
  EXPECT_NEAR(seen, 350 * 350, 2 * 350);
}

// Looked at again, by another sensor, on other threads, beside each other: the same bits, whatever was seen before.
TEST(Occlusion, HasTheSameBitsEveryTime) {
  Random random(21);
  Scene scene = randomScene(random);
  scene.cloth.porosity = 0.3;
  const Simulator simulator(scene);
  std::vector<double> warp, weft;
  simulator.copyRestLengths(warp, weft);
  const FlatCloth flat(simulator.fineMeshTopology(), warp, weft);
  SensorParams params;
  params.sensor = SensorKind::kLidar;
  params.noise = RangeNoise::kGaussian;
  params.dropout = 0.1;
  const Moment before = randomMoment(simulator, random);
  Moment moment = randomMoment(simulator, random);
  const Pose sensor = randomSensor(simulator, random);
  const auto look = [&](bool looked_before, std::vector<CloudPoint>& out) {
    SensorView view(simulator, flat, params);
    view.setRays(lidarRays(params.lidar));
    if (looked_before) view.render(before, sensor);
    view.render(moment, sensor);
    view.points(moment, out);
  };
  std::array<std::vector<CloudPoint>, 3> points;
  look(false, points[0]);
  std::thread one([&] { look(true, points[1]); }), other([&] { look(false, points[2]); });
  one.join();
  other.join();
  const auto same = [](const std::vector<CloudPoint>& a, const std::vector<CloudPoint>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(CloudPoint)) == 0;
  };
  ASSERT_EQ(points[0].size(), 16U * 1800U);
  EXPECT_TRUE(same(points[0], points[1]));
  EXPECT_TRUE(same(points[0], points[2]));
  ++moment.frame;
  look(false, points[1]);
  EXPECT_FALSE(same(points[0], points[1])) << "another frame, other random numbers";
  --moment.frame;
  params.seed = 2;
  look(false, points[1]);
  EXPECT_FALSE(same(points[0], points[1])) << "another seed";
}

}  // namespace
}  // namespace curtain
