// SPDX-License-Identifier: BSD-3-Clause
//
// What acts for a time and has an id: winds, drags.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/ranges.h"

namespace curtain {

/// The one with this id; null: there is none.
template <typename Params>
const Params* findById(const std::vector<Params>& all, const std::string& id) {
  const auto found = std::find_if(all.begin(), all.end(), [&id](const Params& one) { return one.id == id; });
  return found == all.end() ? nullptr : &*found;
}

/// Where that is in the list.
template <typename Params>
std::optional<std::size_t> placeOf(const std::vector<Params>& all, const std::string& id) {
  const Params* const found = findById(all, id);
  return found == nullptr ? std::nullopt : std::optional<std::size_t>(found - all.data());
}

template <typename Params>
bool actsAt(const Params& source, double time) {
  return source.start <= time && time < source.end;
}

/// It begins or ends within [from, to]. An event on the border of two frames belongs to both, whatever the rounding.
template <typename Params>
bool changesWithin(const Params& source, double from, double to) {
  constexpr double kTimeRounding = 1e-9;  // [s]
  const auto within = [&](double time) { return time >= from - kTimeRounding && time <= to + kTimeRounding; };
  return within(source.start) || within(source.end);
}

/// Why it does not act at this time; empty: it does.
template <typename Params>
std::string whyNotAt(const Params& source, double time) {
  if (time < source.start) return "begins at " + formatNumber(source.start) + " s";
  return time >= source.end ? "ended at " + formatNumber(source.end) + " s" : "";
}

/// Sources of one kind, and their parameters in the same order.
template <typename Source, typename Params>
struct Sources {
  std::vector<Source> list;
  std::vector<Params> params;

  /// Adds the source, or replaces the one with its id.
  void put(Source source) {
    const std::size_t at = placeOf(params, source.params().id).value_or(list.size());
    params.resize(std::max(params.size(), at + 1));
    params[at] = source.params();
    if (at == list.size())
      list.push_back(std::move(source));
    else
      list[at] = std::move(source);
  }
  /// False: there is none.
  bool remove(const std::string& id) {
    const auto at = placeOf(params, id);
    if (!at) return false;
    params.erase(params.begin() + static_cast<std::ptrdiff_t>(*at));
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(*at));
    return true;
  }
};

}  // namespace curtain
