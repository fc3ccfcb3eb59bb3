// SPDX-License-Identifier: BSD-3-Clause
//
// Serialization of members for snapshots. A class lists its members once,
//
//     void serialize(Archive& archive);
//
// and the same list saves, loads and describes them, so loading matches saving. Loading trusts no input: counts must
// match the object, or bytes for each item must follow; indices and loop bounds are range-checked. It changes nothing
// before commit(), which can't fail, so a bad snapshot leaves the object as it was.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// The data cannot have been saved by this object; says where and why.
class ArchiveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Not thread-safe. Numbers are in the machine's own format.
class Archive {
 public:
  static Archive saving() { return Archive(Way::kSave, {}); }
  /// bytes must outlive it.
  static Archive loading(std::string_view bytes) { return Archive(Way::kLoad, bytes); }
  /// Neither saves nor loads: lists names, types and fixed counts.
  static Archive describing() { return Archive(Way::kDescribe, {}); }

  bool loads() const noexcept { return way_ == Way::kLoad; }
  /// The saved bytes, or the description, one line a member.
  std::string extractWritten() noexcept { return std::move(out_); }
  /// Throws ArchiveError when not all bytes were read.
  void finishLoading() const;
  /// Assigns the loaded values to the members.
  void commit() noexcept;

  /// Any numbers, including NaN and infinity.
  void number(const char* name, double& value);
  void numbers(const char* name, Vec3& value);
  void numbers(const char* name, Eigen::AlignedBox3d& box);
  void numbers(const char* name, Field& values);
  void numbers(const char* name, Field3& values);
  void numbers(const char* name, std::vector<double>& values);

  /// Finite numbers.
  void finite(const char* name, double& value);
  void finite(const char* name, Vec3& value);
  void finite(const char* name, Eigen::Matrix3d& value);
  void finite(const char* name, Field3& values);
  void finite(const char* name, std::vector<double>& values);
  void finite(const char* name, Pose& pose);

  /// In [low, high], which may be infinite.
  void within(const char* name, double& value, double low, double high);
  template <typename Integer>
  void integer(const char* name, Integer& value, std::int64_t low, std::int64_t high);
  void flag(const char* name, bool& value);
  /// 0 or 1 each.
  void flags(const char* name, std::vector<std::uint8_t>& values);
  void text(const char* name, std::string& value);

  /// Index of a node of the grid, not of padding.
  template <typename Integer>
  void node(const char* name, Integer& index, const Grid& grid);
  void node(const char* name, NodeIndex& index, const Grid& grid);

  /// A value that the object fixes: it is saved, and loading another one fails with `why`.
  void same(const char* name, std::uint64_t value, const std::string& why);

  /// serialize(item) for every item of a list of any length; its capacity stays. Returns the number of items.
  template <typename Item, typename Serialize>
  std::size_t list(const char* name, std::vector<Item>& items, const Serialize& serialize);
  /// blank: what serialize(item) loads into.
  template <typename Item, typename Serialize>
  void optional(const char* name, std::optional<Item>& item, const Item& blank, const Serialize& serialize);

  /// Groups what serialize() lists under a name.
  template <typename Serialize>
  void group(const char* name, const Serialize& serialize);
  /// object.serialize(archive) under a name.
  template <typename Object>
  void part(const char* name, Object& object) {
    group(name, [&] { object.serialize(*this); });
  }

  /// Values that serialize() loads are assigned at once, not by commit(): for local variables.
  template <typename Serialize>
  void atOnce(const Serialize& serialize);
  /// When loading: assigns the value to the member, with commit().
  template <typename T>
  void put(T& member, T value);

  /// When loading: throws ArchiveError if it does not hold.
  void require(bool holds, const char* text) const {
    if (loads() && !holds) fail(text);
  }
  [[noreturn]] void fail(const std::string& text) const;

 private:
  enum class Way { kSave, kLoad, kDescribe };
  struct Step {
    const char* name;
    std::size_t index;  // of a list's item
  };
  static constexpr std::size_t kNoIndex = ~std::size_t{0};
  // Appends a name to the path while it exists.
  class Naming {
   public:
    Naming(Archive& archive, const char* name) : path_(archive.path_) { path_.push_back({name, kNoIndex}); }
    ~Naming() { path_.pop_back(); }
    Naming(const Naming&) = delete;
    Naming& operator=(const Naming&) = delete;

   private:
    std::vector<Step>& path_;
  };

  Archive(Way way, std::string_view bytes) : way_(way), in_(bytes) {}

  std::string pathText() const;
  void describe(const std::string& type);
  void write(const void* from, std::size_t bytes);
  void read(void* to, std::size_t bytes);
  void integerOf(const char* name, std::int64_t& value, std::int64_t low, std::int64_t high);
  std::size_t countOf(std::size_t count);
  template <typename T, typename Check>
  void one(const char* name, const char* type, T& value, const Check& check);
  template <typename Values, typename Check>
  void many(const char* name, const char* type, Values& values, const Check& check);

  Way way_;
  std::string_view in_;
  std::size_t at_ = 0;
  std::string out_;
  std::vector<Step> path_;
  bool at_once_ = false;
  std::vector<std::function<void()>> pending_;
};

template <typename T>
void Archive::put(T& member, T value) {
  if (!loads()) return;
  if (at_once_) {
    member = std::move(value);
  } else {
    pending_.push_back([&member, taken = std::move(value)]() mutable { member = std::move(taken); });
  }
}

template <typename Integer>
void Archive::integer(const char* name, Integer& value, std::int64_t low, std::int64_t high) {
  auto wide = static_cast<std::int64_t>(value);
  integerOf(name, wide, low, high);
  put(value, static_cast<Integer>(wide));
}

template <typename Integer>
void Archive::node(const char* name, Integer& index, const Grid& grid) {
  auto wide = static_cast<std::int64_t>(index);
  integerOf(name, wide, 0, static_cast<std::int64_t>(grid.size()) - 1);
  if (loads() && wide % grid.stride >= grid.columns) fail(std::string(name) + " is no node of the cloth");
  put(index, static_cast<Integer>(wide));
}

template <typename Serialize>
void Archive::group(const char* name, const Serialize& serialize) {
  const Naming naming(*this, name);
  serialize();
}

template <typename Serialize>
void Archive::atOnce(const Serialize& serialize) {
  const bool before = std::exchange(at_once_, true);
  serialize();
  at_once_ = before;
}

template <typename Item, typename Serialize>
std::size_t Archive::list(const char* name, std::vector<Item>& items, const Serialize& serialize) {
  const Naming naming(*this, name);
  if (way_ == Way::kDescribe) {
    describe("list of");
    Item item{};
    serialize(item);
    return 0;
  }
  const std::size_t count = countOf(items.size());
  if (way_ == Way::kSave) {
    for (Item& item : items) serialize(item);
    return count;
  }
  // Not resized to count, which can't be trusted: it grows while there are bytes.
  std::vector<Item> loaded;
  loaded.reserve(items.capacity());
  atOnce([&] {
    for (path_.back().index = 0; path_.back().index < count; ++path_.back().index) {
      const std::size_t before = at_;
      Item item{};
      serialize(item);
      if (at_ == before) fail("has items of nothing");
      loaded.push_back(std::move(item));
    }
  });
  path_.back().index = kNoIndex;
  put(items, std::move(loaded));
  return count;
}

template <typename Item, typename Serialize>
void Archive::optional(const char* name, std::optional<Item>& item, const Item& blank, const Serialize& serialize) {
  const Naming naming(*this, name);
  Item taken = item.value_or(blank);
  bool there = item.has_value();
  atOnce([&] {
    flag("there", there);
    if (there || way_ == Way::kDescribe) serialize(taken);
  });
  put(item, there ? std::optional<Item>(taken) : std::nullopt);
}

}  // namespace curtain
