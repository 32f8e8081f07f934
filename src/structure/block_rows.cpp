// Extracts the non-zero entries of block tridiagonal rows, stores repeated rows once, and multiplies several nodes at a
// time with sums in registers.
#include "structure/block_rows.hpp"

#include <algorithm>

namespace traverse::structure {
namespace {

/// Entry (row, column) of node i's block with the previous node, itself or the next one.
struct RowReader {
  const solve::BlockTridiagonal& A;
  const std::vector<double>& left;

  double operator()(std::ptrdiff_t i, int row, int column, int shift) const {
    const int b = A.block;
    const auto of = [&](const std::vector<double>& blocks, std::ptrdiff_t node, int r, int c) {
      return blocks[static_cast<std::size_t>(node * b * b + r + c * b)];
    };
    if (shift == 1) return of(A.diagonal, i, row, column);
    if (shift == 2) return of(A.upper, i, row, column);
    if (i > 0) return of(A.upper, i - 1, column, row);
    return left.empty() ? 0.0 : of(left, 0, column, row);
  }
};

}  // namespace

BlockRows::BlockRows(const solve::BlockTridiagonal& rows, const std::vector<double>& left) {
  const RowReader entry{rows, left};
  for (int row = 0; row < rows.block; ++row) {
    row_begins_.push_back(static_cast<int>(entries_.size()));
    for (int column = 0; column < rows.block; ++column)
      for (int shift = 0; shift < 3; ++shift) {
        std::ptrdiff_t i = 0;
        while (i < rows.nodes && entry(i, row, column, shift) == 0.0) ++i;
        if (i < rows.nodes) entries_.push_back({row, column, shift, {}});
      }
  }
  row_begins_.push_back(static_cast<int>(entries_.size()));
  const auto mark = [&](std::ptrdiff_t i) {
    std::uint64_t result = 0;
    for (const Entry& e : entries_) result = solve::hash_of(result, std::array{entry(i, e.row, e.column, e.shift)});
    return result;
  };
  const auto same = [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    return std::all_of(entries_.begin(), entries_.end(), [&](const Entry& e) {
      return entry(i, e.row, e.column, e.shift) == entry(j, e.row, e.column, e.shift);
    });
  };
  for (std::ptrdiff_t i : stored_.assign(rows.nodes, mark, same))
    for (Entry& e : entries_) e.along.push_back(entry(i, e.row, e.column, e.shift));
  for (Entry& e : entries_) {
    const auto nonzero = [](double number) { return number != 0.0; };
    e.from = std::find_if(e.along.begin(), e.along.end(), nonzero) - e.along.begin();
    e.to = e.along.rend() - std::find_if(e.along.rbegin(), e.along.rend(), nonzero);
    e.along.resize(e.along.size() + beam::nodes_per_step, 0.0);
  }
}

// A few nodes at a time, whose sums remain in registers for all entries of a row.
void BlockRows::add(int first, int past, const beam::Planes& x, const beam::Planes& r) const {
  for (std::ptrdiff_t begin = first; begin < past;) {
    const solve::Stored& stored = stored_.at(begin);
    const std::ptrdiff_t end = std::min<std::ptrdiff_t>(past, stored.row_end(begin)), place = stored.place(begin);
    for (std::ptrdiff_t from = begin; from < end; from += beam::nodes_per_step) {
      const auto count = static_cast<int>(std::min<std::ptrdiff_t>(beam::nodes_per_step, end - from));
      const std::ptrdiff_t at = place + (from - begin);
      for (std::size_t row = 0; row + 1 < row_begins_.size(); ++row) {
        std::array<double, beam::nodes_per_step> sums{};
        for (int k = row_begins_[row]; k < row_begins_[row + 1]; ++k) {
          const Entry& e = entries_[k];
          if (e.to <= at || at + count <= e.from) continue;
          const double* const a = e.along.data() + at;
          const double* const of = x[e.column] + (from - first) + e.shift;
          for (int i = 0; i < beam::nodes_per_step; ++i) sums[i] += a[i] * of[i];
        }
        double* const to = r[row] + (from - first);
        for (int i = 0; i < count; ++i) to[i] += sums[i];
      }
    }
    begin = end;
  }
}

}  // namespace traverse::structure
