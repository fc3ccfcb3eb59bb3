// SPDX-License-Identifier: BSD-3-Clause
//
// Collects problems, one a key: the first is reported, and what only follows from it is not. Checks of several
// values together ask good() first, so that a typing error in one does not bring up complaints about the others.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

class ProblemLog {
 public:
  /// So many are listed; who has more to mend than that has another file before him than a scene.
  static constexpr std::size_t kMostProblems = 200;

  /// Adds the problem unless the key, or a key it lies under, has one already.
  void add(const std::string& key, const std::string& text);

  /// No problem with the key, with what lies under it or with what it lies under.
  bool good(const std::string& key) const;

  const std::vector<Problem>& problems() const { return problems_; }

 private:
  bool hasSelfOrAncestor(const std::string& key) const;

  std::vector<Problem> problems_;
  std::set<std::string> keys_;
};

/// "prefix.name", or the name alone when the prefix is empty.
std::string joinKey(const std::string& prefix, const std::string& name);

/// "key[index]"
std::string itemKey(const std::string& key, std::size_t index);

}  // namespace curtain
