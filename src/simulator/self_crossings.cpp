// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/self_crossings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace curtain {
namespace {

// Heights over a triangle's plane below this share of the coordinates are rounding, accumulated over many substeps:
// coplanar cloth is off its plane by 1e-12 of its size and does not cross. Contact keeps at least 1e-5 of it.
constexpr double kRounding = 1e-10;

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return (b - a).cross(c - a).dot(d - a); }

bool pierces(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double side_p = volume(a, b, c, p);
  const double side_q = volume(a, b, c, q);
  if (side_p * side_q >= 0.0) return false;
  const double far = std::max({p.cwiseAbs().maxCoeff(), q.cwiseAbs().maxCoeff(), a.cwiseAbs().maxCoeff()});
  if (!(std::min(std::abs(side_p), std::abs(side_q)) > kRounding * far * (b - a).cross(c - a).norm())) return false;
  const double s1 = volume(p, q, a, b);
  const double s2 = volume(p, q, b, c);
  const double s3 = volume(p, q, c, a);
  return (s1 > 0.0 && s2 > 0.0 && s3 > 0.0) || (s1 < 0.0 && s2 < 0.0 && s3 < 0.0);
}

}  // namespace

std::vector<SelfCrossing> findSelfCrossings(const Grid& grid, const Field3& position) {
  const CoarseMesh mesh = makeCoarseMesh(grid);
  struct BoxedEdge {
    Eigen::AlignedBox3d box;
    MeshEdge edge;
  };
  std::vector<BoxedEdge> edges;
  double longest = 0.0;  // along x
  for (const MeshEdge& edge : mesh.edges) {
    Eigen::AlignedBox3d box(position.at(edge[0]));
    box.extend(position.at(edge[1]));
    longest = std::max(longest, box.sizes().x());
    edges.push_back({box, edge});
  }
  std::sort(edges.begin(), edges.end(),
            [](const BoxedEdge& a, const BoxedEdge& b) { return a.box.min().x() < b.box.min().x(); });
  const auto beginsBefore = [](const BoxedEdge& edge, double x) { return edge.box.min().x() < x; };
  std::vector<SelfCrossing> crossings;
  for (const MeshTriangle& triangle : mesh.triangles) {
    const Vec3 a = position.at(triangle[0]), b = position.at(triangle[1]), c = position.at(triangle[2]);
    Eigen::AlignedBox3d box(a);
    box.extend(b).extend(c);
    auto edge = std::lower_bound(edges.begin(), edges.end(), box.min().x() - longest, beginsBefore);
    for (; edge != edges.end() && edge->box.min().x() <= box.max().x(); ++edge) {
      if (!box.intersects(edge->box)) continue;
      const bool shared = std::any_of(triangle.begin(), triangle.end(), [&](std::uint32_t corner) {
        return corner == edge->edge[0] || corner == edge->edge[1];
      });
      if (!shared && pierces(position.at(edge->edge[0]), position.at(edge->edge[1]), a, b, c))
        crossings.push_back({edge->edge, triangle});
    }
  }
  return crossings;
}

}  // namespace curtain
