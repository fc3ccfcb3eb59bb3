// SPDX-License-Identifier: BSD-3-Clause
#include "scene/strict_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "scene/orientation.h"
#include "scene/spelling.h"

namespace curtain {

// Of the entries of cloth.slits that are maps.
template <>
struct Fields<SlitParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& slit) {
    v.integer(required("column"), slit.column, IntRange{0, 4095});
    v.integer("from_row", slit.from_row, IntRange{0, 4095});
  }
};
namespace {

// Longest name of a key that is read; known ones are shorter.
constexpr std::size_t kLongestName = 100;

const char* const kNodeWords = "[row, column], two integers";

// Whether YAML preserves the text: yaml-cpp reads any bytes, but writes U+FFFD for invalid characters.
bool isWritable(const std::string& text) {
  YAML::Emitter out;
  out << YAML::DoubleQuoted << text;
  return YAML::Load(out.c_str()).Scalar() == text;
}

std::string lines(const YAML::Node& first, const YAML::Node& second) {
  if (first.Mark().is_null() || second.Mark().is_null()) return "";
  return " (lines " + std::to_string(first.Mark().line + 1) + " and " + std::to_string(second.Mark().line + 1) + ")";
}

}  // namespace

StrictReader::StrictReader(const YAML::Node& map, std::string key, ProblemLog& log)
    : prefix_(std::move(key)), log_(log) {
  std::map<std::string, std::size_t> places;  // in entries_
  for (const auto& entry : map) {
    if (!entry.first.IsScalar()) {
      log_.add(joinKey(prefix_, "?"), "a key must be text, is " + describeValue(entry.first));
      continue;
    }
    const std::string& name = entry.first.Scalar();
    if (name.size() > kLongestName) {
      log_.add(joinKey(prefix_, shortened(name)), "is not a known key");
      continue;
    }
    // yaml-cpp keeps duplicates; which one it finds is undefined.
    const auto [first, is_new] = places.emplace(name, entries_.size());
    if (!is_new) {
      log_.add(joinKey(prefix_, name), "is given more than once" + lines(entries_[first->second].second, entry.second));
      continue;
    }
    entries_.emplace_back(name, entry.second);
  }
}

StrictReader::Entries::const_iterator StrictReader::entryOf(Key key) const {
  return std::find_if(entries_.begin(), entries_.end(), [&key](const auto& one) { return one.first == key.name; });
}

// The value of the key, or null when it is missing or empty; wanted: what it must be, for the problem.
const YAML::Node* StrictReader::find(Key key, const std::string& wanted) {
  asked_.emplace_back(key.name);
  const auto found = entryOf(key);
  if (found == entries_.end()) {
    if (key.required) log_.add(keyOf(key), "is missing, must be " + wanted);
    return nullptr;
  }
  if (!found->second.IsDefined() || found->second.IsNull()) {
    log_.add(keyOf(key), "must be " + wanted + ", is empty");
    return nullptr;
  }
  return &found->second;
}

void StrictReader::reportUnknown() const {
  for (const auto& [name, value] : entries_) {
    if (std::find(asked_.begin(), asked_.end(), name) != asked_.end()) continue;
    const std::optional<std::string> near = nearestWord(name, asked_);
    log_.add(joinKey(prefix_, name),
             "is not a known key, " + (near ? "did you mean " + *near + "?" : "known are " + listWords(asked_)));
  }
}

void StrictReader::refuse(const std::string& key, const std::string& wanted, const YAML::Node& node) {
  log_.add(key, "must be " + wanted + ", is " + describeValue(node));
}

void StrictReader::refuseNumber(const std::string& key, const std::string& wanted, const YAML::Node& node) {
  log_.add(key, "must be " + wanted + ", is " + describeNumber(node));
}

YAML::Node StrictReader::mapUnder(Key key) {
  const YAML::Node* found = find(key, "a map");
  if (found && found->IsMap()) return *found;
  if (found) refuse(keyOf(key), "a map", *found);
  return YAML::Node(YAML::NodeType::Map);  // missing: all defaults; required keys are reported
}

bool StrictReader::checkSequence(const YAML::Node& node, const std::string& key, const std::string& wanted,
                                 std::optional<std::size_t> size) {
  if (node.IsSequence() && node.size() == size.value_or(node.size())) return true;
  refuse(key, wanted, node);
  return false;
}

bool StrictReader::readNumber(const YAML::Node& node, const std::string& key, Range range, double& value) {
  const ScalarValue scalar = numberValue(node);
  const bool is_number = scalar.kind == ScalarKind::kInteger || scalar.kind == ScalarKind::kReal;
  if (is_number)
    value = scalar.number;
  else
    refuseNumber(key, range.text(), node);
  return is_number;
}

bool StrictReader::readInteger(const YAML::Node& node, const std::string& key, const std::string& wanted, int& value) {
  const ScalarValue scalar = numberValue(node);
  const bool fits = !scalar.overflow && scalar.magnitude <= std::uint64_t{std::numeric_limits<int>::max()};
  const bool is_int = scalar.kind == ScalarKind::kInteger && fits;
  if (is_int)
    value = (scalar.negative ? -1 : 1) * static_cast<int>(scalar.magnitude);
  else
    refuseNumber(key, wanted, node);
  return is_int;
}

bool StrictReader::readVector(const YAML::Node& node, const std::string& key, Range range, Vec3& value) {
  if (!checkSequence(node, key, "a list of 3 numbers", 3)) return false;
  Vec3 read = Vec3::Zero();
  bool all = true;
  for (std::size_t i = 0; i < 3; ++i) {
    all = readNumber(node[i], itemKey(key, i), range, read[static_cast<Eigen::Index>(i)]) && all;
  }
  if (all) value = read;
  return all;
}

bool StrictReader::readNode(const YAML::Node& node, const std::string& key, NodeIndex& value) {
  if (!checkSequence(node, key, kNodeWords, 2)) return false;
  NodeIndex read;
  const bool row = readInteger(node[0], itemKey(key, 0), "an integer", read.row);
  const bool column = readInteger(node[1], itemKey(key, 1), "an integer", read.column);
  if (row && column) value = read;
  return row && column;
}

// Place of the scalar among the names; none: it is another one, or no scalar.
std::optional<std::size_t> StrictReader::placeAmong(const std::vector<std::string>& names, const YAML::Node& node) {
  const auto name = node.IsScalar() ? std::find(names.begin(), names.end(), node.Scalar()) : names.end();
  return name == names.end() ? std::nullopt : std::optional<std::size_t>(name - names.begin());
}

std::optional<std::size_t> StrictReader::choiceIndex(Key key, const std::vector<std::string>& names) {
  const YAML::Node* found = find(key, alternatives(names));
  if (!found) return std::nullopt;
  const std::optional<std::size_t> place = placeAmong(names, *found);
  if (!place) refuse(keyOf(key), alternatives(names), *found);
  return place;
}

void StrictReader::integer(Key key, int& value, IntRange range) {
  if (const YAML::Node* found = find(key, range.text())) readInteger(*found, keyOf(key), range.text(), value);
}

void StrictReader::integerOr(Key key, int& value, IntRange range, const char* word, int word_value) {
  const std::string wanted = std::string(word) + " or " + range.text();
  const YAML::Node* found = find(key, wanted);
  if (!found) return;
  if (found->IsScalar() && found->Scalar() == word) {
    value = word_value;
    return;
  }
  int read = 0;
  if (!readInteger(*found, keyOf(key), wanted, read)) return;
  // Checked here: the number that encodes the word in the struct is not allowed in files.
  if (range.contains(read))
    value = read;
  else
    refuseNumber(keyOf(key), wanted, *found);
}

void StrictReader::seed(Key key, std::uint64_t& value) {
  const std::string wanted = "an integer in [0, " + std::to_string(std::numeric_limits<std::uint64_t>::max()) + "]";
  const YAML::Node* found = find(key, wanted);
  if (!found) return;
  const ScalarValue scalar = numberValue(*found);
  const bool fits = !scalar.overflow && (!scalar.negative || scalar.magnitude == 0);
  if (scalar.kind == ScalarKind::kInteger && fits)
    value = scalar.magnitude;
  else
    refuseNumber(keyOf(key), wanted, *found);
}

void StrictReader::number(Key key, double& value, Range range) {
  if (const YAML::Node* found = find(key, range.text())) readNumber(*found, keyOf(key), range, value);
}

void StrictReader::optionalNumber(Key key, std::optional<double>& value, Range range) {
  const YAML::Node* found = find(key, range.text());
  double read = 0.0;
  if (found && readNumber(*found, keyOf(key), range, read)) value = read;
}

void StrictReader::numberOrUnset(Key key, double& value, Range range) {
  const YAML::Node* found = find(key, range.text());
  double read = 0.0;
  if (!found || !readNumber(*found, keyOf(key), range, read)) return;
  // NaN encodes "not given" in the struct; in a file it is a mistake.
  if (std::isnan(read))
    refuseNumber(keyOf(key), range.text(), *found);
  else
    value = read;
}

void StrictReader::flag(Key key, bool& value) {
  const YAML::Node* found = find(key, "true or false");
  if (!found) return;
  const ScalarValue scalar = scalarValue(*found);
  if (scalar.kind == ScalarKind::kBool)
    value = scalar.flag;
  else
    refuse(keyOf(key), "true or false", *found);
}

void StrictReader::text(Key key, std::string& value) {
  if (const YAML::Node* found = find(key, "text")) readText(*found, keyOf(key), value);
}

void StrictReader::optionalText(Key key, std::optional<std::string>& value) {
  std::string read;
  if (entryOf(key) == entries_.end()) {
    asked_.emplace_back(key.name);
    return;
  }
  text(key, read);
  value = read;
}

void StrictReader::texts(Key key, std::vector<std::string>& values) {
  const YAML::Node* found = find(key, "a list of texts");
  if (!found || !checkSequence(*found, keyOf(key), "a list of texts")) return;
  values.assign(found->size(), "");
  for (std::size_t i = 0; i < values.size(); ++i) readText((*found)[i], itemKey(keyOf(key), i), values[i]);
}

void StrictReader::readText(const YAML::Node& node, const std::string& key, std::string& value) {
  if (scalarValue(node).kind != ScalarKind::kText) {
    const std::string how = node.IsScalar() ? " (write it in quotes)" : "";
    log_.add(key, "must be text, is " + describeValue(node) + how);
  } else if (isWritable(node.Scalar())) {
    value = node.Scalar();
  } else {
    log_.add(key, "must be text in UTF-8");
  }
}

void StrictReader::vector(Key key, Vec3& value, Range range) {
  if (const YAML::Node* found = find(key, "a list of 3 numbers")) readVector(*found, keyOf(key), range, value);
}

void StrictReader::optionalVector(Key key, std::optional<Vec3>& value, Range range) {
  const YAML::Node* found = find(key, "a list of 3 numbers");
  Vec3 read = Vec3::Zero();
  if (found && readVector(*found, keyOf(key), range, read)) value = read;
}

void StrictReader::scale(Key key, Vec3& value, Range range) {
  const YAML::Node* found = find(key, "a number or a list of 3 numbers");
  if (!found) return;
  if (found->IsSequence()) {
    readVector(*found, keyOf(key), range, value);
    return;
  }
  double read = 1.0;
  if (!readNumber(*found, keyOf(key), range, read)) return;
  // Checked here, so that one number gives one problem and not three.
  if (range.contains(read))
    value = Vec3::Constant(read);
  else
    refuseNumber(keyOf(key), range.text(), *found);
}

void StrictReader::rotation(Key key, Rotation& value) {
  const std::string wanted = "a list of 4 numbers [x, y, z, w]";
  const YAML::Node* found = find(key, wanted);
  if (!found || !checkSequence(*found, keyOf(key), wanted, 4)) return;
  Eigen::Vector4d read = Eigen::Vector4d::Zero();
  bool all = true;
  for (std::size_t i = 0; i < 4; ++i) {
    all = readNumber((*found)[i], itemKey(keyOf(key), i), anywhere(), read[static_cast<Eigen::Index>(i)]) && all;
  }
  if (all) value = nearlyUnit(Rotation(read));
}

void StrictReader::node(Key key, std::optional<NodeIndex>& value) {
  const YAML::Node* found = find(key, kNodeWords);
  NodeIndex read;
  if (found && readNode(*found, keyOf(key), read)) value = read;
}

void StrictReader::nodes(Key key, std::vector<NodeIndex>& values) {
  const std::string wanted = "a list of [row, column]";
  const YAML::Node* found = find(key, wanted);
  if (found && checkSequence(*found, keyOf(key), wanted)) readNodes(*found, key, values);
}

void StrictReader::readNodes(const YAML::Node& nodes, Key key, std::vector<NodeIndex>& values) {
  values.assign(nodes.size(), NodeIndex{});
  for (std::size_t i = 0; i < values.size(); ++i) readNode(nodes[i], itemKey(keyOf(key), i), values[i]);
}

void StrictReader::numbers(Key key, std::vector<double>& values, Range range) {
  const YAML::Node* found = find(key, "a list of numbers");
  if (!found || !checkSequence(*found, keyOf(key), "a list of numbers")) return;
  values.assign(found->size(), 1.0);
  for (std::size_t i = 0; i < values.size(); ++i) readNumber((*found)[i], itemKey(keyOf(key), i), range, values[i]);
}

void StrictReader::integers(Key key, std::vector<int>& values, IntRange range) {
  const YAML::Node* found = find(key, "a list of integers");
  if (!found || !checkSequence(*found, keyOf(key), "a list of integers")) return;
  values.assign(found->size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i)
    readInteger((*found)[i], itemKey(keyOf(key), i), range.text(), values[i]);
}

// Points [x, y, z], and arcs {to: [x, y, z], centre: [x, y, z]}.
void StrictReader::path(Key key, std::vector<RailPiece>& pieces, Range range) {
  const std::string wanted = "a list of points [x, y, z] and arcs {to, centre}";
  const YAML::Node* found = find(key, wanted);
  if (!found || !checkSequence(*found, keyOf(key), wanted)) return;
  pieces.assign(found->size(), RailPiece());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::string item_key = itemKey(keyOf(key), i);
    const YAML::Node item = (*found)[i];
    if (!item.IsMap()) {
      readVector(item, item_key, range, pieces[i].to);
      continue;
    }
    StrictReader arc(item, item_key, log_);
    pieces[i].centre.emplace(Vec3::Zero());
    arc.vector(required("to"), pieces[i].to, range);
    arc.vector(required("centre"), *pieces[i].centre, range);
    arc.reportUnknown();
  }
}

void StrictReader::pins(Key key, PinParams& value) {
  const std::string wanted = alternatives(pinNames()) + ", or a list of [row, column]";
  const YAML::Node* found = find(key, wanted);
  if (!found) return;
  if (found->IsSequence()) {
    value.kind = PinKind::kList;
    readNodes(*found, key, value.nodes);
  } else if (const std::optional<std::size_t> place = placeAmong(pinNames(), *found)) {
    value.kind = static_cast<PinKind>(*place);
  } else {
    refuse(keyOf(key), wanted, *found);
  }
}

void StrictReader::slits(Key key, std::vector<SlitParams>& values) {
  const YAML::Node* found = find(key, "a list");
  if (!found || !checkSequence(*found, keyOf(key), "a list")) return;
  values.assign(found->size(), SlitParams{});
  for (std::size_t i = 0; i < values.size(); ++i) readSlit((*found)[i], itemKey(keyOf(key), i), values[i]);
}

void StrictReader::readSlit(const YAML::Node& node, const std::string& key, SlitParams& value) {
  if (node.IsMap()) {
    readMap(node, key, value, log_);
  } else {
    readInteger(node, key, "a column, or a map {column, from_row}", value.column);
  }
}

bool StrictReader::belongs(Key key, bool yes, const Chosen& chosen) {
  // With an unknown choice nothing is known of its keys: this one counts as known.
  const bool given = entryOf(key) != entries_.end();
  asked_.emplace_back(key.name);
  if (!log_.good(joinKey(prefix_, chosen.key))) return false;
  if (given && !yes) {
    log_.add(keyOf(key), "does not belong to " + std::string(chosen.key) + " " + chosen.names.at(chosen.value));
  }
  return yes;
}

}  // namespace curtain
