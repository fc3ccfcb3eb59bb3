// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that becomes another one while it moves. Much is worked out from its masses and rigidities as a simulator is
// made, so another simulator is made, and goes on where this one is: nothing of the old cloth can be left in it.
#include <algorithm>
#include <new>
#include <stdexcept>

#include "cloth/archive.h"
#include "curtain_sim/scene_yaml.h"
#include "scene/scalar.h"
#include "scene/scene_difference.h"
#include "simulator/simulator_impl.h"

namespace curtain {
namespace {

// Keys that may change, of the first cloth and of layers.
std::vector<std::string> mayChange() {
  std::vector<std::string> keys;
  for (const char* name : {"material", "surface_density", "porosity", "row_mass", "column_mass", "shear", "patches",
                           "bending_warp", "bending_weft", "bending_bias", "bending_hysteresis"}) {
    for (const char* of : {"cloth.", "layers[].cloth."}) keys.push_back(std::string(of) + name);
  }
  return keys;
}

std::string layoutOf(Part& part) {
  Archive archive = Archive::describing();
  part.serialize(archive);
  return archive.extractWritten();
}

template <typename Item>
void transfer(Item& from, Item& to) {
  Archive saving = Archive::saving();
  from.serialize(saving);
  const std::string bytes = saving.extractWritten();
  Archive loading = Archive::loading(bytes);
  to.serialize(loading);
  loading.finishLoading();
  loading.commit();
}

}  // namespace

std::unique_ptr<Simulator::Impl> Simulator::Impl::withCloths(const Scene& changed) const {
  auto next = std::make_unique<Impl>(
      changed, [this](std::size_t number, const ObstacleParams&) { return motion.obstacles.sharedShape(number); });
  if (startsElsewhere(scene)) {  // where it is does not depend on the fabric
    next->motion.initial = motion.initial;
    next->reset();
  }
  return next;
}

void Simulator::Impl::continueFrom(Impl& other) {
  other.sleep.wake();
  other.motion.synchronise();
  transfer(other.times, times);
  motion.state = other.motion.state;
  transfer(other.motion.obstacles, motion.obstacles);
  for (std::size_t k = 0; k < motion.parts.all.size(); ++k) {
    Part &from = *other.motion.parts.all[k], &to = *motion.parts.all[k];
    // What only one of both cloths has begins where the cloth is.
    layoutOf(from) == layoutOf(to) ? transfer(from, to) : to.placed(other.motion.state, motion.state);
  }
  motion.statistics = other.motion.statistics;
  motion.counts_work = other.motion.counts_work;
  motion.step.account().restore(other.motion.step.account().work());
  surface.shareTopology(other.surface);
  transfer(other.motion.clock, motion.clock);
  sleep.rest().countOn(other.sleep.rest().wakes());
  if (errors && other.errors) transfer(other.errors->estimate(), errors->estimate());
  keysChanged();
  pinsChanged();
  motion.step.resume(motion.state);
  motion.measureState();
  motion.step.account().leaveOpen();
  if (errors) errors->lose();
  revision = other.revision + 1;
}

std::vector<Problem> Simulator::setCloth(const ClothParams& cloth, const std::string& layer) {
  Scene changed = impl_->scene;
  if (layer == kFirstCloth) {
    changed.cloth = cloth;
  } else {
    const auto found = std::find_if(changed.layers.begin(), changed.layers.end(),
                                    [&](const LayerParams& one) { return one.name == layer; });
    if (found == changed.layers.end())
      return {{"layer", "must be \"cloth\" or the name of a layer, is " + quoted(layer)}};
    found->cloth = cloth;
  }
  std::vector<Problem> problems = validate(changed);
  if (!problems.empty()) return problems;
  const std::string before = writeScene(impl_->scene), after = writeScene(changed);
  if (const auto problem = firstDifference(before, after, mayChange()))
    return {{problem->key, "can't change while it runs: " + problem->text}};
  if (before == after) return {};
  try {
    std::unique_ptr<Impl> next = impl_->withCloths(changed);
    next->continueFrom(*impl_);
    impl_ = std::move(next);
  } catch (const std::invalid_argument& error) {
    return {{"cloth", error.what()}};
  } catch (const ArchiveError& error) {
    return {{"cloth", std::string("can't change: the state is not sound: ") + error.what()}};
  } catch (const std::bad_alloc&) {
    return {{"cloth", "can't change: there is not enough memory"}};
  }
  return {};
}

bool Simulator::Impl::mayBecome(const Scene& other) const {
  return !firstDifference(writeScene(scene), writeScene(other), mayChange());
}

}  // namespace curtain
