// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/surface/curtain_surface.h"

#include <algorithm>
#include <numeric>

namespace curtain_rviz {

using curtain::Vec3;

namespace {

Vec3 pointAt(const std::vector<float>& flat, std::size_t node) {
  return {flat[3 * node], flat[3 * node + 1], flat[3 * node + 2]};
}

std::array<float, 3> toFloats(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

double meanOf(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

bool CurtainSurface::update(const curtain_sim::CurtainState& state) {
  const bool is_new = !isOfThisCloth(state);
  if (is_new) setCloth(state);
  setNodes(state);
  curtain::fineMeshNormals(topology_, mesh_, normals_);
  setVertices();
  return is_new;
}

bool CurtainSurface::isOfThisCloth(const curtain_sim::CurtainState& state) const {
  return builder_ && topology_.rows == static_cast<int>(state.rows) &&
         topology_.folds == static_cast<int>(state.folds) && topology_.closed == static_cast<bool>(state.closed) &&
         warp_rest_ == state.warp_rest && weft_rest_ == state.weft_rest && slit_columns_ == state.slit_columns &&
         slit_rows_ == state.slit_rows;
}

void CurtainSurface::setCloth(const curtain_sim::CurtainState& state) {
  curtain::ClothParams cloth;
  cloth.rows = static_cast<int>(state.rows);
  cloth.columns = static_cast<int>(state.columns);
  cloth.folds = static_cast<int>(state.folds);
  cloth.closed = state.closed;
  slit_columns_ = state.slit_columns;
  slit_rows_ = state.slit_rows;
  for (std::size_t k = 0; k < slit_columns_.size(); ++k)
    cloth.slits.push_back({static_cast<int>(slit_columns_[k]), static_cast<int>(slit_rows_[k])});
  topology_ = curtain::makeFineMeshTopology(cloth);
  warp_rest_ = state.warp_rest;
  weft_rest_ = state.weft_rest;
  const std::vector<double> weft(weft_rest_.begin(), weft_rest_.end());
  builder_.emplace(cloth, weft);
  drawn_ = curtain::makeDrawnMesh(cloth, std::vector<double>(warp_rest_.begin(), warp_rest_.end()), weft);
  link_length_ = meanOf(weft_rest_);
}

// The node's own second layer knows where obstacles are; where the message has none it is built from the first.
void CurtainSurface::setNodes(const curtain_sim::CurtainState& state) {
  const std::size_t count = std::size_t{state.rows} * state.columns;
  nodes_.resize(count);
  for (std::size_t n = 0; n < count; ++n) nodes_[n] = pointAt(state.positions, n);
  if (state.fold_nodes.empty()) {
    builder_->build(nodes_, mesh_);
    return;
  }
  mesh_.positions.resize(static_cast<std::size_t>(topology_.rows) * static_cast<std::size_t>(topology_.columns));
  std::size_t node = 0, inner = 0;
  for (std::size_t i = 0; i < mesh_.positions.size(); ++i) {
    const bool first_layer = i % static_cast<std::size_t>(topology_.columns) % state.folds == 0;
    mesh_.positions[i] = first_layer ? nodes_[node++] : pointAt(state.fold_nodes, inner++);
  }
}

void CurtainSurface::setVertices() {
  vertices_.resize(static_cast<std::size_t>(drawn_.topology.rows) * static_cast<std::size_t>(drawn_.topology.columns));
  centre_ = Vec3::Zero();
  lowest_ = highest_ = mesh_.positions.front();
  auto to = vertices_.begin();
  for (int i = 0; i < drawn_.topology.rows; ++i) {
    for (int f = 0; f < drawn_.topology.columns; ++f, ++to) {
      const int column = f % topology_.columns;
      const Vec3& position = fine(i, column);
      const Vec3& normal = normals_[static_cast<std::size_t>(&position - mesh_.positions.data())];
      *to = {toFloats(position), toFloats(normal), hollowAt(i, column, normal)};
      centre_ += position;
      lowest_ = lowest_.cwiseMin(position);
      highest_ = highest_.cwiseMax(position);
    }
  }
  centre_ /= static_cast<double>(vertices_.size());
}

// A link's length beside a point, or as far as there is cloth. rightwards: 1, leftwards: -1.
const Vec3& CurtainSurface::beside(int row, int column, int rightwards) const {
  const int columns = topology_.columns, strip = std::min(row, topology_.rows - 2);
  for (int rod = 0; rod < topology_.folds; ++rod) {
    const int left = rightwards > 0 ? column : column - 1;  // of the rod
    if (!topology_.closed && (left < 0 || left + 1 >= columns)) break;
    if (!curtain::hasStrip(topology_, strip, (left + columns) % columns / topology_.folds)) break;
    column = (column + rightwards + columns) % columns;
  }
  return fine(row, column);
}

// How far the cloth a link to the left and to the right rises above the point, in lengths of a link: folds bow to both
// sides by turns, so that is where the next ridges are.
float CurtainSurface::hollowAt(int row, int column, const Vec3& normal) const {
  const Vec3 middle = 0.5 * (beside(row, column, -1) + beside(row, column, 1));
  return static_cast<float>(std::clamp(normal.dot(middle - fine(row, column)) / link_length_, -1.0, 1.0));
}

void CurtainSurface::spread(const std::vector<float>& nodes, std::vector<float>& out) const {
  const auto folds = static_cast<std::size_t>(drawn_.topology.folds);
  const std::size_t columns = nodes.size() / static_cast<std::size_t>(drawn_.topology.rows);
  out.clear();
  for (std::size_t row = 0; row < nodes.size(); row += columns) {
    for (std::size_t f = 0; f < static_cast<std::size_t>(drawn_.topology.columns); ++f) {
      const float share = static_cast<float>(f % folds) / static_cast<float>(folds);
      const float left = nodes[row + f / folds % columns];
      out.push_back(share > 0.0F ? left + share * (nodes[row + (f / folds + 1) % columns] - left) : left);
    }
  }
}

}  // namespace curtain_rviz
