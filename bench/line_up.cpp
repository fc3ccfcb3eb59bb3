// SPDX-License-Identifier: BSD-3-Clause
//
// The rivals' sweeps. Each ends where the method blows up, takes three times real time, or more of the same no longer
// pays.
#include "bench/line_up.h"

#include <cstdio>

#include "bench/rivals/rivals.h"

namespace curtain_bench {
namespace {

std::string text(const char* name, double value) {
  char out[64];
  std::snprintf(out, sizeof out, "%s %g", name, value);
  return out;
}

template <typename Settings, typename Maker>
void add(std::vector<Entry>& entries, const char* method, const std::string& detail, const Settings& settings,
         Maker maker, bool holds_slack = true) {
  Entry entry;
  entry.method = method;
  entry.setting = text("substeps", settings.substeps) + (detail.empty() ? "" : "; " + detail);
  entry.make = [settings, maker](const curtain::Scene&, const ClothStart& start) { return maker(start, settings); };
  entry.holds_slack = holds_slack;
  entries.push_back(entry);
}

// Every value, or every second one.
template <typename Value>
std::vector<Value> pick(const std::vector<Value>& values, bool thin) {
  std::vector<Value> picked;
  for (std::size_t v = 0; v < values.size(); v += thin ? 2 : 1) picked.push_back(values[v]);
  return picked;
}

void addExplicit(std::vector<Entry>& entries, bool thin) {
  for (const int substeps : pick<int>({8, 16, 32, 64, 128, 256, 512, 1024}, thin)) {
    for (const double limit : pick<double>({1.95, 1.5, 1.8}, thin)) {
      for (const double dashpot : {0.0, 0.05}) {
        const std::string detail = text("dt*omega", limit) + "; " + text("dashpot", dashpot);
        add(entries, "symplectic Euler", detail, ExplicitSettings{substeps, limit, dashpot}, makeSymplecticEuler);
      }
    }
  }
  for (const int substeps : pick<int>({4, 8, 16, 32, 64, 128, 256, 512}, thin)) {
    for (const double limit : pick<double>({1.8, 2.4, 2.7}, thin)) {
      add(entries, "Runge-Kutta 4", text("dt*omega", limit), ExplicitSettings{substeps, limit, 0.0}, makeRungeKutta);
    }
  }
}

void addImplicit(std::vector<Entry>& entries, bool thin) {
  for (const int substeps : pick<int>({1, 2, 4, 8, 16, 32, 64, 128}, thin)) {
    for (const double stiffness : pick<double>({1e2, 1e3, 1e4, 1e5}, thin)) {
      for (const double tolerance : pick<double>({1e-2, 1e-1, 1e-4}, thin)) {
        add(entries, "Baraff-Witkin", text("stiffness", stiffness) + " N/m; " + text("tolerance", tolerance),
            ImplicitSettings{substeps, stiffness, tolerance, 400}, makeBaraffWitkin);
      }
    }
  }
}

void addPosition(std::vector<Entry>& entries, bool thin) {
  for (const int substeps : pick<int>({1, 2, 4, 8, 16, 32, 64, 128, 256, 512}, thin)) {
    for (const int iterations : {1, 3, 10, 30, 100}) {
      if (substeps * iterations > 1024) continue;
      add(entries, "PBD", text("iterations", iterations), PositionSettings{substeps, iterations, 0.0}, makePbd);
      for (const double compliance : pick<double>({0.0, 1e-7, 1e-5}, thin)) {
        add(entries, "XPBD", text("iterations", iterations) + "; " + text("compliance", compliance) + " m/N",
            PositionSettings{substeps, iterations, compliance}, makeXpbd);
      }
    }
  }
}

void addBullet(std::vector<Entry>& entries, bool thin) {
  if (!bulletInstalled()) return;
  for (const int substeps : pick<int>({1, 2, 4, 8, 16, 32, 64, 128}, thin)) {
    for (const int iterations : {1, 3, 10, 30, 100}) {
      if (substeps * iterations > 256) continue;
      for (const int velocity : pick<int>({0, 1}, thin)) {
        add(entries, "btSoftBody", text("piterations", iterations) + "; " + text("viterations", velocity * iterations),
            BulletSettings{substeps, iterations, velocity * iterations}, makeBullet, false);
      }
    }
  }
}

}  // namespace

std::vector<Entry> rivalEntries(bool thin) {
  std::vector<Entry> entries;
  addExplicit(entries, thin);
  addImplicit(entries, thin);
  addPosition(entries, thin);
  addBullet(entries, thin);
  return entries;
}

}  // namespace curtain_bench
