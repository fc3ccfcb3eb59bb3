// SPDX-License-Identifier: BSD-3-Clause
//
// Looks up winds and drags.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace curtain {

/// The one with this id; null: there is none.
template <typename Params>
const Params* findById(const std::vector<Params>& all, const std::string& id) {
  const auto found = std::find_if(all.begin(), all.end(), [&id](const Params& one) { return one.id == id; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace curtain
