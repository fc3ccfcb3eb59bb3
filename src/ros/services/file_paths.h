// SPDX-License-Identifier: BSD-3-Clause
//
// Paths of files that callers of services name.
#pragma once

#include <string>

namespace curtain_ros {

/// What is wrong with a path to write a file to, in words; empty: nothing that can be told before writing.
std::string problemOfOutput(const std::string& path);

/// The same for one to read.
std::string problemOfInput(const std::string& path);

}  // namespace curtain_ros
