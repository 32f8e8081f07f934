// Finds parts with equal matrices, factorises each kind once, and solves up to eight neighbouring equal parts as
// right-hand sides of one factor.
#include "solve/separate_parts.hpp"

#include <algorithm>

namespace traverse::solve {
namespace {

constexpr std::ptrdiff_t max_parts_per_solve = 8;  // parts in one solve

bool same(const std::vector<double>& values, std::ptrdiff_t a, std::ptrdiff_t b, std::ptrdiff_t count) {
  return std::equal(values.begin() + a, values.begin() + a + count, values.begin() + b);
}

}  // namespace

const Parts::Part& Parts::at(std::ptrdiff_t node) const {
  const auto behind = [](std::ptrdiff_t n, const Part& part) { return n < part.first; };
  return *(std::upper_bound(parts.begin(), parts.end(), node, behind) - 1);
}

const Parts::Part* Parts::group_end(const Part* part, std::ptrdiff_t past) const {
  const Part* const end = parts.data() + parts.size();
  const Part* next = part + 1;
  while (next != end && next->first < past && next->kind == part->kind && next - part < max_parts_per_solve) ++next;
  return next;
}

Parts Parts::find(const std::vector<std::ptrdiff_t>& begins, const std::vector<const BlockTridiagonal*>& matrices,
                  const std::vector<char>& fixed) {
  Parts result;
  const auto equal = [&](const Part& a, const Part& b) {
    const std::ptrdiff_t n = a.past - a.first;
    if (b.past - b.first != n) return false;
    for (const BlockTridiagonal* m : matrices) {
      const std::ptrdiff_t area = static_cast<std::ptrdiff_t>(m->block) * m->block;
      if (!same(m->diagonal, a.first * area, b.first * area, n * area) ||
          !same(m->upper, a.first * area, b.first * area, (n - 1) * area))
        return false;
    }
    const std::ptrdiff_t block = matrices.front()->block;
    return std::equal(fixed.begin() + a.first * block, fixed.begin() + a.past * block, fixed.begin() + b.first * block);
  };
  for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
    Part part{begins[i], begins[i + 1], 0};
    const int kinds = static_cast<int>(result.of_kind.size());
    // Most parts equal the part before.
    if (i > 0) part.kind = result.parts.back().kind;
    if (i == 0 || !equal(part, result.parts.back())) {
      part.kind = 0;
      while (part.kind < kinds &&
             !equal(part, result.parts[static_cast<std::size_t>(result.of_kind[static_cast<std::size_t>(part.kind)])]))
        ++part.kind;
    }
    if (part.kind == kinds) result.of_kind.push_back(static_cast<int>(i));
    result.parts.push_back(part);
  }
  return result;
}

BlockTridiagonal rows_of(const BlockTridiagonal& matrix, const Parts::Part& part) {
  BlockTridiagonal rows(matrix.block, static_cast<int>(part.past - part.first));
  const std::ptrdiff_t area = static_cast<std::ptrdiff_t>(matrix.block) * matrix.block;
  std::copy(matrix.diagonal.begin() + part.first * area, matrix.diagonal.begin() + part.past * area,
            rows.diagonal.begin());
  std::copy(matrix.upper.begin() + part.first * area, matrix.upper.begin() + (part.past - 1) * area,
            rows.upper.begin());
  return rows;
}

SeparateParts::SeparateParts(int block_size, const Parts& layout) : block_(block_size), layout_(layout) {
  for (int kind = 0; kind < static_cast<int>(layout.of_kind.size()); ++kind)
    factors_.emplace_back(MPI_COMM_SELF, block_size, static_cast<int>(layout.nodes(kind)));
}

void SeparateParts::factor(int kind, const BlockTridiagonal& A, const std::vector<char>& fixed) {
  const std::size_t k = static_cast<std::size_t>(kind);
  const Parts::Part& part = layout_.parts[static_cast<std::size_t>(layout_.of_kind[k])];
  factors_[k].factor(A, {fixed.begin() + part.first * block_, fixed.begin() + part.past * block_});
}

void SeparateParts::solve(double* x, int columns) const {
  struct NoCallback final : RhsCallback {
    void fill(std::ptrdiff_t, std::ptrdiff_t) override {}
  } no_callback;
  if (layout_.parts.empty()) return;
  const std::ptrdiff_t nodes = layout_.parts.back().past;
  for (int c = 0; c < columns; ++c) solve_window(x + c * nodes * block_, 0, nodes, no_callback);
}

void SeparateParts::solve(double* x, RhsCallback& rhs_callback) const {
  if (!layout_.parts.empty()) solve_window(x, 0, layout_.parts.back().past, rhs_callback);
}

void SeparateParts::solve_window(double* x, std::ptrdiff_t first, std::ptrdiff_t past,
                                 RhsCallback& rhs_callback) const {
  if (first >= past) return;
  const Parts::Part* part = &layout_.at(first);
  const Parts::Part* end = layout_.parts.data() + layout_.parts.size();
  while (part != end && part->first < past) {
    const Parts::Part* next = layout_.group_end(part, past);
    rhs_callback.fill(part->first, next[-1].past);
    factor_of(*part).solve(x + part->first * block_, static_cast<int>(next - part));
    part = next;
  }
}

void SeparateParts::solve_local(double* x, int columns, std::ptrdiff_t first, std::ptrdiff_t past) const {
  if (first < past) factor_of(layout_.at(first)).solve(x, columns);
}

double SeparateParts::pivot_ratio() const {
  double least = 1.0;
  for (const SubstructuredCholesky& f : factors_) least = std::min(least, f.pivot_ratio());
  return least;
}

}  // namespace traverse::solve
