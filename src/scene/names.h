// SPDX-License-Identifier: BSD-3-Clause
//
// Spelling of the enums in scene files, in the order of each enum.
#pragma once

#include <string>
#include <vector>

namespace curtain {

const std::vector<std::string>& lumpingNames();
const std::vector<std::string>& headingNames();
const std::vector<std::string>& materialNames();
const std::vector<std::string>& pinNames();  ///< without kList, which is a list of nodes
const std::vector<std::string>& airLawNames();
const std::vector<std::string>& gustSpectrumNames();
const std::vector<std::string>& windProfileNames();
const std::vector<std::string>& shapeNames();
const std::vector<std::string>& graspRegionNames();

/// "a, b or c"
std::string alternatives(const std::vector<std::string>& names);

}  // namespace curtain
