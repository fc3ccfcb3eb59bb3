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
  drawn.happenings.at = node["at"].as<double>();
  const SceneReading reading = readSceneText(node["scene"].as<std::string>());
  if (!reading.problems.empty()) throw std::runtime_error(describe(reading.problems));
  drawn.scene = reading.scene;
  return drawn;
}

}  // namespace curtain_test
