// SPDX-License-Identifier: BSD-3-Clause
#include "export/ply_series.h"

#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "simulator/export.h"
#include "simulator/whole_file.h"

namespace curtain {

PlySeries::PlySeries(const std::string& path) : stem_(std::filesystem::path(path).replace_extension().string()) {}

std::string PlySeries::pathOf(int number) const {
  char digits[16];
  std::snprintf(digits, sizeof digits, "_%04d.ply", number);
  return stem_ + digits;
}

void PlySeries::setCloth(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                         const std::vector<ClothCoordinate>&) {
  topology_.triangles = triangles;
}

void PlySeries::addFrame(double, const std::vector<AnimatedVertex>& vertices, int ticks) {
  mesh_.positions.clear();
  for (const AnimatedVertex& vertex : vertices)
    mesh_.positions.emplace_back(vertex.position[0], vertex.position[1], vertex.position[2]);
  const std::string file = meshFile(mesh_, topology_, MeshFormat::kPly);
  for (int tick = 0; tick < ticks; ++tick) {
    const std::vector<Problem> problems = writeWholeFile(pathOf(count_), file);
    if (!problems.empty()) throw std::runtime_error(describe(problems));
    ++count_;
  }
}

std::size_t PlySeries::addBody(const AnimatedBody&) { return 0; }

void PlySeries::addPose(std::size_t, double, const Pose&, bool) {}

}  // namespace curtain
