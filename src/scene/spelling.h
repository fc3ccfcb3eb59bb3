// SPDX-License-Identifier: BSD-3-Clause
//
// Guesses which known word a mistyped one was meant to be.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace curtain {

/// Least number of letters to insert, delete, replace or swap with a neighbour (Damerau-Levenshtein distance).
std::size_t editDistance(const std::string& a, const std::string& b);

/// The known word nearest to this one, if at most a third of the letters differ.
std::optional<std::string> nearestWord(const std::string& word, const std::vector<std::string>& known);

/// "a, b, c"
std::string listWords(const std::vector<std::string>& words);

}  // namespace curtain
