// SPDX-License-Identifier: BSD-3-Clause
//
// Binary layout of a snapshot (docs/snapshots.md):
//
//   magic                16 letters
//   byte order           32-bit 0x01020304
//   format version       32-bit
//   number format        64-bit double 0.1
//   length               64-bit, of all of it [bytes]
//   layout               32-bit CRC of names, types and fixed counts of the members
//   length of the scene  32-bit [bytes]
//   scene                YAML text
//   members              as Archive writes them
//   checksum             32-bit CRC of all before it
//
// Numbers in the machine's own format.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "curtain_sim/scene.h"

namespace curtain {

/// To be raised with every change of what is serialized, or of its meaning (checked by
/// test/simulator/snapshot_test.cpp).
constexpr std::uint32_t kSnapshotVersion = 21;

/// Bytes before the scene.
constexpr std::size_t kSnapshotHeader = 48;

struct SnapshotParts {
  std::uint32_t layout = 0;
  std::string_view scene;
  std::string_view state;
};

std::string packSnapshot(const SnapshotParts& parts);

/// What is wrong with a snapshot of `size` bytes that begins with these (kSnapshotHeader bytes, or all); none: it may
/// be valid.
std::optional<Problem> judgeHeader(std::string_view begin, std::uint64_t size);

/// Splits a snapshot, which must outlive the parts; or says what is wrong with it.
std::optional<Problem> unpackSnapshot(std::string_view snapshot, SnapshotParts& parts);

std::uint32_t checksum(std::string_view bytes);

}  // namespace curtain
