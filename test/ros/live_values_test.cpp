// SPDX-License-Identifier: BSD-3-Clause
//
// What dynamic_reconfigure offers is what config/curtain.yaml calls live, with the defaults and ranges of the tables
// that the scene and the parameters are read by; what is wrong is refused in the scene's words and changes nothing.
#include "ros/tuning/live_values.h"

#include <gtest/gtest.h>

#include <boost/any.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "curtain_sim/scene_yaml.h"
#include "scene/names.h"

namespace curtain_ros {
namespace {

using curtain_sim::CurtainConfig;

struct Entry {
  double value, low, high;
};
using Table = std::map<std::string, Entry>;

// Numbers of a table of keys, with a prefix. Others than numbers are not live but for air.law.
struct Collector {
  Table* table;
  std::string prefix;

  void number(curtain::Key key, double value, curtain::Range range) {
    (*table)[prefix + key.name] = {value, range.low, range.high};
  }
  template <typename... Rest>
  void text(Rest&&...) {}
  template <typename... Rest>
  void textOrNone(Rest&&...) {}
  template <typename... Rest>
  void texts(Rest&&...) {}
  template <typename... Rest>
  void flag(Rest&&...) {}
  template <typename... Rest>
  void integer(Rest&&...) {}
  template <typename... Rest>
  void integerOr(Rest&&...) {}
  template <typename... Rest>
  void choice(Rest&&...) {}
  template <typename... Rest>
  void seed(Rest&&...) {}
  template <typename... Rest>
  void optionalNumber(Rest&&...) {}
  template <typename... Rest>
  void vector(Rest&&...) {}
  template <typename... Rest>
  void numbers(Rest&&...) {}
  template <typename... Rest>
  void slits(Rest&&...) {}
  template <typename... Rest>
  void list(Rest&&...) {}
};

Table tableOfKeys() {
  Table table;
  const auto collect = [&table](const std::string& prefix, const auto& values) {
    Collector collector{&table, prefix};
    curtain::visitFields(collector, values);
  };
  const curtain::Scene scene;
  collect("", NodeParams());
  collect("air_", scene.air);
  collect("cloth_", scene.cloth);
  collect("contact_", scene.contact);
  collect("solver_", scene.solver);
  const curtain::Range range = curtain::anywhere();
  table["gravity_x"] = {scene.gravity.x(), range.low, range.high};
  table["gravity_y"] = {scene.gravity.y(), range.low, range.high};
  table["gravity_z"] = {scene.gravity.z(), range.low, range.high};
  return table;
}

template <typename Value>
Value valueOf(const CurtainConfig::AbstractParamDescription& parameter, const CurtainConfig& config) {
  boost::any value;
  parameter.getValue(config, value);
  return boost::any_cast<Value>(value);
}

TEST(LiveValues, HaveTheDefaultsAndRangesOfTheirKeys) {
  const Table table = tableOfKeys();
  int numbers = 0;
  for (const auto& parameter : CurtainConfig::__getParamDescriptions__()) {
    if (parameter->name == "air_law") continue;
    ASSERT_EQ(parameter->type, "double") << parameter->name;
    const auto key = table.find(parameter->name);
    ASSERT_NE(key, table.end()) << parameter->name << " is no key";
    EXPECT_EQ(valueOf<double>(*parameter, CurtainConfig::__getDefault__()), key->second.value) << parameter->name;
    EXPECT_EQ(valueOf<double>(*parameter, CurtainConfig::__getMin__()), key->second.low) << parameter->name;
    EXPECT_EQ(valueOf<double>(*parameter, CurtainConfig::__getMax__()), key->second.high) << parameter->name;
    ++numbers;
  }
  EXPECT_EQ(numbers, 30);
}

TEST(LiveValues, OfferEveryLawOfTheAir) {
  for (const auto& parameter : CurtainConfig::__getParamDescriptions__()) {
    if (parameter->name != "air_law") continue;
    for (const std::string& law : curtain::airLawNames())
      EXPECT_NE(parameter->edit_method.find("'value': '" + law + "'"), std::string::npos) << law;
    EXPECT_EQ(valueOf<std::string>(*parameter, CurtainConfig::__getDefault__()), curtain::airLawNames().at(0));
    return;
  }
  FAIL() << "there is no air_law";
}

// The keys of config/curtain.yaml, those of the scene's sections as dynamic_reconfigure spells them, and what is said
// of each: "live" or "startup only" in its comment, which may stand above it or go on below it, or for all of its
// section. Keys that are commented out are off by default, and those of entries of lists; none of them is live.
std::map<std::string, std::string> commentsOfKeys() {
  std::ifstream file(std::string(CURTAIN_SOURCE_DIR) + "/config/curtain.yaml");
  const std::regex key("^( *)([a-z_]+):([^#]*)(# (.*))?$"), comment("^( *)# (.*)$");
  constexpr std::size_t kBehind = 20;  // columns from which on a comment belongs to the key above it
  std::map<std::string, std::string> comments;
  std::string section, last, above;
  for (std::string line; std::getline(file, line);) {
    std::smatch match;
    if (std::regex_match(line, match, key)) {
      const auto depth = static_cast<std::size_t>(match[1].length());
      if (depth == 2) section = match[2];
      last = depth == 0 ? match[2].str() : depth == 2 ? section : section + "_" + match[2].str();
      comments[last] = above + match[5].str();
      above.clear();
    } else if (std::regex_match(line, match, comment)) {
      const bool behind = static_cast<std::size_t>(match[1].length()) >= kBehind;
      (behind ? comments[last] : above) += " " + match[2].str();
    } else {
      above.clear();
    }
  }
  return comments;
}

TEST(LiveValues, AreWhatTheManualCallsLive) {
  std::set<std::string> offered;
  for (const auto& parameter : CurtainConfig::__getParamDescriptions__())
    offered.insert(parameter->name.rfind("gravity_", 0) == 0 ? "gravity" : parameter->name);
  std::set<std::string> live;
  const std::map<std::string, std::string> comments = commentsOfKeys();
  const std::regex says_live("(.*; )?(all )?live( .*)?");
  for (const auto& [name, comment] : comments) {
    if (name == "scene") continue;
    const std::string section = name.substr(0, name.find('_'));
    const bool of_section = comments.count(section) > 0 && !comments.at(section).empty();
    const std::string& says = of_section ? comments.at(section) : comment;
    const bool lives = std::regex_match(says, says_live);
    const bool starts = says.find("startup only") != std::string::npos;
    const bool is_section = name == "cloth" || name == "contact" || name == "solver";  // whose keys say it each
    EXPECT_TRUE(is_section || lives != starts) << name << " must say one of both: " << says;
    if (lives && (name == "gravity" || name != section)) live.insert(name);
  }
  EXPECT_EQ(live, offered);
}

curtain::Simulator makeSimulator(const std::string& rest = "") {
  return curtain::Simulator(
      curtain::readSceneText("cloth: {rows: 6, columns: 5, bending_warp: 1.0e-4, bending_weft: 1.0e-4}\n" + rest)
          .scene);
}

CurtainConfig presentOf(const curtain::Simulator& simulator, const NodeParams& params) {
  return liveValues(simulator.scene(), params);
}

bool same(const CurtainConfig& a, const CurtainConfig& b) {
  bool all = true;
  for (const auto& parameter : CurtainConfig::__getParamDescriptions__()) {
    const bool text = parameter->name == "air_law";
    all = all && (text ? a.air_law == b.air_law : valueOf<double>(*parameter, a) == valueOf<double>(*parameter, b));
  }
  return all;
}

// Every value that is offered arrives, and comes back.
TEST(LiveValues, AreTakenOneByOne) {
  for (const auto& parameter : CurtainConfig::__getParamDescriptions__()) {
    curtain::Simulator simulator = makeSimulator("solver: {position_tolerance: 1.0e-3}\n");
    NodeParams params;
    const CurtainConfig before = presentOf(simulator, params);
    dynamic_reconfigure::Config message;
    CurtainConfig wanted = before;
    wanted.__toMessage__(message);
    for (auto& number : message.doubles) {
      if (number.name == parameter->name) number.value = 0.5 * number.value + 0.004;
    }
    for (auto& text : message.strs) {
      if (text.name == parameter->name) text.value = "relative";
    }
    wanted.__fromMessage__(message);
    ASSERT_FALSE(same(wanted, before)) << parameter->name;
    EXPECT_TRUE(applyLiveValues(wanted, simulator, params).empty()) << parameter->name;
    EXPECT_TRUE(same(presentOf(simulator, params), wanted)) << parameter->name;
  }
}

// One that is wrong is left as it was; the others of the same call are taken.
TEST(LiveValues, ThatAreWrongAreLeftAlone) {
  curtain::Simulator simulator = makeSimulator();
  NodeParams params;
  const CurtainConfig before = presentOf(simulator, params);
  CurtainConfig wanted = before;
  wanted.contact_friction = std::nan("");
  wanted.solver_position_tolerance = 1e-3;
  wanted.air_law = "thick";
  wanted.mesh_rate = std::nan("");
  wanted.gravity_z = -1.62;
  const std::vector<curtain::Problem> problems = applyLiveValues(wanted, simulator, params);
  std::set<std::string> keys;
  for (const curtain::Problem& problem : problems) keys.insert(problem.key);
  EXPECT_EQ(keys, (std::set<std::string>{"air.law", "contact.friction", "mesh_rate", "solver.position_tolerance"}));
  CurtainConfig expected = before;
  expected.gravity_z = -1.62;
  EXPECT_TRUE(same(presentOf(simulator, params), expected));
}

// Values that are the same wake nobody.
TEST(LiveValues, ThatAreTheSameChangeNothing) {
  curtain::Simulator simulator = makeSimulator("air: {inside: 1.0, border: 1.0, corner: 1.0}\n");
  NodeParams params;
  while (!simulator.statistics().asleep && simulator.time() < 20.0) simulator.step();
  ASSERT_TRUE(simulator.statistics().asleep);
  EXPECT_TRUE(applyLiveValues(presentOf(simulator, params), simulator, params).empty());
  for (int frame = 0; frame < 3; ++frame) simulator.step();
  EXPECT_TRUE(simulator.statistics().asleep);
}

// They are there when a node is started again, and nobody is told that they are unknown.
TEST(LiveValues, LeftByAnEarlierRunAreKnown) {
  XmlRpc::XmlRpcValue tree;
  for (const auto& parameter : CurtainConfig::__getParamDescriptions__()) tree[parameter->name] = 20.0;
  tree["air_law"] = std::string("relative");
  tree["mesh_viewer_tolerance"] = 0.5;
  tree["scene"]["cloth"]["rows"] = 6;
  tree["scene"]["cloth"]["columns"] = 5;
  const ParameterReading reading = readParameters(tree, "/curtain");
  EXPECT_TRUE(reading.problems.empty()) << reading.problems.front();
  EXPECT_TRUE(reading.warnings.empty()) << reading.warnings.front();
  EXPECT_EQ(reading.node.mesh_rate, 20.0) << "the node's own hold";
  EXPECT_EQ(reading.scene.gravity.z(), -9.81) << "the scene's are the scene's";
  EXPECT_EQ(reading.scene.solver.frame_rate, 60.0);
}

}  // namespace
}  // namespace curtain_ros
