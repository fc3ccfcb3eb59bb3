// SPDX-License-Identifier: BSD-3-Clause
//
// Lines whose nodes give way: the moments of kLane lines side by side, by elimination of the symmetric matrix
// 1/k + C D C^T (L D L^T without pivoting, which positive definite matrices do not need). It couples a joint with the
// next two. Of a closed line the last two joints are a border that is eliminated last.
#include "cloth/wide.h"
#include "parts/bending/bending_lines.h"

namespace curtain {
namespace {

// Eight lines: node i of lane j is at first + i * stride + j.
struct Bundle {
  const double *x, *y, *z, *give, *per_rest, *compliance;
  BendingScratch& scratch;
  std::size_t first, stride;
  int count;  // nodes of a line
  bool closed;

  std::size_t at(int i) const { return first + static_cast<std::size_t>(i) * stride; }
  int wrapped(int i) const { return i < 0 ? i + count : i < count ? i : i - count; }
  std::size_t around(int i) const { return at(wrapped(i)); }
};

using Lanes = double[kLane];

// Entries of the matrix: of joint i with itself, with the next joint, and with the one after that.
struct Entries {
  Lanes own, next, after;
};

CURTAIN_INTO_WIDE void setEntries(const Bundle& b, int i, Entries& e) {
  const double* const a = b.per_rest;
  const double* const d = b.give;
  const std::size_t before = b.around(i - 1), here = b.around(i), one = b.around(i + 1), two = b.around(i + 2);
#pragma omp simd
  for (std::size_t j = 0; j < kLane; ++j) {
    const double a0 = a[here + j], a1 = a[one + j], a2 = a[two + j];
    const double turn = (a0 + a1) * d[here + j], reach = a1 * d[one + j];
    e.own[j] = b.compliance[here + j] + a0 * a0 * d[before + j] + (a0 + a1) * turn + a1 * reach;
    e.next[j] = -(a1 * turn + (a1 + a2) * reach);
    e.after[j] = a2 * reach;
  }
}

// The turns C x of joint i.
CURTAIN_INTO_WIDE void setTurn(const Bundle& b, int i, Lanes& x, Lanes& y, Lanes& z) {
  const std::size_t before = b.around(i - 1), here = b.around(i), one = b.around(i + 1);
  const double* const a = b.per_rest;
#pragma omp simd
  for (std::size_t j = 0; j < kLane; ++j) {
    const double a0 = a[here + j], a1 = a[one + j];
    x[j] = a1 * (b.x[one + j] - b.x[here + j]) - a0 * (b.x[here + j] - b.x[before + j]);
    y[j] = a1 * (b.y[one + j] - b.y[here + j]) - a0 * (b.y[here + j] - b.y[before + j]);
    z[j] = a1 * (b.z[one + j] - b.z[here + j]) - a0 * (b.z[here + j] - b.z[before + j]);
  }
}

// The last two joints of a closed line: their matrix, right-hand sides, and moments.
struct Border {
  Lanes pp, pq, qq, px, py, pz, qx, qy, qz;
};

// Rows of the matrix in their order; near and far are the entries left of joints i+1 and i+2, pivot the inverse. Joints
// that are missing have an infinite entry, so 0.
template <bool kClosed>
CURTAIN_INTO_WIDE void eliminate(const Bundle& b, Border& border) {
  BendingScratch& s = b.scratch;
  const int end = kClosed ? b.count - 2 : b.count - 1;
  Lanes near_before = {}, far_before = {}, far_two = {};       // u_(i-1), v_(i-1), v_(i-2), over their pivots
  Lanes near_raw = {}, far_raw = {}, far_raw_two = {};         // the same before division
  Lanes p_before = {}, p_two = {}, q_before = {}, q_two = {};  // border entries of the last two rows
  Lanes x1 = {}, y1 = {}, z1 = {}, x2 = {}, y2 = {}, z2 = {};  // their right-hand sides
  Entries e;
  Lanes x, y, z;
  for (int i = kClosed ? 0 : 1; i < end; ++i) {
    setEntries(b, i, e);
    setTurn(b, i, x, y, z);
    const double has_next = i + 1 < end ? 1.0 : 0.0, has_after = i + 2 < end ? 1.0 : 0.0;
    const std::size_t n = b.at(i);
    Lanes p = {}, q = {};
    if (kClosed) {
      Entries back;  // of the border's own rows, with this one
      for (std::size_t j = 0; j < kLane; ++j) {
        if (i + 1 == end) p[j] += e.next[j], q[j] += e.after[j];
        if (i + 2 == end) p[j] += e.after[j];
      }
      if (i == 0) {
        setEntries(b, b.count - 2, back);
        for (std::size_t j = 0; j < kLane; ++j) p[j] += back.after[j];
        setEntries(b, b.count - 1, back);
        for (std::size_t j = 0; j < kLane; ++j) q[j] += back.next[j];
      }
      if (i == 1) {
        setEntries(b, b.count - 1, back);
        for (std::size_t j = 0; j < kLane; ++j) q[j] += back.after[j];
      }
    }
#pragma omp simd
    for (std::size_t j = 0; j < kLane; ++j) {
      const double u = near_before[j], v = far_two[j];
      const double inverse = 1.0 / (e.own[j] - u * near_raw[j] - v * far_raw_two[j]);
      const double near = has_next * (e.next[j] - u * far_raw[j]), far = has_after * e.after[j];
      x[j] -= u * x1[j] + v * x2[j];
      y[j] -= u * y1[j] + v * y2[j];
      z[j] -= u * z1[j] + v * z2[j];
      if (kClosed) {
        p[j] -= u * p_before[j] + v * p_two[j];
        q[j] -= u * q_before[j] + v * q_two[j];
        border.pp[j] -= inverse * p[j] * p[j];
        border.pq[j] -= inverse * p[j] * q[j];
        border.qq[j] -= inverse * q[j] * q[j];
        border.px[j] -= inverse * p[j] * x[j], border.py[j] -= inverse * p[j] * y[j];
        border.pz[j] -= inverse * p[j] * z[j], border.qx[j] -= inverse * q[j] * x[j];
        border.qy[j] -= inverse * q[j] * y[j], border.qz[j] -= inverse * q[j] * z[j];
        s.border[n + j] = inverse * p[j];
        s.last[n + j] = inverse * q[j];
        p_two[j] = p_before[j], p_before[j] = p[j];
        q_two[j] = q_before[j], q_before[j] = q[j];
      }
      far_two[j] = far_before[j];
      far_raw_two[j] = far_raw[j];
      near_raw[j] = near;
      far_raw[j] = far;
      s.near[n + j] = near_before[j] = near * inverse;
      s.far[n + j] = far_before[j] = far * inverse;
      s.mx[n + j] = x[j] * inverse;
      s.my[n + j] = y[j] * inverse;
      s.mz[n + j] = z[j] * inverse;
      x2[j] = x1[j], x1[j] = x[j];
      y2[j] = y1[j], y1[j] = y[j];
      z2[j] = z1[j], z1[j] = z[j];
    }
  }
}

// The border before the elimination. With three nodes the last joint's second neighbour is the one before it.
CURTAIN_INTO_WIDE void beginBorder(const Bundle& b, Border& border) {
  Entries p, q;
  setEntries(b, b.count - 2, p);
  setEntries(b, b.count - 1, q);
  setTurn(b, b.count - 2, border.px, border.py, border.pz);
  setTurn(b, b.count - 1, border.qx, border.qy, border.qz);
  for (std::size_t j = 0; j < kLane; ++j) {
    border.pp[j] = p.own[j];
    border.qq[j] = q.own[j];
    border.pq[j] = p.next[j] + (b.count == 3 ? q.after[j] : 0.0);
  }
}

// A border joint without stiffness has an infinite pivot, and no moment.
CURTAIN_INTO_WIDE void solveBorder(const Bundle& b, Border& border) {
  BendingScratch& s = b.scratch;
  const std::size_t p = b.at(b.count - 2), q = b.at(b.count - 1);
  for (std::size_t j = 0; j < kLane; ++j) {
    const double inverse = 1.0 / border.pp[j], share = inverse * border.pq[j];
    const double last = 1.0 / (border.qq[j] - share * border.pq[j]);
    const auto solve = [&](double rp, double rq, double& mp, double& mq) {
      mq = last * (rq - share * rp);
      mp = inverse * rp - share * mq;
    };
    solve(border.px[j], border.qx[j], s.mx[p + j], s.mx[q + j]);
    solve(border.py[j], border.qy[j], s.my[p + j], s.my[q + j]);
    solve(border.pz[j], border.qz[j], s.mz[p + j], s.mz[q + j]);
  }
}

template <bool kClosed>
CURTAIN_INTO_WIDE void substitute(const Bundle& b) {
  BendingScratch& s = b.scratch;
  const int end = kClosed ? b.count - 2 : b.count - 1;
  const std::size_t p = b.at(b.count - 2), q = b.at(b.count - 1);
  Lanes x1 = {}, y1 = {}, z1 = {}, x2 = {}, y2 = {}, z2 = {};
  for (int i = end - 1; i >= (kClosed ? 0 : 1); --i) {
    const std::size_t n = b.at(i);
#pragma omp simd
    for (std::size_t j = 0; j < kLane; ++j) {
      const double u = s.near[n + j], v = s.far[n + j];
      double x = s.mx[n + j] - u * x1[j] - v * x2[j];
      double y = s.my[n + j] - u * y1[j] - v * y2[j];
      double z = s.mz[n + j] - u * z1[j] - v * z2[j];
      if (kClosed) {
        const double of_p = s.border[n + j], of_q = s.last[n + j];
        x -= of_p * s.mx[p + j] + of_q * s.mx[q + j];
        y -= of_p * s.my[p + j] + of_q * s.my[q + j];
        z -= of_p * s.mz[p + j] + of_q * s.mz[q + j];
      }
      x2[j] = x1[j], x1[j] = x, s.mx[n + j] = x;
      y2[j] = y1[j], y1[j] = y, s.my[n + j] = y;
      z2[j] = z1[j], z1[j] = z, s.mz[n + j] = z;
    }
  }
}

CURTAIN_INTO_WIDE void solveMoments(const Bundle& b) {
  BendingScratch& s = b.scratch;
  if (b.closed) {
    Border border;
    beginBorder(b, border);
    eliminate<true>(b, border);
    solveBorder(b, border);
    substitute<true>(b);
    return;
  }
  Border none;
  for (Field* const m : {&s.mx, &s.my, &s.mz}) {
    std::fill_n(m->data() + b.at(0), kLane, 0.0);
    std::fill_n(m->data() + b.at(b.count - 1), kLane, 0.0);
  }
  eliminate<false>(b, none);
  substitute<false>(b);
}

// Shear of link i = a_i (m_(i-1) - m_i).
CURTAIN_INTO_WIDE double shearAt(const double* a, const double* m, std::size_t before, std::size_t here) {
  return a[here] * (m[before] - m[here]);
}

// -(C^T m) of node i = a_(i+1) (m_i - m_(i+1)) - a_i (m_(i-1) - m_i).
CURTAIN_INTO_WIDE double forceAt(const double* a, const double* m, std::size_t before, std::size_t here,
                                 std::size_t one) {
  return a[one] * (m[here] - m[one]) - a[here] * (m[before] - m[here]);
}

}  // namespace

CURTAIN_WIDE void bendWarpGiving(const Grid& grid, const BendingLines& lines, const Field& give, const Field3& position,
                                 int block, BendingScratch& scratch, Field3& force) noexcept {
  const auto offset = static_cast<std::size_t>(block) * kLane;
  const Bundle b{position.x.data(),
                 position.y.data(),
                 position.z.data(),
                 give.data(),
                 lines.per_rest.data(),
                 lines.compliance.data(),
                 scratch,
                 offset,
                 static_cast<std::size_t>(grid.stride),
                 grid.rows,
                 false};
  solveMoments(b);
  const double* const a = lines.per_rest.data();
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t before = b.around(i - 1), here = b.at(i), one = b.around(i + 1);
#pragma omp simd
    for (std::size_t j = 0; j < kLane; ++j) {
      force.x[here + j] += forceAt(a, scratch.mx.data(), before + j, here + j, one + j);
      force.y[here + j] += forceAt(a, scratch.my.data(), before + j, here + j, one + j);
      force.z[here + j] += forceAt(a, scratch.mz.data(), before + j, here + j, one + j);
    }
  }
}

CURTAIN_WIDE void bendWeftGiving(const Grid& grid, const BendingLines& lines, const Field& give, const Field3& position,
                                 int block, BendingScratch& scratch, bool spares, WeftShears& shears,
                                 Field3& force) noexcept {
  const int top = block * kLane, rows = std::min(kLane, grid.rows - top);
  const std::size_t first = static_cast<std::size_t>(top) * static_cast<std::size_t>(grid.columns);
  // Lanes beyond the last row repeat it.
  for (int lane = 0; lane < kLane; ++lane) {
    const std::size_t row = grid.row(top + std::min(lane, rows - 1));
    const std::size_t to = first + static_cast<std::size_t>(lane);
    const auto turn = [&](const Field& from, Field& into) {
      for (std::size_t j = 0; j < static_cast<std::size_t>(grid.columns); ++j) into[to + kLane * j] = from[row + j];
    };
    turn(position.x, scratch.x);
    turn(position.y, scratch.y);
    turn(position.z, scratch.z);
    turn(give, scratch.give);
    turn(lines.per_rest, scratch.per_rest);
    turn(lines.compliance, scratch.compliance);
  }
  const Bundle b{scratch.x.data(),
                 scratch.y.data(),
                 scratch.z.data(),
                 scratch.give.data(),
                 scratch.per_rest.data(),
                 scratch.compliance.data(),
                 scratch,
                 first,
                 kLane,
                 grid.columns,
                 grid.closed};
  solveMoments(b);
  const double* const a = scratch.per_rest.data();
  for (std::size_t lane = 0; lane < static_cast<std::size_t>(rows); ++lane) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(top + static_cast<int>(lane), j);
      const std::size_t before = b.around(j - 1) + lane, here = b.at(j) + lane;
      shears.q.x[n] = shearAt(a, scratch.mx.data(), before, here);
      shears.q.y[n] = shearAt(a, scratch.my.data(), before, here);
      shears.q.z[n] = shearAt(a, scratch.mz.data(), before, here);
    }
  }
  addShears(grid, lines.string, position, block, shears.q, spares ? &shears.spared : nullptr, force);
}

}  // namespace curtain
