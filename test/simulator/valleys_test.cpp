// SPDX-License-Identifier: BSD-3-Clause
//
// Limp sheets without friction that fall into the valleys of rough meshes: nothing drives them, so their energy never
// rises.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "curtain_sim/simulator.h"
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

TEST(Valleys, OfRoughMeshesGiveFallingClothNoEnergy) {
  // In a frame, of m g L: what is asked of strips that slide off edges.
  constexpr double kMostRise = 1e-2;
  for (const unsigned seed : {13U, 16U, 31U, 39U}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    Scene scene;
    scene.cloth.rows = 8 + static_cast<int>(8.0 * share(random));
    scene.cloth.columns = 8 + static_cast<int>(8.0 * share(random));
    scene.cloth.height = scene.cloth.width = 0.5;
    scene.hang.from = {-0.25, -0.25, 0.3};
    scene.hang.to = {0.25, -0.25, 0.3};
    scene.hang.tilt = -0.5 * curtain_test::kPi;
    scene.pins.kind = PinKind::kNone;
    scene.solver.rest_speed = 0.0;
    scene.solver.threads = 1;
    scene.air.inside = scene.air.border = scene.air.corner = 0.0;
    ObstacleParams ground;
    ground.name = "ground";
    ground.shape = ShapeKind::kMesh;
    ground.mesh = writeGround(seed, 0.1, 0.06);
    ground.friction = 0.0;
    scene.obstacles.push_back(ground);
    Simulator simulator(scene);
    std::filesystem::remove(ground.mesh);
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
    EXPECT_LT(most, kMostRise) << "seed " << seed;
    EXPECT_LT(simulator.energy().potential, start - 0.3 * unit) << "it fell by at least half of its height";
  }
}

}  // namespace
}  // namespace curtain
