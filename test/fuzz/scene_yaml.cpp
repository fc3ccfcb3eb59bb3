// SPDX-License-Identifier: BSD-3-Clause
#include "curtain_sim/scene_yaml.h"

#include "fuzz/checks.h"
#include "fuzz/scene_bits.h"

namespace curtain_test {

void checkSceneText(const std::string& bytes) {
  const curtain::SceneReading reading = curtain::readSceneText(bytes);
  if (!reading.problems.empty()) {
    require(!curtain::describe(reading.problems).empty(), "refused without a word");
    return;
  }
  const std::vector<curtain::Problem> problems = curtain::validate(reading.scene);
  require(problems.empty(), "read without a problem, but not valid: " + curtain::describe(problems));
  const std::string text = curtain::writeScene(reading.scene);
  const curtain::SceneReading back = curtain::readSceneText(text);
  require(back.problems.empty(), "can't read what it wrote: " + curtain::describe(back.problems) + "\n" + text);
  require(SceneBits::of(back.scene) == SceneBits::of(reading.scene), "reads back as another scene:\n" + text);
  require(curtain::writeScene(back.scene) == text, "is written in another way the second time:\n" + text);
}

}  // namespace curtain_test
