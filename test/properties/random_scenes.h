// SPDX-License-Identifier: BSD-3-Clause
//
// Scenes made from a seed: any cloth, hung anyhow, in any wind, near any obstacles. The same seed gives the same scene
// everywhere.
#pragma once

#include <cstdint>
#include <vector>

#include "curtain_sim/scene.h"
#include "testing.h"

namespace curtain_test {

/// What a scene shall have.
struct Wanted {
  bool taut = false;    ///< weft links near their length from the start, few pins: strings pull. Else gathered
  bool gentle = false;  ///< winds and drags so weak that no string of gathered cloth ever pulls
  bool damped = false;
  bool wind = false;
  bool drags = false;
  bool obstacles = false;  ///< one of each analytic shape in the way, some of them moving
  bool mesh = false;       ///< and a mesh
  bool self = false;       ///< gathered, blown together: contact of the cloth with itself
  bool fabric = false;     ///< bends, resists shear and twist, rubs within itself
  int max_nodes = 9;       ///< along either side
};

class RandomScenes {
 public:
  explicit RandomScenes(std::uint64_t seed) : random_(seed) {}

  curtain::Scene make(const Wanted& wanted);

  double between(double low, double high) { return random_.between(low, high); }
  int integer(int low, int high) { return random_.integer(low, high); }
  bool chance(double share) { return random_.chance(share); }
  Random& random() { return random_; }

 private:
  std::vector<double> factors(int count, double least, double most);
  void makeCloth(const Wanted& wanted, curtain::Scene& scene);
  void hang(const Wanted& wanted, curtain::Scene& scene);
  void addWinds(const Wanted& wanted, const curtain::Vec3& middle, curtain::Scene& scene);
  void addDrags(bool gentle, curtain::Scene& scene);
  void addObstacles(const curtain::Vec3& middle, curtain::Scene& scene);
  void addMesh(curtain::Scene& scene);
  void place(const curtain::Vec3& middle, double reach, const curtain::Scene& scene, curtain::ObstacleParams& obstacle);

  Random random_;
};

curtain::Scene randomScene(std::uint64_t seed, const Wanted& wanted);

}  // namespace curtain_test
