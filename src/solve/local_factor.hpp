// The elimination on one rank: its batches of parts, and the small system of the separators between the parts.
#pragma once

#include <memory>
#include <vector>

#include "subdomain_batch.hpp"

namespace traverse::solve {

/// The separators' unknowns in C columns: this rank's and the next rank's.
template <int B, int C>
struct SeparatorPanels {
  Panel<B, C> own;
  Panel<B, C> next;
};

template <int B>
class LocalFactor {
 public:
  /// nodes > 0. `follows`: the first node is a separator; `followed`: a separator follows the last node.
  LocalFactor(Extent<B> block, std::ptrdiff_t nodes, bool follows, bool followed);

  /// Returns false, with an entry in the record, if the slice is not positive definite.
  bool factor(const Slice<B>& slice, PivotRecord& record);
  const SchurPart<B>& schur() const { return schur_; }

  /// The batch of a rank with one part without separators, for which solve_single is faster; otherwise null.
  const SubdomainBatch<B>* single_batch() const {
    return parts_ == 1 && !follows_ && !followed_ ? &batches_.front() : nullptr;
  }

  std::size_t stored_numbers() const {
    std::size_t sum = coarse_ ? coarse_->stored_numbers() : 0;
    for (const SubdomainBatch<B>& batch : batches_) sum += batch.stored_numbers();
    return sum;
  }

  /// Allocates memory for a solve with this number of columns.
  void reserve(int columns);

  /// First half of a solve within a window, in C columns of which the first has the number `column`: eliminates the
  /// inner nodes, after the callback (unless null) has written all nodes of the window. separators, out: this rank's
  /// reduced right-hand side and its contribution to the next rank's; zero if the window does not reach them.
  template <int C>
  void eliminate(const Columns& x, int column, Range window, RhsCallback* rhs_callback,
                 SeparatorPanels<B, C>& separators);

  /// Second half: computes all nodes of the window from the separators' solutions.
  template <int C>
  void substitute(const Columns& x, int column, Range window, const SeparatorPanels<B, C>& separators);

 private:
  /// A window with the unknowns of its nodes and separators, and the batches and separators of the rank in it.
  struct Work {
    Columns x;
    Columns borders;  // node p: separator before part p, or behind the last part
    Range window;
    Range batches;
    Range separators;  // parts whose separator is in the window
  };
  Work make_work(const Columns& x, int column, Range window);
  Columns coarse_columns(const Work& work) const { return {work.borders.x, -first_separator(), border_stride_}; }
  Range coarse_window(const Work& work) const {
    return {work.separators.first - first_separator(), work.separators.past - first_separator()};
  }
  bool factor_separators(const Slice<B>& slice, PivotRecord& record);

  bool bordered(std::ptrdiff_t p) const { return (p > 0 || follows_) && (p < parts_ || followed_); }
  std::ptrdiff_t begin(std::ptrdiff_t p) const { return begins_[static_cast<std::size_t>(p)]; }
  std::ptrdiff_t first_separator() const { return follows_ ? 0 : 1; }
  const SchurPart<B>& part_schur(std::ptrdiff_t p) const {
    const auto at = static_cast<std::size_t>(p);
    return batches_[at / parts_per_batch].schur(at % parts_per_batch);
  }
  /// The parts of these batches.
  Range parts_of(Range batches) const {
    constexpr auto most = static_cast<std::ptrdiff_t>(parts_per_batch);
    return {batches.first * most, std::min(parts_, batches.past * most)};
  }
  /// Batches whose back substitution needs the solution of other separators, or of neighbour ranks, first.
  bool needs_separators(std::ptrdiff_t batch) const {
    return coupled_ || (batch == 0 && follows_) || batch + 1 == static_cast<std::ptrdiff_t>(batches_.size());
  }
  /// Calls body(chain of the batch, border at which it starts).
  template <class Body>
  void for_borders(std::ptrdiff_t batch, Body body) const {
    const Range parts = parts_of({batch, batch + 1});
    for (std::ptrdiff_t p = parts.first; p < parts.past; ++p) {
      const auto lane = static_cast<std::size_t>(2 * (p - parts.first));
      if (bordered(p)) body(lane, p);
      if (bordered(p + 1)) body(lane + 1, p + 1);
    }
  }

  template <int C>
  void load_borders(const Work& work, RhsCallback* rhs_callback) const;
  template <int C>
  void forward(const Work& work, RhsCallback* rhs_callback, std::ptrdiff_t batch) const;
  template <int C>
  void backward(const Work& work, std::ptrdiff_t batch) const;
  template <int C>
  void finish_separators(const Work& work, std::ptrdiff_t batch) const;
  template <int C>
  Panel<B, C> load(const Columns& x, std::ptrdiff_t node) const;
  template <int C>
  void store(const Panel<B, C>& panel, const Columns& x, std::ptrdiff_t node) const;

  Extent<B> block_;
  std::ptrdiff_t nodes_;
  std::ptrdiff_t parts_;
  std::vector<std::ptrdiff_t> begins_;  // the parts' first nodes (separators of bordered parts), and the end
  bool follows_;
  bool followed_;
  std::vector<SubdomainBatch<B>> batches_;
  SchurPart<B> schur_;

  // The separators within the rank. If the fill of no part reaches its middle, they are not coupled, and each is solved
  // as soon as the parts on both its sides are eliminated. Otherwise they form a block tridiagonal system, which
  // includes this rank's first node if it is a separator.
  bool coupled_ = false;
  std::unique_ptr<LocalFactor<B>> coarse_;
  BlockTridiagonal coarse_matrix_;
  std::vector<double> coarse_diagonal_;  // their diagonal entries in the original matrix
  std::vector<Block<B>> separator_inverse_;

  std::ptrdiff_t border_stride_;
  std::vector<double> borders_;  // the separators' unknowns, column after column
};

}  // namespace traverse::solve
