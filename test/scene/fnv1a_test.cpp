// SPDX-License-Identifier: BSD-3-Clause
//
// Hashes that its authors publish (draft-eastlake-fnv, appendix C).
#include "scene/fnv1a.h"

#include <gtest/gtest.h>

#include <string>

namespace curtain {
namespace {

std::uint64_t hashOf(const std::string& text) {
  Fnv1a bits;
  bits.addBytes(text.data(), text.size());
  return bits.hash;
}

TEST(Fnv1a, HasThePublishedValues) {
  EXPECT_EQ(hashOf(""), 0xcbf29ce484222325ULL);
  EXPECT_EQ(hashOf("a"), 0xaf63dc4c8601ec8cULL);
  EXPECT_EQ(hashOf("foobar"), 0x85944171f73967e8ULL);
}

}  // namespace
}  // namespace curtain
