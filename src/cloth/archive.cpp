// SPDX-License-Identifier: BSD-3-Clause
#include "cloth/archive.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

namespace curtain {
namespace {

const auto anything = [](const auto&) { return true; };

bool isFinite(double value) { return std::isfinite(value); }
template <typename Matrix>
bool allFinite(const Matrix& value) {
  return value.allFinite();
}
bool isFlag(std::uint8_t value) { return value <= 1; }

}  // namespace

std::string Archive::pathText() const {
  std::string text;
  for (const Step& step : path_) {
    if (!text.empty()) text += '.';
    text += step.name;
    if (step.index != kNoIndex) text += '[' + std::to_string(step.index) + ']';
  }
  return text;
}

void Archive::fail(const std::string& text) const { throw ArchiveError(pathText() + ": " + text); }

void Archive::describe(const std::string& type) { out_ += pathText() + ' ' + type + '\n'; }

void Archive::write(const void* from, std::size_t bytes) {
  if (bytes > 0) out_.append(static_cast<const char*>(from), bytes);
}

void Archive::read(void* to, std::size_t bytes) {
  if (bytes > in_.size() - at_) fail("ends too soon");
  if (bytes == 0) return;  // an empty list may have a null pointer
  std::memcpy(to, in_.data() + at_, bytes);
  at_ += bytes;
}

std::size_t Archive::countOf(std::size_t count) {
  auto value = static_cast<std::uint64_t>(count);
  if (way_ == Way::kSave) write(&value, sizeof value);
  if (way_ != Way::kLoad) return count;
  read(&value, sizeof value);
  if (value > in_.size() - at_) fail("has " + std::to_string(value) + " items, more than there are bytes for");
  return static_cast<std::size_t>(value);
}

void Archive::finishLoading() const {
  if (at_ != in_.size()) fail(std::to_string(in_.size() - at_) + " bytes too many");
}

void Archive::commit() noexcept {
  for (const std::function<void()>& take : pending_) take();
  pending_.clear();
}

// A value of fixed size.
template <typename T, typename Check>
void Archive::one(const char* name, const char* type, T& value, const Check& check) {
  const Naming naming(*this, name);
  if (way_ == Way::kDescribe) describe(type);
  if (way_ == Way::kSave) write(&value, sizeof value);
  if (way_ != Way::kLoad) return;
  T taken = value;
  read(static_cast<void*>(&taken), sizeof taken);
  if (!check(taken)) fail(std::string("must be ") + type);
  put(value, taken);
}

// A list whose size is fixed by the object.
template <typename Values, typename Check>
void Archive::many(const char* name, const char* type, Values& values, const Check& check) {
  const Naming naming(*this, name);
  using Value = typename Values::value_type;
  const std::size_t bytes = values.size() * sizeof(Value);
  if (way_ == Way::kDescribe) describe(std::string(type) + " x " + std::to_string(values.size()));
  const std::size_t count = countOf(values.size());
  if (way_ == Way::kSave) write(values.data(), bytes);
  if (way_ != Way::kLoad) return;
  if (count != values.size())
    fail("must be " + std::to_string(values.size()) + " numbers, is " + std::to_string(count));
  Values taken(values.size());
  read(taken.data(), bytes);
  for (const Value value : taken) {
    if (!check(value)) fail(std::string("must be ") + type);
  }
  put(values, std::move(taken));
}

void Archive::number(const char* name, double& value) { one(name, "number", value, anything); }
void Archive::numbers(const char* name, Vec3& value) { one(name, "vector", value, anything); }
void Archive::numbers(const char* name, Eigen::AlignedBox3d& box) { one(name, "box", box, anything); }
void Archive::numbers(const char* name, Field& values) { many(name, "numbers", values, anything); }
void Archive::numbers(const char* name, std::vector<double>& values) { many(name, "numbers", values, anything); }
void Archive::numbers(const char* name, Field3& values) {
  const Naming naming(*this, name);
  numbers("x", values.x);
  numbers("y", values.y);
  numbers("z", values.z);
}

void Archive::finite(const char* name, double& value) { one(name, "a finite number", value, isFinite); }
void Archive::finite(const char* name, Vec3& value) { one(name, "a finite vector", value, allFinite<Vec3>); }
void Archive::finite(const char* name, Eigen::Matrix3d& value) {
  one(name, "a finite matrix", value, allFinite<Eigen::Matrix3d>);
}
void Archive::finite(const char* name, Field3& values) {
  const Naming naming(*this, name);
  many("x", "finite numbers", values.x, isFinite);
  many("y", "finite numbers", values.y, isFinite);
  many("z", "finite numbers", values.z, isFinite);
}
void Archive::finite(const char* name, std::vector<double>& values) { many(name, "finite numbers", values, isFinite); }
void Archive::finite(const char* name, Pose& pose) {
  const Naming naming(*this, name);
  finite("position", pose.position);
  one("orientation", "a finite quaternion", pose.orientation,
      [](const Rotation& value) { return value.coeffs().allFinite(); });
}

void Archive::within(const char* name, double& value, double low, double high) {
  const auto inside = [=](double taken) {
    if (taken >= low && taken <= high) return true;
    std::ostringstream text;
    text << "must be a number in [" << low << ", " << high << "], is " << taken;
    fail(text.str());
  };
  one(name, "a number in a range", value, inside);
}

void Archive::integerOf(const char* name, std::int64_t& value, std::int64_t low, std::int64_t high) {
  const auto inside = [=](std::int64_t taken) {
    if (taken >= low && taken <= high) return true;
    fail("must be an integer in [" + std::to_string(low) + ", " + std::to_string(high) + "], is " +
         std::to_string(taken));
  };
  atOnce([&] { one(name, "an integer in a range", value, inside); });
}

void Archive::flag(const char* name, bool& value) {
  auto byte = static_cast<std::uint8_t>(value ? 1 : 0);
  atOnce([&] { one(name, "a flag", byte, isFlag); });
  put(value, byte != 0);
}

void Archive::flags(const char* name, std::vector<std::uint8_t>& values) { many(name, "flags", values, isFlag); }

void Archive::text(const char* name, std::string& value) {
  const Naming naming(*this, name);
  if (way_ == Way::kDescribe) {
    describe("text");
    return;
  }
  const std::size_t count = countOf(value.size());
  if (way_ == Way::kSave) write(value.data(), count);
  if (way_ != Way::kLoad) return;
  std::string taken(count, '\0');
  read(taken.data(), count);
  put(value, std::move(taken));
}

void Archive::node(const char* name, NodeIndex& index, const Grid& grid) {
  const Naming naming(*this, name);
  integer("row", index.row, 0, grid.rows - 1);
  integer("column", index.column, 0, grid.columns - 1);
}

void Archive::same(const char* name, std::uint64_t value, const std::string& why) {
  const std::uint64_t own = value;
  atOnce([&] { one(name, "what it is already", value, anything); });
  if (value != own) fail(why);
}

}  // namespace curtain
