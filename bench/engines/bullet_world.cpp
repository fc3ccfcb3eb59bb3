// SPDX-License-Identifier: BSD-3-Clause
//
// Bullet's soft body in a world with the ball, touching itself by clusters where asked.
#include <cmath>

#include "BulletSoftBody/btSoftBody.h"
#include "BulletSoftBody/btSoftBodyInternals.h"
#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "bench/engines/engine.h"
#include "btBulletDynamicsCommon.h"

namespace curtain_bench {
namespace {

constexpr btScalar kCell = btScalar(0.02);  // of the field of the ball's distance [m]

btVector3 vector(double x, double y, double z) {
  return {static_cast<btScalar>(x), static_cast<btScalar>(y), static_cast<btScalar>(z)};
}
btVector3 vector(const std::array<double, 3>& v) { return vector(v[0], v[1], v[2]); }

class BulletWorld : public Engine {
 public:
  BulletWorld(const ClothStart& start, const BulletWorldSettings& settings)
      : start_(start), settings_(settings), h_(start.frame_seconds / settings.substeps) {
    world_.setGravity(vector(start.gravity));
    btSoftBodyWorldInfo& info = world_.getWorldInfo();
    info.m_gravity = vector(start.gravity);
    info.air_density = 0;
    info.water_density = 0;
    info.m_broadphase = &broadphase_;
    info.m_dispatcher = &dispatcher_;
    if (!settings.defaults) {
      info.m_sparsesdf.setDefaultVoxelsz(kCell);
      info.m_sparsesdf.Reset();  // only from here on it has such cells
    }
    makeBody();
    if (start.solid.shape == Solid::Shape::kBall) addBall();
  }
  ~BulletWorld() override {
    world_.removeSoftBody(body_.get());
    if (ball_ != nullptr) world_.removeRigidBody(ball_.get());
  }
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  void frame() override {
    for (int s = 0; s < settings_.substeps; ++s) {
      time_ += h_;
      if (ball_ != nullptr) place();
      for (std::size_t n = 0; n < accelerations_.x.size(); ++n) {
        if (start_.pinned[n] != 0) continue;
        const btScalar mass = static_cast<btScalar>(start_.mass[n]);
        body_->addForce(mass * vector(accelerations_.x[n], accelerations_.y[n], accelerations_.z[n]),
                        static_cast<int>(n));
      }
      world_.stepSimulation(static_cast<btScalar>(h_), 0);
      if (settings_.clusters >= 0) findClustersThatTouch();
    }
  }

  void accelerate(const Points& accelerations) override { accelerations_ = accelerations; }

  void copyPositions(Points& out) const override {
    copy(out, [](const btSoftBody::Node& node) { return node.m_x; });
  }
  void copyVelocities(Points& out) const override {
    copy(out, [](const btSoftBody::Node& node) { return node.m_v; });
  }

  int substeps() const override { return settings_.substeps; }

 private:
  template <typename Value>
  void copy(Points& out, const Value& value) const {
    out.resize(start_.count());
    for (std::size_t n = 0; n < start_.count(); ++n) {
      const btVector3 v = value(body_->m_nodes[static_cast<int>(n)]);
      out.x[n] = static_cast<double>(v.x());
      out.y[n] = static_cast<double>(v.y());
      out.z[n] = static_cast<double>(v.z());
    }
  }

  void makeBody() {
    btAlignedObjectArray<btVector3> places;
    btAlignedObjectArray<btScalar> masses;
    for (std::size_t n = 0; n < start_.count(); ++n) {
      places.push_back(vector(start_.positions.x[n], start_.positions.y[n], start_.positions.z[n]));
      masses.push_back(start_.pinned[n] != 0 ? btScalar(0) : static_cast<btScalar>(start_.mass[n]));
    }
    body_ =
        std::make_unique<btSoftBody>(&world_.getWorldInfo(), static_cast<int>(start_.count()), &places[0], &masses[0]);
    body_->m_materials[0]->m_kLST = 1;
    addLinks();
    btSoftBody::Config& config = body_->m_cfg;
    config.piterations = settings_.iterations;
    config.viterations = 0;
    config.kDP = static_cast<btScalar>(1.0 - std::exp(-start_.damping * h_));
    config.kDF = static_cast<btScalar>(start_.solid.friction);
    if (!settings_.defaults) config.kKHR = 1;
    config.collisions = btSoftBody::fCollision::SDF_RS;
    body_->getCollisionShape()->setMargin(static_cast<btScalar>(start_.solid.margin));
    if (settings_.clusters >= 0) touchItself();
    world_.addSoftBody(body_.get());
  }

  // Warp from the hung edge down, then weft.
  void addLinks() {
    std::vector<double> rests;
    const auto at = [&](int i, int j) { return i * start_.columns + j; };
    const auto add = [&](int a, int b, double rest) {
      if (body_->m_nodes[a].m_im == 0 && body_->m_nodes[b].m_im == 0) return;
      body_->appendLink(a, b);
      rests.push_back(rest);
    };
    for (int i = 1; i < start_.rows; ++i) {
      for (int j = 0; j < start_.columns; ++j) add(at(i - 1, j), at(i, j), start_.warp_rest);
    }
    for (int i = 0; i < start_.rows; ++i) {
      for (int j = 1; j < start_.columns; ++j) add(at(i, j - 1), at(i, j), start_.weft_rest);
    }
    // By itself it takes the rest lengths from the places, in the first step again.
    body_->updateConstants();
    body_->m_bUpdateRtCst = false;
    for (int l = 0; l < body_->m_links.size(); ++l)
      body_->m_links[l].m_rl = static_cast<btScalar>(rests[static_cast<std::size_t>(l)]);
    body_->updateLinkConstants();
  }

  void touchItself() {
    const auto at = [&](int i, int j) { return i * start_.columns + j; };
    for (int i = 1; i < start_.rows; ++i) {
      for (int j = 1; j < start_.columns; ++j) {
        body_->appendFace(at(i - 1, j - 1), at(i, j - 1), at(i - 1, j));
        body_->appendFace(at(i - 1, j), at(i, j - 1), at(i, j));
      }
    }
    body_->m_bUpdateRtCst = false;  // the lengths stay
    body_->generateClusters(settings_.clusters);
    body_->m_cfg.collisions |= btSoftBody::fCollision::CL_SS | btSoftBody::fCollision::CL_SELF;
  }

  // What the world ends its step by, but for bodies with CL_SELF its handler of this version finds no case.
  void findClustersThatTouch() {
    btSoftColliders::CollideCL_SS clusters;
    clusters.ProcessSoftSoft(body_.get(), body_.get());
  }

  void addBall() {
    shape_ = std::make_unique<btSphereShape>(static_cast<btScalar>(start_.solid.radius));
    ball_ = std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, shape_.get()));
    ball_->setCollisionFlags(ball_->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    ball_->setActivationState(DISABLE_DEACTIVATION);
    ball_->setFriction(static_cast<btScalar>(start_.solid.friction));
    place();
    world_.addRigidBody(ball_.get());
  }

  void place() { ball_->setWorldTransform(btTransform(btQuaternion::getIdentity(), vector(start_.solid.at(time_)))); }

  const ClothStart start_;
  const BulletWorldSettings settings_;
  const double h_;  // [s]
  double time_ = 0.0;
  Points accelerations_;
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btSoftRigidDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::unique_ptr<btSphereShape> shape_;
  std::unique_ptr<btRigidBody> ball_;
  std::unique_ptr<btSoftBody> body_;
};

}  // namespace

std::unique_ptr<Engine> makeBulletWorld(const ClothStart& start, const BulletWorldSettings& settings) {
  return std::make_unique<BulletWorld>(start, settings);
}

}  // namespace curtain_bench
