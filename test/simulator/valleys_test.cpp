// SPDX-License-Identifier: BSD-3-Clause
//
// Limp sheets that fall into the valleys of meshes. Nothing drives them, so their energy never rises; and they come to
// rest, held by the faces on both sides.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "curtain_sim/simulator.h"
#include "figures.h"
#include "testing.h"

namespace curtain {
namespace {

// Ground of square cells, each two triangles, whose corners are up to this high or deep [m].
std::string writeGround(unsigned seed, double cell, double height) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("curtain_valleys_" + std::to_string(seed) + ".obj");
  constexpr int kCells = 24;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  std::ofstream file(path);
  for (int i = 0; i <= kCells; ++i) {
    for (int j = 0; j <= kCells; ++j)
      file << "v " << (j - kCells / 2) * cell << ' ' << (i - kCells / 2) * cell << ' ' << height * share(random)
           << '\n';
  }
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const int a = i * (kCells + 1) + j + 1, c = a + kCells + 1;
      file << "f " << a << ' ' << a + 1 << ' ' << c + 1 << "\nf " << a << ' ' << c + 1 << ' ' << c << '\n';
    }
  }
  return path.string();
}

// A square of 0.5 m, flat, at a height above the ground.
Scene sheetOver(const std::string& ground, int rows, int columns, double height, double friction) {
  Scene scene;
  scene.cloth.rows = rows;
  scene.cloth.columns = columns;
  scene.cloth.height = scene.cloth.width = 0.5;
  scene.hang.from = {-0.25, -0.25, height};
  scene.hang.to = {0.25, -0.25, height};
  scene.hang.tilt = -0.5 * curtain_test::kPi;
  scene.pins.kind = PinKind::kNone;
  scene.solver.threads = 1;
  ObstacleParams mesh;
  mesh.name = "ground";
  mesh.shape = ShapeKind::kMesh;
  mesh.mesh = ground;
  mesh.friction = friction;
  scene.obstacles.push_back(mesh);
  return scene;
}

// Two slopes that meet.
std::string writeGroove(double slope) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "curtain_groove.obj";
  std::ofstream file(path);
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) file << "v " << x << ' ' << y << ' ' << slope * std::abs(x) << '\n';
  }
  file << "f 1 3 4\nf 1 4 2\nf 3 5 6\nf 3 6 4\n";
  return path.string();
}

TEST(Valleys, AreWhereClothComesToRest) {
  struct Valley {
    Method method;
    double friction;
  };
  // Without friction implicit still slides along the groove after 10 s, at 2 mm/s.
  for (const Valley& one : {Valley{Method::kAuto, 0.0}, {Method::kAuto, 0.3}, {Method::kImplicit, 0.3}}) {
    for (const double slope : {0.3, 0.6, 1.0, 2.0}) {
      SCOPED_TRACE("method " + std::to_string(static_cast<int>(one.method)) + ", slope " + std::to_string(slope) +
                   ", friction " + std::to_string(one.friction));
      const std::string groove = writeGroove(slope);
      Scene scene = sheetOver(groove, 10, 10, 0.3 + 0.3 * slope, one.friction);
      scene.solver.method = one.method;
      scene.air.inside = scene.air.border = scene.air.corner = 0.5;
      Simulator simulator(scene);
      std::filesystem::remove(groove);
      for (int frame = 0; frame < 600 && !simulator.statistics().asleep; ++frame) simulator.step();
      EXPECT_TRUE(simulator.statistics().asleep);
      EXPECT_EQ(simulator.statistics().last_resort_substeps, 0);
      // As is asked of cloth that lies on spiked shapes.
      const double weight = 9.81 * scene.cloth.surface_density * scene.cloth.width * scene.cloth.height;
      EXPECT_NEAR(simulator.contactWrench(0).force.z(), -weight, 1e-2 * weight);
    }
  }
}

TEST(Valleys, OfRoughMeshesGiveFallingClothNoEnergy) {
  // In a frame, of m g L: what is asked of strips that slide off edges.
  constexpr double kMaxRise = 1e-2;
  for (const unsigned seed : {13U, 16U, 31U, 39U}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const int rows = 8 + static_cast<int>(8.0 * share(random)), columns = 8 + static_cast<int>(8.0 * share(random));
    const std::string ground = writeGround(seed, 0.1, 0.06);
    Scene scene = sheetOver(ground, rows, columns, 0.3, 0.0);
    scene.solver.rest_speed = 0.0;
    scene.air.inside = scene.air.border = scene.air.corner = 0.0;
    Simulator simulator(scene);
    std::filesystem::remove(ground);
    const double unit =
        9.81 * scene.cloth.surface_density * scene.cloth.width * scene.cloth.height * scene.cloth.height;
    const auto energy = [&] { return simulator.energy().kinetic + simulator.energy().potential; };
    const double start = simulator.energy().potential;
    double before = energy(), most = 0.0;
    for (int frame = 0; frame < 90; ++frame) {
      simulator.step();
      const double now = energy();
      most = std::max(most, (now - before) / unit);
      before = now;
    }
    curtain_test::keepFigure("sheets on rough meshes, a frame's rise", most);
    EXPECT_LT(most, kMaxRise) << "seed " << seed;
    EXPECT_LT(simulator.energy().potential, start - 0.3 * unit) << "it fell by at least half of its height";
  }
}

}  // namespace
}  // namespace curtain
