// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: messages to engine structs, judged on the way, and engine state to messages. No ROS master needed.
#pragma once

#include <curtain_sim/CurtainState.h>
#include <curtain_sim/DragForce.h>
#include <curtain_sim/WindSource.h>
#include <geometry_msgs/Point.h>

#include <vector>

#include "curtain_sim/fine_mesh.h"
#include "curtain_sim/scene.h"
#include "curtain_sim/statistics.h"

namespace curtain_ros {

/// What every message must hold before it is looked at closer: names that are not too long, a known action and, but for
/// DELETEALL, an id.
std::vector<curtain::Problem> checkHead(const curtain_sim::WindSource& message);
std::vector<curtain::Problem> checkHead(const curtain_sim::DragForce& message);

/// An ADD message as a wind source.
///   message  any content
///   frame    pose of the message's frame in the world
///   time     simulated time now [s]: the wind starts here
///   wind     in: the source it replaces, or a default one; out: the new one, for Simulator::setWind() to judge when no problem is returned
std::vector<curtain::Problem> toWind(const curtain_sim::WindSource& message, const curtain::Pose& frame, double time,
                                     curtain::WindParams& wind);

/// An ADD message as a user force; cloth is the grid it is for.
std::vector<curtain::Problem> toDrag(const curtain_sim::DragForce& message, const curtain::Pose& frame, double time,
                                     const curtain::ClothParams& cloth, curtain::DragParams& drag);

geometry_msgs::Point toPoint(const curtain::Vec3& point);
geometry_msgs::Vector3 toVector(const curtain::Vec3& vector);

/// Flat xyz, as CurtainState holds its arrays; out is resized.
void flatten(const std::vector<curtain::Vec3>& points, std::vector<float>& out);

/// Flat xyz of the second-layer nodes of a fine mesh, in the order that CurtainState documents; out is resized.
void flattenFolds(const curtain::FineMeshTopology& topology, const curtain::FineMesh& mesh, std::vector<float>& out);

/// The engine's part of the statistics; the node's own fields are left as they are.
void toMessage(const curtain::Statistics& statistics, curtain_sim::Statistics& message);

}  // namespace curtain_ros
