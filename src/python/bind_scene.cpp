// SPDX-License-Identifier: BSD-3-Clause
#include "curtain_sim/scene_yaml.h"
#include "python/bindings.h"
#include "python/yaml_values.h"

namespace py = pybind11;

namespace curtain::python {
namespace {

Scene usable(SceneReading reading, const std::string& source) {
  refuse(reading.problems, source);
  return std::move(reading.scene);
}

Scene readFile(const py::object& path) {
  const auto name = py::module::import("os").attr("fspath")(path).cast<std::string>();
  return usable(readSceneFile(name), name);
}

Scene readText(const std::string& text) { return usable(readSceneText(text), ""); }

}  // namespace

void bindScene(py::module& module) {
  py::class_<Scene>(module, "Scene",
                    "What a simulator starts from: cloth, pins or rail, winds, obstacles, solver. It does not change; "
                    "to change one, change its to_dict() and make another. Can be pickled and compared.")
      .def(py::init([](const py::dict& values) { return readSceneValues(values); }), py::arg("values"),
           "From a dict with the keys of scene files; arrays of NumPy may stand for lists. Relative mesh paths are "
           "taken "
           "from the working directory. ValueError with all problems, one a line.")
      .def_static("from_file", &readFile, py::arg("path"),
                  "Reads a scene file (YAML). Relative mesh paths are taken from its folder. ValueError with all "
                  "problems, one a line.")
      .def_static("from_yaml", &readText, py::arg("text"), "Reads a scene from YAML text; otherwise as Scene().")
      .def(
          "to_dict", [](const Scene& scene) { return writeSceneValues(scene); },
          "A new dict with every key spelled out; Scene() gives the same scene back, bit by bit.")
      .def(
          "to_yaml", [](const Scene& scene) { return writeScene(scene); },
          "YAML text with every key spelled out; from_yaml() gives the same scene back, bit by bit.")
      .def(
          "__eq__", [](const Scene& scene, const Scene& other) { return writeScene(scene) == writeScene(other); },
          py::is_operator())
      .def("__hash__", [](const Scene& scene) { return py::hash(py::str(writeScene(scene))); })
      .def("__repr__",
           [](const Scene& scene) {
             return "<curtain_engine.Scene of " + std::to_string(scene.cloth.rows) + " x " +
                    std::to_string(wholeCloth(scene).columns) + " nodes>";
           })
      .def(py::pickle([](const Scene& scene) { return py::str(writeScene(scene)); },
                      [](const py::str& text) { return readText(text); }));
}

}  // namespace curtain::python
