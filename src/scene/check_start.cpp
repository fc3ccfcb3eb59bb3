// SPDX-License-Identifier: BSD-3-Clause
//
// Checks that the links can have their lengths where `hang` puts the cloth. Flat cloth hangs from a straight line, as a
// fan where it narrows (scene/fan.h); closed cloth starts as a cone around the vertical:
//
//        r_0 ______                  row i, at s_i along the warp, is a ring of radius r_0 + s_i sin(tilt);
//           /      |                 the chord between neighbours must not be longer than their weft link.
//      s_i /  tilt |
#include <algorithm>
#include <cmath>

#include "scene/checks.h"
#include "scene/fan.h"
#include "scene/heading.h"
#include "scene/names.h"
#include "scene/pi.h"
#include "scene/range_checker.h"
#include "scene/ranges.h"
#include "scene/ring_start.h"
#include "scene/shares.h"
#include "scene/strips.h"

namespace curtain {
namespace {

constexpr double kMaxGap = 1e-6;  // of the width, between an edge in pleats and its end

bool clothIsGood(const ClothParams& cloth, const ProblemLog& log) {
  for (const char* key : {"cloth.closed", "cloth.rows", "cloth.columns", "cloth.height", "cloth.width",
                          "cloth.hem_width", "cloth.row_spacing", "cloth.column_spacing"}) {
    if (!log.good(key)) return false;
  }
  // The log may hold a problem of a map above these keys, and what follows divides by them.
  return cloth.rows >= 2 && cloth.columns >= 2;
}

// Each strip's neighbours hang on the same line, and must not reach each other.
void checkOverlap(const Scene& scene, ProblemLog& log) {
  const ClothParams& cloth = scene.cloth;
  const std::vector<int> strips = stripNumbers(cloth);
  if (cloth.closed || strips.back() == 0 || isPleated(scene.hang)) {
    log.add("hang.overlap", "is for flat cloth with slits from row 0 on (cloth.slits), and without a heading");
    return;
  }
  const std::vector<double> links = edgeLinks(cloth);
  std::vector<double> widths(static_cast<std::size_t>(strips.back()) + 1, 0.0);
  for (std::size_t j = 0; j < links.size(); ++j) {
    if (strips[j] == strips[j + 1]) widths[static_cast<std::size_t>(strips[j])] += links[j];
  }
  const double most = 0.5 * *std::min_element(widths.begin(), widths.end());
  if (!(*scene.hang.overlap < most))
    log.add("hang.overlap", "must be less than half of the narrowest strip's width, " + formatNumber(most) + " m, is " +
                                formatNumber(*scene.hang.overlap));
}

// The narrowest hem, up to a thousandth, that flat cloth can have where the hung edge is as wide as `span` [m].
double narrowestHem(Scene scene, double span) {
  double least = hemWidth(scene.cloth), most = std::max(least, scene.cloth.width);
  while (most - least > 1e-3 * most) {
    scene.cloth.hem_width = 0.5 * (least + most);
    (startingHem(scene, span) ? most : least) = *scene.cloth.hem_width;
  }
  return most;
}

void checkFlat(const Scene& scene, ProblemLog& log) {
  const ClothParams& cloth = scene.cloth;
  const HangParams& hang = scene.hang;
  const double span = (hang.to - hang.from).norm();
  const std::string line = "from " + formatVector(hang.from) + " to " + formatVector(hang.to);
  if (!(span > 0.0)) {
    log.add("hang.to", "must differ from hang.from, is " + formatVector(hang.to));
    return;
  }
  const double longest = longestEdge(scene);
  const bool hangs = !hang.start.over;  // of laid cloth the line gives a direction alone
  if (hangs && !(span <= longest * (1.0 + kTypedRounding))) {
    const std::string limit = scene.hang.overlap ? "the overlapping strips reach, " : "cloth.width = ";
    log.add("hang.to", "must be no further from hang.from than " + limit + formatNumber(longest) + " m, is " +
                           formatNumber(span) + " m away (" + line + ")");
    return;
  }
  if (hang.fullness && std::abs(*hang.fullness * span - cloth.width) > kTypedRounding * cloth.width) {
    log.add("hang.fullness", "must be cloth.width / |to - from| = " + formatNumber(cloth.width / span) + ", is " +
                                 formatNumber(*hang.fullness) + "; give one of the two keys");
  }
  const double hung = hangs ? std::min(span, longest) : longest;
  if (startingHem(scene, hung)) return;
  log.add("cloth.hem_width", "must be at least " + formatNumber(narrowestHem(scene, hung)) + " m, is " +
                                 formatNumber(hemWidth(cloth)) + ": the cloth hangs along a straight line of " +
                                 formatNumber(hung) + " m and is " + formatNumber(cloth.height) +
                                 " m high, and its wefts would start longer than they are");
}

void checkHeading(const Scene& scene, ProblemLog& log) {
  const HangParams& hang = scene.hang;
  const ClothParams& cloth = scene.cloth;
  if (cloth.closed && hang.fullness) log.add("hang.fullness", "is not for closed cloth (cloth.closed: true)");
  if (!isPleated(hang)) return;
  const std::string name = headingNames()[static_cast<std::size_t>(hang.heading)];
  const std::string is = ", is " + name;
  if (cloth.closed) log.add("hang.heading", "must be gathered with closed cloth (cloth.closed: true)" + is);
  // The pleats go straight down.
  if (std::abs(hemWidth(cloth) - cloth.width) > kTypedRounding * cloth.width)
    log.add("hang.heading", "must be gathered with tapered cloth (hem_width)" + is);
  const int links = cloth.columns - 1, fewest = fewestLinks(hang.heading);
  const int pleats = pleatCount(hang, links);
  if (!cloth.closed && links < pleats * fewest) {
    const bool given = hang.pleats > 0;
    log.add(given ? "hang.pleats" : "hang.heading", "must leave each pleat of heading " + name + " " +
                                                        std::to_string(fewest) + " weft links, there are " +
                                                        std::to_string(links) + " for " + std::to_string(pleats));
  }
  const double span = (hang.to - hang.from).norm();
  constexpr double kFullest = 3.0;  // beyond, the wave's neighbours come close to each other
  if (!cloth.closed && span > 0.0 && cloth.width > kFullest * (1.0 + kTypedRounding) * span) {
    log.add("hang.heading", "must be gathered where cloth.width is more than three times |to - from|" + is + " at " +
                                formatNumber(cloth.width / span) + " times");
  }
  if (!log.problems().empty() || !(span > 0.0)) return;
  // A link that is long beside the others can't be turned out of the way.
  const std::vector<double> row = pleatLinks(cloth), angles = headingAngles(hang, row, span);
  double reach = 0.0;
  for (std::size_t j = 0; j < row.size(); ++j) reach += row[j] * std::cos(angles[j]);
  if (std::min(cloth.width, hemWidth(cloth)) > span && std::abs(reach - span) > kMaxGap * cloth.width)
    log.add("hang.heading", "must be gathered where pleats of these links reach " + formatNumber(reach) +
                                " m at least, and |to - from| is " + formatNumber(span) + " m" + is);
}

// The rest turn of a joint has a cosine, which its stiffness is multiplied by.
void checkPressed(const Scene& scene, ProblemLog& log) {
  const HangParams& hang = scene.hang;
  if (!(hang.pressed > 0.0)) return;
  if (!isPleated(hang)) {
    log.add("hang.pressed", "must be 0 without pleats (hang.heading: gathered), is " + formatNumber(hang.pressed));
    return;
  }
  if (!(scene.cloth.bending_weft > 0.0)) {
    log.add("hang.pressed",
            "must be 0 for cloth that does not bend (cloth.bending_weft: 0), is " + formatNumber(hang.pressed));
    return;
  }
  const std::vector<double> angles = headingAngles(hang, pleatLinks(scene.cloth), (hang.to - hang.from).norm());
  double most = 0.0;
  for (std::size_t j = 1; j < angles.size(); ++j) most = std::max(most, std::abs(angles[j] - angles[j - 1]));
  constexpr double kMost = 80.0 * kPi / 180.0;  // 1/cos < 6
  if (most > kMost)
    log.add("hang.pressed", "must be 0 where pleats turn by more than 80 degrees from link to link, here " +
                                formatNumber(most * 180.0 / kPi) + ": give the cloth more columns, or fewer pleats");
}

void checkRing(const Scene& scene, ProblemLog& log) {
  const ClothParams& cloth = scene.cloth;
  const double top_radius = typedRadius(scene);
  const double slope = std::sin(scene.hang.tilt);
  const std::vector<double> rods = shareOut(1.0, cloth.row_spacing, cloth.rows - 1);
  const std::vector<double> links = shareOut(1.0, cloth.column_spacing, cloth.columns);
  double down = 0.0;
  for (int i = 0; i < cloth.rows; ++i) {
    if (i > 0) down += rods[static_cast<std::size_t>(i - 1)];
    const double radius = top_radius + down * cloth.height * slope;
    const double width = rowWidth(cloth, down);
    const std::string key = i == 0 ? "hang.radius" : "hang.tilt";
    const std::string is = i == 0 ? formatNumber(top_radius) : formatNumber(scene.hang.tilt);
    if (!(radius > 0.0)) {
      log.add(key, "must leave every row a ring of radius > 0, is " + is + ": row " + std::to_string(i) +
                       " would have radius " + formatNumber(radius) + " m");
      return;
    }
    for (std::size_t j = 0; j < links.size(); ++j) {
      const double chord = 2.0 * radius * std::sin(kPi * links[j]);
      if (chord <= width * links[j] * (1.0 + kTypedRounding)) continue;
      log.add(key, "must not start weft links longer than they are, is " + is + ": in row " + std::to_string(i) +
                       " (radius " + formatNumber(radius) + " m) link " + std::to_string(j) + " would be " +
                       formatNumber(chord) + " m long, at most " + formatNumber(width * links[j]) + " m are allowed");
      return;
    }
  }
  const double drawn_in = hungRadius(scene) + std::min(0.0, cloth.height * slope);
  if (!(drawn_in > 0.0))
    log.add("hang.tilt", "must leave every row a ring of radius > 0, is " + formatNumber(scene.hang.tilt) +
                             ": the narrowest would have radius " + formatNumber(drawn_in) + " m");
}

}  // namespace

void checkStart(const Scene& scene, ProblemLog& log) {
  if (!scene.cloth.closed && scene.hang.radius && log.good("cloth.closed")) {
    log.add("hang.radius", "is for closed cloth only (cloth.closed: true), is " + formatNumber(*scene.hang.radius));
  }
  if (!clothIsGood(scene.cloth, log)) return;
  if (log.good("hang.heading") && log.good("hang.pleats") && log.good("hang.fullness")) checkHeading(scene, log);
  if (scene.hang.overlap && log.good("hang.overlap") && log.good("hang.heading") && log.good("cloth.slits")) {
    checkOverlap(scene, log);
    if (!log.good("hang.overlap")) return;
  }
  if (scene.cloth.closed) {
    if (log.good("hang.radius") && log.good("hang.tilt")) checkRing(scene, log);
  } else if (log.good("hang.from") && log.good("hang.to")) {
    checkFlat(scene, log);
  }
  if (log.problems().empty()) checkPressed(scene, log);
}

}  // namespace curtain
