// SPDX-License-Identifier: BSD-3-Clause
//
// What a DAE file must keep to before assimp sees it. Its nodes may stand for other nodes, and assimp (5.2) follows
// them without an end: around in a circle until the stack is full, or, each twice the one before, until the memory is.
// It also goes down into elements within elements as far as they go, and fills the memory where it looks for an index
// and there is none.
#pragma once

#include <string>

namespace curtain {

/// Nodes that a file may come to, each that stands for another counting as all that it stands for.
constexpr double kMostColladaNodes = 100000.0;

/// What is wrong with the XML of the file, or beyond the limits; "": nothing. For messages: "cannot be read: ...".
std::string colladaProblem(const std::string& path);

}  // namespace curtain
