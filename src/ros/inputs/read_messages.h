// SPDX-License-Identifier: BSD-3-Clause
//
// Wind and drag messages to the engine's structs, checked on the way. Needs no ROS master.
#pragma once

#include <curtain_sim/DragForce.h>
#include <curtain_sim/WindSource.h>

#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain_ros {

/// Longest id and frame name that a message may hold [bytes].
constexpr std::size_t kLongestName = 255;

/// Text of a message for the log: control characters replaced by '?', cut after `longest` bytes.
std::string forLog(const std::string& text, std::size_t longest = 80);

/// What every message must hold: names that are not too long, a known action and, except for DELETEALL, an id.
std::vector<curtain::Problem> checkHead(const curtain_sim::WindSource& message);
std::vector<curtain::Problem> checkHead(const curtain_sim::DragForce& message);

/// An ADD message as a wind source. Simulator::setWind() checks the remaining fields.
///   frame  pose of the message's frame in the world
///   time   [s] of the simulation now: the wind starts here
///   wind   in: the source it replaces, or a default one; out: the new one, valid when no problem is returned
std::vector<curtain::Problem> toWind(const curtain_sim::WindSource& message, const curtain::Pose& frame, double time,
                                     curtain::WindParams& wind);

/// Puts a wind source where a valid message has it in its frame.
void placeWind(const curtain_sim::WindSource& message, const curtain::Pose& frame, curtain::WindParams& wind);

/// An ADD message as a user force on the grid of `cloth`. Simulator::setDrag() checks the remaining fields.
std::vector<curtain::Problem> toDrag(const curtain_sim::DragForce& message, const curtain::Pose& frame, double time,
                                     const curtain::ClothParams& cloth, curtain::DragParams& drag);

}  // namespace curtain_ros
