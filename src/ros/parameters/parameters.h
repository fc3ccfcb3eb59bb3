// SPDX-License-Identifier: BSD-3-Clause
//
// The node's private parameters: one table of names, defaults and ranges, read strictly and judged as a whole before
// anything starts. config/curtain.yaml is their manual. All are read once, at the start; what changes live comes from
// dynamic_reconfigure (tuning).
#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "curtain_sim/scene.h"
#include "ros/parameters/robot.h"
#include "scene/fields.h"
#include "sensing/sensor_params.h"

namespace curtain_ros {

/// The node's own parameters; their ranges are in the table below.
struct NodeParams {
  std::string world_frame = "world";     ///< tf2 frame of the simulation, not empty
  double obstacle_timeout = 0.5;         ///< [s] an obstacle whose frame is older is left out
  double grasp_timeout = 1.0;            ///< [s] a hand whose frame is older lets go
  double state_rate = 0.0;               ///< of ~state, ~contacts and the like [1/s of simulated time]; 0 = every frame
  double state_rest_rate = 0.0;          ///< of them while nothing moves; 0 = the same
  double mesh_rate = 20.0;               ///< of ~mesh; the frame rate is its cap
  double mesh_tolerance = 0.0;           ///< [m] that ~mesh may be off the fine mesh
  std::string mesh_viewer_frame;         ///< tf2 frame of the camera that ~mesh is for; empty: none
  double mesh_viewer_tolerance = 0.001;  ///< [rad] that it may be off as seen from there
  double markers_rate = 10.0;            ///< of ~markers and ~summary, as mesh_rate
  curtain::Vec3 summary_from = curtain::Vec3::UnitZ();  ///< direction from which ~summary sees what the cloth covers
  std::vector<std::string> summary_frames;              ///< tf2 frames of which ~summary tells whether it hides them
  int max_catch_up = 4;                                 ///< frames that a late node makes at once before it drops some
  bool state_folds = false;                             ///< ~state carries the second-layer nodes
  bool contact_points = false;      ///< ~contacts and ~markers carry where the cloth presses on obstacles
  bool handles = true;              ///< interactive markers on the hem
  double handle_stiffness = 100.0;  ///< of their springs [N/m]
  std::string snapshot_file;        ///< where the state is kept for the next start; empty: nowhere
  double snapshot_period = 10.0;    ///< [s] of the node's clock between two snapshots
  double diagnostic_period = 1.0;   ///< [s] of the computer's clock between two messages on /diagnostics
  bool start_paused = false;        ///< no frame before ~pause or ~step asks for it
  bool publish_clock = false;       ///< the node publishes /clock
  bool watch_roscpp = true;         ///< register with a restarted master, count messages dropped in roscpp's queues
};

/// What reading gave: usable only when problems is empty.
struct ParameterReading {
  NodeParams node;
  std::optional<RobotParams> robot;
  curtain::SensorParams points;
  curtain::Scene scene;               ///< with the robot's obstacles behind its own, once the URDF is read
  std::vector<std::string> problems;  ///< "parameter: text", one each
  std::vector<std::string> warnings;
};

/// Reads a tree of private parameters, without the robot's URDF, which another parameter holds.
///   tree           struct, or invalid when there are none
///   private_space  the tree's name on the parameter server, for messages, e.g. /curtain/curtain_node
ParameterReading readParameters(const XmlRpc::XmlRpcValue& tree, const std::string& private_space);

/// What is wrong with values of the node's own; empty: nothing.
std::vector<curtain::Problem> validate(const NodeParams& params);

/// Names of the parameters that dynamic_reconfigure keeps for keys of the scene (cfg/Curtain.cfg). They are there when
/// a node is started again, and not read.
std::vector<std::string> tunedSceneParameters();

/// Parameters that a node can't start with; what() lists every problem.
class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads the private parameters and the robot's URDF from the server, logs the warnings, throws ParameterError.
ParameterReading readParameters(const ros::NodeHandle& private_node);

}  // namespace curtain_ros

namespace curtain {

/// The table, for the visitors that read and check scenes.
template <>
struct Fields<curtain_ros::NodeParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& params) {
    v.text("world_frame", params.world_frame);
    v.number("obstacle_timeout", params.obstacle_timeout, between(kSmallest, 3600.0));
    v.number("grasp_timeout", params.grasp_timeout, between(kSmallest, 3600.0));
    v.number("state_rate", params.state_rate, between(0.0, 10000.0));
    v.number("state_rest_rate", params.state_rest_rate, between(0.0, 10000.0));
    v.number("mesh_rate", params.mesh_rate, between(kSmallest, 10000.0));
    v.number("mesh_tolerance", params.mesh_tolerance, between(0.0, 1000.0));
    v.textOrNone("mesh_viewer_frame", params.mesh_viewer_frame);
    v.number("mesh_viewer_tolerance", params.mesh_viewer_tolerance, between(0.0, 1.0));
    v.number("markers_rate", params.markers_rate, between(kSmallest, 10000.0));
    v.vector("summary_from", params.summary_from, anywhere());
    v.texts("summary_frames", params.summary_frames);
    v.integer("max_catch_up", params.max_catch_up, IntRange{1, 1000});
    v.flag("state_folds", params.state_folds);
    v.flag("contact_points", params.contact_points);
    v.flag("handles", params.handles);
    v.number("handle_stiffness", params.handle_stiffness, between(kSmallest, 1e6));
    v.textOrNone("snapshot_file", params.snapshot_file);
    v.number("snapshot_period", params.snapshot_period, between(0.1, 86400.0));
    v.number("diagnostic_period", params.diagnostic_period, between(0.1, 3600.0));
    v.flag("start_paused", params.start_paused);
    v.flag("publish_clock", params.publish_clock);
    v.flag("watch_roscpp", params.watch_roscpp);
  }
};

}  // namespace curtain
