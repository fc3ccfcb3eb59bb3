// SPDX-License-Identifier: BSD-3-Clause
//
// The visitor of fields.h that writes YAML. Numbers have enough digits to read back the same bits, and text is always
// quoted, so that YAML 1.1 changes neither. Values that are not given (empty optionals, NaN friction) or do not belong
// to the obstacle's shape are left out.
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "curtain_sim/scene_yaml.h"
#include "scene/fields.h"

namespace curtain {
namespace {

class SceneWriter {
 public:
  explicit SceneWriter(YAML::Emitter& out) : out_(out) {}

  void integer(Key key, const int& value, IntRange) { plain(key, std::to_string(value)); }
  void integerOr(Key key, const int& value, IntRange, const char* word, int word_value) {
    plain(key, value == word_value ? word : std::to_string(value));
  }
  void seed(Key key, const std::uint64_t& value) { plain(key, std::to_string(value)); }
  void number(Key key, const double& value, Range) { plain(key, formatYamlNumber(value)); }
  void optionalNumber(Key key, const std::optional<double>& value, Range range) {
    if (value) number(key, *value, range);
  }
  void numberOrUnset(Key key, const double& value, Range range) {
    if (!std::isnan(value)) number(key, value, range);
  }
  void flag(Key key, const bool& value) { plain(key, value ? "true" : "false"); }
  void text(Key key, const std::string& value) {
    out_ << YAML::Key << key.name << YAML::Value << YAML::DoubleQuoted << value;
  }
  void optionalText(Key key, const std::optional<std::string>& value) {
    if (value) text(key, *value);
  }
  void vector(Key key, const Vec3& value, Range) { flow(key, {value.x(), value.y(), value.z()}); }
  void optionalVector(Key key, const std::optional<Vec3>& value, Range range) {
    if (value) vector(key, *value, range);
  }
  void scale(Key key, const Vec3& value, Range range) { vector(key, value, range); }
  void rotation(Key key, const Rotation& value) { flow(key, {value.x(), value.y(), value.z(), value.w()}); }
  void node(Key key, const std::optional<NodeIndex>& value) {
    if (!value) return;
    out_ << YAML::Key << key.name << YAML::Value;
    writeNode(*value);
  }
  void nodes(Key key, const std::vector<NodeIndex>& values) {
    out_ << YAML::Key << key.name << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const NodeIndex& node : values) writeNode(node);
    out_ << YAML::EndSeq;
  }
  void numbers(Key key, const std::vector<double>& values, Range) { flow(key, values); }
  void integers(Key key, const std::vector<int>& values, IntRange) {
    out_ << YAML::Key << key.name << YAML::Value << YAML::Flow << values;
  }
  bool belongs(Key, bool yes, const Chosen&) { return yes; }

  void pins(Key key, const PinParams& value) {
    if (value.kind != PinKind::kList) {
      plain(key, pinNames().at(static_cast<std::size_t>(value.kind)));
      return;
    }
    nodes(key, value.nodes);
  }

  void slits(Key key, const std::vector<SlitParams>& values) {
    out_ << YAML::Key << key.name << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const SlitParams& slit : values) {
      out_ << YAML::BeginMap << YAML::Key << "column" << YAML::Value << slit.column;
      out_ << YAML::Key << "from_row" << YAML::Value << slit.from_row << YAML::EndMap;
    }
    out_ << YAML::EndSeq;
  }

  void path(Key key, const std::vector<RailPiece>& pieces, Range range) {
    out_ << YAML::Key << key.name << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const RailPiece& piece : pieces) {
      if (!piece.centre) {
        numbers({piece.to.x(), piece.to.y(), piece.to.z()});
        continue;
      }
      out_ << YAML::Flow << YAML::BeginMap;
      vector("to", piece.to, range);
      vector("centre", *piece.centre, range);
      out_ << YAML::EndMap;
    }
    out_ << YAML::EndSeq;
  }

  template <typename Enum>
  void choice(Key key, const Enum& value, const std::vector<std::string>& names) {
    plain(key, names.at(static_cast<std::size_t>(value)));
  }

  template <typename T>
  void map(Key key, const T& value) {
    out_ << YAML::Key << key.name << YAML::Value << YAML::BeginMap;
    visitFields(*this, value);
    out_ << YAML::EndMap;
  }

  template <typename T>
  void list(Key key, const std::vector<T>& values, const T& = {}) {
    out_ << YAML::Key << key.name << YAML::Value;
    if (values.empty()) out_ << YAML::Flow;
    out_ << YAML::BeginSeq;
    for (const T& value : values) {
      out_ << YAML::BeginMap;
      visitFields(*this, value);
      out_ << YAML::EndMap;
    }
    out_ << YAML::EndSeq;
  }

 private:
  void plain(Key key, const std::string& value) { out_ << YAML::Key << key.name << YAML::Value << value; }

  void flow(Key key, const std::vector<double>& values) {
    out_ << YAML::Key << key.name << YAML::Value;
    numbers(values);
  }

  void numbers(const std::vector<double>& values) {
    out_ << YAML::Flow << YAML::BeginSeq;
    for (const double value : values) out_ << formatYamlNumber(value);
    out_ << YAML::EndSeq;
  }

  void writeNode(const NodeIndex& node) {
    out_ << YAML::Flow << YAML::BeginSeq << node.row << node.column << YAML::EndSeq;
  }

  YAML::Emitter& out_;
};

}  // namespace

std::string writeScene(const Scene& scene) {
  YAML::Emitter out;
  out << YAML::BeginMap;
  SceneWriter writer(out);
  visitFields(writer, scene);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace curtain
