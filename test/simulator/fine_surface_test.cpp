// SPDX-License-Identifier: BSD-3-Clause
//
// The mesh that the eye sees and obstacles: judged by brute force, nothing of it is in an obstacle that the first layer
// itself is not in, on the move and at rest, and all but few folds keep their rods' lengths.
#include "surface/fine_surface.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "contact/oracle/piercings.h"
#include "curtain_sim/simulator.h"
#include "obstacles/contact_shape.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::kPi;

constexpr double kTolerance = 1e-6;

/// What was seen of a scene.
struct Tally {
  long frames = 0;
  long pierced_first = 0;   ///< frames in which the first layer is pierced
  long quads = 0;           ///< of the first layer, free of the obstacle
  long quads_left_out = 0;  ///< of the first layer, pierced
  long nodes = 0;           ///< of the fine mesh, inside
  long faces = 0;           ///< of the fine mesh, pierced, in quads that are free
  long folds = 0;           ///< of all frames
  long flattened = 0;
  long uneven = 0;  ///< whose rods are not all rest / k long
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

struct Surface {
  std::string name;
  Scene scene;
};

std::vector<Surface> cases() {
  std::vector<Surface> all;
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
      const auto node = [&](int p) {
        return mesh.positions[static_cast<std::size_t>(i * topology.columns + first + p)];
      };
      const double rod = std::max(rest, (node(topology.folds) - node(0)).norm()) / topology.folds;
      bool even = true;
      for (int p = 0; p < topology.folds; ++p)
        even = even && std::abs((node(p + 1) - node(p)).norm() - rod) < 1e-6 * rod;
      uneven += !even;
    }
  }
  return uneven;
}

void look(const Simulator& simulator, const ContactShape& shape, Tally& tally) {
  FineMesh mesh;
  simulator.copyFineMesh(mesh);
  const FineMeshTopology& topology = simulator.fineMeshTopology();
  const Scene& scene = simulator.scene();
  const Transform place(simulator.obstaclePose(0));
  std::vector<MeshTriangle> judged;
  const int links = weftLinkCount(scene.cloth);
  bool first_pierced = false;
  for (int i = 0; i + 1 < topology.rows; ++i) {
    for (int link = 0; link < links; ++link) {
      const auto quad = coarseQuad(topology, i, link);
      if (countPiercings(shape, place, mesh.positions, {quad[0], quad[1]}, 0.0).faces > 0) {
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
  for (const Surface& each : cases()) {
    Simulator simulator(each.scene);
    const auto shape = makeContactShape(each.scene.obstacles[0], resolveMeshUrl);
    Tally tally;
    for (int frame = 0; frame < 120; ++frame) {
      simulator.step();
      if (frame % 8 == 7) look(simulator, *shape, tally);
    }
    std::printf(
        "%-18s contacts %3d, frames %ld (first layer pierced in %ld, %ld of %ld quads), fine nodes in %ld, faces "
        "pierced %ld, folds flattened %.2f %% (uneven %ld of %ld)\n",
        each.name.c_str(), simulator.statistics().contacts_max, tally.frames, tally.pierced_first, tally.quads_left_out,
        tally.quads + tally.quads_left_out, tally.nodes, tally.faces,
        100.0 * static_cast<double>(tally.flattened) / static_cast<double>(tally.folds), tally.uneven, tally.flattened);
    EXPECT_GT(simulator.statistics().contacts_max, 3) << each.name;
    EXPECT_EQ(tally.nodes, 0) << each.name;
    EXPECT_EQ(tally.faces, 0) << each.name;
    EXPECT_EQ(tally.uneven, tally.flattened) << each.name;
    // 4 % at most where the first layer is free; folds whose very ends or chords are in the obstacle come on top.
    EXPECT_LE(static_cast<double>(tally.flattened), 0.1 * static_cast<double>(tally.folds)) << each.name;
  }
}

/// Flat cloth 6 mm over a plane, with more weft than way, and what the eye sees of it.
class OverAPlane {
 public:
  OverAPlane()
      : scene_(planeScene()),
        pattern_(makePattern(scene_)),
        surface_(scene_.cloth, pattern_),
        obstacles_(scene_, shapesBy(resolveMeshUrl)) {
    position_.assign(pattern_.grid.size(), 0.0);
  }
  /// tilt [rad]: of the cloth about its weft, over the plane z = 0.
  const FineMesh& seen(double tilt, FineMesh& mesh) {
    const Eigen::AngleAxisd turned(tilt, Vec3::UnitX());
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 8; ++j) {
        position_.set(pattern_.grid.index(i, j), turned * Vec3(0.06 * j, 0.2 - 0.08 * i, 0.0) + kAbove);
      }
    }
    surface_.build(position_, obstacles_, scene_.contact.thickness, mesh);
    return mesh;
  }
  const FineMeshTopology& topology() const { return surface_.topology(); }
  const Scene& scene() const { return scene_; }

 private:
  static Scene planeScene() {
    Scene scene;
    scene.cloth.rows = 6;
    scene.cloth.columns = 8;
    scene.cloth.width = 0.49;  // rods' length 7 cm over 6 cm
    scene.cloth.height = 0.4;
    ObstacleParams plane;
    plane.name = "plane";
    plane.shape = ShapeKind::kPlane;
    scene.obstacles.push_back(plane);
    return scene;
  }
  const Vec3 kAbove = Vec3(0.0, 0.0, 0.006);  // bows are 16 mm high
  Scene scene_;
  ClothPattern pattern_;
  FineSurface surface_;
  ObstacleSet obstacles_;
  Field3 position_;
};

// Folds that bow into what the cloth lies on need about as far a turn either way. While the cloth trembles around level
// they keep to one side: a node moves no more than a few times as far as the cloth does (1e-5 m in a step) and than the
// turn's last bit lets it (a fifteenth of a degree of 16 mm: 2e-5 m).
TEST(FineSurface, FoldsThatTrembleDoNotFlip) {
  OverAPlane cloth;
  FineMesh last, mesh;
  cloth.seen(-0.01, last);
  double largest = 0.0;
  constexpr int kSteps = 400;
  for (int n = 1; n <= kSteps; ++n) {
    cloth.seen(-0.01 + 0.02 * n / kSteps, mesh);
    for (std::size_t p = 0; p < mesh.positions.size(); ++p) {
      largest = std::max(largest, (mesh.positions[p] - last.positions[p]).norm());
    }
    EXPECT_EQ(mesh.flattened_folds, 0);
    std::swap(mesh, last);
  }
  std::printf("largest way of a fine node in a step of %.1e rad: %.2e m\n", 0.02 / kSteps, largest);
  EXPECT_LT(largest, 1e-4);
}

// The folds that bow away from the obstacle stay as they are, the others turn by what they must: their nodes come to
// rest at the clearance, on the side of the next row.
TEST(FineSurface, TurnsNoFurtherThanItMust) {
  OverAPlane cloth;
  FineMesh mesh;
  cloth.seen(0.0, mesh);
  const FineMeshTopology& topology = cloth.topology();
  int up = 0, turned = 0;
  for (int i = 0; i < topology.rows; ++i) {
    for (int f = 3; f < topology.columns; f += 6) {
      const Vec3& top = mesh.positions[static_cast<std::size_t>(i * topology.columns + f)];
      const double row = 0.2 - 0.08 * i;
      if (top.z() > 0.006) {
        ++up;
        EXPECT_NEAR(top.y(), row, 1e-12);
      } else {
        ++turned;
        EXPECT_NEAR(top.z(), 0.1 * cloth.scene().contact.thickness, 5e-5);
        EXPECT_LT(top.y(), row);
      }
    }
  }
  EXPECT_EQ(up, 18);
  EXPECT_EQ(turned, 24);
}

// The mesh is a function of the nodes and obstacles: asked twice, after other frames, or of another simulator, it has
// the same bits.
TEST(FineSurface, IsTheSameForTheSameState) {
  for (const Surface& each : cases()) {
    Simulator one(each.scene), other(each.scene);
    FineMesh early, first, second, third;
    for (int frame = 0; frame < 50; ++frame) {
      one.step();
      other.step();
      if (frame % 10 == 0) one.copyFineMesh(early);
    }
    one.copyFineMesh(first);
    one.copyFineMesh(second);
    other.copyFineMesh(third);
    EXPECT_EQ(first.positions, second.positions) << each.name;
    EXPECT_EQ(first.positions, third.positions) << each.name;
    EXPECT_EQ(first.flattened_folds, third.flattened_folds) << each.name;
  }
}

}  // namespace
}  // namespace curtain
