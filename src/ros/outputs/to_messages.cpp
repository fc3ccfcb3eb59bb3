// SPDX-License-Identifier: BSD-3-Clause
#include "ros/outputs/to_messages.h"

namespace curtain_ros {

using curtain::Vec3;

void flatten(const std::vector<Vec3>& points, std::vector<float>& out) {
  out.resize(3 * points.size());
  float* to = out.data();
  for (const Vec3& point : points) {
    for (const double x : point) *to++ = static_cast<float>(x);
  }
}

void flattenFolds(const curtain::FineMeshTopology& topology, const curtain::FineMesh& mesh, std::vector<float>& out) {
  out.clear();
  const auto columns = static_cast<std::size_t>(topology.columns);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (i % columns % static_cast<std::size_t>(topology.folds) == 0) continue;  // first layer
    for (const double x : mesh.positions[i]) out.push_back(static_cast<float>(x));
  }
}

void toMessage(const curtain::Statistics& statistics, curtain_sim::Statistics& message) {
  message.frame = static_cast<std::uint64_t>(statistics.frames);
  message.simulated_time = statistics.time;
  message.substeps_total = static_cast<std::uint64_t>(statistics.substeps);
  message.substeps = static_cast<std::uint32_t>(statistics.substeps_last);
  message.sweeps = static_cast<std::uint32_t>(statistics.sweeps_last);
  message.rejected = static_cast<std::uint64_t>(statistics.rejected);
  message.unsettled = static_cast<std::uint64_t>(statistics.unsettled);
  message.estimates_skipped = static_cast<std::uint64_t>(statistics.estimates_skipped);
  message.longer_substeps = static_cast<std::uint64_t>(statistics.longer_substeps);
  message.unfinished_substeps = static_cast<std::uint64_t>(statistics.unfinished_substeps);
  message.shortened_frames = static_cast<std::uint64_t>(statistics.shortened_frames);
  message.lost_time = statistics.lost_time;
  message.late_frames = static_cast<std::uint64_t>(statistics.late_frames);
  message.asleep = static_cast<std::uint32_t>(statistics.asleep);
  message.wakes = static_cast<std::uint64_t>(statistics.wakes);
  message.warp_stretch = statistics.warp_stretch;
  message.weft_stretch = statistics.weft_stretch;
  message.contacts = static_cast<std::uint32_t>(statistics.contacts);
  message.position_error = statistics.position_error;
  message.penetration_max = statistics.penetration_max;
  message.step_ms = 1e3 * statistics.step_seconds;
  message.step_ms_max = 1e3 * statistics.step_seconds_max;
  message.finite = statistics.finite;
  message.last_resort_substeps = static_cast<std::uint64_t>(statistics.last_resort_substeps);
  message.momentum_cut = statistics.momentum_cut;
  message.obstacles_waited = statistics.obstacles_waited;
  message.stops = static_cast<std::uint64_t>(statistics.stops);
}

}  // namespace curtain_ros
