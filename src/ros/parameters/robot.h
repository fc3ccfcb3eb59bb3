// SPDX-License-Identifier: BSD-3-Clause
//
// The robot as an obstacle: ~robot says which links of a URDF the cloth touches, and every collision geometry of these
// becomes an obstacle of the scene, on its link's tf2 frame. From there on they are obstacles like all others.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "curtain_sim/scene.h"
#include "scene/fields.h"

namespace curtain_ros {

/// The parameters of ~robot; their ranges are in the table below.
struct RobotParams {
  std::string description;         ///< parameter that holds the URDF; empty: robot_description
  std::vector<std::string> links;  ///< names, or regular expressions that match whole names; none: all
  double padding = 0.0;            ///< of every obstacle [m], as ObstacleParams::padding
  double friction = std::numeric_limits<double>::quiet_NaN();  ///< the same; NaN: contact.friction
  std::string tf_prefix;                                       ///< of the links' frames; empty: none
  bool visible = true;                                         ///< in ~markers
};

/// What reading gave: usable only when problems is empty.
struct RobotReading {
  std::vector<curtain::ObstacleParams> obstacles;  ///< without those that problems tell of
  std::vector<std::string> links;                  ///< that the obstacles are geometry of, one each
  std::vector<curtain::Problem> problems;          ///< key "links", or empty for those of the URDF
};

/// Obstacles of a robot, by the names of its links: LINK, or LINK/0, LINK/1, … where it has several geometries, on the
/// frame TF_PREFIX/LINK. Boxes, cylinders and spheres stay what they are, meshes keep URL and scale; no file is opened.
///   urdf  its XML text
RobotReading readRobot(const RobotParams& params, const std::string& urdf);

/// What is wrong with the mesh files of a robot, which it reads: those that can't be had, with their links.
std::vector<std::string> meshProblems(const RobotReading& robot);

/// A mesh whose path is relative: neither a URL nor a whole path.
bool isRelativeMesh(const curtain::ObstacleParams& obstacle);

/// What a mesh must be where nobody knows of a folder, for messages.
extern const char* const kMeshPlaces;

}  // namespace curtain_ros

namespace curtain {

/// The table, for the visitors that read and check.
template <>
struct Fields<curtain_ros::RobotParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& robot) {
    v.textOrNone("description", robot.description);
    v.texts("links", robot.links);
    v.number("padding", robot.padding, notNegative());
    v.numberOrUnset("friction", robot.friction, between(0.0, 10.0));
    v.textOrNone("tf_prefix", robot.tf_prefix);
    v.flag("visible", robot.visible);
  }
};

}  // namespace curtain
