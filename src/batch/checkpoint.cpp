// SPDX-License-Identifier: BSD-3-Clause
#include "batch/checkpoint.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "cloth/archive.h"
#include "curtain_sim/scene_yaml.h"
#include "scene/scene_difference.h"
#include "simulator/snapshot_format.h"
#include "simulator/whole_file.h"

namespace curtain_batch {
namespace {

using curtain::Archive;

constexpr std::string_view kMagic = "curtain checkpoint\n";
/// To be raised with every change of what serialize() lists, or of its meaning.
constexpr std::uint32_t kVersion = 4;
constexpr std::size_t kHeader = kMagic.size() + sizeof(std::uint32_t) + sizeof(std::uint64_t);
constexpr std::size_t kChecksum = sizeof(std::uint32_t);

// As of a snapshot's scene: the bits do not depend on these, and of a mesh the triangles are compared.
const std::vector<std::string> kAside = {"solver.threads", "obstacles[].mesh", "obstacles[].color",
                                         "obstacles[].visible"};

void serialize(Archive& archive, RunIdentity& run, Progress& progress, std::string& snapshot) {
  constexpr auto kLowest = std::numeric_limits<std::int64_t>::min(),
                 kHighest = std::numeric_limits<std::int64_t>::max();
  archive.list("options", run.options, [&](std::pair<std::string, std::string>& option) {
    archive.text("name", option.first);
    archive.text("value", option.second);
  });
  archive.text("scene", run.scene);
  curtain::RunSums& sums = progress.sums;
  archive.number("kinetic", sums.initial.kinetic);
  archive.number("potential", sums.initial.potential);
  archive.list("frame_seconds", sums.frame_seconds, [&](double& seconds) { archive.number("seconds", seconds); });
  for (std::int64_t& frames : sums.frames_of) archive.integer("frames_of_quality", frames, 0, kHighest);
  archive.list("loads", sums.loads, [&](curtain::ContactWrench& load) {
    archive.numbers("force", load.force);
    archive.numbers("torque", load.torque);
    archive.number("time", load.time);
  });
  for (TableMark* const mark : {&progress.states, &progress.wrenches}) {
    archive.integer("bytes", mark->bytes, 0, kHighest);
    archive.integer("hash", mark->hash, kLowest, kHighest);
  }
  archive.text("snapshot", snapshot);
}

template <typename T>
void append(const T& value, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}
template <typename T>
T valueAt(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::string readFile(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) throw std::invalid_argument(path + ": is not a file");
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw std::invalid_argument(path + ": cannot be read");
  return bytes;
}

// The members; the bytes must outlive them.
std::string_view unpack(std::string_view bytes) {
  if (bytes.substr(0, kMagic.size()) != kMagic) throw std::invalid_argument("is no checkpoint");
  if (bytes.size() < kHeader + kChecksum) throw std::invalid_argument("is cut short");
  const auto version = valueAt<std::uint32_t>(bytes, kMagic.size());
  if (version != kVersion) {
    throw std::invalid_argument("has format version " + std::to_string(version) + ", this program reads version " +
                                std::to_string(kVersion));
  }
  const auto length = valueAt<std::uint64_t>(bytes, kMagic.size() + sizeof version);
  if (bytes.size() != length) throw std::invalid_argument(bytes.size() < length ? "is cut short" : "is too long");
  const std::string_view summed = bytes.substr(0, bytes.size() - kChecksum);
  if (valueAt<std::uint32_t>(bytes, summed.size()) != curtain::checksum(summed)) {
    throw std::invalid_argument("is damaged: its checksum is wrong");
  }
  return summed.substr(kHeader);
}

void expectSame(const RunIdentity& ours, const RunIdentity& theirs) {
  const std::string another = ": the checkpoint is of another run";
  if (ours.options.size() != theirs.options.size()) throw std::invalid_argument("is of another build");
  for (std::size_t k = 0; k < ours.options.size(); ++k) {
    const auto& [name, value] = ours.options[k];
    if (theirs.options[k] == ours.options[k]) continue;
    throw std::invalid_argument(name + " is '" + value + "', was '" + theirs.options[k].second + "'" + another);
  }
  if (const auto problem = curtain::firstDifference(ours.scene, theirs.scene, kAside)) {
    throw std::invalid_argument(problem->key + " " + problem->text + another);
  }
}

}  // namespace

RunIdentity identityOf(const Options& options, const curtain::Simulator& simulator) {
  RunIdentity run;
  const auto text = [](double value) {
    std::ostringstream out;
    out.precision(17);
    out << value;
    return out.str();
  };
  std::string samples;
  for (const double sample : options.samples) samples += (samples.empty() ? "" : ",") + text(sample);
  run.options = {{"--duration", text(options.duration)},
                 {"--sample", samples},
                 {"--out", options.out},
                 {"--wrenches", options.wrenches},
                 {"--mesh", options.mesh},
                 {"--stats", options.stats},
                 {"--save", options.save},
                 {"--restore", options.restore}};
  if (!options.restore.empty()) {
    curtain::Fnv1a state;  // not a CRC: a snapshot ends with its own, and so all have the same
    const std::string snapshot = simulator.snapshot();
    state.addBytes(snapshot.data(), snapshot.size());
    run.options.emplace_back("hash of --restore", std::to_string(state.hash));
  }
  run.scene = curtain::writeScene(simulator.scene());
  return run;
}

void writeCheckpoint(const std::string& path, const RunIdentity& run, const curtain::Simulator& simulator,
                     const Progress& progress) {
  RunIdentity own_run = run;
  Progress own_progress = progress;
  std::string snapshot = simulator.snapshot();
  Archive archive = Archive::saving();
  serialize(archive, own_run, own_progress, snapshot);
  const std::string members = archive.extractWritten();
  std::string bytes(kMagic);
  bytes.reserve(kHeader + members.size() + kChecksum);
  append(kVersion, bytes);
  append(static_cast<std::uint64_t>(kHeader + members.size() + kChecksum), bytes);
  bytes += members;
  append(curtain::checksum(bytes), bytes);
  const std::vector<curtain::Problem> problems = curtain::writeWholeFile(path, bytes);
  if (!problems.empty()) throw std::runtime_error(curtain::describe(problems, "--checkpoint"));
}

bool readCheckpoint(const std::string& path, const RunIdentity& run, curtain::Simulator& simulator,
                    Progress& progress) {
  if (!std::filesystem::exists(path)) return false;
  try {
    const std::string bytes = readFile(path);
    RunIdentity theirs;
    Progress taken;
    std::string snapshot;
    Archive archive = Archive::loading(unpack(bytes));
    serialize(archive, theirs, taken, snapshot);
    archive.finishLoading();
    archive.commit();
    expectSame(run, theirs);
    const std::vector<curtain::Problem> problems = simulator.restore(snapshot);
    if (!problems.empty()) throw std::invalid_argument(curtain::describe(problems));
    progress = std::move(taken);
  } catch (const curtain::ArchiveError& error) {
    throw std::invalid_argument("--checkpoint: " + path + ": is damaged: " + error.what());
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("--checkpoint: " + path + ": " + error.what());
  }
  return true;
}

void removeLeftovers(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path file = fs::weakly_canonical(fs::absolute(path));  // beside what a link leads to
  const std::string ours = file.filename().string();
  const std::regex ending(R"(\.tmp-\d+-\d+)");  // as writeWholeFile() names them
  for (const fs::directory_entry& entry : fs::directory_iterator(file.parent_path())) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(ours, 0) != 0 || !std::regex_match(name.substr(ours.size()), ending)) continue;
    if (fs::is_regular_file(entry.symlink_status())) fs::remove(entry.path());
  }
}

}  // namespace curtain_batch
