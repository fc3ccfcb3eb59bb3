// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "curtain_sim/obstacle_shape.h"
#include "fuzz/checks.h"
#include "obstacles/obstacle_features.h"

namespace curtain_test {
namespace {

using curtain::ObstacleShape;
using curtain::SurfacePoint;
using curtain::Vec3;

// A file that is gone when the check is over, however it ends.
class ScratchFile {
 public:
  ScratchFile(const std::string& bytes, const std::string& ending)
      : path_(std::filesystem::temp_directory_path() / ("curtain_fuzz_" + std::to_string(getpid()) + ending)) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~ScratchFile() { std::filesystem::remove(path_); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

// The directions that a query gives are divided by lengths once or twice.
constexpr double kUnit = 1e-9;

void askAt(const ObstacleShape& shape, const Vec3& previous, const Vec3& current, double reach) {
  SurfacePoint out;
  if (!shape.query(previous, current, reach, out)) return;
  require(std::isfinite(out.distance), "the distance of a query is finite");
  require(std::abs(out.normal.norm() - 1.0) <= kUnit, "the way out is a unit vector");
}

// Around and inside the shape's box, from every point to the next.
void askAround(const ObstacleShape& shape) {
  const Eigen::AlignedBox3d box = shape.bounds();
  const Vec3 size = box.sizes();
  require(box.min().allFinite() && box.max().allFinite(), "its box is finite");
  constexpr int kSteps = 4;
  Vec3 previous = box.min() - 0.5 * size;
  for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
    const Vec3 share(i % kSteps, i / kSteps % kSteps, i / (kSteps * kSteps));
    const Vec3 current = box.min() + (share * (2.0 / (kSteps - 1)) - Vec3::Constant(0.5)).cwiseProduct(size);
    askAt(shape, previous, current, 0.1 * size.norm());
    askAt(shape, current, current, 0.0);
    previous = current;
  }
  for (const Vec3& corner : shape.triangles().corners) {
    require(corner.allFinite(), "its corners are finite");
    askAt(shape, corner, corner, 1e-3);
    askAt(shape, previous, corner, 0.0);
  }
}

}  // namespace

void checkMesh(const std::string& bytes) {
  // assimp clears 16 MiB for every OBJ; without a vertex there is nothing in it to find.
  const bool may_be_obj = bytes.find("v ") != std::string::npos;
  for (const std::string ending : {".stl", ".dae", ".obj"}) {
    if (ending == ".obj" && !may_be_obj) continue;
    const ScratchFile file(bytes, ending);
    curtain::ObstacleParams obstacle;
    obstacle.name = "fuzzed";
    obstacle.shape = curtain::ShapeKind::kMesh;
    obstacle.mesh = file.path();
    std::unique_ptr<const ObstacleShape> shape;
    try {
      shape = curtain::makeObstacleShape(obstacle);
    } catch (const std::invalid_argument& refused) {
      require(std::string(refused.what()).find("fuzzed") != std::string::npos, "the refusal names the obstacle");
      continue;
    }
    askAround(*shape);
  }
}

}  // namespace curtain_test
