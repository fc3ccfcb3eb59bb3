// SPDX-License-Identifier: BSD-3-Clause
//
// What a scene has but does nothing in it costs next to nothing: instructions of the cheapest motion there is, with the
// feature in vain over those without it, the motion being the same to the bit. Counted by callgrind, so that neither
// the machine's load nor its clock matters.
#include <gtest/gtest.h>

#include <map>

#include "bench/cost/weigh.h"
#include "curtain_sim/scene_yaml.h"

namespace curtain_bench {
namespace {

// The scenes without the feature are few: each is weighed once.
const Weight& weightWithout(const Feature& feature) {
  static std::map<std::string, Weight> known;
  const std::string scene = curtain::writeScene(feature.off.scene) + std::to_string(feature.frames);
  auto found = known.find(scene);
  if (found == known.end()) found = known.emplace(scene, weigh(feature, FeatureState::kOff)).first;
  return found->second;
}

class IdleCost : public testing::TestWithParam<std::string> {};

TEST_P(IdleCost, IsNextToNothing) {
  const Feature& feature = featureOf(GetParam());
  Weight off, idle;
  ASSERT_NO_THROW(off = weightWithout(feature));
  ASSERT_NO_THROW(idle = weigh(feature, FeatureState::kIdle));
  EXPECT_EQ(idle.state_hash, off.state_hash) << "the motions differ: what is compared is not the feature alone";
  EXPECT_LE(idle.instructions / off.instructions, feature.max_idle)
      << idle.instructions << " instructions per node and frame, " << off.instructions << " without";
}

std::vector<std::string> idleFeatures() {
  std::vector<std::string> names;
  for (const Feature& feature : features()) {
    if (feature.has(FeatureState::kIdle)) names.push_back(feature.name);
  }
  return names;
}

std::string asIdentifier(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& letter : name) {
    if (!std::isalnum(static_cast<unsigned char>(letter))) letter = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Features, IdleCost, testing::ValuesIn(idleFeatures()), asIdentifier);

}  // namespace
}  // namespace curtain_bench
