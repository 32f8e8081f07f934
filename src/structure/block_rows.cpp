// Extracts the non-zero entries of block rows, one block row for each node, stores repeated block rows once, and
// multiplies several nodes at a time with sums in registers.
#include "structure/block_rows.hpp"

#include <algorithm>

namespace traverse::structure {
namespace {

/// Entry (unknown, column) of the block that couples node i to the previous node, itself or the next one.
struct EntryReader {
  const solve::BlockTridiagonal& A;
  const std::vector<double>& left;

  double operator()(std::ptrdiff_t i, int unknown, int column, int shift) const {
    const int b = A.block;
    const auto entry_of = [&](const std::vector<double>& blocks, std::ptrdiff_t node, int r, int c) {
      return blocks[static_cast<std::size_t>(node * b * b + r + c * b)];
    };
    if (shift == 1) return entry_of(A.diagonal, i, unknown, column);
    if (shift == 2) return entry_of(A.upper, i, unknown, column);
    if (i > 0) return entry_of(A.upper, i - 1, column, unknown);
    return left.empty() ? 0.0 : entry_of(left, 0, column, unknown);
  }
};

}  // namespace

BlockRows::BlockRows(const solve::BlockTridiagonal& matrix, const std::vector<double>& left) {
  const EntryReader entry{matrix, left};
  for (int unknown = 0; unknown < matrix.block; ++unknown) {
    unknown_begins_.push_back(static_cast<int>(entries_.size()));
    for (int column = 0; column < matrix.block; ++column)
      for (int shift = 0; shift < 3; ++shift) {
        std::ptrdiff_t i = 0;
        while (i < matrix.nodes && entry(i, unknown, column, shift) == 0.0) ++i;
        if (i < matrix.nodes) entries_.push_back({unknown, column, shift, {}});
      }
  }
  unknown_begins_.push_back(static_cast<int>(entries_.size()));
  const auto hash = [&](std::ptrdiff_t i) {
    std::uint64_t result = 0;
    for (const Entry& e : entries_) result = solve::hash_of(result, std::array{entry(i, e.unknown, e.column, e.shift)});
    return result;
  };
  const auto same = [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    return std::all_of(entries_.begin(), entries_.end(), [&](const Entry& e) {
      return entry(i, e.unknown, e.column, e.shift) == entry(j, e.unknown, e.column, e.shift);
    });
  };
  for (std::ptrdiff_t i : stored_.assign(matrix.nodes, hash, same))
    for (Entry& e : entries_) e.values.push_back(entry(i, e.unknown, e.column, e.shift));
  for (Entry& e : entries_) {
    const auto nonzero = [](double number) { return number != 0.0; };
    e.from = std::find_if(e.values.begin(), e.values.end(), nonzero) - e.values.begin();
    e.to = e.values.rend() - std::find_if(e.values.rbegin(), e.values.rend(), nonzero);
    e.values.resize(e.values.size() + beam::nodes_per_chunk, 0.0);
  }
}

// Processes a few nodes at a time, whose sums remain in registers for all entries of an unknown.
void BlockRows::add(int first, int past, const beam::Planes& x, const beam::Planes& r) const {
  for (std::ptrdiff_t begin = first; begin < past;) {
    const solve::Stored& stored = stored_.at(begin);
    const std::ptrdiff_t end = std::min<std::ptrdiff_t>(past, stored.row_end(begin)),
                         storage_index = stored.storage_index(begin);
    for (std::ptrdiff_t from = begin; from < end; from += beam::nodes_per_chunk) {
      const auto count = static_cast<int>(std::min<std::ptrdiff_t>(beam::nodes_per_chunk, end - from));
      const std::ptrdiff_t at = storage_index + (from - begin);
      for (std::size_t unknown = 0; unknown + 1 < unknown_begins_.size(); ++unknown) {
        std::array<double, beam::nodes_per_chunk> sums{};
        for (int k = unknown_begins_[unknown]; k < unknown_begins_[unknown + 1]; ++k) {
          const Entry& e = entries_[k];
          if (e.to <= at || at + count <= e.from) continue;
          const double* const a = e.values.data() + at;
          const double* const x_at = x[e.column] + (from - first) + e.shift;
          for (int i = 0; i < beam::nodes_per_chunk; ++i) sums[i] += a[i] * x_at[i];
        }
        double* const to = r[unknown] + (from - first);
        for (int i = 0; i < count; ++i) to[i] += sums[i];
      }
    }
    begin = end;
  }
}

}  // namespace traverse::structure
