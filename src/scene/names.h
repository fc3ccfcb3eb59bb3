// SPDX-License-Identifier: BSD-3-Clause
//
// How the enums are spelled in scene files, each list in the order of its enum.
#pragma once

#include <string>
#include <vector>

namespace curtain {

const std::vector<std::string>& lumpingNames();
const std::vector<std::string>& pinNames();  ///< without kList, which is spelled as a list of nodes
const std::vector<std::string>& dampingLawNames();
const std::vector<std::string>& shapeNames();

/// "a, b or c"
std::string alternatives(const std::vector<std::string>& names);

}  // namespace curtain
