// SPDX-License-Identifier: BSD-3-Clause
#include "export/gltf_buffer.h"

#include <algorithm>
#include <utility>

namespace curtain {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "glTF is little-endian, and so are the numbers put into it");

GltfBuffer::GltfBuffer(tinygltf::Model& model) : model_(model) { model.buffers.emplace_back(); }

int GltfBuffer::add(const std::vector<float>& values, int type, GltfUse use) {
  const auto parts = static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
  tinygltf::Accessor accessor;
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
  accessor.type = type;
  accessor.count = values.size() / parts;
  accessor.minValues.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(parts));
  accessor.maxValues = accessor.minValues;
  for (std::size_t i = 0; i < values.size(); ++i) {
    double& least = accessor.minValues[i % parts];
    double& most = accessor.maxValues[i % parts];
    least = std::min(least, static_cast<double>(values[i]));
    most = std::max(most, static_cast<double>(values[i]));
  }
  return add(values.data(), values.size() * sizeof(float), use, std::move(accessor));
}

int GltfBuffer::add(const std::vector<std::uint32_t>& indices) {
  tinygltf::Accessor accessor;
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  accessor.type = TINYGLTF_TYPE_SCALAR;
  accessor.count = indices.size();
  const auto [least, most] = std::minmax_element(indices.begin(), indices.end());
  accessor.minValues = {static_cast<double>(*least)};
  accessor.maxValues = {static_cast<double>(*most)};
  return add(indices.data(), indices.size() * sizeof(std::uint32_t), GltfUse::kIndices, std::move(accessor));
}

// All numbers have four bytes, so that every view begins at a multiple of four, as it must.
int GltfBuffer::add(const void* data, std::size_t bytes, GltfUse use, tinygltf::Accessor accessor) {
  std::vector<unsigned char>& buffer = model_.buffers.front().data;
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = buffer.size();
  view.byteLength = bytes;
  if (use == GltfUse::kVertices) view.target = TINYGLTF_TARGET_ARRAY_BUFFER;
  if (use == GltfUse::kIndices) view.target = TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER;
  const auto* const first = static_cast<const unsigned char*>(data);
  buffer.insert(buffer.end(), first, first + bytes);
  accessor.bufferView = static_cast<int>(model_.bufferViews.size());
  model_.bufferViews.push_back(view);
  model_.accessors.push_back(std::move(accessor));
  return static_cast<int>(model_.accessors.size()) - 1;
}

}  // namespace curtain
