// SPDX-License-Identifier: BSD-3-Clause
#include "ros/outputs/layer_states.h"

#include <algorithm>

#include "curtain_sim/Layers.h"

namespace curtain_ros {

namespace {

// Of rows of `width` items, `size` numbers each: the items [first, first + count) of every row.
void cutRows(const std::vector<float>& whole, std::size_t width, std::size_t first, std::size_t count, std::size_t size,
             std::vector<float>& out) {
  out.clear();
  for (std::size_t row = 0; row < whole.size(); row += width * size) {
    const auto begin = whole.begin() + static_cast<std::ptrdiff_t>(row + first * size);
    out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(count * size));
  }
}

}  // namespace

void cutOut(const curtain_sim::CurtainState& whole, std::uint32_t first, std::uint32_t columns,
            const std::vector<float>& warp_rest, curtain_sim::CurtainState& out) {
  out.header = whole.header;
  out.rows = whole.rows;
  out.columns = columns;
  out.closed = 0;  // as all of several cloths
  out.folds = whole.folds;
  cutRows(whole.positions, whole.columns, first, columns, 3, out.positions);
  cutRows(whole.velocities, whole.columns, first, columns, 3, out.velocities);
  cutRows(whole.forces, whole.columns, first, columns, 3, out.forces);
  cutRows(whole.fold_nodes, whole.columns - 1, first, columns - 1, 3 * (whole.folds - 1), out.fold_nodes);
  cutRows(whole.weft_rest, whole.columns - 1, first, columns - 1, 1, out.weft_rest);
  out.warp_rest = warp_rest;
  out.slit_columns.clear();
  out.slit_rows.clear();
  for (std::size_t k = 0; k < whole.slit_columns.size(); ++k) {
    if (whole.slit_columns[k] < first || whole.slit_columns[k] >= first + columns - 1) continue;
    out.slit_columns.push_back(whole.slit_columns[k] - first);
    out.slit_rows.push_back(whole.slit_rows[k]);
  }
  out.winds = whole.winds;
  out.statistics = whole.statistics;
}

LayerStates::LayerStates(ros::NodeHandle& node, const curtain::Simulator& simulator, std::uint32_t queue,
                         const Pace& pace) {
  const std::vector<curtain::Simulator::LayerColumns> layers = simulator.layers();
  if (layers.size() < 2) return;
  std::vector<double> rods;
  simulator.copyRods(rods);
  curtain_sim::Layers message;
  for (const curtain::Simulator::LayerColumns& layer : layers) {
    message.names.push_back(layer.name);
    message.first_columns.push_back(static_cast<std::uint32_t>(layer.first_column));
    message.columns.push_back(static_cast<std::uint32_t>(layer.columns));
    std::vector<float> warp_rest;
    for (int i = 0; i + 1 < simulator.rows(); ++i)
      warp_rest.push_back(
          static_cast<float>(rods[static_cast<std::size_t>(i * simulator.columns() + layer.first_column)]));
    streams_.push_back({node.advertise<curtain_sim::CurtainState>("layers/" + layer.name + "/state", queue), pace,
                        message.first_columns.back(), message.columns.back(), warp_rest, false,
                        ReusedMessage<curtain_sim::CurtainState>(curtain_sim::CurtainState())});
  }
  names_ = node.advertise<curtain_sim::Layers>("layers", 1, true);  // latched
  names_.publish(message);
}

void LayerStates::setRates(double rate, double rest_rate, double frame_rate) {
  for (Stream& stream : streams_) stream.pace.setRates(rate, rest_rate, frame_rate);
}

bool LayerStates::due(std::uint64_t revision) {
  for (Stream& stream : streams_) {
    stream.pace.tick();
    stream.due = stream.pace.due(stream.publisher.getNumSubscribers()) && stream.pace.send(revision);
  }
  return std::any_of(streams_.begin(), streams_.end(), [](const Stream& stream) { return stream.due; });
}

void LayerStates::publish(const curtain_sim::CurtainState& whole) {
  for (Stream& stream : streams_) {
    if (!stream.due) continue;
    const auto message = stream.message.edit();
    cutOut(whole, stream.first, stream.columns, stream.warp_rest, *message);
    stream.publisher.publish(curtain_sim::CurtainState::ConstPtr(message));
  }
}

}  // namespace curtain_ros
