// SPDX-License-Identifier: BSD-3-Clause
//
// btSoftBody of Bullet Physics as its package installs it. The soft body is stepped by itself, without a world around
// it: no broad phase, no contacts, nothing that the other rivals need not pay for; but where there is something solid,
// in a btSoftRigidDynamicsWorld with it. Its links hold both ways, so it takes part only where the weft is never slack.
#include <cmath>

#include "BulletSoftBody/btSoftBody.h"
#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "bench/rivals/rivals.h"
#include "btBulletDynamicsCommon.h"

namespace curtain_bench {
namespace {

btVector3 vector(const std::array<double, 3>& v) {
  return {static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]), static_cast<btScalar>(v[2])};
}

// A floor is a box so thick and wide [m].
constexpr double kThick = 1.0, kWide = 100.0, kLong = 10.0;

// Of the grid on which it knows a shape's distance [m]; by itself 0.25, in which a ball of 0.15 is lost.
constexpr btScalar kVoxel = btScalar(0.02);

std::unique_ptr<btCollisionShape> shapeOf(const Solid& solid) {
  const auto radius = static_cast<btScalar>(solid.radius);
  switch (solid.shape) {
    case Solid::Shape::kBall:
      return std::make_unique<btSphereShape>(radius);
    case Solid::Shape::kBar:
      return std::make_unique<btCylinderShape>(btVector3(radius, btScalar(0.5 * kLong), radius));
    default:
      return std::make_unique<btBoxShape>(btVector3(btScalar(kWide), btScalar(kWide), btScalar(0.5 * kThick)));
  }
}

// What is solid, and what Bullet needs to let a soft body touch it.
class World {
 public:
  World(const ClothStart& start, btSoftBodyWorldInfo& info)
      : solid_(start.solid),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
        shape_(shapeOf(start.solid)),
        rigid_(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, shape_.get())) {
    world_.setGravity(info.m_gravity);
    info.m_broadphase = &broadphase_;
    info.m_dispatcher = &dispatcher_;
    info.m_sparsesdf.Initialize();
    info.m_sparsesdf.setDefaultVoxelsz(kVoxel);
    info.m_sparsesdf.Reset();  // only from here on it has such cells
    rigid_.setCollisionFlags(rigid_.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    rigid_.setActivationState(DISABLE_DEACTIVATION);
    rigid_.setFriction(static_cast<btScalar>(solid_.friction));
    place();
    world_.addRigidBody(&rigid_);
  }
  ~World() {
    if (body_ != nullptr) world_.removeSoftBody(body_);
    world_.removeRigidBody(&rigid_);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void add(btSoftBody& body) {
    body_ = &body;
    body.m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
    body.m_cfg.kKHR = 1;  // by itself it corrects a tenth of what is too deep
    body.m_cfg.kDF = static_cast<btScalar>(solid_.friction);
    body.getCollisionShape()->setMargin(static_cast<btScalar>(solid_.margin));
    world_.addSoftBody(&body);
  }

  void step(double h) {
    time_ += h;
    place();
    world_.stepSimulation(static_cast<btScalar>(h), 0);
  }

 private:
  void place() {
    Solid::Place middle = solid_.at(time_);
    if (solid_.shape == Solid::Shape::kFloor) middle[2] -= 0.5 * kThick;
    rigid_.setWorldTransform(btTransform(btQuaternion::getIdentity(), vector(middle)));
  }

  const Solid solid_;
  double time_ = 0.0;
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btSoftRigidDynamicsWorld world_;
  std::unique_ptr<btCollisionShape> shape_;
  btRigidBody rigid_;
  btSoftBody* body_ = nullptr;
};

class Bullet : public Contestant {
 public:
  Bullet(const ClothStart& start, const BulletSettings& settings)
      : substeps_(settings.substeps), h_(start.frame_seconds / settings.substeps) {
    info_.m_gravity = vector(start.gravity);
    info_.air_density = 0;
    info_.water_density = 0;
    const std::size_t nodes = start.count();
    btAlignedObjectArray<btVector3> places;
    btAlignedObjectArray<btScalar> masses;
    for (std::size_t n = 0; n < nodes; ++n) {
      places.push_back(vector({start.positions.x[n], start.positions.y[n], start.positions.z[n]}));
      masses.push_back(start.pinned[n] != 0 ? btScalar(0) : static_cast<btScalar>(start.mass[n]));
    }
    body_ = std::make_unique<btSoftBody>(&info_, static_cast<int>(nodes), &places[0], &masses[0]);
    body_->m_materials[0]->m_kLST = 1;
    addLinks(start);
    body_->m_cfg.piterations = settings.position_iterations;
    body_->m_cfg.viterations = settings.velocity_iterations;
    body_->m_cfg.collisions = 0;
    body_->m_cfg.kDP = static_cast<btScalar>(1.0 - std::exp(-start.damping * h_));
    if (settings.velocity_iterations > 0) body_->m_cfg.m_vsequence.push_back(btSoftBody::eVSolver::Linear);
    if (start.solid.shape == Solid::Shape::kNone) return;
    world_ = std::make_unique<World>(start, info_);
    world_->add(*body_);
  }

  void frame() override {
    for (int s = 0; s < substeps_; ++s) {
      if (world_ != nullptr) {
        world_->step(h_);
        continue;
      }
      body_->predictMotion(static_cast<btScalar>(h_));
      body_->solveConstraints();
      body_->integrateMotion();
    }
  }

  void copyPositions(Points& out) const override {
    out.resize(static_cast<std::size_t>(body_->m_nodes.size()));
    for (int n = 0; n < body_->m_nodes.size(); ++n) store(body_->m_nodes[n].m_x, n, out);
  }

  void copyVelocities(Points& out) const override {
    out.resize(static_cast<std::size_t>(body_->m_nodes.size()));
    for (int n = 0; n < body_->m_nodes.size(); ++n) store(body_->m_nodes[n].m_v, n, out);
  }

  int substeps() const override { return substeps_; }

 private:
  static void store(const btVector3& from, int node, Points& out) {
    const auto n = static_cast<std::size_t>(node);
    out.x[n] = static_cast<double>(from.x());
    out.y[n] = static_cast<double>(from.y());
    out.z[n] = static_cast<double>(from.z());
  }

  // In the order of the other rivals: warp from the hung edge down, then weft.
  void addLinks(const ClothStart& start) {
    std::vector<double> rests;
    const auto add = [&](int a, int b, double rest) {
      if (body_->m_nodes[a].m_im == 0 && body_->m_nodes[b].m_im == 0) return;
      body_->appendLink(a, b);
      rests.push_back(rest);
    };
    for (int i = 1; i < start.rows; ++i) {
      for (int j = 0; j < start.columns; ++j) add((i - 1) * start.columns + j, i * start.columns + j, start.warp_rest);
    }
    for (int i = 0; i < start.rows; ++i) {
      for (int j = 1; j < start.columns; ++j) add(i * start.columns + j - 1, i * start.columns + j, start.weft_rest);
    }
    // It would take the rest lengths from the places, in the first step again; ours are exact and may be longer.
    body_->updateConstants();
    body_->m_bUpdateRtCst = false;
    for (int l = 0; l < body_->m_links.size(); ++l) {
      body_->m_links[l].m_rl = static_cast<btScalar>(rests[static_cast<std::size_t>(l)]);
    }
    body_->updateLinkConstants();
  }

  btSoftBodyWorldInfo info_;
  std::unique_ptr<btSoftBody> body_;
  std::unique_ptr<World> world_;  // refers to the body
  int substeps_ = 1;
  double h_ = 0.0;  // [s]
};

}  // namespace

bool bulletInstalled() { return true; }

std::string bulletDescription() {
  const std::string version = std::to_string(BT_BULLET_VERSION / 100) + "." + std::to_string(BT_BULLET_VERSION % 100);
  return "Bullet " + version + (sizeof(btScalar) == sizeof(double) ? ", double precision" : ", single precision");
}

std::unique_ptr<Contestant> makeBullet(const ClothStart& start, const BulletSettings& settings) {
  return std::make_unique<Bullet>(start, settings);
}

}  // namespace curtain_bench
