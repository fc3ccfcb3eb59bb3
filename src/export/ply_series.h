// SPDX-License-Identifier: BSD-3-Clause
//
// An animation of the cloth as numbered PLY files: NAME_0000.ply is at the start, NAME_0001.ply a tick later, …
#pragma once

#include <string>

#include "export/animation_writer.h"

namespace curtain {

/// Bodies are left out. Every file is whole, or not there.
class PlySeries : public AnimationWriter {
 public:
  /// path: "NAME.ply", in a folder that exists
  explicit PlySeries(const std::string& path);

  void setCloth(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                const std::vector<ClothCoordinate>& coordinates) override;
  void addFrame(double time, const std::vector<AnimatedVertex>& vertices, int ticks) override;
  std::size_t addBody(const AnimatedBody& body) override;
  void addPose(std::size_t body, double time, const Pose& pose, bool present) override;

  int count() const { return count_; }  ///< files so far
  /// Of the file with a number.
  std::string pathOf(int number) const;

 private:
  std::string stem_;  // path without its ending
  FineMeshTopology topology_;
  FineMesh mesh_;
  int count_ = 0;
};

}  // namespace curtain
