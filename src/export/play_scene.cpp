// SPDX-License-Identifier: BSD-3-Clause
#include "export/play_scene.h"

#include <stdexcept>

#include "curtain_sim/simulator.h"

namespace curtain {
namespace {

std::array<float, 3> toFloats(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

DrawnMesh drawnMeshOf(const Simulator& simulator) {
  std::vector<double> warp, weft;
  simulator.copyRestLengths(warp, weft);
  return makeDrawnMesh(wholeCloth(simulator.scene()), warp, weft);
}

/// A simulator's pictures, one after the other.
class Player {
 public:
  Player(const Simulator& simulator, AnimationWriter& writer)
      : simulator_(simulator), writer_(writer), drawn_(drawnMeshOf(simulator)) {
    writer.setCloth(drawn_.topology.triangles, drawn_.coordinates);
    for (int i = 0; i < simulator.obstacleCount(); ++i) {
      const ObstacleParams& obstacle = simulator.scene().obstacles[static_cast<std::size_t>(i)];
      if (!obstacle.visible) continue;
      bodies_.push_back({i, writer.addBody({obstacle.name, obstacle.color, simulator.obstacleShape(i).triangles()})});
    }
  }

  void show(double time, int ticks) {
    simulator_.copyFineMesh(mesh_);
    fineMeshNormals(simulator_.fineMeshTopology(), mesh_, normals_);
    vertices_.clear();
    for (const std::uint32_t node : drawn_.nodes)
      vertices_.push_back({toFloats(mesh_.positions[node]), toFloats(normals_[node])});
    writer_.addFrame(time, vertices_, ticks);
    for (const Body& body : bodies_)
      writer_.addPose(body.number, time, simulator_.obstaclePose(body.obstacle),
                      simulator_.obstaclePresent(body.obstacle));
  }

 private:
  struct Body {
    int obstacle;
    std::size_t number;  // the writer's
  };

  const Simulator& simulator_;
  AnimationWriter& writer_;
  DrawnMesh drawn_;
  std::vector<Body> bodies_;
  FineMesh mesh_;
  std::vector<Vec3> normals_;
  std::vector<AnimatedVertex> vertices_;
};

}  // namespace

bool playScene(const Scene& scene, const Excerpt& excerpt, AnimationWriter& writer) {
  Simulator simulator(scene);
  Player player(simulator, writer);
  Ticks ticks(excerpt.rate);
  const double rounding = 1e-6 / scene.solver.frame_rate;
  const double end = excerpt.end.value_or(0.0) + rounding;
  std::optional<double> begin;
  while (simulator.statistics().finite && simulator.time() <= end) {
    if (simulator.time() >= excerpt.start - rounding) {
      if (!begin) begin = simulator.time();
      const double time = simulator.time() - *begin;
      if (const int due = ticks.advance(time); due > 0) player.show(time, due);
    }
    simulator.step();
  }
  if (!simulator.statistics().finite) return false;
  if (!begin) throw std::invalid_argument("there is no frame in the part asked for, from --start to --end");
  return true;
}

}  // namespace curtain
