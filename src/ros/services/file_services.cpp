// SPDX-License-Identifier: BSD-3-Clause
#include "ros/services/file_services.h"

#include <utility>

#include "curtain_sim/snapshot_file.h"
#include "ros/services/control_services.h"
#include "ros/services/file_paths.h"
#include "simulator/export.h"
#include "simulator/whole_file.h"

namespace curtain_ros {

FileServices::FileServices(const ros::NodeHandle& private_node, Calls& calls, const curtain::Simulator& simulator,
                           Actions actions)
    : calls_(calls),
      simulator_(simulator),
      topology_(simulator.fineMeshTopology()),
      actions_(std::move(actions)),
      thread_(private_node, 1) {
  save_ = thread_.node().advertiseService("save", &FileServices::save, this);
  load_ = thread_.node().advertiseService("load", &FileServices::load, this);
  export_ = thread_.node().advertiseService("export_mesh", &FileServices::exportMesh, this);
  thread_.start();
}

bool FileServices::save(curtain_sim::Save::Request& request, curtain_sim::Save::Response& response) {
  response.message = problemOfOutput(request.path);
  if (!response.message.empty()) return true;
  std::string snapshot;
  const bool taken = calls_.run([&] {
    snapshot = simulator_.snapshot();
    response.simulated_time = simulator_.time();
  });
  response.message = taken ? curtain::describe(curtain::writeSnapshotFile(request.path, snapshot)) : kStops;
  response.success = response.message.empty();
  return true;
}

bool FileServices::load(curtain_sim::Load::Request& request, curtain_sim::Load::Response& response) {
  response.message = problemOfInput(request.path);
  if (!response.message.empty()) return true;
  std::string snapshot;
  response.message = curtain::describe(curtain::readSnapshotFile(request.path, snapshot));
  if (!response.message.empty()) return true;
  std::vector<curtain::Problem> problems;
  const bool tried = calls_.run([&] {
    problems = actions_.restore(snapshot);
    response.simulated_time = simulator_.time();
  });
  response.message = tried ? curtain::describe(problems, request.path) : kStops;
  response.success = response.message.empty();
  return true;
}

bool FileServices::exportMesh(curtain_sim::ExportMesh::Request& request, curtain_sim::ExportMesh::Response& response) {
  response.message = problemOfOutput(request.path);
  if (!response.message.empty()) return true;
  const auto format = curtain::meshFormatOf(request.path);
  if (!format) {
    response.message = "path: must end in " + std::string(curtain::kMeshEndings);
    return true;
  }
  curtain::FineMesh mesh;
  const bool taken = calls_.run([&] {
    simulator_.copyFineMesh(mesh);
    response.simulated_time = simulator_.time();
  });
  const curtain::FineMeshTopology& topology = topology_;
  response.message =
      taken ? curtain::describe(curtain::writeWholeFile(request.path, curtain::meshFile(mesh, topology, *format)))
            : kStops;
  response.success = response.message.empty();
  if (response.success) response.triangles = static_cast<std::uint32_t>(topology.triangles.size());
  return true;
}

}  // namespace curtain_ros
