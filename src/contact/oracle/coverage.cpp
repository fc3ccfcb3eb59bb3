// SPDX-License-Identifier: BSD-3-Clause
#include "contact/oracle/coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cloth/coarse_mesh.h"

namespace curtain {
namespace {

constexpr int kAcross = 128;  // points of the rectangle, in either direction
constexpr double kNothing = -std::numeric_limits<double>::infinity();

// The points of a rectangle across the line of sight, with what is nearest to who looks there.
class View {
 public:
  /// Coordinates of points seen: across, up, and towards who looks.
  View(const Eigen::AlignedBox3d& box, std::vector<double>& depths)
      : low_(box.min()), step_(box.sizes() / kAcross), depths_(depths) {
    depths_.assign(static_cast<std::size_t>(kAcross) * kAcross, kNothing);
  }

  // Barycentric coordinates are linear across the triangle.
  void draw(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
    if (area == 0.0 || !(a + b + c).allFinite()) return;
    const auto range = [this](double p, double q, double r, int axis) {
      const double low = (std::min({p, q, r}) - low_[axis]) / step_[axis],
                   high = (std::max({p, q, r}) - low_[axis]) / step_[axis];
      return std::pair<int, int>(static_cast<int>(std::clamp(std::ceil(low - 0.5), 0.0, 1.0 * kAcross)),
                                 static_cast<int>(std::clamp(std::floor(high - 0.5), -1.0, kAcross - 1.0)));
    };
    const auto [left, right] = range(a.x(), b.x(), c.x(), 0);
    const auto [bottom, top] = range(a.y(), b.y(), c.y(), 1);
    for (int j = bottom; j <= top; ++j) {
      for (int i = left; i <= right; ++i) {
        const double x = low_.x() + (i + 0.5) * step_.x(), y = low_.y() + (j + 0.5) * step_.y();
        const double of_b = ((x - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (y - a.y())) / area;
        const double of_c = ((b.x() - a.x()) * (y - a.y()) - (x - a.x()) * (b.y() - a.y())) / area;
        if (of_b < 0.0 || of_c < 0.0 || of_b + of_c > 1.0) continue;
        double& nearest = depths_[static_cast<std::size_t>(j * kAcross + i)];
        nearest = std::max(nearest, a.z() + of_b * (b.z() - a.z()) + of_c * (c.z() - a.z()));
      }
    }
  }

 private:
  Vec3 low_, step_;
  std::vector<double>& depths_;
};

}  // namespace

bool hidesPoint(const Grid& grid, const Field3& position, const Vec3& point, const Vec3& from) {
  const std::vector<MeshTriangle> triangles = makeCoarseMesh(grid).triangles;
  return std::any_of(triangles.begin(), triangles.end(), [&](const MeshTriangle& t) {
    const Vec3 a = position.at(t[0]) - point, b = position.at(t[1]) - point, c = position.at(t[2]) - point;
    // The line goes through the triangle where it is on the same side of its three edges, seen from the point.
    const double ab = a.cross(b).dot(from), bc = b.cross(c).dot(from), ca = c.cross(a).dot(from);
    const bool inside = (ab >= 0.0 && bc >= 0.0 && ca >= 0.0) || (ab <= 0.0 && bc <= 0.0 && ca <= 0.0);
    const double sum = ab + bc + ca;
    return inside && sum != 0.0 && a.cross(b).dot(c) / sum > 0.0;
  });
}

double coveredShare(const ContactShape& shape, const Transform& place, const Grid& grid, const Field3& position,
                    const Vec3& from) {
  const Vec3 towards = from.normalized(), across = towards.unitOrthogonal();
  Eigen::Matrix3d seen;  // from the world to the view
  seen << across.transpose(), towards.cross(across).transpose(), towards.transpose();
  if (!shape.bounds().sizes().allFinite()) return std::numeric_limits<double>::quiet_NaN();
  ShapeTriangles solid = shape.triangles();
  Eigen::AlignedBox3d box;
  for (auto& corner : solid.corners) {
    corner = seen * place.toWorld(corner);
    box.extend(Vec3(corner));
  }
  if (box.isEmpty() || !(box.sizes().x() > 0.0 && box.sizes().y() > 0.0))
    return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> of_solid, of_cloth;
  View solid_view(box, of_solid), cloth_view(box, of_cloth);
  for (const auto& t : solid.triangles) {
    const auto corner = [&](int k) -> Vec3 { return solid.corners[static_cast<std::size_t>(t[k])]; };
    solid_view.draw(corner(0), corner(1), corner(2));
  }
  for (const MeshTriangle& t : makeCoarseMesh(grid).triangles)
    cloth_view.draw(seen * position.at(t[0]), seen * position.at(t[1]), seen * position.at(t[2]));
  int all = 0, hidden = 0;
  for (std::size_t n = 0; n < of_solid.size(); ++n) {
    if (of_solid[n] == kNothing) continue;
    ++all;
    hidden += of_cloth[n] > of_solid[n] ? 1 : 0;
  }
  return all > 0 ? static_cast<double>(hidden) / all : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace curtain
