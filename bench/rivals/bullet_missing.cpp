// SPDX-License-Identifier: BSD-3-Clause
//
// Stands in for bullet.cpp where Bullet is not installed.
#include "bench/rivals/rivals.h"

namespace curtain_bench {

bool bulletInstalled() { return false; }

std::string bulletDescription() { return "Bullet is not installed (libbullet-dev): btSoftBody takes no part"; }

std::unique_ptr<Contestant> makeBullet(const ClothStart&, const BulletSettings&) { return nullptr; }

}  // namespace curtain_bench
