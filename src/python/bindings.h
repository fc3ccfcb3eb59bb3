// SPDX-License-Identifier: BSD-3-Clause
//
// The parts of the module, a file each. Docstrings say shapes and units; src/python/__init__.pyi says types.
#pragma once

#include <pybind11/pybind11.h>

#include "python/python_simulator.h"

namespace curtain::python {

using SimulatorClass = pybind11::class_<PythonSimulator>;

void bindScene(pybind11::module& module);
void bindState(SimulatorClass& simulator);      ///< time, nodes, arrays, snapshots
void bindForces(SimulatorClass& simulator);     ///< winds, drags, what of the scene may change
void bindHands(SimulatorClass& simulator);      ///< pins and grasps
void bindFittings(SimulatorClass& simulator);   ///< rail, tie-backs, lines
void bindObstacles(SimulatorClass& simulator);  ///< poses, wrenches, contact points
void bindMeasures(SimulatorClass& simulator);   ///< statistics, energy, work, plan

}  // namespace curtain::python
