// SPDX-License-Identifier: BSD-3-Clause
//
// What must hold whatever bytes come in. Each check is a libFuzzer target (fuzzer.cpp) and, over the corpus, a test of
// every build (corpus_test.cpp). A check that fails throws Violation; crashes, hangs and sanitizers speak for
// themselves.
#pragma once

#include <stdexcept>
#include <string>

namespace curtain_test {

struct Violation : std::logic_error {
  using std::logic_error::logic_error;
};

inline void require(bool holds, const std::string& what) {
  if (!holds) throw Violation(what);
}

/// Any bytes as a scene's text: they are refused, or the scene is valid and the writer's text of it reads back the
/// same.
void checkSceneText(const std::string& bytes);

/// Any bytes as an STL, OBJ and DAE file: they are refused, or make an obstacle whose answers are finite.
void checkMesh(const std::string& bytes);

/// Any bytes as the choices that a scene is made from: it is stepped, and the cloth stays finite and as long as it is.
void checkStep(const std::string& bytes);

/// The same by every method, whatever the scene's own is.
void checkSteps(const std::string& bytes);

/// Any bytes as the choices of what is changed in a snapshot whose checksum is right all the same: it is refused and
/// nothing has changed, or it is gone on from without harm; and a sound one brings everything back.
void checkSnapshot(const std::string& bytes);

}  // namespace curtain_test
