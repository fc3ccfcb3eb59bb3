// SPDX-License-Identifier: BSD-3-Clause
//
// Jolt's soft body in a PhysicsSystem on one thread, with the ball as a kinematic sphere.
#include <Jolt/Jolt.h>
// Before the others.
#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/BroadPhase/BroadPhaseLayerInterfaceTable.h>
#include <Jolt/Physics/Collision/BroadPhase/ObjectVsBroadPhaseLayerFilterTable.h>
#include <Jolt/Physics/Collision/ObjectLayerPairFilterTable.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/PhysicsSettings.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/Physics/SoftBody/SoftBodyCreationSettings.h>
#include <Jolt/Physics/SoftBody/SoftBodyMotionProperties.h>
#include <Jolt/Physics/SoftBody/SoftBodySharedSettings.h>
#include <Jolt/RegisterTypes.h>

#include <stdexcept>

#include "bench/engines/engine.h"

namespace curtain_bench {
namespace {

constexpr JPH::ObjectLayer kBallLayer = 0, kClothLayer = 1;

void registerTypes() {
  static const bool once = [] {
    JPH::RegisterDefaultAllocator();
    JPH::Factory::sInstance = new JPH::Factory();  // lives as long as the program
    JPH::RegisterTypes();
    return true;
  }();
  (void)once;
}

JPH::Vec3 vector(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}
JPH::Vec3 vector(const std::array<double, 3>& v) { return vector(v[0], v[1], v[2]); }

// Links in the order of the other engines: warp from the hung edge down, then weft.
JPH::Ref<JPH::SoftBodySharedSettings> clothOf(const ClothStart& start, bool long_range) {
  using Shared = JPH::SoftBodySharedSettings;
  JPH::Ref<Shared> cloth = new Shared;
  for (std::size_t n = 0; n < start.count(); ++n) {
    Shared::Vertex vertex;
    vector(start.positions.x[n], start.positions.y[n], start.positions.z[n]).StoreFloat3(&vertex.mPosition);
    vertex.mInvMass = start.pinned[n] != 0 ? 0.0f : static_cast<float>(1.0 / start.mass[n]);
    cloth->mVertices.push_back(vertex);
  }
  const auto at = [&](int i, int j) { return static_cast<JPH::uint32>(i * start.columns + j); };
  const auto link = [&](JPH::uint32 a, JPH::uint32 b, double rest) {
    if (start.pinned[a] != 0 && start.pinned[b] != 0) return;
    Shared::Edge edge(a, b);
    edge.mRestLength = static_cast<float>(rest);
    cloth->mEdgeConstraints.push_back(edge);
  };
  for (int i = 1; i < start.rows; ++i) {
    for (int j = 0; j < start.columns; ++j) {
      link(at(i - 1, j), at(i, j), start.warp_rest);
      if (long_range) cloth->mLRAConstraints.emplace_back(at(0, j), at(i, j), static_cast<float>(i * start.warp_rest));
    }
  }
  for (int i = 0; i < start.rows; ++i) {
    for (int j = 1; j < start.columns; ++j) {
      link(at(i, j - 1), at(i, j), start.weft_rest);
      if (i == 0) continue;
      cloth->AddFace({at(i - 1, j - 1), at(i, j - 1), at(i - 1, j)});
      cloth->AddFace({at(i - 1, j), at(i, j - 1), at(i, j)});
    }
  }
  const JPH::Array<Shared::Edge> links = cloth->mEdgeConstraints;
  cloth->Optimize();
  cloth->mEdgeConstraints = links;  // its order is for threads, and where cloth is gathered and blown it gains energy
  return cloth;
}

class Jolt : public Engine {
 public:
  Jolt(const ClothStart& start, const JoltSettings& settings)
      : start_(start), settings_(settings), h_(start.frame_seconds / settings.steps) {
    collide_.EnableCollision(kBallLayer, kClothLayer);
    broad_.MapObjectToBroadPhaseLayer(kBallLayer, JPH::BroadPhaseLayer(0));
    broad_.MapObjectToBroadPhaseLayer(kClothLayer, JPH::BroadPhaseLayer(1));
    against_ = std::make_unique<JPH::ObjectVsBroadPhaseLayerFilterTable>(broad_, 2, collide_, 2);
    system_.Init(8, 0, 64, 64, broad_, *against_, collide_);
    system_.SetGravity(vector(start.gravity));
    addBall();
    addCloth();
    system_.OptimizeBroadPhase();
  }
  ~Jolt() override {
    for (const JPH::BodyID& body : {cloth_, ball_}) {
      if (body.IsInvalid()) continue;
      bodies().RemoveBody(body);
      bodies().DestroyBody(body);
    }
  }
  Jolt(const Jolt&) = delete;
  Jolt& operator=(const Jolt&) = delete;

  void frame() override {
    for (int s = 0; s < settings_.steps; ++s) {
      time_ += h_;
      if (!ball_.IsInvalid())
        bodies().MoveKinematic(ball_, JPH::RVec3(vector(start_.solid.at(time_))), JPH::Quat::sIdentity(),
                               static_cast<float>(h_));
      if (!accelerations_.x.empty()) push();
      system_.Update(static_cast<float>(h_), 1, &scratch_, &jobs_);
    }
  }

  void accelerate(const Points& accelerations) override { accelerations_ = accelerations; }

  void copyPositions(Points& out) const override {
    const JPH::Vec3 middle(body_->GetCenterOfMassPosition());
    copy(out, [&](const JPH::SoftBodyVertex& vertex) { return middle + vertex.mPosition; });
  }
  void copyVelocities(Points& out) const override {
    copy(out, [](const JPH::SoftBodyVertex& vertex) { return vertex.mVelocity; });
  }

  int substeps() const override { return settings_.steps * settings_.iterations; }

 private:
  JPH::BodyInterface& bodies() { return system_.GetBodyInterfaceNoLock(); }
  JPH::SoftBodyMotionProperties& motion() const {
    return *static_cast<JPH::SoftBodyMotionProperties*>(body_->GetMotionProperties());
  }

  template <typename Value>
  void copy(Points& out, const Value& value) const {
    out.resize(start_.count());
    for (std::size_t n = 0; n < start_.count(); ++n) {
      const JPH::Vec3 v = value(motion().GetVertices()[n]);
      out.x[n] = static_cast<double>(v.GetX());
      out.y[n] = static_cast<double>(v.GetY());
      out.z[n] = static_cast<double>(v.GetZ());
    }
  }

  // It knows no forces on single nodes.
  void push() {
    for (std::size_t n = 0; n < start_.count(); ++n) {
      if (start_.pinned[n] != 0) continue;
      motion().GetVertices()[n].mVelocity +=
          static_cast<float>(h_) * vector(accelerations_.x[n], accelerations_.y[n], accelerations_.z[n]);
    }
  }

  void addBall() {
    if (start_.solid.shape != Solid::Shape::kBall) return;
    JPH::BodyCreationSettings ball(new JPH::SphereShape(static_cast<float>(start_.solid.radius)),
                                   JPH::RVec3(vector(start_.solid.at(0.0))), JPH::Quat::sIdentity(),
                                   JPH::EMotionType::Kinematic, kBallLayer);
    ball.mFriction = static_cast<float>(start_.solid.friction);
    ball.mAllowSleeping = false;
    ball_ = bodies().CreateAndAddBody(ball, JPH::EActivation::Activate);
  }

  void addCloth() {
    JPH::SoftBodyCreationSettings cloth(clothOf(start_, settings_.long_range), JPH::RVec3::sZero(),
                                        JPH::Quat::sIdentity(), kClothLayer);
    cloth.mNumIterations = static_cast<JPH::uint32>(settings_.iterations);
    cloth.mLinearDamping = static_cast<float>(start_.damping);
    cloth.mFriction = static_cast<float>(start_.solid.friction);
    cloth.mVertexRadius = static_cast<float>(start_.solid.margin);
    cloth.mUpdatePosition = false;  // it hangs; shifts would add their rounding to every step
    cloth.mAllowSleeping = false;
    body_ = bodies().CreateSoftBody(cloth);
    if (body_ == nullptr) throw std::runtime_error("Jolt made no soft body");
    cloth_ = body_->GetID();
    bodies().AddBody(cloth_, JPH::EActivation::Activate);
  }

  struct Registered {
    Registered() { registerTypes(); }
  };

  const Registered registered_;  // before all else
  const ClothStart start_;
  const JoltSettings settings_;
  const double h_;  // [s]
  double time_ = 0.0;
  Points accelerations_;
  JPH::ObjectLayerPairFilterTable collide_{2};
  JPH::BroadPhaseLayerInterfaceTable broad_{2, 2};
  std::unique_ptr<JPH::ObjectVsBroadPhaseLayerFilterTable> against_;
  JPH::TempAllocatorImpl scratch_{64 * 1024 * 1024};
  JPH::JobSystemSingleThreaded jobs_{JPH::cMaxPhysicsJobs};
  JPH::PhysicsSystem system_;
  JPH::BodyID ball_, cloth_;
  JPH::Body* body_ = nullptr;  // the cloth
};

}  // namespace

std::unique_ptr<Engine> makeJolt(const ClothStart& start, const JoltSettings& settings) {
  return std::make_unique<Jolt>(start, settings);
}

}  // namespace curtain_bench
