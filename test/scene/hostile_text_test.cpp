// SPDX-License-Identifier: BSD-3-Clause
//
// Texts that are made to hang the reader or to fill the memory are refused at once, with one message that is no longer
// than a message should be.
#include "count_allocations.h"
#include "scene/scene_testing.h"

namespace curtain {
namespace {

// What the reader does is counted in allocations: a known key of ten characters takes about 50 of them, in yaml-cpp and
// in the log of problems. Without the limit that these texts are for it would be millions a character, or no end.
constexpr long kMaxAllocations = 20;      // a character …
constexpr long kFewAllocations = 1000;    // … and at least
constexpr std::size_t kMessage = 100000;  // [characters]: 200 problems of 500

std::string refuse(const std::string& text) {
  const long before = allocations;
  const std::vector<Problem> problems = readSceneText(text).problems;
  EXPECT_LT(allocations - before, kFewAllocations + kMaxAllocations * static_cast<long>(text.size()));
  EXPECT_FALSE(problems.empty());
  const std::string message = describe(problems);
  EXPECT_LT(message.size(), kMessage) << message.substr(0, 300);
  return message;
}

void expectRefused(const std::string& text, const std::string& fragment) {
  const std::string message = refuse(text);
  EXPECT_NE(message.find(fragment), std::string::npos) << message.substr(0, 1000);
}

std::string repeated(const std::string& part, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += part;
  return text;
}

// yaml-cpp 0.7 gives empty documents without end for a sign that nothing begins with.
TEST(HostileText, ADocumentThatNeverEndsIsRefused) {
  expectRefused("cloth: {rows: 4, columns: 3}\n...\n}", "not YAML");
  expectRefused("a\nb: {c}, d", "not YAML");
  expectRefused("cloth: {rows: 2}}\n", "not YAML");
}

TEST(HostileText, AliasesOfAliasesAreRefused) {
  std::string text = "x0: &x0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string before = "*x" + std::to_string(i - 1) + ", ";
    text += "x" + std::to_string(i) + ": &x" + std::to_string(i) + " [" + repeated(before, 9) + "1]\n";
  }
  expectRefused(text + smallScene(), "more than 1000000 values");
}

// A list of aliases of a list of aliases of a map: each would be copied into the scene.
TEST(HostileText, ListsOfTheSameListsAreRefused) {
  const std::string motion = "{name: ball, radius: 1, motion: [&m {time: 0.0}" + repeated(", *m", 3000) + "]}";
  expectRefused(std::string(smallScene()) + "obstacles: [&o " + motion + repeated(", *o", 3000) + "]\n",
                "more than 1000000 values");
}

TEST(HostileText, AnAliasWithinWhatItNamesIsRefused) {
  expectRefused(std::string(smallScene()) + "pins: &a [*a]\n", "an alias within what it stands for");
}

TEST(HostileText, ABarrelOfKeysGivesOneShortMessage) {
  std::string text = smallScene();
  for (int i = 0; i < 150000; ++i) text += "k" + std::to_string(i) + ": 1\n";
  expectRefused(text, "more problems than these 200");
  expectRefused(smallScene() + repeated("again: 1\n", 100000), "given more than once");
}

TEST(HostileText, LongWordsAreCutInMessages) {
  const int long_enough = 1000000;
  expectRefused(std::string(smallScene()) + "? " + repeated(".", long_enough) + "\n: 1\n", "is not a known key");
  expectRefused("cloth: {rows: " + repeated("9", long_enough) + ", columns: 3}\n", "cloth.rows");
  expectRefused("cloth: {rows: " + repeated("x", long_enough) + ", columns: 3}\n", "cloth.rows");
  expectRefused("cloth: {rows: 4, columns: 3, height: " + repeated("9", long_enough) + "e9}\n", "cloth.height");
}

// A message is for terminals and topics: it never ends within a character.
TEST(HostileText, WordsAreCutBetweenCharacters) {
  for (const std::string shift : {"", "x", "xx"}) {
    const std::string message = refuse("cloth: {rows: " + shift + repeated("\xE2\x82\xAC", 100) + ", columns: 3}\n");
    const std::size_t end = message.find("...");
    ASSERT_NE(end, std::string::npos) << message;
    EXPECT_EQ(message.substr(end - 3, 3), "\xE2\x82\xAC");
  }
}

TEST(HostileText, DeepTextIsRefused) {
  for (const char* open : {"[", "{", "- ", "? ", "{a: ", "[a, "}) {
    refuse(repeated(open, 100000));
    refuse(smallScene() + std::string("pins: ") + repeated(open, 100000));
  }
}

TEST(HostileText, TooLongTextIsRefused) {
  expectRefused(smallScene() + repeated("# nothing\n", 2000000), "longer than 16 MiB");
  const std::vector<Problem> problems = readSceneFile("/dev/zero").problems;
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].text.find("longer than 16 MiB"), std::string::npos) << problems[0].text;
}

TEST(HostileText, TextThatIsOnlyLargeIsRead) {
  std::string text = "cloth: {rows: 4096, columns: 4096, row_mass: [";
  for (int i = 0; i < 4096; ++i) text += "1.5, ";
  text += "]}\nobstacles: [{name: ball, shape: sphere, radius: 0.1, motion: [";
  for (int i = 0; i < 20000; ++i) text += "{time: " + std::to_string(i) + ".0, position: [0.0, 0.0, 1.0]},\n";
  const Scene scene = expectScene(text + "]}]\n");
  EXPECT_EQ(scene.obstacles.at(0).motion.size(), 20000u);
}

}  // namespace
}  // namespace curtain
