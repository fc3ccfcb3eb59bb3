// SPDX-License-Identifier: BSD-3-Clause
//
// Looks up `theirs` only along `ours`, so depth or aliases beyond that cost nothing.
#include "scene/scene_difference.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>

namespace curtain {
namespace {

constexpr std::size_t kLongest = 80;  // letters of a value in a message

std::string wordsFor(const YAML::Node& node) {
  if (!node.IsDefined() || node.IsNull()) return "not given";
  if (node.IsScalar()) return node.Scalar().substr(0, kLongest);
  return node.IsSequence() ? "a list of " + std::to_string(node.size()) : "a map";
}

class Comparison {
 public:
  explicit Comparison(const std::vector<std::string>& aside) : aside_(aside) {}

  // key: of this node; general: the same with "[]" for indices.
  std::optional<Problem> compare(const std::string& key, const std::string& general, const YAML::Node& ours,
                                 const YAML::Node& theirs) const {
    if (std::find(aside_.begin(), aside_.end(), general) != aside_.end()) return std::nullopt;
    const Problem differ{key, "is " + wordsFor(theirs) + " there, " + wordsFor(ours) + " here"};
    if (!theirs.IsDefined() || ours.Type() != theirs.Type()) return differ;
    if (ours.IsScalar()) return ours.Scalar() == theirs.Scalar() ? std::nullopt : std::optional<Problem>(differ);
    if (ours.IsSequence()) return compareItems(key, general, ours, theirs, differ);
    const std::string dot = key.empty() ? "" : ".";
    for (const auto& entry : ours) {
      const std::string& name = entry.first.Scalar();
      if (auto problem = compare(key + dot + name, general + dot + name, entry.second, theirs[name])) return problem;
    }
    for (const auto& entry : theirs) {
      if (!entry.first.IsScalar()) return differ;
      const std::string& name = entry.first.Scalar();
      if (!ours[name].IsDefined())
        return Problem{key + dot + name, "is " + wordsFor(entry.second) + " there, not given here"};
    }
    return std::nullopt;
  }

 private:
  std::optional<Problem> compareItems(const std::string& key, const std::string& general, const YAML::Node& ours,
                                      const YAML::Node& theirs, const Problem& differ) const {
    if (ours.size() != theirs.size()) return differ;
    for (std::size_t n = 0; n < ours.size(); ++n) {
      auto problem = compare(key + '[' + std::to_string(n) + ']', general + "[]", ours[n], theirs[n]);
      if (problem) return problem;
    }
    return std::nullopt;
  }

  const std::vector<std::string>& aside_;
};

}  // namespace

std::optional<Problem> firstDifference(const std::string& ours, const std::string& theirs,
                                       const std::vector<std::string>& aside) {
  if (ours == theirs) return std::nullopt;
  try {
    const YAML::Node own = YAML::Load(ours), other = YAML::Load(theirs);
    return Comparison(aside).compare("", "", own, other);
  } catch (const YAML::Exception& error) {
    return Problem{"", std::string("cannot be read: ") + error.what()};
  }
}

}  // namespace curtain
