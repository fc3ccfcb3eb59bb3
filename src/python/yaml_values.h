// SPDX-License-Identifier: BSD-3-Clause
//
// Scenes, and parts of them, between Python's values and YAML nodes. Dicts go through the strict reader of scene files,
// so keys, ranges and the texts of errors are the same in both.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace YAML {
class Node;
}

namespace curtain::python {

/// Throws ValueError with every problem, one a line; does nothing when there is none.
void refuse(const std::vector<Problem>& problems, const std::string& source = "");

/// The same tree with its types; arrays and scalars of NumPy are lists and numbers. Throws ValueError naming the key
/// for what has no place in a scene. name: of the tree, for errors.
YAML::Node toYaml(const pybind11::handle& value, const std::string& name = "");
/// Of a tree that writeScene() has written.
pybind11::object fromYaml(const YAML::Node& node);

/// A scene from a dict; ValueError with its problems.
Scene readSceneValues(const pybind11::handle& values);
/// A scene as a dict, or the part of it under a key.
pybind11::object writeSceneValues(const Scene& scene);
pybind11::object writeSceneValues(const Scene& scene, const char* key);  ///< see above

/// A wind, a drag or the air as its part of a scene file is; ValueError with what is wrong. cloth: that it is for.
WindParams readWind(const pybind11::handle& values, const ClothParams& cloth);
DragParams readDrag(const pybind11::handle& values, const ClothParams& cloth);  ///< as above
/// The present cloth of this name (Simulator::layers()) with these values in place of its own.
ClothParams readCloth(const pybind11::handle& values, const Scene& present, const std::string& layer);
/// Keys that are not given keep the present values.
AirParams readAir(const pybind11::handle& values, const AirParams& present);

}  // namespace curtain::python
