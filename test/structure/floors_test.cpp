// SPDX-License-Identifier: BSD-3-Clause
//
// The house keeps its floors: a file includes only its own floor or a lower one, only the top knows ROS, and every
// public header has its floor in the list below.
//
//   0 scene < 1 cloth < 2 obstacles < 3 step < 4 contact < 5 parts, methods, surface < 6 simulator < 7 ros < 8 programs
//
// The rviz display stands beside ros, a house of its own: it includes public headers and messages alone, and nothing
// includes it, but for its surface, which is what export takes from bags. So does the Python module, which knows no
// messages either.
//
// Sensing stands beside the simulator, whose public headers it includes, and shows itself to ros alone: the engine does
// without it.
//
// So do the rooms of contact and of ros, with what puts them together above them:
//
//   0 narrow_phase, oracle < 1 broad_phase < 2 response < 4 contact's own files
//   0 parameters, time, frames < 1 inputs, obstacles, outputs, snapshots, watch < 2 opening, hands, sensors, health,
//     services < 3 tuning ties < 4 ros' own files
//
// Rooms of ros at the same height do not know each other, nor do those of parts, which are all at the same height.
#include <gtest/gtest.h>

#include <cctype>
#include <map>
#include <optional>
#include <regex>
#include <set>

#include "structure/source_files.h"

namespace {

using curtain_test::lines;
using curtain_test::SourceFile;
using curtain_test::sourceFiles;

const std::map<std::string, int> kFolders = {{"scene", 0},     {"cloth", 1},   {"obstacles", 2}, {"step", 3},
                                             {"contact", 4},   {"parts", 5},   {"methods", 5},   {"surface", 5},
                                             {"simulator", 6}, {"sensing", 6}, {"ros", 7},       {"rviz", 7},
                                             {"python", 7},    {"export", 7},  {"batch", 8},     {"fit", 8}};
using Rooms = std::map<std::string, int>;
// Of export alone this file knows ROS: what an animation is made of and written by needs none.
constexpr char kPlaysBags[] = "src/export/play_bag.cpp";
const Rooms kContactRooms = {{"narrow_phase", 0}, {"oracle", 0}, {"broad_phase", 1}, {"response", 2}};
const Rooms kRosRooms = {{"parameters", 0}, {"time", 0},      {"frames", 0},   {"inputs", 1},  {"obstacles", 1},
                         {"outputs", 1},    {"snapshots", 1}, {"watch", 1},    {"opening", 2}, {"hands", 2},
                         {"sensors", 2},    {"health", 2},    {"services", 2}, {"tuning", 3},  {"ties", 3}};
constexpr int kAboveRooms = 4;
constexpr int kRos = 7;
constexpr int kPrograms = 8;

// Complete: a public header that is not here fails the test. statistics.h and plan.h are plain structs that solvers and
// parts fill.
const std::map<std::string, int> kPublicHeaders = {{"plan.h", 0},       {"scene.h", 0},        {"grasp.h", 0},
                                                   {"scene_yaml.h", 0}, {"statistics.h", 0},   {"fine_mesh.h", 1},
                                                   {"drawn_mesh.h", 1}, {"mesh_reducer.h", 1}, {"obstacle_shape.h", 2},
                                                   {"ccd.h", 4},        {"simulator.h", 6},    {"snapshot_file.h", 6}};

// What only the floors from ros up may include, by the first folder of the name.
const std::set<std::string> kRosFolders = {"ros",
                                           "tf2",
                                           "tf2_ros",
                                           "xmlrpcpp",
                                           "pluginlib",
                                           "nodelet",
                                           "rosgraph_msgs",
                                           "interactive_markers",
                                           "catkin",
                                           "class_loader",
                                           "diagnostic_updater",
                                           "roslib",
                                           "message_filters",
                                           "dynamic_reconfigure",
                                           "urdf",
                                           "console_bridge",
                                           "rosbag",
                                           "rospack"};

/// A message, a service, dynamic_reconfigure's NAMEConfig.h, or a message of an action: NAMEAction.h, NAMEGoal.h, …
bool isMessage(const std::string& header) {
  const std::string name = header.substr(0, header.size() - 2);
  const std::filesystem::path root(CURTAIN_SOURCE_DIR);
  if (std::filesystem::exists(root / "msg" / (name + ".msg"))) return true;
  if (std::filesystem::exists(root / "srv" / (name + ".srv"))) return true;
  const std::size_t config = name.rfind("Config");
  if (config != std::string::npos && std::filesystem::exists(root / "cfg" / (name.substr(0, config) + ".cfg")))
    return true;
  const auto entries = std::filesystem::directory_iterator(root / "action");
  return std::any_of(begin(entries), end(entries),
                     [&](const auto& entry) { return name.rfind(entry.path().stem().string(), 0) == 0; });
}

struct Include {
  std::string file;  ///< as written
  bool quoted = false;
};

std::vector<Include> includesOf(const SourceFile& source) {
  std::vector<Include> includes;
  for (const std::string& line : lines(source.text)) {
    const std::size_t hash = line.find_first_not_of(" \t");
    if (hash == std::string::npos || line[hash] != '#') continue;
    const std::size_t word = line.find_first_not_of(" \t", hash + 1);
    if (word == std::string::npos || line.compare(word, 7, "include") != 0) continue;
    const std::size_t open = line.find_first_of("\"<", word);
    const std::size_t close = open == std::string::npos ? open : line.find_first_of("\">", open + 1);
    EXPECT_NE(close, std::string::npos) << source.name << ": " << line;
    if (close == std::string::npos) continue;
    includes.push_back({line.substr(open + 1, close - open - 1), line[open] == '"'});
  }
  return includes;
}

std::string firstFolder(const std::string& name) {
  const std::size_t slash = name.find('/');
  return slash == std::string::npos ? "" : name.substr(0, slash);
}

/// Floor of a file of src/ or include/; none: unknown.
std::optional<int> floorOfFile(const std::string& name) {
  if (name.rfind("include/curtain_sim/", 0) == 0) {
    const auto found = kPublicHeaders.find(name.substr(20));
    return found == kPublicHeaders.end() ? std::nullopt : std::optional<int>(found->second);
  }
  const std::string inside = name.substr(4);  // "src/"
  const std::string folder = firstFolder(inside);
  if (folder.empty()) return kPrograms;
  const auto found = kFolders.find(folder);
  return found == kFolders.end() ? std::nullopt : std::optional<int>(found->second);
}

/// Floor of what an include names, when that is ours.
std::optional<int> floorOfInclude(const Include& include) {
  const std::string folder = firstFolder(include.file);
  if (folder == "curtain_sim") {
    const std::string header = include.file.substr(12);
    if (const auto found = kPublicHeaders.find(header); found != kPublicHeaders.end()) return found->second;
    if (isMessage(header)) return kRos;
    return std::nullopt;
  }
  if (!include.quoted) return std::nullopt;
  const auto found = kFolders.find(folder);
  return found == kFolders.end() ? std::nullopt : std::optional<int>(found->second);
}

std::vector<SourceFile> houseFiles() {
  std::vector<SourceFile> files = sourceFiles("src");
  for (SourceFile& file : sourceFiles("include")) files.push_back(std::move(file));
  return files;
}

TEST(Floors, EveryFileHasOne) {
  const auto files = houseFiles();
  EXPECT_GT(files.size(), 50u) << "looked in the wrong place";
  std::set<std::string> headers;
  for (const SourceFile& file : files) {
    EXPECT_TRUE(floorOfFile(file.name).has_value()) << file.name << " is on no floor that this test knows";
    if (file.name.rfind("include/curtain_sim/", 0) == 0) headers.insert(file.name.substr(20));
  }
  for (const auto& entry : kPublicHeaders) EXPECT_EQ(headers.count(entry.first), 1u) << entry.first << " is gone";
}

TEST(Floors, NoFileIncludesAHigherOne) {
  int checked = 0;
  for (const SourceFile& file : houseFiles()) {
    const std::optional<int> floor = floorOfFile(file.name);
    if (!floor) continue;
    for (const Include& include : includesOf(file)) {
      const bool ours = include.quoted || firstFolder(include.file) == "curtain_sim";
      if (!ours) continue;
      const std::optional<int> below = floorOfInclude(include);
      ASSERT_TRUE(below.has_value()) << file.name << " includes " << include.file << ": not ours, or no floor is known";
      EXPECT_LE(*below, *floor) << file.name << " (floor " << *floor << ") includes " << include.file << " (floor "
                                << *below << ")";
      ++checked;
    }
  }
  EXPECT_GT(checked, 100);
}

/// The room of a file; name: as seen from the floor's folder, "response/zones.h".
int roomOf(const Rooms& rooms, const std::string& name) {
  const std::string folder = firstFolder(name);
  if (folder.empty()) return kAboveRooms;
  const auto found = rooms.find(folder);
  EXPECT_NE(found, rooms.end()) << name << " is in no room that this test knows";
  return found == rooms.end() ? kAboveRooms : found->second;
}

/// Includes within the floor that have been checked. strangers: rooms at the same height do not know each other.
int checkRooms(const std::string& floor, const Rooms& rooms, bool strangers) {
  int checked = 0;
  for (const SourceFile& file : sourceFiles("src/" + floor)) {
    const std::string inside = file.name.substr(floor.size() + 5);  // "src/", "/"
    const int room = roomOf(rooms, inside);
    for (const Include& include : includesOf(file)) {
      if (!include.quoted || firstFolder(include.file) != floor) continue;
      const std::string other = include.file.substr(floor.size() + 1);
      EXPECT_LE(roomOf(rooms, other), room) << file.name << " includes " << include.file;
      const bool same = firstFolder(other) == firstFolder(inside);
      if (strangers && !same) {
        EXPECT_NE(roomOf(rooms, other), room) << file.name << " includes " << include.file;
      }
      ++checked;
    }
  }
  return checked;
}

/// All at the same height, so that a part is added without a change here.
Rooms roomsOfParts() {
  Rooms rooms;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(CURTAIN_SOURCE_DIR) / "src/parts"))
    rooms[entry.path().filename().string()] = 0;
  return rooms;
}

TEST(Floors, RoomsHaveAnOrder) {
  EXPECT_GT(checkRooms("contact", kContactRooms, false), 50);
  EXPECT_GT(checkRooms("ros", kRosRooms, true), 50);
  EXPECT_GT(checkRooms("parts", roomsOfParts(), true), 0);
}

// Words of its identifiers: maxScaled_limit has most, scaled and limit. Those of a comment do not count.
std::set<std::string> wordsOf(const std::string& whole) {
  std::set<std::string> words;
  const std::string line = whole.substr(0, whole.find("//"));
  const std::regex word("[A-Z]?[a-z]+");
  for (auto at = std::sregex_iterator(line.begin(), line.end(), word); at != std::sregex_iterator(); ++at) {
    std::string one = at->str();
    one[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(one[0])));
    words.insert(one);
  }
  return words;
}

// What of the simulator is of one part, and what lists them all.
bool mayNameParts(const std::string& name) {
  return name.rfind("src/simulator/api/", 0) == 0 || name.rfind("src/simulator/composition.", 0) == 0;
}

// A part is added without a change to the core, so the core can't speak of it.
TEST(Floors, TheCoreNamesNoPart) {
  EXPECT_EQ(wordsOf("kMost scaled_limit  // by hand"), (std::set<std::string>{"k", "limit", "most", "scaled"}));
  const std::set<std::string> parts = {"bend",  "bending", "bends",  "carrier", "carriers", "cord", "cords", "drag",
                                       "drags", "grasp",   "grasps", "gust",    "gusts",    "hand", "hands", "pad",
                                       "pads",  "rail",    "slit",   "slits",   "tie",      "ties", "wind",  "winds"};
  // Members of Work, a public struct, which the core fills.
  const std::regex public_name(R"(work_\.bending|"bending")");
  int checked = 0, named = 0;
  for (const char* const folder : {"src/step", "src/simulator"}) {
    for (const SourceFile& file : sourceFiles(folder)) {
      for (const std::string& line : lines(file.text)) {
        for (const std::string& word : wordsOf(std::regex_replace(line, public_name, ""))) {
          if (parts.count(word) == 0) continue;
          EXPECT_TRUE(mayNameParts(file.name)) << file.name << ": " << line;
          ++named;
        }
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 5000) << "looked in the wrong place";
  EXPECT_GT(named, 20) << "the test must recognise them";
}

TEST(Floors, PublicHeadersIncludeNoPrivateOnes) {
  for (const SourceFile& file : sourceFiles("include")) {
    for (const Include& include : includesOf(file)) {
      if (include.quoted) {
        EXPECT_EQ(firstFolder(include.file), "curtain_sim") << file.name << ": " << include.file;
      }
    }
  }
}

// A type that a public header only declares is one that its users can't use: of ours, a class's own implementation
// alone.
TEST(Floors, PublicHeadersDefineTheTypesTheyName) {
  std::set<std::string> defined;
  std::map<std::string, std::string> declared;
  const std::regex type(R"(^ *(?:class|struct|enum class) (\w+)( *[;:{]| final))");
  for (const SourceFile& file : sourceFiles("include")) {
    for (const std::string& line : lines(file.text)) {
      std::smatch match;
      if (!std::regex_search(line, match, type)) continue;
      if (match[2] == ";")
        declared[match[1]] = file.name;
      else
        defined.insert(match[1]);
    }
  }
  EXPECT_GT(defined.size(), 20u);
  EXPECT_EQ(declared.count("Impl"), 1u) << "the test must recognise declarations";
  for (const auto& [name, file] : declared) {
    const bool of_yaml_cpp = name == "Node" && file == "include/curtain_sim/scene_yaml.h";
    EXPECT_TRUE(defined.count(name) > 0 || name == "Impl" || of_yaml_cpp) << file << " declares " << name;
  }
}

// A part of rviz, Ogre or Qt.
bool isOfRviz(const Include& include) {
  if (include.quoted) return false;
  const std::regex name("(rviz|Overlay|OGRE)/.*|Ogre\\w+\\.h|Q[A-Z]\\w+");
  return std::regex_match(include.file, name);
}

TEST(Floors, TheRvizDisplayIsAHouseOfItsOwn) {
  int own = 0, of_rviz = 0;
  for (const SourceFile& file : houseFiles()) {
    const bool inside = file.name.rfind("src/rviz/", 0) == 0;
    const bool surface = file.name.rfind("src/rviz/surface/", 0) == 0;
    for (const Include& include : includesOf(file)) {
      const std::string folder = firstFolder(include.file);
      if (include.quoted && folder == "rviz") {
        const bool plays_bags = file.name == kPlaysBags && include.file.rfind("rviz/surface/", 0) == 0;
        EXPECT_TRUE(inside || plays_bags) << file.name << " includes " << include.file;
        const bool of_surface = include.file.rfind("rviz/surface/", 0) == 0;
        EXPECT_TRUE(of_surface || !surface) << file.name << " includes " << include.file << ", which needs rviz";
        ++own;
      } else if (inside && include.quoted) {
        EXPECT_EQ(folder, "curtain_sim") << file.name << " includes " << include.file;
      }
      if (!isOfRviz(include)) continue;
      EXPECT_TRUE(inside && !surface) << file.name << " includes " << include.file;
      ++of_rviz;
    }
  }
  EXPECT_GT(own, 15) << "looked in the wrong place";
  EXPECT_GT(of_rviz, 15) << "the test must recognise them";
}

TEST(Floors, TheEngineDoesWithoutSensing) {
  int of_ros = 0;
  for (const SourceFile& file : houseFiles()) {
    const bool inside = file.name.rfind("src/sensing/", 0) == 0;
    for (const Include& include : includesOf(file)) {
      const std::string folder = firstFolder(include.file);
      if (include.quoted && folder == "sensing" && !inside) {
        EXPECT_EQ(file.name.rfind("src/ros/", 0), 0U) << file.name << " includes " << include.file;
        ++of_ros;
      }
      if (inside && include.quoted) {
        EXPECT_NE(folder, "simulator") << file.name << " includes " << include.file;
      }
      EXPECT_TRUE(file.name == "src/sensing/embree.h" || folder.rfind("embree", 0) != 0)
          << file.name << " includes " << include.file;
    }
  }
  EXPECT_GT(of_ros, 3) << "looked in the wrong place";
}

TEST(Floors, ThePythonModuleIsAHouseOfItsOwn) {
  int own = 0, of_python = 0;
  for (const SourceFile& file : houseFiles()) {
    const bool inside = file.name.rfind("src/python/", 0) == 0;
    for (const Include& include : includesOf(file)) {
      const std::string folder = firstFolder(include.file);
      if (include.quoted && folder == "python") {
        EXPECT_TRUE(inside) << file.name << " includes " << include.file;
        ++own;
      } else if (inside && include.quoted) {
        EXPECT_EQ(folder, "curtain_sim") << file.name << " includes " << include.file;
        EXPECT_EQ(kPublicHeaders.count(include.file.substr(12)), 1u) << file.name << " includes " << include.file;
      }
      if (folder != "pybind11") continue;
      EXPECT_TRUE(inside) << file.name << " includes " << include.file;
      ++of_python;
    }
  }
  EXPECT_GT(own, 15) << "looked in the wrong place";
  EXPECT_GT(of_python, 5) << "the test must recognise them";
}

TEST(Floors, OnlyTheTopKnowsRos) {
  int ros_includes = 0;
  for (const SourceFile& file : houseFiles()) {
    const bool top = file.name.rfind("src/ros/", 0) == 0 || file.name.rfind("src/rviz/", 0) == 0 ||
                     file.name == kPlaysBags || file.name == "src/curtain_node.cpp" ||
                     file.name == "src/curtain_nodelet.cpp";
    for (const Include& include : includesOf(file)) {
      const std::string folder = firstFolder(include.file);
      const bool message_package = folder.size() > 5 && folder.compare(folder.size() - 5, 5, "_msgs") == 0;
      const bool message = folder == "curtain_sim" && kPublicHeaders.count(include.file.substr(12)) == 0;
      const bool of_ros = kRosFolders.count(folder) > 0 || message_package || message;
      if (of_ros) ++ros_includes;
      EXPECT_TRUE(top || !of_ros) << file.name << " includes " << include.file;
    }
  }
  EXPECT_GT(ros_includes, 10) << "the test must recognise them";
}

}  // namespace
