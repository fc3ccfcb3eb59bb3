// SPDX-License-Identifier: BSD-3-Clause
//
// Checks of a DAE file before assimp (5.2) reads it. Nodes may instance other nodes, and assimp expands them without a
// limit: a cycle overflows the stack, and nodes that each instance the one before twice fill the memory. It also
// recurses into nested elements without a limit, and loops for ever where an index list holds something else.
#include <tinyxml2.h>

#include <cstring>
#include <map>
#include <vector>

#include "obstacles/mesh_loader.h"

namespace curtain {
namespace {

using tinyxml2::XMLElement;

// Namespace prefixes are not handled, and assimp does not handle them either.
bool isNamed(const XMLElement* element, const char* name) { return std::strcmp(element->Name(), name) == 0; }

std::string attribute(const XMLElement* element, const char* name) {
  const char* const value = element->Attribute(name);
  return value == nullptr ? "" : value;
}

// assimp loops for ever at anything else than an index.
bool hasBadIndices(const XMLElement* element) {
  for (const char* list : {"p", "h", "v", "vcount"}) {
    if (!isNamed(element, list)) continue;
    for (const tinyxml2::XMLNode* part = element->FirstChild(); part != nullptr; part = part->NextSibling()) {
      const tinyxml2::XMLText* const text = part->ToText();
      if (text != nullptr && text->Value()[std::strspn(text->Value(), "0123456789+- \t\r\n")] != '\0') return true;
    }
  }
  for (const XMLElement* child = element->FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (hasBadIndices(child)) return true;
  }
  return false;
}

// Counts nodes as assimp creates them. Recursion is bounded: 100 nested elements (by tinyxml2) times kDeepest.
class NodeCounter {
 public:
  explicit NodeCounter(const XMLElement* root) { note(root); }

  /// Nodes of all scenes; more than kMaxColladaNodes: too many, or a cycle.
  double count() {
    double sum = 0.0;
    for (const XMLElement* scene : scenes_) sum += countUnder(scene);
    return sum;
  }

 private:
  static constexpr int kDeepest = 200;  // nested instances
  static constexpr double kEndless = 10.0 * kMaxColladaNodes;

  void note(const XMLElement* element) {
    for (const XMLElement* child = element->FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      if (isNamed(child, "visual_scene")) scenes_.push_back(child);
      if (isNamed(child, "node")) {
        // As assimp looks up instances: library nodes by id, else the first node with that id or name.
        if (isNamed(element, "library_nodes")) library_[attribute(child, "id")] = child;
        others_.emplace(attribute(child, "id"), child);
        others_.emplace(attribute(child, "name"), child);
      }
      note(child);
    }
  }

  const XMLElement* find(const std::string& name) const {
    const auto in_library = library_.find(name);
    if (in_library != library_.end()) return in_library->second;
    const auto other = others_.find(name);
    return other == others_.end() ? nullptr : other->second;
  }

  double countUnder(const XMLElement* parent) {
    double sum = 0.0;
    for (const XMLElement* child = parent->FirstChildElement(); child != nullptr && sum < kEndless;
         child = child->NextSiblingElement()) {
      if (isNamed(child, "node")) sum += countNode(child);
      if (!isNamed(child, "instance_node")) continue;
      const std::string url = attribute(child, "url");
      const XMLElement* const meant = url.empty() ? nullptr : find(url.substr(1));  // after the #
      if (meant != nullptr) sum += depth_ < kDeepest ? countNode(meant) : kEndless;
    }
    return sum;
  }

  double countNode(const XMLElement* node) {
    const auto known = counts_.find(node);
    if (known != counts_.end()) return known->second;
    counts_[node] = kEndless;  // reached again before it is counted: a cycle
    ++depth_;
    const double count = 1.0 + countUnder(node);
    --depth_;
    return counts_[node] = count;
  }

  std::vector<const XMLElement*> scenes_;
  std::map<std::string, const XMLElement*> library_, others_;
  std::map<const XMLElement*, double> counts_;
  int depth_ = 0;
};

}  // namespace

std::string colladaProblem(const std::string& path) {
  tinyxml2::XMLDocument document;
  if (document.LoadFile(path.c_str()) != tinyxml2::XML_SUCCESS) {
    return document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED
               ? "its elements lie more than 100 deep in each other"
               : "line " + std::to_string(document.ErrorLineNum()) + " is not XML (" + document.ErrorName() + ")";
  }
  if (document.RootElement() == nullptr) return "has no element";
  if (hasBadIndices(document.RootElement())) return "a list of indices (p, h, v or vcount) holds something else";
  if (NodeCounter(document.RootElement()).count() <= kMaxColladaNodes) return "";
  return "its nodes stand for more than 100000 nodes, or for themselves";
}

}  // namespace curtain
