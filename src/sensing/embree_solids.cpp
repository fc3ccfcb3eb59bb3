// SPDX-License-Identifier: BSD-3-Clause
#include "sensing/embree_solids.h"

#include <cmath>
#include <limits>

namespace curtain {
namespace {

// [m] A plane's box ends here: as far as obstacles may be.
constexpr double kFarthest = 1e9;

const PlacedSolid& solidOf(void* user, unsigned int number) {
  return (*static_cast<std::vector<PlacedSolid>*>(user))[number];
}

// Embree's boxes are of single precision: rounded outwards.
void findBounds(const RTCBoundsFunctionArguments* args) {
  const PlacedSolid& solid = solidOf(args->geometryUserPtr, args->primID);
  RTCBounds& box = *args->bounds_o;
  const float none = std::numeric_limits<float>::infinity();
  box = {none, none, none, 0.0F, -none, -none, -none, 0.0F};  // empty: left out
  if (!solid.present()) return;
  const auto below = [&](double value) { return std::nextafter(static_cast<float>(value), -none); };
  const auto above = [&](double value) { return std::nextafter(static_cast<float>(value), none); };
  const Eigen::AlignedBox3d bounds = solid.bounds();
  const Vec3 low = bounds.min(), high = bounds.max();
  box = {below(low.x()), below(low.y()), below(low.z()), 0.0F, above(high.x()), above(high.y()), above(high.z()), 0.0F};
}

void intersect(const RTCIntersectFunctionNArguments* args) {
  const PlacedSolid& solid = solidOf(args->geometryUserPtr, args->primID);
  RTCRayN* const rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* const hits = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned int i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const Vec3 direction(RTCRayN_dir_x(rays, args->N, i), RTCRayN_dir_y(rays, args->N, i),
                         RTCRayN_dir_z(rays, args->N, i));
    const auto hit = solid.meet(direction, RTCRayN_tnear(rays, args->N, i));
    if (!hit || !(hit->distance <= RTCRayN_tfar(rays, args->N, i))) continue;
    const Vec3& normal = hit->normal;
    RTCRayN_tfar(rays, args->N, i) = static_cast<float>(hit->distance);
    RTCHitN_Ng_x(hits, args->N, i) = static_cast<float>(normal.x());
    RTCHitN_Ng_y(hits, args->N, i) = static_cast<float>(normal.y());
    RTCHitN_Ng_z(hits, args->N, i) = static_cast<float>(normal.z());
    RTCHitN_u(hits, args->N, i) = RTCHitN_v(hits, args->N, i) = 0.0F;
    RTCHitN_primID(hits, args->N, i) = args->primID;
    RTCHitN_geomID(hits, args->N, i) = args->geomID;
    RTCHitN_instID(hits, args->N, i, 0) = args->context->instID[0];
  }
}

}  // namespace

void PlacedSolid::place(bool present, const Eigen::Isometry3d& pose) {
  present_ = present;
  pose_ = pose;
  sensor_ = pose.inverse().translation();
  const bool finite = bounds_.sizes().allFinite();
  middle_ = finite ? Vec3(pose * bounds_.center()) : Vec3::Zero();
  radius_squared_ = finite ? 0.25 * bounds_.sizes().squaredNorm() : std::numeric_limits<double>::infinity();
}

Eigen::AlignedBox3d PlacedSolid::bounds() const {
  if (!bounds_.sizes().allFinite()) return {Vec3::Constant(-kFarthest), Vec3::Constant(kFarthest)};
  const Vec3 half = pose_.linear().cwiseAbs() * (0.5 * bounds_.sizes());
  return {middle_ - half, middle_ + half};
}

// A geometry of one solid has no box in Embree that would keep rays away: here is a ball.
std::optional<SolidHit> PlacedSolid::meet(const Vec3& direction, double nearest) const {
  constexpr double kSlack = 1.0 + 1e-9;  // for rounding
  if (middle_.cross(direction).squaredNorm() > kSlack * radius_squared_ * direction.squaredNorm()) return std::nullopt;
  std::optional<SolidHit> hit = firstHit(shape_, sensor_, pose_.linear().transpose() * direction, nearest);
  if (hit) hit->normal = pose_.linear() * hit->normal;
  return hit;
}

RTCGeometry makeSolidGeometry(RTCDevice device, std::vector<PlacedSolid>& solids) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned int>(solids.size()));
  rtcSetGeometryUserData(geometry, &solids);
  rtcSetGeometryBoundsFunction(geometry, findBounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  return geometry;
}

}  // namespace curtain
