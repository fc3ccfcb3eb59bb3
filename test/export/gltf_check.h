// SPDX-License-Identifier: BSD-3-Clause
//
// Reads glTF files back, and whether they are what glTF 2.0 (Khronos, 2021) asks for, where it touches what is written
// here: Sect. 3.6 buffers and accessors, 3.7 meshes and morph targets, 3.5 nodes, 3.11 animations.
#pragma once

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace curtain_test {

inline tinygltf::Model readGltf(const std::string& file) {
  tinygltf::Model model;
  std::string errors, warnings;
  const auto* const bytes = reinterpret_cast<const unsigned char*>(file.data());
  if (!tinygltf::TinyGLTF().LoadBinaryFromMemory(&model, &errors, &warnings, bytes, static_cast<unsigned>(file.size())))
    throw std::runtime_error("not read: " + errors + warnings);
  if (!errors.empty() || !warnings.empty()) throw std::runtime_error(errors + warnings);
  return model;
}

/// The numbers of an accessor, of floats or of 32-bit indices.
inline std::vector<double> numbersOf(const tinygltf::Model& model, int number) {
  const tinygltf::Accessor& accessor = model.accessors.at(static_cast<std::size_t>(number));
  const tinygltf::BufferView& view = model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
  const std::size_t count =
      accessor.count *
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
  const unsigned char* from = model.buffers.at(0).data.data() + view.byteOffset + accessor.byteOffset;
  std::vector<double> numbers(count);
  for (std::size_t i = 0; i < count; ++i, from += 4) {
    float single = 0.0F;
    std::uint32_t index = 0;
    std::memcpy(&single, from, 4);
    std::memcpy(&index, from, 4);
    numbers[i] = accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT ? static_cast<double>(single)
                                                                         : static_cast<double>(index);
  }
  return numbers;
}

/// Collects what is wrong with a model.
class GltfCheck {
 public:
  explicit GltfCheck(const tinygltf::Model& model) : model_(model) {
    that(model.asset.version == "2.0", "asset: version");
    that(model.buffers.size() == 1, "buffers: one");
    checkAccessors();
    for (const tinygltf::Mesh& mesh : model.meshes) checkMesh(mesh);
    checkNodes();
    for (const tinygltf::Animation& animation : model.animations) checkAnimation(animation);
  }

  const std::vector<std::string>& wrong() const { return wrong_; }

 private:
  using Numbers = std::vector<double>;

  void that(bool holds, const std::string& text) {
    if (!holds) wrong_.push_back(text);
  }

  const tinygltf::Accessor& accessor(int number) const { return model_.accessors.at(static_cast<std::size_t>(number)); }

  void checkAccessors() {
    const std::size_t end = model_.buffers.at(0).data.size();
    for (const tinygltf::BufferView& view : model_.bufferViews) {
      that(view.byteOffset % 4 == 0, "bufferView: begins at a multiple of 4");
      that(view.byteLength > 0 && view.byteOffset + view.byteLength <= end, "bufferView: lies in the buffer");
    }
    for (std::size_t a = 0; a < model_.accessors.size(); ++a) {
      const tinygltf::Accessor& own = model_.accessors[a];
      const std::string name = "accessor " + std::to_string(a);
      const auto parts =
          static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(own.type)));
      const tinygltf::BufferView& view = model_.bufferViews.at(static_cast<std::size_t>(own.bufferView));
      that(own.count > 0 && own.byteOffset + 4 * parts * own.count <= view.byteLength, name + ": fits its view");
      const Numbers numbers = numbersOf(model_, static_cast<int>(a));
      that(std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }), name + ": finite");
      if (own.minValues.size() != parts || own.maxValues.size() != parts) {
        that(false, name + ": min and max");
        continue;
      }
      for (std::size_t part = 0; part < parts; ++part) {
        double least = numbers[part], most = numbers[part];
        for (std::size_t i = part; i < numbers.size(); i += parts) {
          least = std::min(least, numbers[i]);
          most = std::max(most, numbers[i]);
        }
        that(own.minValues[part] == least && own.maxValues[part] == most, name + ": min and max are its numbers'");
      }
    }
  }

  void checkUnit(const Numbers& numbers, std::size_t parts, const std::string& name) {
    for (std::size_t i = 0; i < numbers.size(); i += parts) {
      double square = 0.0;
      for (std::size_t part = 0; part < parts; ++part) square += numbers[i + part] * numbers[i + part];
      that(std::abs(std::sqrt(square) - 1.0) < 0.0005, name + ": unit length");  // of Khronos' own validator
    }
  }

  void checkMesh(const tinygltf::Mesh& mesh) {
    that(mesh.primitives.size() == 1, mesh.name + ": one primitive");
    const tinygltf::Primitive& primitive = mesh.primitives.at(0);
    const std::size_t vertices = accessor(primitive.attributes.at("POSITION")).count;
    for (const auto& [name, number] : primitive.attributes)
      that(accessor(number).count == vertices, mesh.name + ": as many " + name);
    checkUnit(numbersOf(model_, primitive.attributes.at("NORMAL")), 3, mesh.name + ": NORMAL");
    if (primitive.indices >= 0) {
      that(accessor(primitive.indices).count % 3 == 0, mesh.name + ": whole triangles");
      that(accessor(primitive.indices).maxValues.at(0) < static_cast<double>(vertices), mesh.name + ": indices");
    } else {
      that(vertices % 3 == 0, mesh.name + ": whole triangles");
    }
    for (const auto& target : primitive.targets) {
      for (const auto& [name, number] : target) {
        that(primitive.attributes.count(name) == 1, mesh.name + ": target of " + name);
        that(accessor(number).count == vertices, mesh.name + ": target as large as the mesh");
      }
    }
    that(mesh.weights.size() == primitive.targets.size(), mesh.name + ": a weight for each target");
  }

  void checkNodes() {
    std::vector<int> parents(model_.nodes.size(), 0);
    for (const tinygltf::Node& node : model_.nodes) {
      for (const int child : node.children) ++parents.at(static_cast<std::size_t>(child));
      if (!node.rotation.empty()) checkUnit(node.rotation, 4, node.name + ": rotation");
      that(node.mesh < static_cast<int>(model_.meshes.size()), node.name + ": mesh");
    }
    for (const int root : model_.scenes.at(0).nodes) ++parents.at(static_cast<std::size_t>(root));
    that(std::all_of(parents.begin(), parents.end(), [](int count) { return count == 1; }), "nodes: one parent each");
  }

  void checkAnimation(const tinygltf::Animation& animation) {
    that(!animation.channels.empty(), "animation: moves something");
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      const tinygltf::AnimationSampler& sampler = animation.samplers.at(static_cast<std::size_t>(channel.sampler));
      const tinygltf::Node& node = model_.nodes.at(static_cast<std::size_t>(channel.target_node));
      const std::string name = node.name + "." + channel.target_path;
      const Numbers times = numbersOf(model_, sampler.input);
      that(times.front() >= 0.0, name + ": times from 0 on");
      that(std::adjacent_find(times.begin(), times.end(), [](double a, double b) { return a >= b; }) == times.end(),
           name + ": times rise");
      const bool morphs = channel.target_path == "weights";
      const std::size_t each =
          morphs ? model_.meshes.at(static_cast<std::size_t>(node.mesh)).primitives.at(0).targets.size() : 1;
      that(accessor(sampler.output).count == each * times.size(), name + ": a value for each time");
      if (channel.target_path == "rotation") checkUnit(numbersOf(model_, sampler.output), 4, name);
    }
  }

  const tinygltf::Model& model_;
  std::vector<std::string> wrong_;
};

/// The cloth of a model at the time of a frame, as its weights have it; of POSITION or NORMAL.
inline std::vector<double> clothAt(const tinygltf::Model& model, std::size_t frame, const std::string& attribute) {
  const tinygltf::Primitive& cloth = model.meshes.at(0).primitives.at(0);
  std::vector<double> values = numbersOf(model, cloth.attributes.at(attribute));
  if (cloth.targets.empty()) return values;
  const std::size_t targets = cloth.targets.size();
  const tinygltf::Animation& animation = model.animations.at(0);
  const std::vector<double> weights =
      numbersOf(model, animation.samplers.at(static_cast<std::size_t>(animation.channels.at(0).sampler)).output);
  for (std::size_t target = 0; target < targets; ++target) {
    const double weight = weights.at(frame * targets + target);
    if (weight == 0.0) continue;
    const std::vector<double> difference = numbersOf(model, cloth.targets[target].at(attribute));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += weight * difference[i];
  }
  return values;
}

/// Times of the cloth's frames [s].
inline std::vector<double> timesOf(const tinygltf::Model& model) {
  if (model.animations.empty()) return {0.0};
  const tinygltf::Animation& animation = model.animations.at(0);
  return numbersOf(model, animation.samplers.at(static_cast<std::size_t>(animation.channels.at(0).sampler)).input);
}

}  // namespace curtain_test
