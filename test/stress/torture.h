// SPDX-License-Identifier: BSD-3-Clause
//
// What a cloth is put through, and what it has to hold.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"
#include "energy_books.h"
#include "testing.h"

namespace curtain_test {

/// One torture. Whatever it does is a function of the frame and of its random numbers, so it can be repeated to the
/// bit.
struct Torture {
  curtain::Scene scene;
  double seconds = 3.0;  ///< of torture; it ends at the first frame's end that is there
  /// Before the first frame, before each of the torture's frames, and when it is over: takes away what it has put
  /// there.
  std::function<void(curtain::Simulator&)> begin;
  std::function<void(curtain::Simulator&, int frame, Random&)> torment;
  std::function<void(curtain::Simulator&)> end;
  /// Largest relative overlength of a link, and shortness of a rod, at any of the torture's frames' ends. Default:
  /// within the tolerance (substeps that do not settle may leave more, and are counted).
  double stretch_during = 2e-3;
  /// Rise of the energy that nobody has put in, over m g H, the kinetic energy meanwhile and the works of the last 60
  /// frames.
  double energy_gain = kSchemeGain;
  /// Kinetic energy over m g H, where links pull by no known force and the works of pins tell nothing.
  double kinetic = std::numeric_limits<double>::infinity();
  /// Methods that are known not to hold: they are shown as what they are, and are news when they do.
  std::vector<curtain::Method> known_failures;
  /// Stretch at the end of the recovery.
  double stretch_after = 2e-3;
  bool gravity_changes = false;  ///< what the potential was does not count then
  /// It must come back to rest once it is over.
  bool recovers = true;
};

/// A torture by its name.
struct TortureCase {
  std::string name;
  std::string what;  ///< for the table, one line
  std::function<Torture()> make;
  bool quick = true;        ///< part of the short form
  bool all_methods = true;  ///< sensible for all
};

/// Cloth of 1 m x 1 m and 0.2 kg/m^2 that hangs by its top row, in air that brings it to rest: all tortures start from
/// it.
curtain::Scene tortureScene(int rows = 12, int columns = 10);

// By what is tortured, one file each.
void addStepTortures(std::vector<TortureCase>& cases);
void addGridTortures(std::vector<TortureCase>& cases);
void addForceTortures(std::vector<TortureCase>& cases);
void addPinTortures(std::vector<TortureCase>& cases);
void addStartTortures(std::vector<TortureCase>& cases);
void addContactTortures(std::vector<TortureCase>& cases);

std::vector<TortureCase> allTortures();

}  // namespace curtain_test
