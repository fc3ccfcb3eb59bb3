// SPDX-License-Identifier: BSD-3-Clause
//
// The seeds that a property is tried with: a few by default, more by the environment.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace curtain_test {

inline std::uint64_t numberFromEnvironment(const char* name, std::uint64_t otherwise) {
  const char* const text = std::getenv(name);
  return text != nullptr ? std::stoull(text) : otherwise;
}

/// `few` seeds from 1 on, and those that once told of something. CURTAIN_PROPERTY_SEEDS: so many instead;
/// CURTAIN_PROPERTY_FIRST_SEED: from this one on.
inline std::vector<std::uint64_t> seeds(std::uint64_t few, const std::vector<std::uint64_t>& telling = {}) {
  const std::uint64_t first = numberFromEnvironment("CURTAIN_PROPERTY_FIRST_SEED", 0);
  const std::uint64_t wanted = numberFromEnvironment("CURTAIN_PROPERTY_SEEDS", 0);
  std::vector<std::uint64_t> all(wanted > 0 ? wanted : few);
  for (std::size_t n = 0; n < all.size(); ++n) all[n] = std::max<std::uint64_t>(first, 1) + n;
  if (first == 0 && wanted == 0) all.insert(all.end(), telling.begin(), telling.end());
  return all;
}

/// What a failure says, so that it can be had again.
inline std::string repeat(std::uint64_t seed) {
  const std::string number = std::to_string(seed);
  return "seed " + number + ", repeat with CURTAIN_PROPERTY_FIRST_SEED=" + number + " CURTAIN_PROPERTY_SEEDS=1";
}

}  // namespace curtain_test
