// SPDX-License-Identifier: BSD-3-Clause
//
// The numbers of a glTF file (Khronos, glTF 2.0, Sect. 3.6): one buffer, with a view and an accessor for each array.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <vector>

namespace curtain {

/// What an array is for.
enum class GltfUse { kVertices, kIndices, kAnimation };

/// Puts arrays into a model's buffer.
class GltfBuffer {
 public:
  /// model: without a buffer; must outlive this
  explicit GltfBuffer(tinygltf::Model& model);

  /// Of floats, type TINYGLTF_TYPE_SCALAR to _VEC4. Returns the accessor's number. Its bounds (min, max) are those of
  /// the floats.
  int add(const std::vector<float>& values, int type, GltfUse use);
  /// Of the corners of triangles.
  int add(const std::vector<std::uint32_t>& indices);

 private:
  int add(const void* data, std::size_t bytes, GltfUse use, tinygltf::Accessor accessor);

  tinygltf::Model& model_;
};

}  // namespace curtain
