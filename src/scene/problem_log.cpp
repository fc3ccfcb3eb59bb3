// SPDX-License-Identifier: BSD-3-Clause
#include "scene/problem_log.h"

namespace curtain {

void ProblemLog::add(const std::string& key, const std::string& text) {
  if (hasSelfOrAncestor(key)) return;
  keys_.insert(key);
  if (problems_.size() < kMaxProblems) {
    problems_.push_back({key, text});
  } else if (problems_.size() == kMaxProblems) {
    problems_.push_back({"", "has more problems than these " + std::to_string(kMaxProblems)});
  }
}

bool ProblemLog::hasSelfOrAncestor(const std::string& key) const {
  if (keys_.count(key) != 0) return true;
  for (std::size_t i = key.find_first_of(".["); i != std::string::npos; i = key.find_first_of(".[", i + 1)) {
    if (i > 0 && keys_.count(key.substr(0, i)) != 0) return true;
  }
  return false;
}

bool ProblemLog::good(const std::string& key) const {
  if (hasSelfOrAncestor(key)) return false;
  for (const char separator : {'.', '['}) {
    const std::string under = key + separator;
    const auto next = keys_.lower_bound(under);
    if (next != keys_.end() && next->compare(0, under.size(), under) == 0) return false;
  }
  return true;
}

std::string joinKey(const std::string& prefix, const std::string& name) {
  return prefix.empty() ? name : prefix + "." + name;
}

std::string itemKey(const std::string& key, std::size_t index) { return key + "[" + std::to_string(index) + "]"; }

std::string describe(const std::vector<Problem>& problems, const std::string& source) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    if (!source.empty()) text += source + ": ";
    if (!problem.key.empty()) text += problem.key + ": ";
    text += problem.text;
  }
  return text;
}

}  // namespace curtain
