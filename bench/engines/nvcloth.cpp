// SPDX-License-Identifier: BSD-3-Clause
//
// NvCloth on the processor: a phase for each set of links that share no node, the ball as its sphere.
#include <NvCloth/Callbacks.h>
#include <NvCloth/Cloth.h>
#include <NvCloth/Fabric.h>
#include <NvCloth/Factory.h>
#include <NvCloth/PhaseConfig.h>
#include <NvCloth/Solver.h>
#include <foundation/PxErrorCallback.h>
#include <foundation/PxVec4.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "bench/engines/engine.h"

namespace curtain_bench {
namespace {

using nv::cloth::Range;
using physx::PxVec3;
using physx::PxVec4;

class Allocator : public physx::PxAllocatorCallback {
  void* allocate(std::size_t size, const char*, const char*, int) override {
    return std::aligned_alloc(16, (size + 15) / 16 * 16);
  }
  void deallocate(void* pointer) override { std::free(pointer); }
};

class Errors : public physx::PxErrorCallback {
  void reportError(physx::PxErrorCode::Enum, const char* message, const char*, int) override {
    std::fprintf(stderr, "NvCloth: %s\n", message);
  }
};

class Asserts : public nv::cloth::PxAssertHandler {
  void operator()(const char* text, const char*, int, bool&) override { std::fprintf(stderr, "NvCloth: %s\n", text); }
};

nv::cloth::Factory& factory() {
  static Allocator allocator;
  static Errors errors;
  static Asserts asserts;
  static nv::cloth::Factory* const made = [] {
    nv::cloth::InitializeNvCloth(&allocator, &errors, &asserts, nullptr);
    return NvClothCreateFactoryCPU();
  }();
  return *made;
}

template <typename T>
Range<const T> rangeOf(const std::vector<T>& values) {
  return Range<const T>(values.data(), values.data() + values.size());
}

PxVec4 vector(double x, double y, double z, double w) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(w)};
}

// Links by phase. Within one no node comes twice.
class Phases {
 public:
  Phases(const ClothStart& start, bool even_odd) : start_(start) {
    if (even_odd) {
      addWarps(1, 2);
      addWarps(2, 2);
    } else {
      for (int i = 1; i < start.rows; ++i) addWarps(i, start.rows);
    }
    warps_ = sets.size();
    addWefts(1);
    addWefts(2);
  }

  std::size_t count() const { return sets.size(); }
  bool isWeft(std::size_t phase) const { return phase >= warps_; }

  std::vector<std::uint32_t> sets;  // where each phase ends
  std::vector<std::uint32_t> nodes;
  std::vector<float> rests;

 private:
  void add(int a, int b, double rest) {
    if (start_.pinned[static_cast<std::size_t>(a)] != 0 && start_.pinned[static_cast<std::size_t>(b)] != 0) return;
    nodes.push_back(static_cast<std::uint32_t>(a));
    nodes.push_back(static_cast<std::uint32_t>(b));
    rests.push_back(static_cast<float>(rest));
  }
  void addWarps(int first, int step) {
    for (int i = first; i < start_.rows; i += step) {
      for (int j = 0; j < start_.columns; ++j)
        add((i - 1) * start_.columns + j, i * start_.columns + j, start_.warp_rest);
    }
    sets.push_back(static_cast<std::uint32_t>(rests.size()));
  }
  void addWefts(int first) {
    for (int i = 0; i < start_.rows; ++i) {
      for (int j = first; j < start_.columns; j += 2)
        add(i * start_.columns + j - 1, i * start_.columns + j, start_.weft_rest);
    }
    sets.push_back(static_cast<std::uint32_t>(rests.size()));
  }

  const ClothStart& start_;
  std::size_t warps_ = 0;
};

class NvCloth : public Engine {
 public:
  NvCloth(const ClothStart& start, const NvClothSettings& settings) : start_(start), settings_(settings) {
    const Phases phases(start, settings.even_odd);
    makeCloth(phases);
    configure(phases);
    solver_.reset(factory().createSolver());
    solver_->addCloth(cloth_.get());
  }
  ~NvCloth() override {
    solver_->removeCloth(cloth_.get());
    solver_.reset();
    cloth_.reset();
    fabric_->decRefCount();
  }
  NvCloth(const NvCloth&) = delete;
  NvCloth& operator=(const NvCloth&) = delete;

  void frame() override {
    const double end = time_ + start_.frame_seconds;
    if (start_.solid.shape == Solid::Shape::kBall) {
      const PxVec4 from = ballAt(time_), to = ballAt(end);
      cloth_->setSpheres(Range<const PxVec4>(&from, &from + 1), Range<const PxVec4>(&to, &to + 1));
    }
    time_ = end;
    if (!solver_->beginSimulation(static_cast<float>(start_.frame_seconds))) return;
    for (int chunk = 0; chunk < solver_->getSimulationChunkCount(); ++chunk) solver_->simulateChunk(chunk);
    solver_->endSimulation();
  }

  void accelerate(const Points& accelerations) override {
    Range<PxVec4> all = cloth_->getParticleAccelerations();
    for (std::size_t n = 0; n < start_.count(); ++n)
      all[static_cast<std::uint32_t>(n)] = vector(accelerations.x[n], accelerations.y[n], accelerations.z[n], 0.0);
  }

  void copyPositions(Points& out) const override {
    const nv::cloth::MappedRange<const PxVec4> now = nv::cloth::readCurrentParticles(*cloth_);
    copy(out, [&](std::uint32_t n) { return now[n].getXYZ(); });
  }

  void copyVelocities(Points& out) const override {
    const nv::cloth::MappedRange<const PxVec4> now = nv::cloth::readCurrentParticles(*cloth_);
    const nv::cloth::MappedRange<const PxVec4> before = nv::cloth::readPreviousParticles(*cloth_);
    const float h = cloth_->getPreviousIterationDt();
    copy(out, [&](std::uint32_t n) {
      return h > 0.0f && start_.pinned[n] == 0 ? (now[n].getXYZ() - before[n].getXYZ()) / h : PxVec3(0.0f);
    });
  }

  int substeps() const override { return static_cast<int>(settings_.frequency * start_.frame_seconds + 0.5); }

 private:
  template <typename Value>
  void copy(Points& out, const Value& value) const {
    out.resize(start_.count());
    for (std::size_t n = 0; n < start_.count(); ++n) {
      const PxVec3 v = value(static_cast<std::uint32_t>(n));
      out.x[n] = static_cast<double>(v.x);
      out.y[n] = static_cast<double>(v.y);
      out.z[n] = static_cast<double>(v.z);
    }
  }

  PxVec4 ballAt(double time) const {
    const Solid::Place place = start_.solid.at(time);
    return vector(place[0], place[1], place[2], start_.solid.radius + start_.solid.margin);
  }

  void makeCloth(const Phases& phases) {
    std::vector<std::uint32_t> order, anchors;
    std::vector<float> lengths;
    for (std::size_t phase = 0; phase < phases.count(); ++phase) order.push_back(static_cast<std::uint32_t>(phase));
    std::vector<PxVec4> particles;
    for (std::size_t n = 0; n < start_.count(); ++n) {
      const double inverse = start_.pinned[n] != 0 ? 0.0 : 1.0 / start_.mass[n];
      particles.push_back(vector(start_.positions.x[n], start_.positions.y[n], start_.positions.z[n], inverse));
      if (!settings_.tethers) continue;
      const auto columns = static_cast<std::size_t>(start_.columns);
      anchors.push_back(static_cast<std::uint32_t>(n % columns));
      lengths.push_back(static_cast<float>(static_cast<double>(n / columns) * start_.warp_rest));
    }
    fabric_ = factory().createFabric(static_cast<std::uint32_t>(start_.count()), rangeOf(order), rangeOf(phases.sets),
                                     rangeOf(phases.rests), Range<const float>(), rangeOf(phases.nodes),
                                     rangeOf(anchors), rangeOf(lengths), Range<const std::uint32_t>());
    if (fabric_ == nullptr) throw std::runtime_error("NvCloth made no fabric");
    cloth_.reset(factory().createCloth(rangeOf(particles), *fabric_));
  }

  void configure(const Phases& phases) {
    const auto frequency = static_cast<float>(settings_.frequency);
    cloth_->setGravity({static_cast<float>(start_.gravity[0]), static_cast<float>(start_.gravity[1]),
                        static_cast<float>(start_.gravity[2])});
    cloth_->setSolverFrequency(frequency);
    cloth_->setStiffnessFrequency(frequency);  // stiffness and damping are those of one iteration
    cloth_->setDamping(PxVec3(static_cast<float>(1.0 - std::exp(-start_.damping / settings_.frequency))));
    cloth_->setFriction(static_cast<float>(start_.solid.friction));
    cloth_->enableContinuousCollision(settings_.continuous);
    cloth_->setSelfCollisionDistance(static_cast<float>(settings_.self_distance));
    if (settings_.self_distance > std::min(start_.warp_rest, start_.weft_rest)) tellPlacesAtRest();
    std::vector<nv::cloth::PhaseConfig> configs;
    for (std::size_t phase = 0; phase < phases.count(); ++phase) {
      configs.emplace_back(static_cast<std::uint16_t>(phase));
      if (!settings_.one_sided || !phases.isWeft(phase)) continue;
      configs.back().mStiffnessMultiplier = 0.0f;  // between these shares of its length a link does nothing
      configs.back().mCompressionLimit = 1e-6f;
    }
    cloth_->setPhaseConfig(rangeOf(configs));
  }

  // Particles that are neighbours at rest then do not push each other apart.
  void tellPlacesAtRest() {
    std::vector<PxVec4> places;
    for (int i = 0; i < start_.rows; ++i) {
      for (int j = 0; j < start_.columns; ++j)
        places.push_back(vector(j * start_.weft_rest, i * start_.warp_rest, 0.0, 0.0));
    }
    cloth_->setRestPositions(rangeOf(places));
  }

  const ClothStart start_;
  const NvClothSettings settings_;
  double time_ = 0.0;
  nv::cloth::Fabric* fabric_ = nullptr;
  std::unique_ptr<nv::cloth::Cloth> cloth_;
  std::unique_ptr<nv::cloth::Solver> solver_;
};

}  // namespace

std::unique_ptr<Engine> makeNvCloth(const ClothStart& start, const NvClothSettings& settings) {
  return std::make_unique<NvCloth>(start, settings);
}

}  // namespace curtain_bench
