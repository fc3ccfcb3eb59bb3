// SPDX-License-Identifier: BSD-3-Clause
#include "obstacles/mesh_loader.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "obstacles/triangle_mesh_topology.h"

namespace curtain {
namespace {

/// Coordinates beyond this [m] count as corrupt: their products would overflow.
constexpr double kFarthest = 1e30;
/// Reading takes about ten times as much memory, and such a mesh is too large for contact in real time.
constexpr std::uintmax_t kLargestFile = std::uintmax_t{256} << 20U;
constexpr std::size_t kMaxTriangles = 4000000;

[[noreturn]] void fail(const std::string& obstacle, const std::string& path, const std::string& reason) {
  throw std::invalid_argument("obstacle '" + obstacle + "': mesh '" + path + "' " + reason);
}

void requireReadable(const std::string& path, const std::string& obstacle) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) fail(obstacle, path, "does not exist");
  if (!std::filesystem::is_regular_file(path, error)) fail(obstacle, path, "is not a file");
  if (!std::ifstream(path, std::ios::binary)) fail(obstacle, path, "cannot be opened for reading");
  if (std::filesystem::file_size(path, error) > kLargestFile) fail(obstacle, path, "is larger than 256 MiB");
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::string problem = ending == ".dae" ? colladaProblem(path) : "";
  if (!problem.empty()) fail(obstacle, path, "cannot be read: " + problem);
}

/// Opens the mesh's file only: materials are not used, and what an OBJ or DAE refers to may be a device or a pipe.
class OneFile final : public Assimp::DefaultIOSystem {
 public:
  explicit OneFile(std::string path) : path_(std::move(path)) {}

  bool Exists(const char* file) const override { return path_ == file && DefaultIOSystem::Exists(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return path_ == file ? DefaultIOSystem::Open(file, mode) : nullptr;
  }

 private:
  std::string path_;
};

/// Triangulation takes a time quadratic in the corners of a polygon.
void requireModestPolygons(const aiScene& scene, const std::string& path, const std::string& obstacle) {
  constexpr unsigned int kMaxCorners = 1000;
  for (unsigned int m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[m];
    for (unsigned int f = 0; f < part.mNumFaces; ++f) {
      const unsigned int corners = part.mFaces[f].mNumIndices;
      if (corners <= kMaxCorners) continue;
      fail(obstacle, path, "has a polygon of " + std::to_string(corners) + " corners, more than 1000");
    }
  }
}

/// A node of the scene's tree with its pose in the file.
struct PlacedNode {
  const aiNode* node;
  Eigen::Matrix4d pose;
};

Eigen::Matrix4d toEigen(const aiMatrix4x4& m) {
  Eigen::Matrix4d matrix;
  matrix << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return matrix;
}

/// Appends the triangles of one part; points and lines are left out.
void appendPart(const aiMesh& part, const Eigen::Matrix4d& pose, const Vec3& scale, ShapeTriangles& mesh) {
  const auto first = static_cast<int>(mesh.corners.size());
  const Eigen::Matrix3d linear = scale.asDiagonal() * pose.topLeftCorner<3, 3>();
  const Vec3 shift = scale.cwiseProduct(pose.topRightCorner<3, 1>());
  for (unsigned int i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& vertex = part.mVertices[i];
    mesh.corners.push_back(linear * Vec3(vertex.x, vertex.y, vertex.z) + shift);
  }
  const bool mirrored = linear.determinant() < 0.0;
  for (unsigned int f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices != 3 ||
        std::any_of(face.mIndices, face.mIndices + 3, [&part](unsigned int i) { return i >= part.mNumVertices; })) {
      continue;
    }
    Eigen::Vector3i triangle(first + static_cast<int>(face.mIndices[0]), first + static_cast<int>(face.mIndices[1]),
                             first + static_cast<int>(face.mIndices[2]));
    if (mirrored) std::swap(triangle[1], triangle[2]);
    mesh.triangles.push_back(triangle);
  }
}

/// Parts may be instanced many times: the total is limited.
ShapeTriangles collectParts(const aiScene& scene, const Vec3& scale, const std::string& path,
                            const std::string& obstacle) {
  ShapeTriangles mesh;
  std::vector<PlacedNode> pending = {{scene.mRootNode, toEigen(scene.mRootNode->mTransformation)}};
  while (!pending.empty()) {
    const PlacedNode placed = pending.back();
    pending.pop_back();
    for (unsigned int i = 0; i < placed.node->mNumMeshes; ++i) {
      const aiMesh& part = *scene.mMeshes[placed.node->mMeshes[i]];
      if (mesh.triangles.size() + part.mNumFaces > kMaxTriangles ||
          mesh.corners.size() + part.mNumVertices > 3 * kMaxTriangles) {
        fail(obstacle, path, "has more than 4 million triangles");
      }
      appendPart(part, placed.pose, scale, mesh);
    }
    for (unsigned int i = placed.node->mNumChildren; i-- > 0;) {  // so that the first child comes first
      const aiNode* child = placed.node->mChildren[i];
      pending.push_back({child, placed.pose * toEigen(child->mTransformation)});
    }
  }
  return mesh;
}

/// Merges exactly equal corners; drops triangles with one corner twice, and corners without a triangle.
ShapeTriangles weld(const ShapeTriangles& mesh) {
  std::vector<int> order;
  order.reserve(3 * mesh.triangles.size());
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    order.insert(order.end(), {triangle[0], triangle[1], triangle[2]});
  }
  const auto corner = [&mesh](int i) -> const Vec3& { return mesh.corners[static_cast<std::size_t>(i)]; };
  std::sort(order.begin(), order.end(), [&corner](int one, int other) {
    const Vec3& p = corner(one);
    const Vec3& q = corner(other);
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  });
  ShapeTriangles welded;
  std::vector<int> place(mesh.corners.size(), -1);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || corner(order[i]) != corner(order[i - 1])) welded.corners.push_back(corner(order[i]));
    place[static_cast<std::size_t>(order[i])] = static_cast<int>(welded.corners.size()) - 1;
  }
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const Eigen::Vector3i moved = triangle.unaryExpr([&place](int i) { return place[static_cast<std::size_t>(i)]; });
    if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0]) welded.triangles.push_back(moved);
  }
  return welded;
}

bool isUsable(const Vec3& corner) { return (corner.array().abs() <= kFarthest).all(); }  // false for NaN

void requireSound(const ShapeTriangles& mesh, const std::string& path, const std::string& obstacle) {
  const auto corner = [&mesh](int i) -> const Vec3& { return mesh.corners[static_cast<std::size_t>(i)]; };
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    if (!isUsable(corner(triangle[0])) || !isUsable(corner(triangle[1])) || !isUsable(corner(triangle[2]))) {
      fail(obstacle, path, "has a corner that is not finite, or beyond 1e30 m");
    }
  }
}

}  // namespace

ShapeTriangles loadMesh(const std::string& path, const Vec3& scale, const std::string& obstacle) {
  requireReadable(path, obstacle);
  Assimp::Importer importer;
  importer.SetIOHandler(new OneFile(path));  // owned by the importer
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = nullptr;
  std::string reason;
  try {
    scene = importer.ReadFile(path, 0);
    if (scene != nullptr) {
      requireModestPolygons(*scene, path, obstacle);
      scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    }
    reason = importer.GetErrorString();
  } catch (const std::invalid_argument&) {  // from requireModestPolygons()
    throw;
  } catch (const std::exception& error) {  // of a reader, or out of memory
    reason = error.what();
  }
  if (scene == nullptr || scene->mRootNode == nullptr) fail(obstacle, path, "cannot be read: " + reason);
  ShapeTriangles mesh = collectParts(*scene, scale, path, obstacle);
  if (mesh.triangles.empty()) fail(obstacle, path, "has no triangles");
  requireSound(mesh, path, obstacle);
  mesh = weld(mesh);
  const auto corner = [&mesh](int i) -> const Vec3& { return mesh.corners[static_cast<std::size_t>(i)]; };
  if (std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&corner](const Eigen::Vector3i& t) {
        return isDegenerate(corner(t[0]), corner(t[1]), corner(t[2]));
      })) {
    fail(obstacle, path, "has no triangle of nonzero area");
  }
  return mesh;
}

ShapeTriangles loadMesh(const ObstacleParams& obstacle, const MeshResolver& resolve) {
  const std::string who = "obstacle '" + obstacle.name + "': ";
  if (!(obstacle.scale.allFinite() && (obstacle.scale.array() != 0.0).all()))
    throw std::invalid_argument(who + "scale must be finite and not 0");
  const std::string path = resolve(obstacle.mesh);
  if (path.empty()) {
    throw std::invalid_argument(who + "mesh '" + obstacle.mesh +
                                "' cannot be resolved (package://PACKAGE/PATH needs the package on ROS_PACKAGE_PATH, "
                                "file:///PATH is a whole path on this computer, and nothing else is fetched)");
  }
  return loadMesh(path, obstacle.scale, obstacle.name);
}

}  // namespace curtain
