// SPDX-License-Identifier: BSD-3-Clause
//
// curtain_shell: the oracle of drape on the command line.
#include <cstdio>
#include <cstdlib>

#include "bench/shell/shell.h"

int main(int argc, char** argv) {
  if (argc != 7) {
    std::fprintf(stderr,
                 "usage: curtain_shell DENSITY[kg/m2] B[N.m] SHEAR[N/m] POISSON RINGS STARTS\n"
                 "Drape of an isotropic shell; POISSON of its membrane, that of its bending is 0. A line a start:\n"
                 "coefficient [%%], folds, seconds until it was at rest (0: it was not).\n");
    return 2;
  }
  const curtain_shell::Fabric fabric{std::atof(argv[1]), std::atof(argv[2]), std::atof(argv[3]), std::atof(argv[4]),
                                     0.0};
  const int rings = std::atoi(argv[5]), starts = std::atoi(argv[6]);
  for (int start = 1; start <= starts; ++start) {
    const curtain_shell::Reading reading = curtain_shell::drape(fabric, rings, static_cast<unsigned>(start));
    std::printf("%.1f %d %.1f\n", 100.0 * reading.coefficient, reading.folds, reading.seconds);
    std::fflush(stdout);
  }
  return 0;
}
