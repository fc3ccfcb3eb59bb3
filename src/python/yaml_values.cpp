// SPDX-License-Identifier: BSD-3-Clause
#include "python/yaml_values.h"

#include <yaml-cpp/yaml.h>

#include <utility>

#include "curtain_sim/scene_yaml.h"

namespace py = pybind11;

namespace curtain::python {
namespace {

// A dict can hold itself.
constexpr int kDeepest = 32;

// A scalar as the scene's reader knows it from a file: "!" is text, whatever it looks like, "" a value from code.
YAML::Node scalar(const std::string& text, const char* tag) {
  YAML::Node node(text);
  node.SetTag(tag);
  return node;
}

// With all digits that a double has, in YAML's spelling.
std::string numberText(const py::handle& value) {
  const std::string text = py::repr(value);
  if (text == "inf") return ".inf";
  if (text == "-inf") return "-.inf";
  return text == "nan" ? ".nan" : text;
}

// Python's text may hold half a surrogate pair, which is no character.
std::string textOf(const py::handle& value, const std::string& name) {
  Py_ssize_t size = 0;
  const char* const bytes = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
  if (bytes != nullptr) return {bytes, static_cast<std::size_t>(size)};
  PyErr_Clear();
  refuse({{name, "is no text that UTF-8 has"}});
  return {};
}

std::string under(const std::string& name, const std::string& key) { return name.empty() ? key : name + "." + key; }

YAML::Node convert(const py::handle& value, const std::string& name, int depth);

YAML::Node convertDict(const py::handle& value, const std::string& name, int depth) {
  YAML::Node node(YAML::NodeType::Map);
  for (const auto& [key, entry] : py::reinterpret_borrow<py::dict>(value)) {
    if (!py::isinstance<py::str>(key)) refuse({{name, "a key must be text, is " + std::string(py::repr(key))}});
    const std::string text = textOf(key, name);
    node.force_insert(scalar(text, "!"), convert(entry, under(name, text), depth + 1));
  }
  return node;
}

YAML::Node convertSequence(const py::handle& value, const std::string& name, int depth) {
  YAML::Node node(YAML::NodeType::Sequence);
  std::size_t n = 0;
  for (const py::handle entry : py::reinterpret_borrow<py::sequence>(value))
    node.push_back(convert(entry, name + "[" + std::to_string(n++) + "]", depth + 1));
  return node;
}

YAML::Node convert(const py::handle& value, const std::string& name, int depth) {
  if (depth > kDeepest) refuse({{name, "is nested too deeply"}});
  if (value.is_none()) return YAML::Node(YAML::NodeType::Null);
  if (py::isinstance<py::bool_>(value)) return scalar(value.cast<bool>() ? "true" : "false", "?");
  if (py::isinstance<py::int_>(value)) return scalar(py::str(value), "");
  if (py::isinstance<py::float_>(value)) {
    const py::float_ plain(value.cast<double>());  // not a class derived from it, whose repr() is its own
    return scalar(numberText(plain), "");
  }
  if (py::isinstance<py::str>(value)) return scalar(textOf(value, name), "!");
  if (py::isinstance<py::dict>(value)) return convertDict(value, name, depth);
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) return convertSequence(value, name, depth);
  if (py::hasattr(value, "tolist")) return convert(value.attr("tolist")(), name, depth + 1);  // NumPy's
  const std::string type = py::str(value.get_type().attr("__name__"));
  refuse({{name, "must be a number, text, a list or a dict, is a " + type}});
  return {};
}

// The scene that readers of its parts wrap them in: what the parts' checks look at.
YAML::Node wrapping(const ClothParams& cloth) {
  YAML::Node root;
  root["cloth"]["rows"] = cloth.rows;
  root["cloth"]["columns"] = cloth.columns;
  return root;
}

Scene smallest() {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = 2;
  return scene;
}

// Of a scene around one entry of a list: "wind[0].radius" is "wind.radius".
Scene readEntry(const py::handle& values, const ClothParams& cloth, const std::string& list) {
  YAML::Node root = wrapping(cloth);
  root[list].push_back(toYaml(values, list));
  SceneReading reading = readScene(root);
  const std::string first = list + "[0]";
  for (Problem& problem : reading.problems) {
    if (problem.key.compare(0, first.size(), first) == 0) problem.key.replace(0, first.size(), list);
  }
  refuse(reading.problems);
  return std::move(reading.scene);
}

}  // namespace

void refuse(const std::vector<Problem>& problems, const std::string& source) {
  if (!problems.empty()) throw py::value_error(describe(problems, source));
}

YAML::Node toYaml(const py::handle& value, const std::string& name) { return convert(value, name, 0); }

py::object fromYaml(const YAML::Node& node) {
  if (node.IsMap()) {
    py::dict values;
    for (const auto& entry : node) values[py::str(entry.first.Scalar())] = fromYaml(entry.second);
    return py::object(values);
  }
  if (node.IsSequence()) {
    py::list values;
    for (const auto& entry : node) values.append(fromYaml(entry));
    return py::object(values);
  }
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return py::str(text);
  if (text == "true" || text == "false") return py::bool_(text == "true");
  if (text == ".inf" || text == "-.inf") return py::float_(py::str(text[0] == '-' ? "-inf" : "inf"));
  if (text.find_first_of("0123456789") > 1) return py::str(text);  // a word; numbers may have a sign
  const bool real = text.find_first_of(".e") != std::string::npos;
  return real ? py::object(py::float_(py::str(text))) : py::object(py::int_(py::str(text)));
}

Scene readSceneValues(const py::handle& values) {
  SceneReading reading = readScene(toYaml(values));
  refuse(reading.problems);
  return std::move(reading.scene);
}

py::object writeSceneValues(const Scene& scene) { return fromYaml(YAML::Load(writeScene(scene))); }

py::object writeSceneValues(const Scene& scene, const char* key) {
  const YAML::Node root = YAML::Load(writeScene(scene));
  return fromYaml(root[key]);
}

WindParams readWind(const py::handle& values, const ClothParams& cloth) {
  return readEntry(values, cloth, "wind").wind.front();
}

DragParams readDrag(const py::handle& values, const ClothParams& cloth) {
  return readEntry(values, cloth, "drag").drag.front();
}

ClothParams readCloth(const py::handle& values, const Scene& present, const std::string& layer) {
  YAML::Node root = YAML::Load(writeScene(present));
  const auto found = std::find_if(present.layers.begin(), present.layers.end(),
                                  [&](const LayerParams& one) { return one.name == layer; });
  const bool first = layer == kFirstCloth;
  if (!first && found == present.layers.end())
    refuse({{"layer", "must be \"cloth\" or the name of a layer, is \"" + layer + "\""}});
  const auto number = static_cast<std::size_t>(found - present.layers.begin());
  YAML::Node cloth = first ? root["cloth"] : root["layers"][number]["cloth"];
  const YAML::Node given = toYaml(values, "cloth");
  if (given["material"]) {  // sets all of these, but for those that are given
    for (const char* key : {"surface_density", "porosity", "shear", "bending_warp", "bending_weft", "bending_bias"})
      cloth.remove(key);
  }
  for (const auto& entry : given) cloth[entry.first.Scalar()] = entry.second;
  SceneReading reading = readScene(root);
  refuse(reading.problems);
  return first ? reading.scene.cloth : reading.scene.layers[number].cloth;
}

AirParams readAir(const py::handle& values, const AirParams& present) {
  Scene scene = smallest();
  scene.air = present;
  YAML::Node root = wrapping(scene.cloth);
  YAML::Node air = YAML::Load(writeScene(scene))["air"];
  const YAML::Node given = toYaml(values, "air");
  if (!given.IsMap()) refuse({{"air", "must be a dict"}});
  for (const auto& entry : given) air[entry.first.Scalar()] = entry.second;
  root["air"] = air;
  SceneReading reading = readScene(root);
  refuse(reading.problems);
  return reading.scene.air;
}

}  // namespace curtain::python
