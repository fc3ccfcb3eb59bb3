// SPDX-License-Identifier: BSD-3-Clause
//
// The mesh that the eye sees and obstacles: judged by brute force, nothing of it is in an obstacle that the first layer
// itself is not in, on the move and at rest, and all but few folds keep their rods' lengths.
#include "simulator/fine_surface.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>
#include <string>

#include "contact/piercings.h"
#include "curtain_sim/simulator.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::kPi;

constexpr double kTolerance = 1e-6;

/// What was seen of a scene.
struct Tally {
  long frames = 0;
  long pierced_first = 0;    ///< frames in which the first layer is pierced
  long quads = 0;            ///< of the first layer, near the obstacle and free of it
  long quads_left_out = 0;   ///< of the first layer, pierced
  long nodes = 0;            ///< of the fine mesh, inside
  long faces = 0;            ///< of the fine mesh, pierced, in quads that are free
  long folds = 0;            ///< of all frames
  long flattened = 0;
  long uneven = 0;           ///< whose rods are not all rest / k long
  long turned_rods = 0;
};

/// A sheet of 1 m, its links 8 % longer than its nodes are apart, that falls on what lies below its middle.
Scene sheetOver(const ObstacleParams& obstacle, int nodes) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = nodes;
  scene.cloth.height = scene.cloth.width = 1.0;
  scene.hang.tilt = 0.5 * kPi;
  scene.hang.from = Vec3(-0.46, 0.5, 0.45);
  scene.hang.to = Vec3(0.46, 0.5, 0.45);
  scene.pins.kind = PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = 0.3;
  scene.obstacles.push_back(obstacle);
  // Stands, then goes up and aside while it turns, and stands again.
  const Pose start = obstacle.pose;
  Pose end = start;
  end.position += Vec3(0.1, 0.05, 0.2);
  end.orientation = Eigen::AngleAxisd(0.6, Vec3(0.3, 0.2, 1.0).normalized()) * start.orientation;
  scene.obstacles[0].motion = {{0.0, start}, {0.8, start}, {1.3, end}, {2.5, end}};
  return scene;
}

ObstacleParams obstacleOf(ShapeKind shape, const std::string& mesh = "") {
  ObstacleParams obstacle;
  obstacle.name = "obstacle";
  obstacle.shape = shape;
  obstacle.radius = 0.2;
  obstacle.length = 0.5;
  obstacle.size = Vec3(0.35, 0.3, 0.4);
  obstacle.friction = 0.8;
  obstacle.pose.position = Vec3(0.02, 0.03, 0.15);
  if (shape == ShapeKind::kMesh) {
    obstacle.mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/" + mesh;
    obstacle.scale = Vec3::Constant(0.5);
  }
  if (shape == ShapeKind::kCylinder || shape == ShapeKind::kCapsule) {
    obstacle.radius = 0.1;
    obstacle.pose.orientation = Eigen::AngleAxisd(0.5 * kPi, Vec3(1.0, 0.4, 0.0).normalized());
  }
  return obstacle;
}

struct Case {
  std::string name;
  Scene scene;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  const auto add = [&](const std::string& name, const ObstacleParams& obstacle, int nodes) {
    all.push_back({name, sheetOver(obstacle, nodes)});
  };
  add("sphere", obstacleOf(ShapeKind::kSphere), 20);
  add("box", obstacleOf(ShapeKind::kBox), 20);
  ObstacleParams cornered = obstacleOf(ShapeKind::kBox);
  cornered.pose.orientation = Eigen::Quaterniond::FromTwoVectors(Vec3(0.35, 0.3, 0.4), Vec3::UnitZ());
  add("box on its corner", cornered, 20);
  add("cylinder", obstacleOf(ShapeKind::kCylinder), 20);
  add("capsule", obstacleOf(ShapeKind::kCapsule), 20);
  ObstacleParams pea = obstacleOf(ShapeKind::kSphere);
  pea.radius = 0.08;
  pea.pose.position.z() = 0.3;
  add("small ball", pea, 9);
  ObstacleParams plane = obstacleOf(ShapeKind::kPlane);
  add("plane", plane, 14);
  ObstacleParams hollow = obstacleOf(ShapeKind::kMesh, "l_prism.obj");
  hollow.pose.orientation = Eigen::AngleAxisd(0.25 * kPi, Vec3::UnitX());  // the hollow upwards
  add("L", hollow, 20);
  add("icosphere", obstacleOf(ShapeKind::kMesh, "icosphere.stl"), 20);
  all.back().scene.obstacles[0].scale = Vec3::Constant(0.2);
  add("open cube", obstacleOf(ShapeKind::kMesh, "cube_open.obj"), 20);
  return all;
}

/// The two triangles of every quad of the first layer, by index into the fine mesh.
std::array<MeshTriangle, 2> coarseQuad(const FineMeshTopology& topology, int row, int link) {
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>(i * topology.columns + j * topology.folds % topology.columns);
  };
  return {{{at(row, link), at(row + 1, link), at(row, link + 1)},
           {at(row, link + 1), at(row + 1, link), at(row + 1, link + 1)}}};
}

/// Folds whose rods are not of equal length, rest / k; taut ones may be longer.
long unevenFolds(const Scene& scene, const FineMeshTopology& topology, const FineMesh& mesh) {
  const double rest = scene.cloth.width / weftLinkCount(scene.cloth);
  long uneven = 0;
  for (int i = 0; i < topology.rows; ++i) {
    for (int first = 0; first + topology.folds < topology.columns; first += topology.folds) {
      const auto node = [&](int p) { return mesh.positions[static_cast<std::size_t>(i * topology.columns + first + p)]; };
      const double rod = std::max(rest, (node(topology.folds) - node(0)).norm()) / topology.folds;
      bool even = true;
      for (int p = 0; p < topology.folds; ++p) even = even && std::abs((node(p + 1) - node(p)).norm() - rod) < 1e-6 * rod;
      uneven += !even;
    }
  }
  return uneven;
}

void look(const Simulator& simulator, Tally& tally) {
  FineMesh mesh;
  simulator.copyFineMesh(mesh);
  const FineMeshTopology& topology = simulator.fineMeshTopology();
  const Scene& scene = simulator.scene();
  const Transform place(simulator.obstaclePose(0));
  const ObstacleShape& shape = simulator.obstacleShape(0);
  std::vector<MeshTriangle> judged;
  const int links = weftLinkCount(scene.cloth);
  bool first_pierced = false;
  for (int i = 0; i + 1 < topology.rows; ++i) {
    for (int link = 0; link < links; ++link) {
      const auto quad = coarseQuad(topology, i, link);
      if (countPiercings(shape, place, mesh.positions, {quad[0], quad[1]}, kTolerance).faces > 0) {
        ++tally.quads_left_out;
        first_pierced = true;
        continue;
      }
      ++tally.quads;
      const auto first = topology.triangles.begin() + 2L * (i * links + link) * topology.folds;
      judged.insert(judged.end(), first, first + 2L * topology.folds);
    }
  }
  tally.pierced_first += first_pierced;
  const Piercings count = countPiercings(shape, place, mesh.positions, judged, kTolerance);
  tally.nodes += countPiercings(shape, place, mesh.positions, topology.triangles, kTolerance).nodes;
  tally.faces += count.faces;
  tally.folds += static_cast<long>(topology.rows) * links;
  tally.flattened += mesh.flattened_folds;
  tally.uneven += unevenFolds(scene, topology, mesh);
  ++tally.frames;
}

TEST(FineSurface, PiercesNothing) {
  for (const Case& each : cases()) {
    Simulator simulator(each.scene);
    Tally tally;
    for (int frame = 0; frame < 120; ++frame) {
      simulator.step();
      if (frame % 4 == 3) look(simulator, tally);
    }
    std::printf("%-18s contacts %3d, frames %ld (first layer pierced in %ld, %ld of %ld quads), fine nodes in %ld, faces "
                "pierced %ld, folds flattened %.2f %% (uneven %ld of %ld)\n", each.name.c_str(),
                simulator.statistics().contacts_max, tally.frames, tally.pierced_first, tally.quads_left_out,
                tally.quads + tally.quads_left_out, tally.nodes, tally.faces,
                100.0 * static_cast<double>(tally.flattened) / static_cast<double>(tally.folds), tally.uneven, tally.flattened);
    EXPECT_GT(simulator.statistics().contacts_max, 3) << each.name;
    EXPECT_EQ(tally.nodes, 0) << each.name;
    EXPECT_EQ(tally.faces, 0) << each.name;
    EXPECT_EQ(tally.uneven, tally.flattened) << each.name;
  }
}

}  // namespace
}  // namespace curtain
