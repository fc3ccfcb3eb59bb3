// SPDX-License-Identifier: BSD-3-Clause
//
// Guesses which known word a mistyped one was meant to be.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace curtain {

/// Least number of letters to insert, delete, replace or swap with their neighbour to get from one to the other.
std::size_t editDistance(const std::string& a, const std::string& b);

/// The known word nearest to the given one, when it is near enough to be meant (a third of the letters at most).
std::optional<std::string> nearestWord(const std::string& word, const std::vector<std::string>& known);

/// "a, b, c"
std::string listWords(const std::vector<std::string>& words);

}  // namespace curtain
