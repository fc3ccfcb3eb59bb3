// SPDX-License-Identifier: BSD-3-Clause
//
// Writes libFuzzer's dictionary for scenes on stdout: every key and every word of the key table, and YAML's own signs.
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include "scene/fields.h"

namespace {

using curtain::Key;
using curtain::Range;

// The visitor of fields.h that notes down every word it knows: keys, choices, words that stand for a number.
class WordCollector {
 public:
  std::set<std::string> words;

  void integer(Key key, const int&, curtain::IntRange) { note(key); }
  void integerOr(Key key, const int&, curtain::IntRange, const char* word, int) {
    note(key);
    words.insert(word);
  }
  void seed(Key key, const std::uint64_t&) { note(key); }
  void number(Key key, const double&, Range) { note(key); }
  void optionalNumber(Key key, const std::optional<double>&, Range) { note(key); }
  void numberOrUnset(Key key, const double&, Range) { note(key); }
  void flag(Key key, const bool&) { note(key); }
  void text(Key key, const std::string&) { note(key); }
  void optionalText(Key key, const std::optional<std::string>&) { note(key); }
  void vector(Key key, const curtain::Vec3&, Range) { note(key); }
  void optionalVector(Key key, const std::optional<curtain::Vec3>&, Range) { note(key); }
  void scale(Key key, const curtain::Vec3&, Range) { note(key); }
  void rotation(Key key, const curtain::Rotation&) { note(key); }
  void node(Key key, const std::optional<curtain::NodeIndex>&) { note(key); }
  void nodes(Key key, const std::vector<curtain::NodeIndex>&) { note(key); }
  void numbers(Key key, const std::vector<double>&, Range) { note(key); }
  void integers(Key key, const std::vector<int>&, curtain::IntRange) { note(key); }
  void path(Key key, const std::vector<curtain::RailPiece>&, Range) {
    note(key);
    words.insert({"to: ", "centre: "});
  }
  void pins(Key key, const curtain::PinParams&) {
    note(key);
    words.insert(curtain::pinNames().begin(), curtain::pinNames().end());
  }
  void slits(Key key, const std::vector<curtain::SlitParams>&) {
    note(key);
    words.insert({"column", "from_row"});
  }
  bool belongs(Key, bool, const curtain::Chosen&) { return true; }

  template <typename Enum>
  void choice(Key key, const Enum&, const std::vector<std::string>& names) {
    note(key);
    words.insert(names.begin(), names.end());
  }

  template <typename T>
  void map(Key key, const T& value) {
    note(key);
    curtain::visitFields(*this, value);
  }

  template <typename T>
  void list(Key key, const std::vector<T>&, const T& = {}) {
    note(key);
    const T item;
    curtain::visitFields(*this, item);
  }

 private:
  void note(Key key) { words.insert(std::string(key.name) + ": "); }
};

void write(const std::string& word) {
  std::cout << '"';
  for (const char c : word) {
    if (c == '"' || c == '\\') std::cout << '\\';
    if (c == '\n') {
      std::cout << "\\x0a";
    } else {
      std::cout << c;
    }
  }
  std::cout << "\"\n";
}

}  // namespace

int main() {
  WordCollector collector;
  const curtain::Scene scene;
  curtain::visitFields(collector, scene);
  for (const char* sign :
       {"true",  ".inf", "-.inf", ".nan",       "1.0e-300",    "1.0e+308", "4294967296", "0x1F", "010",
        "3e-06", "&a ",  "*a",    "<<: ",       "!!float ",    "!!int ",   "!!str ",     "! ",   "---\n",
        "...\n", "- ",   "[",     "]",          "{",           "}",        ", ",         "? ",   "|\n ",
        ">-\n ", "# ",   "\"\\x", "\"\\U0001F", "%YAML 1.2\n", "~",        "\n  "}) {
    collector.words.insert(sign);
  }
  for (const std::string& word : collector.words) write(word);
}
