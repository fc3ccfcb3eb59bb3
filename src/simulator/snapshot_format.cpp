// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/snapshot_format.h"

#include <zlib.h>

#include <cstring>

namespace curtain {
namespace {

constexpr std::string_view kMagic = "curtain snapshot";
constexpr std::uint32_t kByteOrder = 0x01020304;
constexpr double kNumber = 0.1;

struct Header {
  char magic[16];
  std::uint32_t byte_order;
  std::uint32_t version;
  double number;
  std::uint64_t length;
  std::uint32_t layout;
  std::uint32_t scene_length;
};
static_assert(sizeof(Header) == kSnapshotHeader && sizeof(Header::magic) == kMagic.size());
constexpr std::size_t kChecksum = sizeof(std::uint32_t);

Header headerOf(std::string_view bytes) {
  Header header;
  std::memcpy(&header, bytes.data(), sizeof header);
  return header;
}

Problem problem(const std::string& text) { return {"snapshot", text}; }

}  // namespace

std::uint32_t checksum(std::string_view bytes) {
  const auto* const first = reinterpret_cast<const unsigned char*>(bytes.data());
  return static_cast<std::uint32_t>(crc32_z(crc32_z(0, nullptr, 0), first, bytes.size()));
}

std::string packSnapshot(const SnapshotParts& parts) {
  Header header{
      {}, kByteOrder, kSnapshotVersion, kNumber, 0, parts.layout, static_cast<std::uint32_t>(parts.scene.size())};
  std::memcpy(header.magic, kMagic.data(), kMagic.size());
  header.length = sizeof header + parts.scene.size() + parts.state.size() + kChecksum;
  std::string bytes;
  bytes.reserve(header.length);
  bytes.append(reinterpret_cast<const char*>(&header), sizeof header);
  bytes.append(parts.scene);
  bytes.append(parts.state);
  const std::uint32_t sum = checksum(bytes);
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  return bytes;
}

std::optional<Problem> judgeHeader(std::string_view begin, std::uint64_t size) {
  const std::string_view magic = begin.substr(0, kMagic.size());
  if (magic.empty() || magic != kMagic.substr(0, magic.size())) return problem("is no snapshot of a curtain");
  if (begin.size() < sizeof(Header)) {
    return problem("is cut short: " + std::to_string(size) + " bytes are less than its header");
  }
  const Header header = headerOf(begin);
  if (header.byte_order != kByteOrder || header.number != kNumber) {
    return problem("was written on a machine with other numbers than this one");
  }
  if (header.version != kSnapshotVersion) {
    return problem("has format version " + std::to_string(header.version) + ", this program reads version " +
                   std::to_string(kSnapshotVersion));
  }
  const bool shorter = size < header.length;
  if (size != header.length) {
    return problem(std::string(shorter ? "is cut short: " : "is too long: ") + std::to_string(size) +
                   " bytes instead of " + std::to_string(header.length));
  }
  return std::nullopt;
}

std::optional<Problem> unpackSnapshot(std::string_view snapshot, SnapshotParts& parts) {
  if (auto wrong = judgeHeader(snapshot.substr(0, sizeof(Header)), snapshot.size())) return wrong;
  if (snapshot.size() < sizeof(Header) + kChecksum) return problem("is damaged: it has no checksum");
  const std::string_view summed = snapshot.substr(0, snapshot.size() - kChecksum);
  std::uint32_t sum = 0;
  std::memcpy(&sum, snapshot.data() + summed.size(), sizeof sum);
  if (sum != checksum(summed)) return problem("is damaged: its checksum is wrong");
  const Header header = headerOf(snapshot);
  const std::string_view rest = summed.substr(sizeof(Header));
  if (header.scene_length > rest.size()) return problem("is damaged: its scene ends beyond it");
  parts = {header.layout, rest.substr(0, header.scene_length), rest.substr(header.scene_length)};
  return std::nullopt;
}

}  // namespace curtain
