// SPDX-License-Identifier: BSD-3-Clause
//
// Membrane   Saint Venant-Kirchhoff in plane stress: E = A / 2 (lambda tr(e)^2 + 2 mu e : e), e = (F^T F - 1) / 2.
// Bending    E = B A / 2 ((1 - nu) L : L + nu tr(L)^2), with a triangle's shape operator from the dihedral angles theta
//            at its edges of length l and normal n in its plane, L = sum of theta l / (2 A) n n^T (Grinspun, Gingold,
//            Reisman, Zorin 2006). Exact for quadratic surfaces on a regular mesh. The rim's edges bear no moment. At
//            an edge of the clamp only the triangle outside bends, so that all of the turn is its own, not half of it.
// Mesh       rings of points as far apart as the rings are, turned at random: no direction is preferred. The two
//            innermost are clamped, the second of them at the disc's edge.
#include "bench/shell/shell.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace curtain_shell {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;

const double kPi = std::acos(-1.0);
constexpr double kDisc = 0.09, kRim = 0.15;  // radii [m]
constexpr double kLongest = 10.0;            // simulated [s]
constexpr double kGravity = 9.81;            // [m/s^2]
constexpr double kDamping = 10.0;            // of velocities [1/s]

struct Triangle {
  std::array<int, 3> corner{};  // counterclockwise
  std::array<int, 3> edge{};    // of each corner, the edge on the other side
  double area = 0.0;
  Mat2 inverse = Mat2::Zero();  // of the flat edges from corner 0
  std::array<Vec2, 3> normal;   // of its edges, in its plane
  Mat2 moment = Mat2::Zero();   // of the last bend
};

struct Edge {
  int from = 0, to = 0;
  std::array<int, 2> triangle{-1, -1};  // on its left, on its right
  std::array<int, 2> corner{-1, -1};    // the corner of each that is not on it
  double length = 0.0;
  double angle = 0.0;
};

class Shell {
 public:
  Shell(const Fabric& fabric, int rings, unsigned seed)
      : fabric_(fabric), spacing_((kRim - kDisc) / rings), random_(seed) {
    makePoints(rings);
    connect();
    makeUneven();
  }

  // Simulated time until it is at rest [s]; 0: it is not, within the longest.
  double sink(double longest) {
    // Largest frequencies of a mesh of this spacing, of its membrane and in bending, with room below the limit of 2.
    const double stretch = 2.0 * fabric_.shear / (1.0 - fabric_.poisson);
    const double omega = std::max(4.0 * std::sqrt(stretch / fabric_.density) / spacing_,
                                  16.0 * std::sqrt(fabric_.bending / fabric_.density) / (spacing_ * spacing_));
    const double step = 0.8 / omega;
    const double still = 1e-7 * total_mass_ * kGravity * (kRim - kDisc);
    const int between = static_cast<int>(1.0 / 60.0 / step) + 1;
    for (double time = 0.0; time < longest; time += between * step) {
      for (int k = 0; k < between; ++k) push(step);
      if (kinetic() < still) return time;
      if (!std::isfinite(kinetic())) break;
    }
    return 0.0;
  }

  // Shadow of sample and disc, less the disc, over the flat ring.
  double coefficient() const {
    constexpr double kSquare = 0.5e-3, kHalf = 0.16;
    constexpr int kSide = 640;
    std::vector<char> dark(static_cast<std::size_t>(kSide) * kSide, 0);
    const auto index = [](double place) {
      return std::clamp(static_cast<int>((place + kHalf) / kSquare), 0, kSide - 1);
    };
    const auto middle = [](int at) { return (at + 0.5) * kSquare - kHalf; };
    const auto cross = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
    for (const Triangle& t : triangles_) {
      std::array<Vec2, 3> p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = place_[at(t.corner[k])].head<2>();
      const double twice = cross(p[1] - p[0], p[2] - p[0]);
      if (twice == 0.0) continue;
      const auto [low_x, high_x] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
      const auto [low_y, high_y] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
      for (int row = index(low_y); row <= index(high_y); ++row) {
        for (int column = index(low_x); column <= index(high_x); ++column) {
          const Vec2 q(middle(column), middle(row));
          const double u = cross(p[1] - p[0], q - p[0]) / twice, v = cross(p[2] - p[1], q - p[1]) / twice;
          if (u >= -1e-9 && v >= -1e-9 && u + v <= 1.0 + 1e-9) dark[static_cast<std::size_t>(row * kSide + column)] = 1;
        }
      }
    }
    double area = 0.0;
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        if (dark[static_cast<std::size_t>(row * kSide + column)] != 0 ||
            std::hypot(middle(row), middle(column)) < kDisc)
          area += kSquare * kSquare;
      }
    }
    return (area - kPi * kDisc * kDisc) / (kPi * (kRim * kRim - kDisc * kDisc));
  }

  // How often the rim's radius rises through its mean, small waves left out.
  int folds() const {
    std::vector<double> radius;
    for (int n = first_of_rim_; n < static_cast<int>(place_.size()); ++n)
      radius.push_back(place_[at(n)].head<2>().norm());
    double mean = 0.0;
    for (const double r : radius) mean += r / static_cast<double>(radius.size());
    const auto lowest = std::min_element(radius.begin(), radius.end());
    const double band = 0.1 * (*std::max_element(radius.begin(), radius.end()) - *lowest);
    std::rotate(radius.begin(), lowest, radius.end());
    int count = 0;
    bool out = false;
    for (const double r : radius) {
      if (!out && r > mean + band) out = true, ++count;
      if (r < mean - band) out = false;
    }
    return count;
  }

 private:
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }
  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

  void makePoints(int rings) {
    std::vector<std::vector<double>> angles;
    std::vector<int> first;
    for (int ring = -1; ring <= rings; ++ring) {
      const double radius = kDisc + ring * spacing_, turn = uniform();
      const int count = static_cast<int>(std::lround(2.0 * kPi * radius / spacing_));
      first.push_back(static_cast<int>(flat_.size()));
      angles.emplace_back();
      for (int k = 0; k < count; ++k) {
        const double angle = 2.0 * kPi * (k + turn) / count;
        angles.back().push_back(angle);
        flat_.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
        held_.push_back(ring <= 0);
      }
    }
    first_of_rim_ = first.back();
    for (std::size_t ring = 0; ring + 1 < angles.size(); ++ring)
      stitch(angles[ring], first[ring], angles[ring + 1], first[ring + 1]);
    for (const Vec2& point : flat_) place_.emplace_back(point.x(), point.y(), 0.0);
    velocity_.assign(place_.size(), Vec3::Zero());
    force_.assign(place_.size(), Vec3::Zero());
  }

  // Triangles between two rings: of the two next points the one that is nearer in angle comes first.
  void stitch(const std::vector<double>& inner, int inner_first, const std::vector<double>& outer, int outer_first) {
    const std::size_t n = inner.size(), m = outer.size();
    // The outer point nearest to the first inner one begins.
    std::size_t start = 0;
    const auto apart = [](double a, double b) { return std::abs(std::remainder(a - b, 2.0 * kPi)); };
    for (std::size_t k = 0; k < m; ++k) {
      if (apart(outer[k], inner[0]) < apart(outer[start], inner[0])) start = k;
    }
    const double offset = std::remainder(outer[start] - inner[0], 2.0 * kPi);
    const auto inside = [&](std::size_t k) { return inner_first + static_cast<int>(k % n); };
    const auto outside = [&](std::size_t k) { return outer_first + static_cast<int>((start + k) % m); };
    for (std::size_t i = 0, o = 0; i < n || o < m;) {
      const double next_inner = 2.0 * kPi * static_cast<double>(i + 1) / static_cast<double>(n);
      const double next_outer = offset + 2.0 * kPi * static_cast<double>(o + 1) / static_cast<double>(m);
      if (o == m || (i < n && next_inner < next_outer)) {
        addTriangle(inside(i), outside(o), inside(i + 1));
        ++i;
      } else {
        addTriangle(inside(i), outside(o), outside(o + 1));
        ++o;
      }
    }
  }

  void addTriangle(int a, int b, int c) {
    Triangle t;
    t.corner = {a, b, c};
    Mat2 edges;
    edges << flat_[at(b)] - flat_[at(a)], flat_[at(c)] - flat_[at(a)];
    t.area = 0.5 * edges.determinant();
    t.inverse = edges.inverse();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 along = (flat_[at(t.corner[(k + 2) % 3])] - flat_[at(t.corner[(k + 1) % 3])]).normalized();
      t.normal[k] = Vec2(along.y(), -along.x());
    }
    triangles_.push_back(t);
  }

  void connect() {
    std::map<std::pair<int, int>, int> known;
    mass_.assign(flat_.size(), 0.0);
    for (std::size_t index = 0; index < triangles_.size(); ++index) {
      Triangle& t = triangles_[index];
      for (std::size_t k = 0; k < 3; ++k) {
        mass_[at(t.corner[k])] += fabric_.density * t.area / 3.0;
        const int from = t.corner[(k + 1) % 3], to = t.corner[(k + 2) % 3];
        const auto [found, fresh] = known.try_emplace(std::minmax(from, to), static_cast<int>(edges_.size()));
        if (fresh) {
          Edge edge;
          edge.from = from;
          edge.to = to;
          edge.length = (flat_[at(to)] - flat_[at(from)]).norm();
          edges_.push_back(edge);
        }
        const std::size_t side = fresh ? 0 : 1;
        edges_[at(found->second)].triangle[side] = static_cast<int>(index);
        edges_[at(found->second)].corner[side] = t.corner[k];
        t.edge[k] = found->second;
      }
    }
    for (const double mass : mass_) total_mass_ += mass;
  }

  // Long waves, a tenth of a millimetre at the rim.
  void makeUneven() {
    for (int wave = 0; wave < 8; ++wave) {
      const double direction = 2.0 * kPi * uniform(), phase = 2.0 * kPi * uniform(),
                   length = 0.06 * std::pow(5.0, uniform());
      const Vec2 along = 2.0 * kPi / length * Vec2(std::cos(direction), std::sin(direction));
      for (std::size_t n = 0; n < place_.size(); ++n) {
        if (!held_[n])
          place_[n].z() += 1e-4 * (flat_[n].norm() - kDisc) / (kRim - kDisc) * std::sin(along.dot(flat_[n]) + phase);
      }
    }
  }

  void stretch() {
    const double mu = fabric_.shear, lambda = 2.0 * mu * fabric_.poisson / (1.0 - fabric_.poisson);
    for (const Triangle& t : triangles_) {
      Eigen::Matrix<double, 3, 2> edges;
      edges << place_[at(t.corner[1])] - place_[at(t.corner[0])], place_[at(t.corner[2])] - place_[at(t.corner[0])];
      const Eigen::Matrix<double, 3, 2> gradient = edges * t.inverse;
      const Mat2 strain = 0.5 * (gradient.transpose() * gradient - Mat2::Identity());
      const Mat2 stress = lambda * strain.trace() * Mat2::Identity() + 2.0 * mu * strain;
      const Eigen::Matrix<double, 3, 2> pull = t.area * gradient * stress * t.inverse.transpose();
      force_[at(t.corner[1])] -= pull.col(0);
      force_[at(t.corner[2])] -= pull.col(1);
      force_[at(t.corner[0])] += pull.col(0) + pull.col(1);
    }
  }

  // Of an edge's turn, what a triangle beside it bends.
  double shareOf(const Edge& edge, const Triangle& t) const {
    const auto held = [&](int n) { return held_[at(n)] != 0; };
    if (!held(edge.from) || !held(edge.to)) return 0.5;
    return std::all_of(t.corner.begin(), t.corner.end(), held) ? 0.0 : 1.0;
  }

  void bend() {
    for (Edge& edge : edges_) {
      if (edge.triangle[1] < 0) continue;
      const Vec3 along = place_[at(edge.to)] - place_[at(edge.from)];
      const Vec3 left = along.cross(place_[at(edge.corner[0])] - place_[at(edge.from)]);
      const Vec3 right = (place_[at(edge.corner[1])] - place_[at(edge.from)]).cross(along);
      edge.angle = std::atan2(left.cross(right).dot(along) / along.norm(), left.dot(right));
    }
    const double nu = fabric_.bending_poisson;
    for (Triangle& t : triangles_) {
      Mat2 shape = Mat2::Zero();
      std::size_t free = 3;
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge& edge = edges_[at(t.edge[k])];
        if (edge.triangle[1] < 0)
          free = k;
        else
          shape += shareOf(edge, t) * edge.angle * edge.length / t.area * t.normal[k] * t.normal[k].transpose();
      }
      if (free < 3) {  // turned so far that there is no moment about it
        const Vec2& n = t.normal[free];
        shape -= ((1.0 - nu) * n.dot(shape * n) + nu * shape.trace()) * n * n.transpose();
      }
      t.moment = fabric_.bending * ((1.0 - nu) * shape + nu * shape.trace() * Mat2::Identity());
    }
    for (const Edge& edge : edges_) {
      if (edge.triangle[1] < 0) continue;
      double torque = 0.0;  // energy by angle
      for (const int index : edge.triangle) {
        const Triangle& t = triangles_[at(index)];
        for (std::size_t k = 0; k < 3; ++k) {
          if (&edges_[at(t.edge[k])] == &edge)
            torque += shareOf(edge, t) * edge.length * t.normal[k].dot(t.moment * t.normal[k]);
        }
      }
      turn(edge, torque);
    }
  }

  // Forces of a torque about an edge: minus the torque times the gradients of the angle.
  void turn(const Edge& edge, double torque) {
    const Vec3 from = place_[at(edge.from)], along = place_[at(edge.to)] - from;
    const Vec3 to_left = place_[at(edge.corner[0])] - from, to_right = place_[at(edge.corner[1])] - from;
    const Vec3 left = along.cross(to_left), right = to_right.cross(along);
    const double length = along.norm(), square = length * length;
    // Where a corner goes up by z the angle is less by z over the corner's distance from the edge.
    const Vec3 by_left = -length / left.squaredNorm() * left, by_right = -length / right.squaredNorm() * right;
    const double left_share = to_left.dot(along) / square, right_share = to_right.dot(along) / square;
    force_[at(edge.corner[0])] -= torque * by_left;
    force_[at(edge.corner[1])] -= torque * by_right;
    force_[at(edge.to)] += torque * (left_share * by_left + right_share * by_right);
    force_[at(edge.from)] += torque * ((1.0 - left_share) * by_left + (1.0 - right_share) * by_right);
  }

  void push(double step) {
    for (std::size_t n = 0; n < place_.size(); ++n) force_[n] = Vec3(0.0, 0.0, -kGravity * mass_[n]);
    stretch();
    bend();
    const double kept = std::exp(-kDamping * step);
    for (std::size_t n = 0; n < place_.size(); ++n) {
      if (held_[n]) continue;
      velocity_[n] = kept * velocity_[n] + step / mass_[n] * force_[n];
      place_[n] += step * velocity_[n];
    }
  }

  double kinetic() const {
    double sum = 0.0;
    for (std::size_t n = 0; n < place_.size(); ++n) sum += 0.5 * mass_[n] * velocity_[n].squaredNorm();
    return sum;
  }

  Fabric fabric_;
  double spacing_;
  std::mt19937 random_;
  std::vector<Vec2> flat_;
  std::vector<char> held_;
  std::vector<Vec3> place_, velocity_, force_;
  std::vector<double> mass_;
  std::vector<Triangle> triangles_;
  std::vector<Edge> edges_;
  int first_of_rim_ = 0;
  double total_mass_ = 0.0;
};

}  // namespace

Reading drape(const Fabric& fabric, int rings, unsigned start) {
  Shell shell(fabric, rings, start);
  const double seconds = shell.sink(kLongest);
  return {shell.coefficient(), shell.folds(), seconds};
}

}  // namespace curtain_shell
