// SPDX-License-Identifier: BSD-3-Clause
//
// The analytic obstacles, a file each.
#pragma once

#include "contact/shapes/box.h"
#include "contact/shapes/capsule.h"
#include "contact/shapes/cylinder.h"
#include "contact/shapes/plane.h"
#include "contact/shapes/sphere.h"
