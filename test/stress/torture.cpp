// SPDX-License-Identifier: BSD-3-Clause
#include "stress/torture.h"

namespace curtain_test {

curtain::Scene tortureScene(int rows, int columns) {
  curtain::Scene scene = flatScene(rows, columns);
  scene.hang.from.z() = scene.hang.to.z() = 2.0;
  // c / m = density c_r / surface density = 6 / s: a swing of 1 m (14.2 / s^2) is damped by 0.8 of critical.
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  return scene;
}

std::vector<TortureCase> allTortures() {
  std::vector<TortureCase> cases;
  addStepTortures(cases);
  addGridTortures(cases);
  addForceTortures(cases);
  addPinTortures(cases);
  addStartTortures(cases);
  addContactTortures(cases);
  return cases;
}

}  // namespace curtain_test
