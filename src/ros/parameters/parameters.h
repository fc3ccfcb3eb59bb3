// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: the node's private parameters, read strictly and judged as a whole before anything starts.
// config/curtain.yaml is their manual. All are read once, at the start.
#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain_ros {

/// The node's own parameters.
struct NodeParams {
  std::string world_frame = "world";     ///< tf2 frame of the simulation, not empty
  double obstacle_timeout = 0.5;         ///< [s] an obstacle whose frame is older is left out, > 0
  double state_rate = 0.0;               ///< of ~state and ~contacts [1/s of simulated time], >= 0; 0 = every frame
  double state_rest_rate = 0.0;          ///< of them while nothing moves, >= 0; 0 = the same
  double mesh_rate = 20.0;               ///< of ~mesh, > 0; the frame rate is its cap
  double mesh_tolerance = 0.0;           ///< [m] that ~mesh may be off the fine mesh, >= 0
  std::string mesh_viewer_frame;         ///< tf2 frame of an eye that ~mesh is for; empty: none
  double mesh_viewer_tolerance = 0.001;  ///< [rad] that it may be off as seen from there, >= 0
  double markers_rate = 10.0;            ///< of ~markers, the same
  int max_catch_up = 4;                  ///< frames a late node makes at once before it drops some [1..1000]
  bool state_folds = false;              ///< ~state carries the second-layer nodes
  bool handles = true;                   ///< interactive markers on the hem
  double handle_stiffness = 100.0;       ///< of their springs [N/m], > 0
  std::string snapshot_file;             ///< where the curtain's state is kept for the next start; empty: nowhere
  double snapshot_period = 10.0;         ///< [s] of the node's clock between two of them [0.1..86400]
  double diagnostic_period = 1.0;  ///< [s] between two messages on /diagnostics, by the computer's clock [0.1..3600]
};

/// What reading gave: usable only when problems is empty.
struct ParameterReading {
  NodeParams node;
  curtain::Scene scene;
  std::vector<std::string> problems;  ///< "parameter: text", one each
  std::vector<std::string> warnings;
};

/// Names of the node's own parameters, without scene; sorted.
std::vector<std::string> nodeParameterNames();

/// Reads a tree of private parameters.
///   tree           struct, or invalid when there are none
///   private_space  the tree's name on the parameter server, for messages, e.g. /curtain/curtain_node
ParameterReading readParameters(const XmlRpc::XmlRpcValue& tree, const std::string& private_space);

/// Parameters that a node can't start with; what() lists every problem.
class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads the private parameters from the server, warns of unknown ones, throws ParameterError.
ParameterReading readParameters(const ros::NodeHandle& private_node);

}  // namespace curtain_ros
