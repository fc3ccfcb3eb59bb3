// SPDX-License-Identifier: BSD-3-Clause
//
// What a scene's values are by habit: how often a key is given at all, and within what. Keys that are not in the table
// take part all the same, seldom.
#pragma once

#include <string>

namespace curtain_test {

struct Bounds {
  double low = 0.0, high = 0.0;  ///< both 0: any of the key's range, near its default
};

struct Habit {
  const char* key = "";             ///< dotted, lists without their index; of a layer as of the first cloth
  double chance = 0.1;              ///< that it is given; of a map or list: that anything in it is
  Bounds everyday = {}, wild = {};  ///< sizes, of vectors of every component or of their length; of a list: items
};

const Habit& habitOf(const std::string& key);

}  // namespace curtain_test
