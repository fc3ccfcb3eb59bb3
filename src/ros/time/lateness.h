// SPDX-License-Identifier: BSD-3-Clause
//
// Why frames were dropped. What was due is split in three: the time that went into frames, the rest of the time that
// passed, and what the clock went on by beyond that.
#pragma once

#include <sstream>
#include <string>

namespace curtain_ros {

/// Of the time between two looks at the clock, the second of which found more frames due than can be made up.
struct Lateness {
  double due = 0.0;     ///< by the clock of the frames [s]
  double passed = 0.0;  ///< by the computer's monotonic clock [s]
  double spent = 0.0;   ///< computing time of the frames that were made in it, their messages included [s]
  int frames = 0;       ///< that were made in it
};

/// The cause in words.
///   frame_length  [s]
inline std::string causeOf(const Lateness& lateness, double frame_length) {
  std::ostringstream words;
  words.precision(4);
  const double pace = lateness.due > lateness.passed ? lateness.passed / lateness.due : 1.0;
  const double taken = lateness.frames > 0 ? lateness.spent / lateness.frames : 0.0;
  if (lateness.due - lateness.passed > lateness.passed) {
    words << "/clock went on by " << lateness.due << " s within " << lateness.passed << " s";
  } else if (taken > pace * frame_length) {
    words << "a frame takes " << 1e3 * taken << " ms of the " << 1e3 * pace * frame_length << " ms it has";
  } else {
    words << "the computer was busy with other things, " << lateness.passed - lateness.spent << " s of "
          << lateness.passed << " s";
  }
  return words.str();
}

}  // namespace curtain_ros
