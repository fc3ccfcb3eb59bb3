// SPDX-License-Identifier: BSD-3-Clause
//
// Mesh files become shapes in metres, whatever their format, unit and winding; a file that cannot is refused with one
// sentence naming obstacle, file and reason. The files in test/meshes are cubes of edge 1 around the origin unless
// their name says otherwise.
#include "obstacles/mesh_loader.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>

#include "obstacles/shapes.h"
#include "obstacles/triangle_mesh.h"

namespace curtain {
namespace {

namespace fs = std::filesystem;

// The files hold single precision: 0.1 m and the like are off by half a unit of 2^-24 relative, twice for the product
// of a coordinate with a factor; coordinates are below 4 m.
constexpr double kSingle = 5e-7;

const fs::path kMeshes = fs::path(CURTAIN_SOURCE_DIR) / "test" / "meshes";

ObstacleParams meshObstacle(const std::string& url) {
  ObstacleParams obstacle;
  obstacle.name = "chair";
  obstacle.shape = ShapeKind::kMesh;
  obstacle.mesh = url;
  return obstacle;
}

std::unique_ptr<const ObstacleShape> makeFile(const std::string& file, const Vec3& scale = Vec3::Ones()) {
  ObstacleParams obstacle = meshObstacle((kMeshes / file).string());
  obstacle.scale = scale;
  return makeObstacleShape(obstacle);
}

bool isWatertight(const ObstacleShape& shape) { return dynamic_cast<const TriangleMeshShape&>(shape).watertight(); }

double distanceAt(const ObstacleShape& shape, const Vec3& point) {
  SurfacePoint surface;
  EXPECT_TRUE(shape.query(point, point, 100.0, surface));
  return surface.distance;
}

/// The message of the refusal; "" when the obstacle was accepted.
std::string refusal(const ObstacleParams& obstacle) {
  try {
    makeObstacleShape(obstacle);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void expectBounds(const ObstacleShape& shape, const Vec3& low, const Vec3& high) {
  EXPECT_NEAR((shape.bounds().min() - low).norm(), 0.0, kSingle) << shape.bounds().min().transpose();
  EXPECT_NEAR((shape.bounds().max() - high).norm(), 0.0, kSingle) << shape.bounds().max().transpose();
}

class EveryCube : public testing::TestWithParam<const char*> {};

TEST_P(EveryCube, IsTheUnitCube) {
  const auto shape = makeFile(GetParam());
  const BoxShape cube(Vec3(1.0, 1.0, 1.0));
  EXPECT_TRUE(isWatertight(*shape));
  expectBounds(*shape, Vec3::Constant(-0.5), Vec3::Constant(0.5));
  for (const double x : {-0.8, -0.45, 0.1, 0.6}) {
    for (const double y : {-0.7, 0.2, 0.43}) {
      for (const double z : {-0.9, -0.3, 0.46}) {
        // Halves are exact in single precision: only rounding in double is left.
        EXPECT_NEAR(distanceAt(*shape, Vec3(x, y, z)), cube.nearest(Vec3(x, y, z)).distance, 1e-15);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(MeshLoader, EveryCube,
                         testing::Values("cube_ascii.stl", "cube_binary.stl", "cube_quads.obj", "cube_inward.obj",
                                         "cube.dae", "cube_sliver.stl", "good_and_degenerate.stl"));

TEST(MeshLoader, IcosphereIsClosedAndRound) {
  const auto shape = makeFile("icosphere.stl");
  EXPECT_TRUE(isWatertight(*shape));
  EXPECT_EQ(shape->triangles().triangles.size(), 320u);
  EXPECT_EQ(shape->triangles().corners.size(), 162u);  // welded
  // Inscribed; edges of at most 0.325: circumradius below 0.325 / sqrt 3 = 0.188, sagitta below 0.188^2 / 2 = 0.0177.
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0.6, 0.64, -0.48), Vec3(0, -0.6, 0.8)}) {
    const double distance = distanceAt(*shape, 1.5 * direction);
    EXPECT_GE(distance, 0.5 - kSingle);
    EXPECT_LE(distance, 0.5177);
  }
}

TEST(MeshLoader, OpenFilesAreShells) {
  for (const char* const file : {"square_open.obj", "cube_open.obj"}) {
    const auto shape = makeFile(file);
    EXPECT_FALSE(isWatertight(*shape)) << file;
    EXPECT_GT(distanceAt(*shape, Vec3(0.1, 0.2, -0.4)), 0.0) << file;
    EXPECT_GT(distanceAt(*shape, Vec3(0.1, 0.2, 0.4)), 0.0) << file;
  }
}

TEST(MeshLoader, DaeUnitAndNodePosesAreAppliedAndItsUpAxisIsNot) {
  // In cm: a cube of 20 x 20 x 40 at x = 100, a mirrored one of 20 x 20 x 20 at z = 300.
  for (const char* const file : {"two_cubes_cm_z_up.dae", "two_cubes_cm_y_up.dae"}) {
    const auto shape = makeFile(file);
    EXPECT_TRUE(isWatertight(*shape)) << file;
    expectBounds(*shape, Vec3(-0.1, -0.1, -0.2), Vec3(1.1, 0.1, 3.1));
    EXPECT_NEAR(distanceAt(*shape, Vec3(1.0, 0.0, 0.17)), -0.03, kSingle) << file;
    EXPECT_NEAR(distanceAt(*shape, Vec3(0.0, 0.0, 3.05)), -0.05, kSingle) << file;  // inside although mirrored
    EXPECT_NEAR(distanceAt(*shape, Vec3(0.0, 0.0, 0.0)), 0.9, kSingle) << file;
  }
}

TEST(MeshLoader, ScaleIsPerAxisAndMayMirror) {
  const auto shape = makeFile("two_cubes_cm_z_up.dae", Vec3(-1.0, 2.0, 0.5));
  EXPECT_TRUE(isWatertight(*shape));
  expectBounds(*shape, Vec3(-1.1, -0.2, -0.1), Vec3(0.1, 0.2, 1.55));
  EXPECT_NEAR(distanceAt(*shape, Vec3(-1.0, 0.0, 0.08)), -0.02, kSingle);
  // An open mesh keeps its outside too: winding and normals are mirrored together.
  const auto square = makeFile("square_open.obj", Vec3(-1.0, 1.0, 1.0));
  const ShapeTriangles mesh = square->triangles();
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto at = [&](int i) { return mesh.corners[static_cast<std::size_t>(t[i])]; };
    EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).z(), 0.0);
  }
}

struct BadFile {
  const char* file;
  const char* reason;
};

class EveryBadFile : public testing::TestWithParam<BadFile> {};

TEST_P(EveryBadFile, IsRefusedWithObstacleFileAndReason) {
  const std::string path = (kMeshes / GetParam().file).string();
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const std::string message = refusal(meshObstacle(path));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");  // the reader does not chat
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(message.find("obstacle 'chair': mesh '" + path + "' " + GetParam().reason), 0u) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    MeshLoader, EveryBadFile,
    testing::Values(BadFile{"no_such_file.stl", "does not exist"}, BadFile{"", "is not a file"},
                    BadFile{"bad_empty.stl", "cannot be read: "}, BadFile{"bad_empty.obj", "cannot be read: "},
                    BadFile{"bad_empty.dae", "cannot be read: "}, BadFile{"bad_garbage.stl", "cannot be read: "},
                    BadFile{"bad_truncated.dae", "cannot be read: "},
                    BadFile{"bad_truncated_ascii.stl", "cannot be read: "},
                    BadFile{"bad_truncated_binary.stl", "cannot be read: "},
                    BadFile{"bad_index.obj", "cannot be read: "}, BadFile{"bad_no_facets.stl", "has no triangles"},
                    BadFile{"bad_points.obj", "has no triangles"},
                    BadFile{"bad_degenerate.stl", "has no triangle of nonzero area"},
                    BadFile{"bad_nan.stl", "has a corner that is not finite"},
                    BadFile{"bad_nan_ascii.stl", "has a corner that is not finite"},
                    BadFile{"bad_infinite.stl", "has a corner that is not finite"}));

TEST(MeshLoader, FileCutAnywhereIsAMeshOrARefusal) {
  // Whatever is left of a file, the answer is a shape or the documented exception, never anything else.
  const fs::path folder = fs::path(testing::TempDir()) / "curtain_mesh_cut";
  fs::create_directories(folder);
  for (const char* const file : {"cube_ascii.stl", "cube_binary.stl", "cube_quads.obj", "cube.dae"}) {
    std::ifstream input(kMeshes / file, std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(input)), std::istreambuf_iterator<char>());
    ASSERT_GT(whole.size(), 100u);
    int refused = 0;
    for (std::size_t length = 0; length < whole.size(); length += 7) {
      const fs::path cut = folder / file;
      std::ofstream(cut, std::ios::binary) << whole.substr(0, length);
      const std::string message = refusal(meshObstacle(cut.string()));
      EXPECT_TRUE(message.empty() || message.find("obstacle 'chair': mesh '") == 0) << message;
      refused += !message.empty();
    }
    EXPECT_GT(refused, 5) << file;
  }
  fs::remove_all(folder);
}

TEST(MeshLoader, ScaleThatLeavesNothingIsRefused) {
  ObstacleParams obstacle = meshObstacle((kMeshes / "cube_binary.stl").string());
  obstacle.scale = Vec3(1.0, 0.0, 1.0);
  EXPECT_EQ(refusal(obstacle), "obstacle 'chair': scale must be finite and not 0");
  obstacle.scale = Vec3::Constant(1e200);
  EXPECT_NE(refusal(obstacle).find("has a corner that is not finite, or beyond 1e30 m"), std::string::npos);
  obstacle.scale = Vec3::Constant(1e-200);
  EXPECT_NE(refusal(obstacle).find("has no triangle of nonzero area"), std::string::npos);
}

TEST(MeshUrl, FilesAndPlainPathsAreTakenAsTheyAre) {
  EXPECT_EQ(resolveMeshUrl("/a/b.stl"), "/a/b.stl");
  EXPECT_EQ(resolveMeshUrl("b.stl"), "b.stl");
  EXPECT_EQ(resolveMeshUrl("file:///a/b%20c.stl"), "/a/b c.stl");
  EXPECT_EQ(resolveMeshUrl("file:///a/100%.stl"), "/a/100%.stl");
  EXPECT_EQ(resolveMeshUrl("file://localhost/a/b%20c.stl"), "/a/b c.stl");  // RFC 8089
  EXPECT_EQ(resolveMeshUrl("file://LOCALHOST/a.stl"), "/a.stl");
  EXPECT_EQ(resolveMeshUrl("file://localhost"), "");
  EXPECT_EQ(resolveMeshUrl("file://localhosts/a.stl"), "") << "another computer";
  EXPECT_EQ(resolveMeshUrl("file://meshes/a.stl"), "") << "another computer, called meshes";
  EXPECT_EQ(resolveMeshUrl("file://"), "");
  EXPECT_EQ(resolveMeshUrl("http://a/b.stl"), "");
  EXPECT_EQ(resolveMeshUrl("package://"), "");
  EXPECT_EQ(resolveMeshUrl("package://nameonly"), "");
}

/// A tree of packages in a temporary folder, on ROS_PACKAGE_PATH while it lives.
class PackageTree : public testing::Test {
 protected:
  void SetUp() override {
    if (const char* const path = std::getenv("ROS_PACKAGE_PATH")) {
      before_ = path;
    }
    root_ = fs::path(testing::TempDir()) / "curtain_packages";
    fs::remove_all(root_);
    addPackage("one/alpha", "alpha");
    addPackage("one/stack/folder/deep", "beta");
    addPackage("one/a/b/c/d/e", "too_deep");
    addPackage("one/.hidden", "hidden");
    addPackage("two", "gamma");
    addPackage("three/alpha", "alpha");
    setenv("ROS_PACKAGE_PATH",
           ((root_ / "none").string() + "::" + (root_ / "one").string() + ":" + (root_ / "two").string() + ":" +
            (root_ / "three").string())
               .c_str(),
           1);
  }
  void TearDown() override {
    if (before_.empty()) {
      unsetenv("ROS_PACKAGE_PATH");
    } else {
      setenv("ROS_PACKAGE_PATH", before_.c_str(), 1);
    }
    fs::remove_all(root_);
  }
  void addPackage(const std::string& folder, const std::string& name) {
    fs::create_directories(root_ / folder);
    std::ofstream(root_ / folder / "package.xml")
        << "<?xml version=\"1.0\"?>\n<package>\n<!-- <name>commented</name> -->\n <name> " << name
        << "\n</name></package>";
  }

  fs::path root_;
  std::string before_;
};

TEST_F(PackageTree, PackagesAreFoundByTheNameInTheirManifest) {
  EXPECT_EQ(resolveMeshUrl("package://alpha/m/x.stl"), (root_ / "one/alpha/m/x.stl").string());  // first entry wins
  EXPECT_EQ(resolveMeshUrl("package://beta/x.stl"), (root_ / "one/stack/folder/deep/x.stl").string());
  EXPECT_EQ(resolveMeshUrl("package://gamma/x.stl"), (root_ / "two/x.stl").string());
  for (const char* const name : {"too_deep", "hidden", "commented", "deep", "delta"}) {
    EXPECT_EQ(resolveMeshUrl(std::string("package://") + name + "/x.stl"), "") << name;
  }
  unsetenv("ROS_PACKAGE_PATH");
  EXPECT_EQ(resolveMeshUrl("package://alpha/m/x.stl"), "");
}

TEST_F(PackageTree, MeshesLoadByPackageUrlAndUnknownPackagesAreRefused) {
  fs::copy_file(kMeshes / "cube_binary.stl", root_ / "two/cube.stl");
  EXPECT_EQ(makeObstacleShape(meshObstacle("package://gamma/cube.stl"))->triangles().triangles.size(), 12u);
  EXPECT_EQ(refusal(meshObstacle("package://delta/cube.stl"))
                .find("obstacle 'chair': mesh 'package://delta/cube.stl' cannot be resolved"),
            0u);
}

TEST(MeshUrl, AResolverOfOnesOwnIsAsked) {
  std::string asked;
  const auto shape = makeObstacleShape(meshObstacle("model:cube"), [&asked](const std::string& url) {
    asked = url;
    return (kMeshes / "cube_quads.obj").string();
  });
  EXPECT_EQ(asked, "model:cube");
  EXPECT_TRUE(isWatertight(*shape));
}

}  // namespace
}  // namespace curtain
