// SPDX-License-Identifier: BSD-3-Clause
//
// What the benchmark asks of a method, ours or a rival's: start from the same grid, make frames, show the nodes. Free
// of Eigen, so that rivals may be built for the instruction set of this machine without a change of anyone's memory
// layout.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace curtain_bench {

/// Coordinates of all nodes, row-major, each of length rows * columns.
struct Points {
  std::vector<double> x, y, z;

  void resize(std::size_t count) {
    x.resize(count);
    y.resize(count);
    z.resize(count);
  }
};

/// What the cloth touches.
struct Solid {
  enum class Shape {
    kNone,
    kBall,
    kBar,   ///< round, along y
    kFloor  ///< all below its height
  };
  using Place = std::array<double, 3>;

  Shape shape = Shape::kNone;
  double radius = 0.0;  ///< of a ball or bar [m]
  double margin = 0.0;  ///< kept from it [m]
  double friction = 0.0;
  std::function<Place(double)> at;  ///< of its middle, or of the floor's top, at a time [s] [m]

  /// How far a point is from its surface, less than 0 inside [m]; normal: unit, away from it.
  double distance(const Place& middle, const Place& point, Place& normal) const {
    const double along = shape == Shape::kBar ? 0.0 : point[1] - middle[1];
    if (shape == Shape::kFloor) {
      normal = {0.0, 0.0, 1.0};
      return point[2] - middle[2];
    }
    const double x = point[0] - middle[0], z = point[2] - middle[2];
    const double length = std::sqrt(x * x + along * along + z * z);
    if (length > 0.0) normal = {x / length, along / length, z / length};
    return length - radius;
  }
};

/// The scene as every method gets it: taken from the simulator's public interface, so that it is the very same scene.
struct ClothStart {
  int rows = 0;
  int columns = 0;
  Points positions;                 ///< [m], at rest
  std::vector<double> mass;         ///< [kg], row-major
  std::vector<char> pinned;         ///< row-major
  double warp_rest = 0.0;           ///< [m] of every rod along a column: held both ways
  double weft_rest = 0.0;           ///< [m] of every link along a row: held against stretch only
  std::array<double, 3> gravity{};  ///< [m/s^2]
  double damping = 0.0;  ///< [1/s] velocities go with e^(-damping t); 0 but where a study wants the state of rest
  double frame_seconds = 1.0 / 60.0;
  Solid solid;  ///< position-based methods and btSoftBody alone know it

  std::size_t count() const { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns); }
};

/// A method at one setting on one scene.
class Contestant {
 public:
  virtual ~Contestant() = default;

  /// One frame of ClothStart::frame_seconds. The only call whose time is taken.
  virtual void frame() = 0;

  virtual void copyPositions(Points& out) const = 0;   ///< [m], row-major; out is resized
  virtual void copyVelocities(Points& out) const = 0;  ///< [m/s]

  /// Energy stored in springs [J]; rods have none.
  virtual double elasticEnergy() const { return 0.0; }

  /// Substeps made in the last frame.
  virtual int substeps() const = 0;
};

}  // namespace curtain_bench
