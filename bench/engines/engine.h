// SPDX-License-Identifier: BSD-3-Clause
//
// The other engines, each made by one function from the start of a scene and its settings; one that is not built has no
// function. Free of Eigen and of the engines' headers: they are built for the instruction set of this machine.
#pragma once

#include <memory>

#include "bench/contestant.h"

namespace curtain_bench {

/// An engine whose air is computed outside of it.
class Engine : public Contestant {
 public:
  /// Of every node in the next frame, beside gravity and ClothStart::damping [m/s^2].
  virtual void accelerate(const Points& accelerations) = 0;
};

struct NvClothSettings {
  int frequency = 60;          ///< of the solver and of its stiffness [Hz]
  bool tethers = false;        ///< from each node to the top of its column
  bool continuous = false;     ///< continuous collision with the ball
  bool one_sided = false;      ///< wefts may be short
  double self_distance = 0.0;  ///< that particles keep from each other [m], but neighbours at rest; 0: they do not
  bool even_odd = false;       ///< even warps, then odd ones; else row by row from the top down
};
std::unique_ptr<Engine> makeNvCloth(const ClothStart& start, const NvClothSettings& settings);

struct JoltSettings {
  bool long_range = false;  ///< attachments of each node to the top of its column
  int steps = 1;            ///< a frame
  int iterations = 5;       ///< a step
};
std::unique_ptr<Engine> makeJolt(const ClothStart& start, const JoltSettings& settings);

struct BulletWorldSettings {
  int substeps = 1;
  int iterations = 4;     ///< of positions
  bool defaults = false;  ///< of contact: hardness 0.1, cells of 0.25 m in the field of the ball's distance
  int clusters = -1;      ///< that collide with each other; 0: one a triangle, -1: none
};
std::unique_ptr<Engine> makeBulletWorld(const ClothStart& start, const BulletWorldSettings& settings);

}  // namespace curtain_bench
