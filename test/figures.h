// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace curtain_test {

/// Keeps a figure of this test, for pages to quote, in the test's report, from where docs/record_figures.py takes it.
/// Of a name that is kept more than once the least and the largest value count.
inline void keepFigure(const std::string& name, double value) {
  static int count = 0;  // of a property that is recorded twice a report has the last value alone
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  testing::Test::RecordProperty("figure " + std::to_string(++count) + " " + name, text);
}

}  // namespace curtain_test
