// SPDX-License-Identifier: BSD-3-Clause
//
// The demo for hours, as fast as it goes: the curtain, the ball that swings through it, the fan that sweeps over it
// (scripts/demo_motion), and at the end of every interval half a minute of quiet. A line of CSV an interval: what
// grows, slows down or drifts shows in its column. Exit code 1: something did.
//
//   soak SCENE.yaml [--hours H] [--interval SECONDS] [--out FILE.csv]
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"

namespace {

using namespace curtain;

constexpr double kPi = 3.14159265358979323846;
constexpr double kQuiet = 30.0;   // at the end of an interval [s]
constexpr int kFramesPerFan = 6;  // the fan is told ten times a second

struct Options {
  std::string scene, out;
  double hours = 8.0;
  double interval = 600.0;  // [s]
};

Options readOptions(int argc, char** argv) {
  Options options;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    const auto value = [&]() -> std::string {
      if (k + 1 < argc) return argv[++k];
      std::cerr << "soak: " << word << " needs a value\n";
      std::exit(2);
    };
    if (word == "--hours")
      options.hours = std::strtod(value().c_str(), nullptr);
    else if (word == "--interval")
      options.interval = std::strtod(value().c_str(), nullptr);
    else if (word == "--out")
      options.out = value();
    else if (word.rfind("--", 0) != 0 && options.scene.empty())
      options.scene = word;
    else
      std::cerr << "soak: unknown option " << word << "\n", std::exit(2);
  }
  if (options.scene.empty()) std::cerr << "soak: a scene is needed\n", std::exit(2);
  if (!(options.hours > 0.0 && options.hours < 1e6)) std::cerr << "soak: --hours must be in (0, 1e6)\n", std::exit(2);
  if (!(options.interval >= 2.0 * kQuiet))
    std::cerr << "soak: --interval must be " << 2.0 * kQuiet << " s at least\n", std::exit(2);
  return options;
}

// Memory of the process that is in RAM [kB].
long residentMemory() {
  std::ifstream file("/proc/self/statm");
  long all = 0, resident = 0;
  file >> all >> resident;
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

// glibc before 2.33 counts in int alone.
std::size_t heapMemory() {
#if __GLIBC_PREREQ(2, 33)
  return mallinfo2().uordblks / 1024;
#else
  return static_cast<unsigned int>(mallinfo().uordblks) / 1024;
#endif
}

// What the demo's motion node does at a time, to the simulator that owns the ball and the fan.
Pose ballAt(double time) {
  const double angle = 2.0 * kPi * 0.15 * time;
  Pose ball;
  ball.position = Vec3(0.3 + 0.15 * std::sin(0.37 * angle), -0.6 * std::cos(angle), 1.0);
  return ball;
}

void turnFan(double time, Simulator& simulator) {
  WindParams fan = simulator.scene().wind.front();
  const double yaw = 0.5 * kPi + 0.6 * std::sin(2.0 * kPi * 0.1 * time);
  fan.position = Vec3(0.3, -1.5, 1.1);
  fan.direction = Vec3(std::cos(yaw), std::sin(yaw), 0.0);
  fan.radius = 0.5;
  fan.half_angle = 0.2;
  fan.pressure = 4.0;
  fan.unsteadiness = 1.0;
  simulator.setWind(fan);
}

struct Row {
  double hours, median_ms, longest_ms, sweeps, stretch, rest_height, rest_speed, rest_stretch, pin_drift;
  long resident_kb;
  std::size_t heap_kb;
  std::int64_t unsettled, last_resort, stops;
  bool finite;
};

// The mean height of the nodes [m]: gathered cloth comes to rest in many ways, but at one height.
double meanHeight(const Simulator& simulator) {
  double mass = 0.0, moment = 0.0;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) {
      mass += simulator.mass({i, j});
      moment += simulator.mass({i, j}) * simulator.position({i, j}).z();
    }
  }
  return moment / mass;
}

Row soakInterval(double seconds, const std::vector<Vec3>& start, Simulator& simulator) {
  const double rate = simulator.scene().solver.frame_rate;
  const auto frames = static_cast<std::int64_t>(std::llround(seconds * rate));
  const auto quiet = static_cast<std::int64_t>(std::llround(kQuiet * rate));
  const Statistics before = simulator.statistics();
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(frames));
  simulator.setObstaclePresent(0, true);
  Row row{};
  for (std::int64_t f = 0; f < frames - quiet; ++f) {
    const double time = static_cast<double>(f) / rate;
    simulator.setObstaclePose(0, ballAt(time), f == 0);
    if (f % kFramesPerFan == 0) turnFan(time, simulator);
    simulator.step();
    times.push_back(simulator.statistics().step_seconds);
    row.stretch = std::max({row.stretch, simulator.statistics().warp_stretch, simulator.statistics().weft_stretch});
  }
  const Statistics moved = simulator.statistics();
  simulator.clearWinds();
  simulator.setObstaclePresent(0, false);
  for (std::int64_t f = 0; f < quiet; ++f) simulator.step();
  std::sort(times.begin(), times.end());
  const Statistics& after = simulator.statistics();
  row.hours = after.time / 3600.0;
  row.median_ms = 1e3 * times[times.size() / 2];
  row.longest_ms = 1e3 * times.back();
  row.sweeps = static_cast<double>(moved.sweeps - before.sweeps) / static_cast<double>(times.size());
  row.rest_height = meanHeight(simulator);
  row.rest_stretch = std::max(after.warp_stretch, after.weft_stretch);
  std::vector<Vec3> values;
  simulator.copyVelocities(values);
  for (const Vec3& v : values) row.rest_speed = std::max(row.rest_speed, v.norm());
  simulator.copyPositions(values);
  for (int j = 0; j < simulator.columns(); ++j) {
    if (simulator.pinned({0, j})) {
      row.pin_drift =
          std::max(row.pin_drift, (values[static_cast<std::size_t>(j)] - start[static_cast<std::size_t>(j)]).norm());
    }
  }
  row.resident_kb = residentMemory();
  row.heap_kb = heapMemory();
  row.unsettled = after.unsettled - before.unsettled;
  row.last_resort = after.last_resort_substeps - before.last_resort_substeps;
  row.stops = after.stops - before.stops;
  row.finite = after.finite;
  return row;
}

const char* const kHeader =
    "hours,median_ms,longest_ms,sweeps_per_frame,stretch_max,rest_height_m,rest_speed_m_s,rest_stretch,pin_drift_m,"
    "resident_kb,heap_kb,unsettled,last_resort,stops,finite";

std::string line(const Row& row) {
  char text[512];
  std::snprintf(text, sizeof text, "%.4f,%.4f,%.3f,%.3f,%.3g,%.6f,%.3g,%.3g,%.3g,%ld,%zu,%lld,%lld,%lld,%d", row.hours,
                row.median_ms, row.longest_ms, row.sweeps, row.stretch, row.rest_height, row.rest_speed,
                row.rest_stretch, row.pin_drift, row.resident_kb, row.heap_kb, static_cast<long long>(row.unsettled),
                static_cast<long long>(row.last_resort), static_cast<long long>(row.stops), row.finite ? 1 : 0);
  return text;
}

// What must not grow, slow down or drift, from the second interval on: the first one fills what grows with the motion.
int judge(const std::vector<Row>& rows) {
  if (rows.size() < 3) return 0;
  const Row &early = rows[1], &late = rows.back();
  int failures = 0;
  const auto must = [&failures](bool holds, const char* what) {
    if (holds) return;
    std::cerr << "soak: " << what << "\n";
    ++failures;
  };
  must(late.finite, "the state is not finite");
  // Machines are shared and noisy by a factor of two; sweeps, below, are not.
  const auto fastestOf = [&rows](std::size_t from, std::size_t to) {
    double least = rows[from].median_ms;
    for (std::size_t n = from; n < to; ++n) least = std::min(least, rows[n].median_ms);
    return least;
  };
  must(fastestOf(rows.size() / 2, rows.size()) <= 1.5 * fastestOf(0, rows.size() / 2), "frames take longer");
  const auto bad = [](const Row& row) {
    return row.stretch > 1e-2 || row.rest_speed > 1e-3 || row.stops > 0 || !row.finite;
  };
  must(std::none_of(rows.begin(), rows.end(), bad),
       "an interval has long links, no rest at its end, a stop or numbers that are none");
  // Rows of the table and the folds' scratch are all that may come: a leak of a byte a frame would be 35 kB in an
  // interval.
  must(late.heap_kb <= early.heap_kb + 64 * rows.size() / 10 + 64, "the heap has grown");
  must(late.resident_kb <= early.resident_kb + 2048, "resident memory has grown by more than 2 MB");
  must(std::abs(late.sweeps / early.sweeps - 1.0) <= 0.1, "a frame takes another number of sweeps");
  must(late.rest_stretch <= 1e-3 && late.pin_drift == 0.0, "links or pins have drifted");
  must(std::abs(late.rest_height - early.rest_height) <= 1e-3, "it comes to rest elsewhere");
  return failures;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = readOptions(argc, argv);
  const SceneReading reading = readSceneFile(options.scene);
  if (!reading.problems.empty()) {
    std::cerr << describe(reading.problems, options.scene) << "\n";
    return 2;
  }
  Simulator simulator(reading.scene);
  std::ofstream file;
  if (!options.out.empty()) file.open(options.out);
  std::ostream& out = options.out.empty() ? std::cout : file;
  out << kHeader << std::endl;
  std::vector<Vec3> start;
  simulator.copyPositions(start);
  std::vector<Row> rows;
  rows.reserve(100000);
  while (simulator.time() < 3600.0 * options.hours - 1e-6) {
    rows.push_back(soakInterval(options.interval, start, simulator));
    out << line(rows.back()) << std::endl;
  }
  return judge(rows) == 0 ? 0 : 1;
}
