// SPDX-License-Identifier: BSD-3-Clause
#include "bench/engines/scenes.h"

#include "bench/contact_scenes.h"
#include "bench/engines/waves.h"
#include "bench/line_up.h"

namespace curtain_bench {
namespace {

using curtain::Scene;

// Of slow cloth, by bench/engines/air.h [1/s].
double dampingOf(const Scene& scene) { return scene.air.density * scene.air.inside / scene.cloth.surface_density; }

EngineScene made(const std::string& name, const Scene& scene, int frames) {
  EngineScene made;
  made.name = name;
  made.scene = scene;
  Scene bare = scene;
  bare.obstacles.clear();
  bare.wind.clear();
  made.flat = clothStart(bare, dampingOf(scene));
  made.flat.solid = solidOf(scene);
  const bool gathered = (scene.hang.to - scene.hang.from).norm() < scene.cloth.width;
  made.waves = gathered ? inWaves(made.flat) : made.flat;
  made.frames = frames;
  made.touches_itself = scene.contact.self;
  return made;
}

Scene gathered(int rows, int columns) { return blown(touchingItself(curtainOf(rows, columns, 0.6, 0.0))); }

}  // namespace

std::vector<EngineScene> engineScenes() {
  constexpr int kFrames = 180;
  return {made("ball and itself 44 x 40", with(gathered(44, 40), swingingBall()), kFrames),
          made("gathered 44 x 40", gathered(44, 40), kFrames), made("gathered 105 x 96", gathered(105, 96), kFrames),
          made("ball 44 x 40", with(dampedBy(curtainOf(44, 40, 1.0, 0.0), 0.5), ballThatComes()), kFrames)};
}

}  // namespace curtain_bench
