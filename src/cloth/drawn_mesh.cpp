// SPDX-License-Identifier: BSD-3-Clause
#include "curtain_sim/drawn_mesh.h"

#include <stdexcept>

namespace curtain {
namespace {

// Of the drawn columns [m].
std::vector<float> placesAlongWeft(const std::vector<double>& weft_rest, std::size_t rows, std::size_t folds) {
  const std::size_t links = weft_rest.size() / rows;
  std::vector<float> places{0.0F};
  for (std::size_t link = 0; link < links; ++link) {
    double mean = 0.0;
    for (std::size_t i = 0; i < rows; ++i) mean += weft_rest[i * links + link] / static_cast<double>(rows);
    const float rod = static_cast<float>(mean) / static_cast<float>(folds);
    for (std::size_t p = 0; p < folds; ++p) places.push_back(places.back() + rod);
  }
  return places;
}

}  // namespace

DrawnMesh makeDrawnMesh(const ClothParams& cloth, const std::vector<double>& warp_rest,
                        const std::vector<double>& weft_rest) {
  const auto rows = static_cast<std::size_t>(cloth.rows);
  const auto links = static_cast<std::size_t>(cloth.closed ? cloth.columns : cloth.columns - 1);
  if (warp_rest.size() != rows - 1 || weft_rest.size() != rows * links)
    throw std::invalid_argument("rest lengths: must be one a rod and one a weft link");
  ClothParams cut_open = cloth;
  cut_open.columns = static_cast<int>(links) + 1;
  cut_open.closed = false;
  DrawnMesh drawn;
  drawn.topology = makeFineMeshTopology(cut_open);
  const std::size_t fine_columns = links * static_cast<std::size_t>(cloth.folds) + (cloth.closed ? 0 : 1);
  const std::vector<float> along_weft = placesAlongWeft(weft_rest, rows, static_cast<std::size_t>(cloth.folds));
  float along_warp = 0.0F;
  for (std::size_t i = 0; i < rows; ++i) {
    if (i > 0) along_warp += static_cast<float>(warp_rest[i - 1]);
    for (std::size_t f = 0; f < along_weft.size(); ++f) {
      drawn.coordinates.push_back({along_weft[f], along_warp});
      drawn.nodes.push_back(static_cast<std::uint32_t>(i * fine_columns + f % fine_columns));
    }
  }
  return drawn;
}

}  // namespace curtain
