// SPDX-License-Identifier: BSD-3-Clause
//
// The analytic obstacles, a file each.
#pragma once

#include "obstacles/box.h"
#include "obstacles/capsule.h"
#include "obstacles/cylinder.h"
#include "obstacles/plane.h"
#include "obstacles/sphere.h"
