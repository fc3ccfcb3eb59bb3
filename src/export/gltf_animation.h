// SPDX-License-Identifier: BSD-3-Clause
//
// An animation as a binary glTF 2.0 file. glTF moves a cloth by morph targets: the first frame is the mesh, every other
// one a target, the differences of its positions and normals. At the time of a frame its target has the weight 1 and
// all others 0; between frames weights are linear, and so is the motion of every vertex:
//
//   time     0    1/30  2/30         A frame takes 24 bytes a vertex, the weights 4 bytes times the square of the
//   weight   0    1     0    of target 1       number of frames: more than the frames where they are over 6 a vertex.
//            0    0     1    of target 2
//
// Bodies are nodes with a position, an orientation and, where one comes or goes, a scale that is 0 while it is not
// there. glTF has y up: a node above all turns the world.
#pragma once

#include <tiny_gltf.h>

#include <string>

#include "export/animation_writer.h"
#include "export/gltf_buffer.h"

namespace curtain {

/// Memory: while it is written four times the file.
class GltfAnimation : public AnimationWriter {
 public:
  /// color: of the cloth, as AnimatedBody's
  explicit GltfAnimation(const Vec3& color);

  void setCloth(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                const std::vector<ClothCoordinate>& coordinates) override;
  void addFrame(double time, const std::vector<AnimatedVertex>& vertices, int ticks) override;
  std::size_t addBody(const AnimatedBody& body) override;
  void addPose(std::size_t body, double time, const Pose& pose, bool present) override;

  int count() const { return static_cast<int>(times_.size()); }  ///< frames so far

  /// The content of the file; once, last, after a frame at least.
  std::string file();

 private:
  struct BodyPath {
    int node;
    std::vector<float> times, positions, orientations, scales;
  };

  void checkSize() const;
  int addMaterial(const Vec3& color, bool both_sides);
  int addNode(const std::string& name, int mesh);
  void addChannel(int node, const char* path, int times, int values, const char* interpolation);
  void animateCloth();
  void animateBody(const BodyPath& path);

  tinygltf::Model model_;
  GltfBuffer buffer_;
  tinygltf::Animation animation_;
  std::vector<float> times_;
  std::vector<float> first_positions_, first_normals_;  // of the first frame
  std::vector<float> positions_, normals_;              // of the present one
  std::vector<BodyPath> bodies_;
};

}  // namespace curtain
