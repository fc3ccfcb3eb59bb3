// SPDX-License-Identifier: BSD-3-Clause
//
// An oracle for the drape test, with nothing of the engine in it: Cusick's sample as an isotropic elastic shell of
// triangles, pushed by explicit steps until it is at rest.
#pragma once

namespace curtain_shell {

struct Fabric {
  double density = 0.0;  ///< [kg/m^2]
  double bending = 0.0;  ///< B [N m]
  double shear = 0.0;    ///< mu, of the membrane [N/m]
  double poisson = 0.0;  ///< of the membrane
  double bending_poisson = 0.0;
};

struct Reading {
  double coefficient = 0.0;  ///< of drape [0..1]
  int folds = 0;
  double seconds = 0.0;  ///< until it was at rest; 0: it was not
};

/// Lets a sample of so many rings of triangles (> 2) sink; `start` draws how it is triangulated.
Reading drape(const Fabric& fabric, int rings, unsigned start);

}  // namespace curtain_shell
