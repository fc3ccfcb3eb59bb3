// SPDX-License-Identifier: BSD-3-Clause
#include "scene/rail_path.h"

#include <algorithm>
#include <cmath>

#include "scene/pi.h"
#include "scene/ranges.h"

namespace curtain {
namespace {

// Relative difference of an arc's radii at both ends: for rounding of typed coordinates.
constexpr double kRound = 1e-3;
// Least sine of an arc's angle: its plane follows from its ends and centre, which must not be on one line.
constexpr double kMinSine = 1e-3;

double angleBetween(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

std::string RailPath::problemOf(const std::vector<RailPiece>& pieces, std::size_t index) {
  const RailPiece& piece = pieces[index];
  if (index == 0) return piece.centre ? "must be a point [x, y, z]: the rail begins there" : "";
  const Vec3& from = pieces[index - 1].to;
  if (!((piece.to - from).norm() >= kSmallest)) return "must differ from the point before it";
  if (!piece.centre) return "";
  const Vec3 a = from - *piece.centre, b = piece.to - *piece.centre;
  if (!(std::abs(a.norm() - b.norm()) <= kRound * a.norm())) {
    return "must be an arc: its centre is " + formatNumber(a.norm()) + " m from its beginning and " +
           formatNumber(b.norm()) + " m from its end";
  }
  const double angle = angleBetween(a, b);
  if (std::sin(angle) >= kMinSine) return "";
  return "must be an arc of more than 0 and less than 180 degrees, has " + formatNumber(angle * 180.0 / kPi) +
         " (longer arcs: two of them)";
}

// An arc's radius is that of its beginning, and the next piece begins where the arc really ends: no step in the path.
RailPath::RailPath(const std::vector<RailPiece>& pieces) {
  Vec3 from = pieces.empty() ? Vec3(Vec3::Zero()) : pieces.front().to;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const RailPiece& given = pieces[i];
    Piece piece{length_, (given.to - from).norm(), from, (given.to - from).normalized()};
    if (given.centre) {
      const Vec3 out = from - *given.centre;
      piece.radius = out.norm();
      piece.out = out / piece.radius;
      const Vec3 end = given.to - *given.centre;
      piece.along = (end - piece.out.dot(end) * piece.out).normalized();
      piece.length = piece.radius * angleBetween(out, end);
    }
    pieces_.push_back(piece);
    length_ += piece.length;
    from = placeOn(piece, piece.length).point;
  }
}

RailPath::Place RailPath::placeOn(const Piece& piece, double way) noexcept {
  if (piece.radius == 0.0) return {piece.from + way * piece.along, piece.along, Vec3::Zero()};
  const double angle = way / piece.radius;
  const Vec3 out = std::cos(angle) * piece.out + std::sin(angle) * piece.along;
  // From `from`, not from the centre: a place at 0 is `from` to the bit.
  return {piece.from + piece.radius * (out - piece.out), std::cos(angle) * piece.along - std::sin(angle) * piece.out,
          -out / piece.radius};
}

RailPath::Place RailPath::at(double s) const noexcept {
  const Piece* piece = &pieces_.front();
  for (const Piece& next : pieces_) {
    if (next.begin <= s) piece = &next;
  }
  return placeOn(*piece, std::clamp(s - piece->begin, 0.0, piece->length));
}

double RailPath::nearestOn(const Piece& piece, const Vec3& point) noexcept {
  const Vec3 to = point - piece.from;
  if (piece.radius == 0.0) return std::clamp(to.dot(piece.along), 0.0, piece.length);
  const Vec3 from_centre = to + piece.radius * piece.out;
  const double angle = std::atan2(from_centre.dot(piece.along), from_centre.dot(piece.out));
  // Behind the arc: to the end that is nearer.
  const double half = 0.5 * piece.length / piece.radius;
  return std::clamp(piece.radius * (angle < half - kPi ? angle + 2.0 * kPi : angle), 0.0, piece.length);
}

double RailPath::nearest(const Vec3& point) const noexcept {
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  for (const Piece& piece : pieces_) {
    const double way = nearestOn(piece, point);
    const double square = (placeOn(piece, way).point - point).squaredNorm();
    if (!(square < least)) continue;
    least = square;
    best = piece.begin + way;
  }
  return best;
}

}  // namespace curtain
