// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/export.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "simulator/whole_file.h"

namespace curtain {
namespace {

void writePly(const FineMesh& mesh, const FineMeshTopology& topology, std::ostream& out) {
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.positions.size()
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << topology.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& p : mesh.positions) out << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (const auto& t : topology.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
}

void writeObj(const FineMesh& mesh, const FineMeshTopology& topology, std::ostream& out) {
  for (const Vec3& p : mesh.positions) out << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (const auto& t : topology.triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
}

void put(std::uint32_t value, std::size_t bytes, std::string& out) {
  for (std::size_t k = 0; k < bytes; ++k) out.push_back(static_cast<char>(value >> (8 * k) & 0xFFU));
}

void put(const Vec3& vector, std::string& out) {
  for (const double value : {vector.x(), vector.y(), vector.z()}) {
    const auto single = static_cast<float>(value);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &single, sizeof bits);
    put(bits, 4, out);
  }
}

// Binary STL: 80 bytes of anything but "solid", the number of facets, and for each its normal, three corners and an
// unused 16-bit number; little-endian (Burns, Automated Fabrication, 1993, Sect. 6.5). A facet without an area has the
// normal 0, which readers work out themselves.
std::string stlFile(const FineMesh& mesh, const FineMeshTopology& topology) {
  constexpr std::size_t kHeader = 80, kFacet = 50;
  std::string out = "binary STL, metres";
  out.reserve(kHeader + 4 + kFacet * topology.triangles.size());
  out.resize(kHeader, ' ');
  put(static_cast<std::uint32_t>(topology.triangles.size()), 4, out);
  for (const auto& t : topology.triangles) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    put((b - a).cross(c - a).stableNormalized(), out);
    for (const Vec3* corner : {&a, &b, &c}) put(*corner, out);
    put(0, 2, out);
  }
  return out;
}

// The value below which the given share of the samples lies.
double quantile(std::vector<double> samples, double share) {
  if (samples.empty()) return 0.0;
  std::sort(samples.begin(), samples.end());
  return samples[static_cast<std::size_t>(std::lround(share * static_cast<double>(samples.size() - 1)))];
}

nlohmann::ordered_json toJson(const ContactWrench& wrench) {
  return {{"force", {wrench.force.x(), wrench.force.y(), wrench.force.z()}},
          {"torque", {wrench.torque.x(), wrench.torque.y(), wrench.torque.z()}}};
}

}  // namespace

namespace {

// A field of a CSV file (RFC 4180).
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? std::string(2, letter) : std::string(1, letter);
  return quoted + '"';
}

}  // namespace

void writeStateHeader(std::ostream& out) { out << "t,row,column,x,y,z,vx,vy,vz\n"; }

void writeState(const Simulator& simulator, std::ostream& out) {
  std::vector<Vec3> positions, velocities;
  simulator.copyPositions(positions);
  simulator.copyVelocities(velocities);
  out << std::setprecision(17);
  std::size_t n = 0;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j, ++n) {
      const Vec3& x = positions[n];
      const Vec3& v = velocities[n];
      out << simulator.time() << ',' << i << ',' << j << ',' << x.x() << ',' << x.y() << ',' << x.z() << ',' << v.x()
          << ',' << v.y() << ',' << v.z() << '\n';
    }
  }
}

void writeWrenchHeader(std::ostream& out) { out << "t,obstacle,fx,fy,fz,tx,ty,tz,contacts\n"; }

void writeWrenches(const Simulator& simulator, std::ostream& out) {
  out << std::setprecision(17);
  for (int obstacle = 0; obstacle < simulator.obstacleCount(); ++obstacle) {
    const ContactWrench wrench = simulator.contactWrench(obstacle);
    out << simulator.time() << ',' << field(simulator.scene().obstacles[static_cast<std::size_t>(obstacle)].name);
    for (const Vec3* const vector : {&wrench.force, &wrench.torque})
      out << ',' << vector->x() << ',' << vector->y() << ',' << vector->z();
    out << ',' << wrench.contacts << '\n';
  }
}

std::optional<MeshFormat> meshFormatOf(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".ply") return MeshFormat::kPly;
  if (ending == ".obj") return MeshFormat::kObj;
  if (ending == ".stl") return MeshFormat::kStl;
  return std::nullopt;
}

std::string meshFile(const FineMesh& mesh, const FineMeshTopology& topology, MeshFormat format) {
  if (format == MeshFormat::kStl) return stlFile(mesh, topology);
  std::ostringstream out;
  out << std::setprecision(9);
  (format == MeshFormat::kPly ? writePly : writeObj)(mesh, topology, out);
  return out.str();
}

void writeMesh(const Simulator& simulator, const std::string& path) {
  const std::optional<MeshFormat> format = meshFormatOf(path);
  if (!format) throw std::invalid_argument(path + ": a mesh file must end in " + kMeshEndings);
  FineMesh mesh;
  simulator.copyFineMesh(mesh);
  const std::vector<Problem> problems = writeWholeFile(path, meshFile(mesh, simulator.fineMeshTopology(), *format));
  if (!problems.empty()) throw std::runtime_error(describe(problems));
}

void RunSums::add(const Simulator& simulator) {
  frame_seconds.push_back(simulator.statistics().step_seconds);
  ++frames_of[static_cast<std::size_t>(simulator.statistics().quality)];
  loads.resize(static_cast<std::size_t>(simulator.obstacleCount()));
  for (int obstacle = 0; obstacle < simulator.obstacleCount(); ++obstacle) {
    ContactWrench& mean = loads[static_cast<std::size_t>(obstacle)];
    const ContactWrench last = simulator.contactWrench(obstacle);
    mean.time += last.time;
    if (!(mean.time > 0.0)) continue;
    mean.force += (last.time / mean.time) * (last.force - mean.force);
    mean.torque += (last.time / mean.time) * (last.torque - mean.torque);
  }
}

std::string describeLastResort(const Statistics& s) {
  if (s.stops == 0 && s.momentum_cut == 0.0 && s.obstacles_waited == 0.0) return {};
  std::ostringstream text;
  text << "the cloth was jammed, or under a load too heavy for the shortest substeps: " << s.stops
       << " substeps stopped, " << s.momentum_cut << " N s of momentum cut, obstacles waited " << s.obstacles_waited
       << " s";
  return text.str();
}

std::string statisticsJson(const Simulator& simulator, const RunSums& run) {
  const Statistics& s = simulator.statistics();
  const Energy energy = simulator.energy();
  nlohmann::ordered_json json;
  json["nodes"] = simulator.rows() * simulator.columns();
  json["frames"] = s.frames;
  json["simulated_s"] = s.time;
  json["wall_s"] = s.step_seconds_sum;
  json["ms_per_frame"] = {{"median", 1e3 * quantile(run.frame_seconds, 0.5)},
                          {"p99", 1e3 * quantile(run.frame_seconds, 0.99)},
                          {"max", 1e3 * quantile(run.frame_seconds, 1.0)}};
  json["substeps_mean"] = s.frames > 0 ? static_cast<double>(s.substeps) / static_cast<double>(s.frames) : 0.0;
  json["sweeps_mean"] = s.substeps > 0 ? static_cast<double>(s.sweeps) / static_cast<double>(s.substeps) : 0.0;
  for (std::size_t n = 0; n < run.frames_of.size(); ++n)
    json["quality"][toString(static_cast<FrameQuality>(n))] = run.frames_of[n];
  json["position_error"] = s.position_error;
  json["substeps_rejected"] = s.rejected;
  json["last_resort_substeps"] = s.last_resort_substeps;
  json["substeps_unsettled"] = s.unsettled;
  json["stops"] = s.stops;
  json["stops_last"] = s.stops_last;
  json["momentum_cut"] = s.momentum_cut;
  json["obstacles_waited"] = s.obstacles_waited;
  json["stretch_max"] = {{"warp", s.warp_stretch_max}, {"weft", s.weft_stretch_max}};
  json["compression_max"] = {{"warp", s.warp_compression_max}};
  json["energy"] = {{"initial", run.initial.kinetic + run.initial.potential},
                    {"final", energy.kinetic + energy.potential},
                    {"kinetic", energy.kinetic},
                    {"potential", energy.potential}};
  json["contacts_max"] = s.contacts_max;
  json["penetration_max"] = s.penetration_max;
  json["self_crossings"] = simulator.selfCrossings();
  Piercings piercings;
  for (int obstacle = 0; obstacle < simulator.obstacleCount(); ++obstacle) {
    const Piercings own = simulator.piercings(obstacle);
    piercings.nodes += own.nodes;
    piercings.edges += own.edges;
    piercings.faces += own.faces;
  }
  json["piercings"] = {{"nodes", piercings.nodes}, {"edges", piercings.edges}, {"faces", piercings.faces}};
  nlohmann::ordered_json wrenches = nlohmann::ordered_json::object();
  for (int obstacle = 0; obstacle < simulator.obstacleCount(); ++obstacle) {
    const auto at = static_cast<std::size_t>(obstacle);
    nlohmann::ordered_json& entry = wrenches[simulator.scene().obstacles[at].name];
    entry = toJson(simulator.contactWrench(obstacle));
    entry["mean"] = toJson(at < run.loads.size() ? run.loads[at] : ContactWrench());
  }
  json["wrenches"] = wrenches;
  nlohmann::ordered_json hands = nlohmann::ordered_json::object();
  for (const HandParams& hand : simulator.scene().hands) {
    const std::optional<GraspState> state = simulator.graspState(hand.grasp.id);
    if (!state) continue;
    hands[hand.grasp.id] = {{"end", toString(state->end)},
                            {"nodes", state->nodes.size()},
                            {"force", {state->force.x(), state->force.y(), state->force.z()}},
                            {"torque", {state->torque.x(), state->torque.y(), state->torque.z()}},
                            {"slipped", state->slipped}};
  }
  json["hands"] = hands;
  json["rest"] = {{"asleep", s.asleep}, {"frames_asleep", s.asleep_frames}, {"wakes", s.wakes}};
  json["budget"] = {{"ms", simulator.scene().solver.budget_ms},
                    {"estimates_skipped", s.estimates_skipped},
                    {"longer_substeps", s.longer_substeps},
                    {"unfinished_substeps", s.unfinished_substeps},
                    {"shortened_frames", s.shortened_frames},
                    {"lost_s", s.lost_time},
                    {"late_frames", s.late_frames}};
  nlohmann::ordered_json stages;
  for (int stage = 0; stage < kStageCount; ++stage) {
    stages[stageName(static_cast<Stage>(stage))] = 1e3 * s.stage_seconds[static_cast<std::size_t>(stage)];
  }
  json["stages"] = stages;
  json["finite"] = s.finite;
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(simulator.stateHash()));
  json["state_hash"] = hash;
  return json.dump(2) + "\n";
}

}  // namespace curtain
