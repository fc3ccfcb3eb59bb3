// SPDX-License-Identifier: BSD-3-Clause
//
// The first key that two scenes differ in.
#include "scene/scene_difference.h"

#include <gtest/gtest.h>

namespace curtain {
namespace {

void expectDifference(const std::string& ours, const std::string& theirs, const std::string& key,
                      const std::string& text) {
  const std::optional<Problem> found = firstDifference(ours, theirs, {"aside", "list[].aside"});
  ASSERT_TRUE(found.has_value()) << ours << theirs;
  EXPECT_EQ(found->key, key);
  EXPECT_EQ(found->text, text);
}

void expectSame(const std::string& ours, const std::string& theirs) {
  const std::optional<Problem> found = firstDifference(ours, theirs, {"aside", "list[].aside"});
  EXPECT_FALSE(found.has_value()) << found->key << ": " << found->text;
}

TEST(SceneDifference, IsTheFirstInOrder) {
  expectDifference("a: 1\nb: {c: 2, d: 3}\n", "a: 1\nb: {d: 4, c: 5}\n", "b.c", "is 5 there, 2 here");
  expectDifference("list: [{x: 1}, {x: 2}]\n", "list: [{x: 1}, {x: 3}]\n", "list[1].x", "is 3 there, 2 here");
  expectDifference("list: [1]\n", "list: [1, 2]\n", "list", "is a list of 2 there, a list of 1 here");
  expectDifference("a: {b: 1}\n", "a: 7\n", "a", "is 7 there, a map here");
  expectDifference("a: 1\n", "a: 1.0\n", "a", "is 1.0 there, 1 here");
}

TEST(SceneDifference, IsAKeyThatIsMissingOrTooMany) {
  expectDifference("a: 1\nb: 2\n", "a: 1\n", "b", "is not given there, 2 here");
  expectDifference("a: {b: 1}\n", "a: {b: 1, c: 2}\n", "a.c", "is 2 there, not given here");
}

TEST(SceneDifference, IsNoneWhereItMayDiffer) {
  expectSame("a: 1\naside: 2\n", "aside: {any: thing}\na: 1\n");
  expectSame("list: [{x: 1, aside: 2}]\n", "list: [{x: 1, aside: 3}]\n");
  expectDifference("list: [{x: {aside: 2}}]\n", "list: [{x: {aside: 3}}]\n", "list[0].x.aside", "is 3 there, 2 here");
}

// Who writes it may write anything.
TEST(SceneDifference, IsToldOfAnyText) {
  for (const std::string& theirs :
       {std::string(), std::string(100000, '['), std::string("a: ["), std::string("a: &a [*a]"),
        std::string("\0\1\2", 3), std::string("? [1]\n: 2\n"), std::string("a: ") + std::string(1000000, 'x')}) {
    const std::optional<Problem> found = firstDifference("a: 1\nb: 2\n", theirs, {});
    ASSERT_TRUE(found.has_value());
    EXPECT_LT(found->text.size(), 300U);
  }
}

}  // namespace
}  // namespace curtain
