// SPDX-License-Identifier: BSD-3-Clause
//
// The torture suite: every case for the default method, and for all of them where that is sensible. Prints a line a
// case and method; exit code 1 when one does not hold.
//
//   curtain_stress [--slow] [--all-methods] [--long] [--only TEXT] [--method NAME] [--csv FILE] [--list]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>

#include "stress/torture.h"
#include "stress/trial.h"

namespace {

using namespace curtain_test;

struct Options {
  bool slow = false;              // the slow cases, too, with the default method
  bool all_methods = false;       // the quick cases with all methods
  bool slow_all_methods = false;  // the slow ones, too
  bool list = false;
  std::string only, method, csv;
};

bool read(int argc, char** argv, Options& options) {
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    const bool last = k + 1 >= argc;
    if (word == "--long")
      options.slow = options.all_methods = options.slow_all_methods = true;
    else if (word == "--slow")
      options.slow = true;
    else if (word == "--all-methods")
      options.all_methods = true;
    else if (word == "--list")
      options.list = true;
    else if (word == "--only" && !last)
      options.only = argv[++k];
    else if (word == "--method" && !last)
      options.method = argv[++k];
    else if (word == "--csv" && !last)
      options.csv = argv[++k];
    else
      return false;
  }
  return options.method.empty() || curtain::methodFromName(options.method).has_value();
}

std::string describe(const Trial& trial) {
  char text[256];
  std::snprintf(text, sizeof text,
                "%s stretch %.1e after %.1e energy %+.1e rest %.2f of %.2f s, %lld unsettled %lld last resort "
                "%lld stops, slowest %.1f ms, %.1f s",
                trial.holds() ? "holds " : "FAILS ", trial.stretch, trial.stretch_after, trial.energy_gain,
                trial.recovery, trial.recovery_allowed, static_cast<long long>(trial.unsettled),
                static_cast<long long>(trial.last_resort), static_cast<long long>(trial.stops), 1e3 * trial.slowest,
                trial.seconds);
  std::string line = text;
  for (const std::string& failure : trial.faults) line += "\n        " + failure;
  return line;
}

void writeRow(const std::string& name, const std::string& method, const Trial& trial, std::ostream& out) {
  out << name << ',' << method << ',' << (trial.holds() ? 1 : 0) << ',' << (trial.finite ? 1 : 0) << ','
      << trial.stretch << ',' << trial.stretch_allowed << ',' << trial.stretch_after << ',' << trial.energy_gain << ','
      << trial.energy_allowed << ',' << trial.recovery << ',' << trial.recovery_allowed << ','
      << (trial.repeated ? (trial.same_bits ? "1" : "0") : "") << ',' << trial.frames << ',' << trial.unsettled << ','
      << trial.last_resort << ',' << trial.stops << ',' << 1e3 * trial.slowest << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!read(argc, argv, options)) {
    std::cerr << "usage: curtain_stress [--long] [--all-methods] [--only TEXT] [--method NAME] [--csv FILE] [--list]\n";
    return 2;
  }
  std::ofstream csv;
  if (!options.csv.empty()) csv.open(options.csv);
  csv << "case,method,holds,finite,stretch,stretch_allowed,stretch_after,energy_gain,energy_allowed,recovery_s,"
         "recovery_allowed_s,"
         "same_bits,frames,unsettled,last_resort,stops,slowest_ms\n";
  int held = 0, failed = 0, surprises = 0;
  for (const TortureCase& one : allTortures()) {
    if (one.name.find(options.only) == std::string::npos || (!one.quick && !options.slow)) continue;
    if (options.list) std::cout << one.name << ": " << one.what << '\n';
    const bool all_methods = one.all_methods && (one.quick ? options.all_methods : options.slow_all_methods);
    for (const std::string& name : curtain::methodNames()) {
      const bool wanted = options.method.empty() ? name == "auto" || all_methods : name == options.method;
      if (options.list || !wanted) continue;
      const Torture torture = one.make();
      const curtain::Method method = *curtain::methodFromName(name);
      const Trial trial = carryOut(torture, method, one.quick || name == "auto");
      const auto& known = torture.known_failures;
      const bool expected = std::find(known.begin(), known.end(), method) != known.end();
      if (expected == trial.holds()) ++surprises;
      std::printf("%-28s %-9s %s\n", one.name.c_str(), name.c_str(), describe(trial).c_str());
      std::fflush(stdout);
      writeRow(one.name, name, trial, csv);
      csv.flush();
      ++(trial.holds() ? held : failed);
    }
  }
  if (!options.list) std::printf("%d hold, %d fail; %d otherwise than known\n", held, failed, surprises);
  return surprises == 0 ? 0 : 1;
}
