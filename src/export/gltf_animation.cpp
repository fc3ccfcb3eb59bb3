// SPDX-License-Identifier: BSD-3-Clause
#include "export/gltf_animation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "obstacles/corner_normals.h"

namespace curtain {
namespace {

// A file holds its length in 32 bits; some are left for the text in front of the numbers.
constexpr std::uint64_t kMaxBytes = 4000000000U;
constexpr int kRoot = 0, kClothMesh = 0;

// IEC 61966-2-1, Sect. 5.2: glTF has linear colours.
double linear(double shown) { return shown <= 0.04045 ? shown / 12.92 : std::pow((shown + 0.055) / 1.055, 2.4); }

void append(const Vec3& v, std::vector<float>& to) {
  for (const double part : {v.x(), v.y(), v.z()}) to.push_back(static_cast<float>(part));
}

std::vector<float> minus(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<float> difference(a.size());
  std::transform(a.begin(), a.end(), b.begin(), difference.begin(), [](float x, float y) { return x - y; });
  return difference;
}

bool isConstant(const std::vector<float>& values, std::size_t parts) {
  for (std::size_t i = parts; i < values.size(); ++i) {
    if (values[i] != values[i - parts]) return false;
  }
  return true;
}

std::vector<double> firstOf(const std::vector<float>& values, std::size_t parts) {
  return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(parts)};
}

}  // namespace

GltfAnimation::GltfAnimation(const Vec3& color) : buffer_(model_) {
  model_.asset.version = "2.0";
  model_.asset.generator = "curtain_sim curtain_export";
  addNode("world", -1);
  const double half = std::sqrt(0.5);
  model_.nodes[kRoot].rotation = {-half, 0.0, 0.0, half};  // about x, z to y
  model_.scenes.emplace_back();
  model_.scenes.front().nodes = {kRoot};
  model_.defaultScene = 0;
  model_.meshes.emplace_back();
  model_.meshes.front().name = "cloth";
  model_.meshes.front().primitives.emplace_back();
  model_.meshes.front().primitives.front().mode = TINYGLTF_MODE_TRIANGLES;
  model_.meshes.front().primitives.front().material = addMaterial(color, true);
  addNode("cloth", kClothMesh);
  animation_.name = "curtain";
}

int GltfAnimation::addMaterial(const Vec3& color, bool both_sides) {
  tinygltf::Material material;
  material.pbrMetallicRoughness.baseColorFactor = {linear(color.x()), linear(color.y()), linear(color.z()), 1.0};
  material.pbrMetallicRoughness.metallicFactor = 0.0;
  material.pbrMetallicRoughness.roughnessFactor = 0.9;
  material.doubleSided = both_sides;
  model_.materials.push_back(material);
  return static_cast<int>(model_.materials.size()) - 1;
}

// In the world, but for the world itself.
int GltfAnimation::addNode(const std::string& name, int mesh) {
  const int number = static_cast<int>(model_.nodes.size());
  tinygltf::Node node;
  node.name = name;
  node.mesh = mesh;
  model_.nodes.push_back(node);
  if (number != kRoot) model_.nodes[kRoot].children.push_back(number);
  return number;
}

void GltfAnimation::setCloth(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                             const std::vector<ClothCoordinate>& coordinates) {
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  std::vector<float> flat;
  for (const ClothCoordinate& c : coordinates) flat.insert(flat.end(), {c.along_weft, c.along_warp});
  tinygltf::Primitive& cloth = model_.meshes[kClothMesh].primitives.front();
  cloth.indices = buffer_.add(corners);
  cloth.attributes["TEXCOORD_0"] = buffer_.add(flat, TINYGLTF_TYPE_VEC2, GltfUse::kVertices);
}

// Of the frames, weights included.
void GltfAnimation::checkSize() const {
  const std::uint64_t frames = times_.size() + 1;
  const std::uint64_t bytes = model_.buffers.front().data.size() + sizeof(float) * frames * frames;
  if (bytes <= kMaxBytes) return;
  throw std::invalid_argument("a glTF file ends at 4 GB, here after " + std::to_string(times_.size()) +
                              " frames: take fewer a second, or a shorter part");
}

void GltfAnimation::addFrame(double time, const std::vector<AnimatedVertex>& vertices, int) {
  checkSize();
  positions_.clear();
  normals_.clear();
  for (const AnimatedVertex& vertex : vertices) {
    positions_.insert(positions_.end(), vertex.position.begin(), vertex.position.end());
    normals_.insert(normals_.end(), vertex.normal.begin(), vertex.normal.end());
  }
  const auto add = [&](const std::vector<float>& values) {
    return buffer_.add(values, TINYGLTF_TYPE_VEC3, GltfUse::kVertices);
  };
  tinygltf::Primitive& cloth = model_.meshes[kClothMesh].primitives.front();
  if (times_.empty()) {
    cloth.attributes["POSITION"] = add(positions_);
    cloth.attributes["NORMAL"] = add(normals_);
    first_positions_ = positions_;
    first_normals_ = normals_;
  } else {
    cloth.targets.push_back(
        {{"POSITION", add(minus(positions_, first_positions_))}, {"NORMAL", add(minus(normals_, first_normals_))}});
  }
  times_.push_back(static_cast<float>(time));
}

std::size_t GltfAnimation::addBody(const AnimatedBody& body) {
  std::vector<float> positions, normals;
  const std::vector<Vec3> corner_normals = cornerNormals(body.shape);
  for (std::size_t i = 0; i < corner_normals.size(); ++i) {
    append(body.shape.corners[static_cast<std::size_t>(body.shape.triangles[i / 3][static_cast<int>(i % 3)])],
           positions);
    // A triangle without an area has none; glTF wants one.
    append(corner_normals[i].isZero() ? Vec3(Vec3::UnitZ()) : corner_normals[i], normals);
  }
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = addMaterial(body.color, false);
  primitive.attributes["POSITION"] = buffer_.add(positions, TINYGLTF_TYPE_VEC3, GltfUse::kVertices);
  primitive.attributes["NORMAL"] = buffer_.add(normals, TINYGLTF_TYPE_VEC3, GltfUse::kVertices);
  tinygltf::Mesh mesh;
  mesh.name = body.name;
  mesh.primitives.push_back(primitive);
  model_.meshes.push_back(mesh);
  bodies_.push_back({addNode(body.name, static_cast<int>(model_.meshes.size()) - 1), {}, {}, {}, {}});
  return bodies_.size() - 1;
}

void GltfAnimation::addPose(std::size_t body, double time, const Pose& pose, bool present) {
  BodyPath& path = bodies_[body];
  const auto single = static_cast<float>(time);
  while (!path.times.empty() && path.times.back() >= single) {
    path.times.pop_back();
    path.positions.resize(path.positions.size() - 3);
    path.orientations.resize(path.orientations.size() - 4);
    path.scales.resize(path.scales.size() - 3);
  }
  path.times.push_back(single);
  append(pose.position, path.positions);
  Eigen::Vector4d turn = pose.orientation.coeffs();  // x, y, z, w, as glTF
  if (path.orientations.size() >= 4) {               // of the two that mean the same, the one nearer to the last
    const float* const last = path.orientations.data() + path.orientations.size() - 4;
    if (turn.dot(Eigen::Vector4d(last[0], last[1], last[2], last[3])) < 0.0) turn = -turn;
  }
  for (const double part : {turn.x(), turn.y(), turn.z(), turn.w()})
    path.orientations.push_back(static_cast<float>(part));
  path.scales.insert(path.scales.end(), 3, present ? 1.0F : 0.0F);
}

void GltfAnimation::addChannel(int node, const char* path, int times, int values, const char* interpolation) {
  tinygltf::AnimationSampler sampler;
  sampler.input = times;
  sampler.output = values;
  sampler.interpolation = interpolation;
  tinygltf::AnimationChannel channel;
  channel.sampler = static_cast<int>(animation_.samplers.size());
  channel.target_node = node;
  channel.target_path = path;
  animation_.samplers.push_back(sampler);
  animation_.channels.push_back(channel);
}

void GltfAnimation::animateCloth() {
  const std::size_t targets = times_.size() - 1;
  if (targets == 0) return;
  std::vector<float> weights((targets + 1) * targets, 0.0F);
  for (std::size_t target = 0; target < targets; ++target) weights[(target + 1) * targets + target] = 1.0F;
  model_.meshes[kClothMesh].weights.assign(targets, 0.0);
  const int times = buffer_.add(times_, TINYGLTF_TYPE_SCALAR, GltfUse::kAnimation);
  const int values = buffer_.add(weights, TINYGLTF_TYPE_SCALAR, GltfUse::kAnimation);
  addChannel(kRoot + 1, "weights", times, values, "LINEAR");
}

void GltfAnimation::animateBody(const BodyPath& path) {
  tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(path.node)];
  if (path.times.empty()) return;
  node.translation = firstOf(path.positions, 3);
  node.rotation = firstOf(path.orientations, 4);
  node.scale = firstOf(path.scales, 3);
  int times = -1;
  const auto animate = [&](const char* name, const std::vector<float>& values, int type, const char* interpolation) {
    if (isConstant(values, static_cast<std::size_t>(type == TINYGLTF_TYPE_VEC4 ? 4 : 3))) return;
    if (times < 0) times = buffer_.add(path.times, TINYGLTF_TYPE_SCALAR, GltfUse::kAnimation);
    addChannel(path.node, name, times, buffer_.add(values, type, GltfUse::kAnimation), interpolation);
  };
  animate("translation", path.positions, TINYGLTF_TYPE_VEC3, "LINEAR");
  animate("rotation", path.orientations, TINYGLTF_TYPE_VEC4, "LINEAR");
  animate("scale", path.scales, TINYGLTF_TYPE_VEC3, "STEP");
}

std::string GltfAnimation::file() {
  animateCloth();
  for (const BodyPath& path : bodies_) animateBody(path);
  if (!animation_.channels.empty()) model_.animations.push_back(animation_);
  std::ostringstream out;
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, out, false, true);
  return out.str();
}

}  // namespace curtain
