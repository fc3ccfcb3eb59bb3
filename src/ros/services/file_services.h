// SPDX-License-Identifier: BSD-3-Clause
//
// Services that write and read files: ~save, ~load and ~export_mesh. The simulation thread takes or restores the state
// between two frames; a thread of their own reads and writes, one file at a time.
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <functional>
#include <string>
#include <vector>

#include "curtain_sim/ExportMesh.h"
#include "curtain_sim/Load.h"
#include "curtain_sim/Save.h"
#include "curtain_sim/simulator.h"
#include "ros/services/calls.h"
#include "ros/services/service_threads.h"

namespace curtain_ros {

class FileServices {
 public:
  struct Actions {
    /// Goes on from a snapshot; what is wrong with it, then nothing changed. Simulation thread.
    std::function<std::vector<curtain::Problem>(const std::string& snapshot)> restore;
  };
  /// simulator is read by the simulation thread, through calls; both must outlive this.
  FileServices(const ros::NodeHandle& private_node, Calls& calls, const curtain::Simulator& simulator, Actions actions);

 private:
  bool save(curtain_sim::Save::Request& request, curtain_sim::Save::Response& response);
  bool load(curtain_sim::Load::Request& request, curtain_sim::Load::Response& response);
  bool exportMesh(curtain_sim::ExportMesh::Request& request, curtain_sim::ExportMesh::Response& response);

  Calls& calls_;
  const curtain::Simulator& simulator_;
  const curtain::FineMeshTopology& topology_;  // which never changes
  Actions actions_;
  ServiceThreads thread_;
  ros::ServiceServer save_, load_, export_;
};

}  // namespace curtain_ros
