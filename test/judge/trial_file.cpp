// SPDX-License-Identifier: BSD-3-Clause
#include <yaml-cpp/yaml.h>

#include <stdexcept>
#include <vector>

#include "curtain_sim/scene_yaml.h"
#include "judge/draw.h"

namespace curtain_test {

using namespace curtain;

namespace {

void put(YAML::Emitter& out, const char* key, const Vec3& v) {
  out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq << v.x() << v.y() << v.z() << YAML::EndSeq;
}

void putHand(YAML::Emitter& out, const Hand& hand) {
  out << YAML::Flow << YAML::BeginSeq << hand.node.row << hand.node.column;
  for (const double value : {hand.radius, hand.from, hand.until, hand.swing.x(), hand.swing.y(), hand.swing.z(),
                             hand.turn, hand.frequency, hand.stiffness, hand.pinch_force, hand.break_force})
    out << value;
  out << YAML::EndSeq;
}

Hand readHand(const YAML::Node& node) {
  std::vector<double> v;
  for (std::size_t k = 2; k < 13; ++k) v.push_back(node[k].as<double>());
  return {{node[0].as<int>(), node[1].as<int>()}, v[0], v[1], v[2], {v[3], v[4], v[5]}, v[6], v[7], v[8], v[9], v[10]};
}

}  // namespace

std::string write(const Drawn& drawn) {
  const Happenings& happenings = drawn.happenings;
  YAML::Emitter out;
  out.SetDoublePrecision(17);
  out << YAML::BeginMap;
  out << YAML::Key << "kind" << YAML::Value << kindName(drawn.kind);
  out << YAML::Key << "seed" << YAML::Value << drawn.seed;
  out << YAML::Key << "seconds" << YAML::Value << drawn.seconds;
  put(out, "pin_swing", happenings.pin_swing);
  out << YAML::Key << "pin_frequency" << YAML::Value << happenings.pin_frequency;
  put(out, "pin_jerk", happenings.pin_jerk);
  put(out, "gravity", happenings.gravity);
  out << YAML::Key << "other_rate" << YAML::Value << happenings.other_rate;
  out << YAML::Key << "opening" << YAML::Value << happenings.opening;
  out << YAML::Key << "tie_back" << YAML::Value << happenings.tie_back;
  out << YAML::Key << "hands" << YAML::Value << YAML::BeginSeq;
  for (const Hand& hand : happenings.hands) putHand(out, hand);
  out << YAML::EndSeq;
  out << YAML::Key << "at" << YAML::Value << happenings.at;
  out << YAML::Key << "scene" << YAML::Value << YAML::Literal << writeScene(drawn.scene);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

Drawn readTrial(const std::string& text) {
  const YAML::Node node = YAML::Load(text);
  const auto vector = [&](const char* key) {
    const auto values = node[key].as<std::vector<double>>();
    return Vec3(values.at(0), values.at(1), values.at(2));
  };
  Drawn drawn;
  const auto kind = node["kind"].as<std::string>();
  for (const Kind one : {Kind::kEveryday, Kind::kWild, Kind::kSudden}) {
    if (kind == kindName(one)) drawn.kind = one;
  }
  drawn.seed = node["seed"].as<std::uint64_t>();
  drawn.seconds = node["seconds"].as<double>();
  drawn.happenings.pin_swing = vector("pin_swing");
  drawn.happenings.pin_frequency = node["pin_frequency"].as<double>();
  drawn.happenings.pin_jerk = vector("pin_jerk");
  drawn.happenings.gravity = vector("gravity");
  drawn.happenings.other_rate = node["other_rate"].as<double>();
  drawn.happenings.opening = node["opening"].as<double>(-1.0);  // trials of before have none
  drawn.happenings.tie_back = node["tie_back"].as<int>(-1);
  for (const YAML::Node& hand : node["hands"]) drawn.happenings.hands.push_back(readHand(hand));
  drawn.happenings.at = node["at"].as<double>();
  const SceneReading reading = readSceneText(node["scene"].as<std::string>());
  if (!reading.problems.empty()) throw std::runtime_error(describe(reading.problems));
  drawn.scene = reading.scene;
  return drawn;
}

}  // namespace curtain_test
