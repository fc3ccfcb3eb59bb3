// SPDX-License-Identifier: BSD-3-Clause
//
// Grids of every size, and links and masses far apart.
#include "stress/torture.h"

namespace curtain_test {
namespace {

using namespace curtain;

// Swings from a start out of the vertical, with its hung edge gathered a little so that strings go slack and snap.
Torture swing(int rows, int columns, double seconds) {
  Torture torture;
  torture.scene = tortureScene(rows, columns);
  torture.scene.hang.tilt = 0.8;
  torture.scene.hang.to.x() = 0.9;
  torture.seconds = seconds;
  return torture;
}

Torture grid(int rows, int columns, double seconds, bool recovers) {
  Torture torture = swing(rows, columns, seconds);
  torture.recovers = recovers;
  return torture;
}

Torture rodsFarApart(double ratio) {
  Torture torture = swing(12, 10, 3.0);
  for (int i = 0; i + 1 < 12; ++i) torture.scene.cloth.row_spacing.push_back(i % 2 == 0 ? 1.0 : ratio);
  return torture;
}

Torture stringsFarApart(double ratio) {
  Torture torture = swing(12, 10, 3.0);
  for (int j = 0; j + 1 < 10; ++j) torture.scene.cloth.column_spacing.push_back(j % 2 == 0 ? 1.0 : ratio);
  return torture;
}

Torture heavyHem(double factor) {
  Torture torture = swing(12, 10, 3.0);
  torture.scene.cloth.row_mass.assign(12, 1.0);
  torture.scene.cloth.row_mass.back() = factor;
  return torture;
}

Torture heavyColumn(double factor) {
  Torture torture = swing(12, 10, 3.0);
  torture.recovers = false;  // the air is nothing to it
  torture.scene.cloth.column_mass.assign(10, 1.0);
  torture.scene.cloth.column_mass[4] = factor;
  return torture;
}

Torture massesOfEverySize() {
  Torture torture = swing(12, 10, 3.0);
  Random random(3);
  torture.recovers = false;
  for (int i = 0; i < 12; ++i) torture.scene.cloth.row_mass.push_back(std::exp(random.between(0.0, std::log(1e6))));
  return torture;
}

// In air as thin, so that it is not brought to a stop at once.
Torture feather() {
  Torture torture = swing(12, 10, 3.0);
  torture.scene.air.density *= 1e-6 / torture.scene.cloth.surface_density;
  torture.scene.cloth.surface_density = 1e-6;
  return torture;
}

Torture lead() {
  Torture torture = swing(12, 10, 3.0);
  torture.recovers = false;
  torture.scene.cloth.surface_density = 1e6;
  return torture;
}

Torture ofSize(double size) {
  Torture torture = swing(12, 10, 3.0);
  torture.scene.cloth.height = torture.scene.cloth.width = size;
  torture.scene.hang.to.x() = 0.9 * size;
  return torture;
}

}  // namespace

void addGridTortures(std::vector<TortureCase>& cases) {
  cases.push_back({"2 x 2", "the smallest cloth there is", [] { return grid(2, 2, 3.0, true); }});
  cases.push_back({"2 x 10", "", [] { return grid(2, 10, 3.0, true); }});
  cases.push_back({"10 x 2", "", [] { return grid(10, 2, 3.0, true); }});
  cases.push_back({"100 x 100", "10 000 nodes", [] { return grid(100, 100, 0.5, false); }, false});
  cases.push_back({"2 x 4000", "one row of rods", [] { return grid(2, 4000, 0.5, false); }, false});
  cases.push_back({"4000 x 2", "rods of 0.25 mm", [] { return grid(4000, 2, 0.05, false); }, false});
  cases.push_back({"1000 x 1000", "a million nodes", [] { return grid(1000, 1000, 0.05, false); }, false, false});
  cases.push_back({"rods 1e3 : 1", "lengths by turns", [] { return rodsFarApart(1e-3); }});
  cases.push_back({"rods 1e6 : 1", "lengths by turns", [] { return rodsFarApart(1e-6); }});
  cases.push_back({"strings 1e3 : 1", "lengths by turns", [] { return stringsFarApart(1e-3); }});
  cases.push_back({"strings 1e6 : 1", "lengths by turns", [] { return stringsFarApart(1e-6); }});
  cases.push_back({"hem 1e3 times as heavy", "", [] { return heavyHem(1e3); }});
  cases.push_back({"hem 1e6 times as heavy", "", [] { return heavyHem(1e6); }});
  cases.push_back({"hem 1e6 times as light", "", [] { return heavyHem(1e-6); }});
  cases.push_back({"column 1e6 times as heavy", "", [] { return heavyColumn(1e6); }});
  cases.push_back({"masses 1 to 1e6", "at random by row", massesOfEverySize});
  cases.push_back({"feather cloth", "1e-6 kg/m^2", feather});
  cases.push_back({"leaden cloth", "1e6 kg/m^2", lead});
  cases.push_back({"cloth of 1 mm", "", [] { return ofSize(1e-3); }});
  cases.push_back({"cloth of 1 km", "", [] { return ofSize(1e3); }});
}

}  // namespace curtain_test
