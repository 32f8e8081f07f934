// Function bodies of LocalFactor<B> that blocks.hpp compiles.
#pragma once

#include <algorithm>

#include "local_factor.hpp"

namespace traverse::solve {

// Fewer nodes are one part with two chains: separators would cost more than further chains would save.
inline constexpr std::ptrdiff_t min_nodes_to_divide = 512;

// Nodes per batch: the back substitution of a batch follows soon after its elimination, while its factors are in a
// cache.
inline constexpr std::ptrdiff_t nodes_per_batch = 16384;

inline std::ptrdiff_t count_parts(std::ptrdiff_t nodes) {
  if (nodes < min_nodes_to_divide) return 1;
  return static_cast<std::ptrdiff_t>(parts_per_batch) * std::max<std::ptrdiff_t>(1, nodes / nodes_per_batch);
}

template <int B>
bool is_zero(const Block<B>& block) {
  return std::all_of(block.data(), block.data() + std::ptrdiff_t{block.size()} * block.size(),
                     [](double entry) { return entry == 0.0; });
}

template <int B>
LocalFactor<B>::LocalFactor(Extent<B> block, std::ptrdiff_t nodes, bool follows, bool followed)
    : block_(block),
      nodes_(nodes),
      parts_(count_parts(nodes)),
      follows_(follows),
      followed_(followed),
      border_stride_((parts_ + 1) * block.size()) {
  for (std::ptrdiff_t p = 0; p <= parts_; ++p) begins_.push_back(p * nodes / parts_);
  for (std::ptrdiff_t batch = 0; parts_of({batch, batch + 1}).first < parts_; ++batch) {
    std::array<Part, parts_per_batch> parts;
    const Range own = parts_of({batch, batch + 1});
    for (std::ptrdiff_t p = own.first; p < own.past; ++p) {
      parts[static_cast<std::size_t>(p - own.first)] = Part({begin(p), begin(p + 1)}, bordered(p), bordered(p + 1));
    }
    batches_.emplace_back(block, parts);
  }
  if (parts_ == 1) return;
  const std::ptrdiff_t separators = parts_ - first_separator();
  coarse_ = std::make_unique<LocalFactor<B>>(block, separators, follows, followed);
  coarse_matrix_ = BlockTridiagonal(block.size(), static_cast<int>(separators));
  coarse_diagonal_.resize(static_cast<std::size_t>(separators * block.size()));
  separator_inverse_.resize(static_cast<std::size_t>(separators));
}

template <int B>
bool LocalFactor<B>::factor(const Slice<B>& slice, PivotRecord& record) {
  for (SubdomainBatch<B>& batch : batches_) {
    if (!batch.factor(slice, record)) return false;
  }
  schur_ = part_schur(0);
  coupled_ = false;
  return parts_ == 1 || factor_separators(slice, record);
}

template <int B>
bool LocalFactor<B>::factor_separators(const Slice<B>& slice, PivotRecord& record) {
  const std::ptrdiff_t area = block_.area();
  for (std::ptrdiff_t p = first_separator(); p < parts_; ++p) {
    const std::ptrdiff_t i = p - first_separator();
    Block<B> diagonal = part_schur(p).own;
    if (p > 0) diagonal += part_schur(p - 1).next;
    std::copy_n(diagonal.data(), area, coarse_matrix_.diagonal.data() + i * area);
    std::copy_n(part_schur(p).coupling.data(), area, coarse_matrix_.upper.data() + i * area);
    for (int e = 0; e < block_.size(); ++e) {
      coarse_diagonal_[static_cast<std::size_t>(i * block_.size() + e)] = slice.reference(begin(p), e);
    }
  }
  for (std::ptrdiff_t p = 0; p < parts_; ++p) coupled_ = coupled_ || !is_zero(part_schur(p).coupling);
  const Slice<B> coarse = {coarse_matrix_, nullptr, 0, coarse_diagonal_.data()};
  PivotRecord found;
  if (coupled_) {
    coarse_->factor(coarse, found);
    schur_ = coarse_->schur();
  } else {
    for (std::ptrdiff_t p = 1; p < parts_ && !found.failed(); ++p) {
      const std::ptrdiff_t i = p - first_separator();
      Block<B>& inverse = separator_inverse_[static_cast<std::size_t>(i)];
      inverse = coarse.diagonal(i);
      invert(inverse, coarse, i, found);
    }
    schur_.next = Block<B>(block_);
  }
  schur_.next += part_schur(parts_ - 1).next;
  record.smallest_ratio = std::min(record.smallest_ratio, found.smallest_ratio);
  if (!found.failed()) return true;
  record.bad_unknown =
      begin(found.bad_unknown / block_.size() + first_separator()) * block_.size() + found.bad_unknown % block_.size();
  record.bad_pivot = found.bad_pivot;
  record.bad_diagonal = found.bad_diagonal;
  return false;
}

template <int B>
void LocalFactor<B>::reserve(int columns) {
  const std::size_t size = static_cast<std::size_t>(border_stride_) * static_cast<std::size_t>(columns);
  if (borders_.size() < size) borders_.resize(size);
  if (coarse_) coarse_->reserve(columns);
}

template <int B>
typename LocalFactor<B>::Work LocalFactor<B>::make_work(const Columns& x, int column, Range window) {
  Work result = {x,
                 {borders_.data() + column * border_stride_, 0, border_stride_},
                 window,
                 {0, static_cast<std::ptrdiff_t>(batches_.size())},
                 {first_separator(), parts_}};
  if (window.first > 0 || window.past < nodes_) {
    const auto first_from = [&](std::ptrdiff_t node) {
      return std::lower_bound(begins_.begin(), begins_.end() - 1, node) - begins_.begin();
    };
    constexpr auto most = static_cast<std::ptrdiff_t>(parts_per_batch);
    result.batches = {(first_from(window.first + 1) - 1) / most, (first_from(window.past) - 1) / most + 1};
    result.separators = {std::max(first_separator(), first_from(window.first)), first_from(window.past)};
  }
  return result;
}

template <int B>
template <int C>
Panel<B, C> LocalFactor<B>::load(const Columns& x, std::ptrdiff_t node) const {
  Panel<B, C> result;
  result.load(block_, x.x + (node - x.origin) * block_.size(), x.stride);
  return result;
}

template <int B>
template <int C>
void LocalFactor<B>::store(const Panel<B, C>& panel, const Columns& x, std::ptrdiff_t node) const {
  panel.store(block_, x.x + (node - x.origin) * block_.size(), x.stride);
}

template <int B>
template <int C>
void LocalFactor<B>::eliminate(const Columns& x, int column, Range window, RhsCallback* rhs_callback,
                               SeparatorPanels<B, C>& separators) {
  separators = {};
  if (window.empty()) return;
  const Work work = make_work(x, column, window);
  load_borders<C>(work, rhs_callback);
  for (std::ptrdiff_t batch = work.batches.first; batch < work.batches.past; ++batch) {
    forward<C>(work, rhs_callback, batch);
    if (coupled_) continue;
    finish_separators<C>(work, batch);
    if (batch > work.batches.first && !needs_separators(batch - 1)) backward<C>(work, batch - 1);
  }
  if (!needs_separators(work.batches.past - 1)) backward<C>(work, work.batches.past - 1);
  if (coupled_) {
    coarse_->template eliminate<C>(coarse_columns(work), column, coarse_window(work), nullptr, separators);
  } else if (follows_) {
    separators.own = load<C>(work.borders, 0);
  }
  if (followed_) separators.next.add(block_, load<C>(work.borders, parts_));
}

template <int B>
template <int C>
void LocalFactor<B>::substitute(const Columns& x, int column, Range window, const SeparatorPanels<B, C>& separators) {
  if (window.empty()) return;
  const Work work = make_work(x, column, window);
  if (follows_) store<C>(separators.own, work.borders, 0);
  if (followed_) store<C>(separators.next, work.borders, parts_);
  if (coupled_) coarse_->template substitute<C>(coarse_columns(work), column, coarse_window(work), separators);
  const Range pending = work.separators.common({0, coupled_ ? parts_ : 1});
  for (std::ptrdiff_t p = pending.first; p < pending.past; ++p) store<C>(load<C>(work.borders, p), x, begin(p));
  for (std::ptrdiff_t batch = work.batches.first; batch < work.batches.past; ++batch) {
    if (needs_separators(batch)) backward<C>(work, batch);
  }
}

/// Loads the right-hand sides of the separators in the window, and zero for other separators next to its parts.
template <int B>
template <int C>
void LocalFactor<B>::load_borders(const Work& work, RhsCallback* rhs_callback) const {
  const Range parts = parts_of(work.batches);
  for (std::ptrdiff_t p = parts.first; p <= parts.past; ++p) {
    const bool inside = work.separators.contains(p);
    if (inside && rhs_callback != nullptr) rhs_callback->fill(begin(p), begin(p) + 1);
    store<C>(inside ? load<C>(work.x, begin(p)) : Panel<B, C>{}, work.borders, p);
  }
  if (parts.past < parts_) store<C>({}, work.borders, parts_);
}

template <int B>
template <int C>
void LocalFactor<B>::forward(const Work& work, RhsCallback* rhs_callback, std::ptrdiff_t batch) const {
  ChainBorders<B, C> added = {};
  batches_[static_cast<std::size_t>(batch)].template forward<C>(work.x, work.window, rhs_callback, added);
  for_borders(batch, [&](std::size_t lane, std::ptrdiff_t p) {
    if (p == parts_ ? work.window.past < nodes_ : !work.separators.contains(p)) return;
    added[lane].add(block_, load<C>(work.borders, p));
    store<C>(added[lane], work.borders, p);
  });
}

template <int B>
template <int C>
void LocalFactor<B>::backward(const Work& work, std::ptrdiff_t batch) const {
  ChainBorders<B, C> borders = {};
  for_borders(batch, [&](std::size_t lane, std::ptrdiff_t p) { borders[lane] = load<C>(work.borders, p); });
  batches_[static_cast<std::size_t>(batch)].template backward<C>(work.x, work.window, borders);
}

/// Solves for the uncoupled separators before the parts of a batch, without this rank's first separator.
template <int B>
template <int C>
void LocalFactor<B>::finish_separators(const Work& work, std::ptrdiff_t batch) const {
  const Range parts = parts_of({batch, batch + 1}).common(work.separators);
  for (std::ptrdiff_t p = std::max<std::ptrdiff_t>(1, parts.first); p < parts.past; ++p) {
    Panel<B, C> solution;
    const Block<B>& inverse = separator_inverse_[static_cast<std::size_t>(p - first_separator())];
    solution.multiply(block_, inverse.data(), load<C>(work.borders, p));
    store<C>(solution, work.borders, p);
    store<C>(solution, work.x, begin(p));
  }
}

}  // namespace traverse::solve
