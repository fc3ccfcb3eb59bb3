// SPDX-License-Identifier: BSD-3-Clause
//
// What a snapshot looks like from outside (docs/snapshots.md):
//
//   magic                16 letters
//   byte order           32-bit 0x01020304
//   format version       32-bit
//   number format        64-bit double 0.1
//   length               64-bit, of all of it [bytes]
//   layout               32-bit CRC of the list of what is carried
//   length of the scene  32-bit [bytes]
//   scene                YAML text
//   what is carried
//   checksum             32-bit CRC of all before it
//
// Numbers as the machine has them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "curtain_sim/scene.h"

namespace curtain {

/// To be raised with every change of what is carried, or of what it means. test/simulator/snapshot_test.cpp keeps
/// watch.
constexpr std::uint32_t kSnapshotVersion = 5;

/// Bytes that all snapshots begin with, up to the scene.
constexpr std::size_t kSnapshotHeader = 48;

struct SnapshotParts {
  std::uint32_t layout = 0;
  std::string_view scene;
  std::string_view carried;
};

std::string packSnapshot(const SnapshotParts& parts);

/// What is wrong with what begins like this (kSnapshotHeader bytes, fewer where there are no more) and has so many
/// bytes; none: it may be a snapshot.
std::optional<Problem> judgeHeader(std::string_view begin, std::uint64_t size);

/// Takes a snapshot apart, which must outlive the parts; or says what is wrong with it.
std::optional<Problem> unpackSnapshot(std::string_view snapshot, SnapshotParts& parts);

std::uint32_t checksum(std::string_view bytes);

}  // namespace curtain
