// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/cloth_tree.h"

#include <algorithm>

namespace curtain {
namespace {

/// Floats beyond the end of an array that whole vectors may read.
constexpr std::size_t kBeyond = 16;

/// Even shares of at most `most` quads: where they begin, and the end.
std::vector<int> shareQuads(int quads, int most) {
  const int blocks = (quads + most - 1) / most;
  std::vector<int> bounds;
  for (int b = 0; b <= blocks; ++b) bounds.push_back(static_cast<int>(static_cast<std::int64_t>(b) * quads / blocks));
  return bounds;
}

std::vector<int> shareOf(const std::vector<int>& bounds) {
  std::vector<int> shares;
  for (std::size_t b = 0; b + 1 < bounds.size(); ++b)
    shares.resize(static_cast<std::size_t>(bounds[b + 1]), static_cast<int>(b));
  return shares;
}

double meanWeft(const ClothPattern& pattern, int link) {
  const Grid& grid = pattern.grid;
  double sum = 0.0;
  for (int i = 0; i < grid.rows; ++i) sum += pattern.weft_rest[grid.index(i, (link + 1) % grid.columns)];
  return sum / grid.rows;
}

double meanWarp(const ClothPattern& pattern, int rod) {
  const Grid& grid = pattern.grid;
  double sum = 0.0;
  for (int j = 0; j < grid.columns; ++j) sum += pattern.warp_rest[grid.index(rod + 1, j)];
  return sum / grid.columns;
}

/// The bound inside [begin, end] nearest to the middle, neither end.
int middleBound(const std::vector<int>& bounds, int begin, int end) {
  const auto first = std::lower_bound(bounds.begin(), bounds.end(), begin);
  const auto last = std::lower_bound(bounds.begin(), bounds.end(), end);
  return *(first + (last - first) / 2);
}

}  // namespace

ClothTree::ClothTree(const ClothPattern& pattern) : grid_(pattern.grid) {
  const int rows = grid_.rows - 1, columns = grid_.linkCount();
  const auto quads = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  immovable_.resize(grid_.size());
  for (std::size_t n = 0; n < grid_.size(); ++n) immovable_[n] = pattern.inverse_mass[n] == 0.0 ? 1 : 0;

  row_bounds_ = shareQuads(rows, kBlock);
  column_bounds_ = shareQuads(columns, kBlock);
  block_row_ = shareOf(row_bounds_);
  block_column_ = shareOf(column_bounds_);

  stride_ = static_cast<std::size_t>(grid_.closed ? Grid::strideFor(grid_.columns + 1) : grid_.stride);
  for (Floats* const floats : {&start_[0], &start_[1], &start_[2], &end_[0], &end_[1], &end_[2]}) {
    floats->assign(static_cast<std::size_t>(grid_.rows) * stride_ + kBeyond, 0.0f);
  }
  for (Floats& floats : columns_) floats.assign(stride_, 0.0f);
  per_spacing_u_.assign(stride_ + kBeyond, 1.0f);
  per_spacing_v_.assign(static_cast<std::size_t>(rows), 1.0f);
  for (int j = 0; j < columns; ++j)
    per_spacing_u_[static_cast<std::size_t>(j)] = static_cast<float>(1.0 / meanWeft(pattern, j));
  for (int i = 0; i < rows; ++i)
    per_spacing_v_[static_cast<std::size_t>(i)] = static_cast<float>(1.0 / meanWarp(pattern, i));

  nodes_.reserve(2 * quads);
  blocks_.resize((row_bounds_.size() - 1) * (column_bounds_.size() - 1));
  quad_nodes_.resize(quads);
  split({0, rows, 0, columns}, kNone);
  boxes_.resize(nodes_.size());
  slopes_.resize(nodes_.size());
  wanted_.assign(nodes_.size(), 1);
  ways_.resize(grid_.size());
  element_refits_.assign(quads, 0);
  element_boxes_.resize(quads + 1);
  quad_refits_.assign(quads, 0);
  quad_ways_.resize(quads);
  window_groups_ = (static_cast<std::size_t>(columns) + 3) / 4;
  window_queries_.assign(static_cast<std::size_t>(rows) * window_groups_, 0);
  windows_flat_.assign(window_queries_.size(), 0);
  for (NodeWay& way : ways_) way.start = way.end = Eigen::Array4f::Zero();
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    boxes_[n].low = boxes_[n].high = Eigen::Array4f::Zero();
    slopes_[n].u = slopes_[n].v = boxes_[n];
    const QuadRectangle& node = nodes_[n].quads;
    slopes_[n].spacing_u =
        1.0f / *std::max_element(per_spacing_u_.begin() + node.column, per_spacing_u_.begin() + node.column_end);
    slopes_[n].spacing_v =
        1.0f / *std::max_element(per_spacing_v_.begin() + node.row, per_spacing_v_.begin() + node.row_end);
  }
  std::reverse(upper_.begin(), upper_.end());
}

std::uint32_t ClothTree::split(const QuadRectangle& quads, std::uint32_t block) {
  const auto [row, row_end, column, column_end] = quads;
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  const int block_row = block_row_[static_cast<std::size_t>(row)],
            block_column = block_column_[static_cast<std::size_t>(column)];
  const bool many_rows = block_row_[static_cast<std::size_t>(row_end) - 1] > block_row;
  const bool many_columns = block_column_[static_cast<std::size_t>(column_end) - 1] > block_column;
  if (block == kNone && !many_rows && !many_columns) {
    block = static_cast<std::uint32_t>(block_row) * static_cast<std::uint32_t>(column_bounds_.size() - 1) +
            static_cast<std::uint32_t>(block_column);
    blocks_[block] = {index, false};
  }
  const int height = row_end - row, width = column_end - column;
  nodes_.push_back({quads, kNone, block, 0});
  if (block == kNone) upper_.push_back(index);
  if (height * width == 1) {
    quad_nodes_[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.linkCount()) +
                static_cast<std::size_t>(column)] = index;
  } else {
    const bool by_rows = block == kNone ? many_rows && (height >= width || !many_columns) : height >= width;
    const int row_cut = block == kNone ? middleBound(row_bounds_, row, row_end) : row + height / 2;
    const int column_cut = block == kNone ? middleBound(column_bounds_, column, column_end) : column + width / 2;
    split({row, by_rows ? row_cut : row_end, column, by_rows ? column_end : column_cut}, block);
    const std::uint32_t second =
        split({by_rows ? row_cut : row, row_end, by_rows ? column : column_cut, column_end}, block);
    nodes_[index].second = second;
  }
  nodes_[index].end = static_cast<std::uint32_t>(nodes_.size());
  return index;
}

}  // namespace curtain
