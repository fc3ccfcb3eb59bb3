// SPDX-License-Identifier: BSD-3-Clause
//
// Collects problems, at most one a key, without their consequences: checks of several values together ask good() first,
// so that a typing error in one brings no complaints about the others.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

class ProblemLog {
 public:
  /// Limit for the list; with more problems the file is hardly a scene.
  static constexpr std::size_t kMaxProblems = 200;

  /// Adds the problem unless the key, or a key above it, has one already.
  void add(const std::string& key, const std::string& text);

  /// No problem with the key, nor with keys below or above it.
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
