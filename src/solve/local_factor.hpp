// One rank's part of the elimination: its bundles of parts, and the small system of the separators between the parts.
#pragma once

#include <memory>
#include <vector>

#include "bundle.hpp"

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
  /// nodes > 0. `follows`: the first node is a separator; `followed`: there is a separator behind the last node.
  LocalFactor(Extent<B> block, std::ptrdiff_t nodes, bool follows, bool followed);

  /// False, and noted in the record, when the slice is not positive definite.
  bool factor(const Slice<B>& slice, PivotRecord& record);
  const SchurPart<B>& schur() const { return schur_; }

  /// One part without separators, whose solve_alone is the short way.
  const Bundle<B>* alone() const { return parts_ == 1 && !follows_ && !followed_ ? &bundles_.front() : nullptr; }

  std::size_t stored_numbers() const {
    std::size_t sum = coarse_ ? coarse_->stored_numbers() : 0;
    for (const Bundle<B>& bundle : bundles_) sum += bundle.stored_numbers();
    return sum;
  }

  /// Room for a solve in so many columns.
  void reserve(int columns);

  /// First half of a solve within a window, in C columns of which the first is number `column`: eliminates the inner
  /// nodes, the filler, unless null, writing all nodes of the window before. separators, out: this rank's reduced
  /// right-hand side and what is added to the next rank's; zero where the window does not reach them.
  template <int C>
  void eliminate(const Columns& x, int column, Range window, NodeFiller* filler, SeparatorPanels<B, C>& separators);

  /// Second half: all nodes of the window, from the separators' solutions.
  template <int C>
  void substitute(const Columns& x, int column, Range window, const SeparatorPanels<B, C>& separators);

 private:
  /// A window, its nodes' unknowns and its separators', and what of the rank it meets.
  struct Work {
    Columns x;
    Columns borders;  // node p: the separator before part p, or behind the last
    Range window;
    Range bundles;
    Range separators;  // parts whose own separator is in the window
  };
  Work meet(const Columns& x, int column, Range window);
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
    return bundles_[at / parts_a_bundle].schur(at % parts_a_bundle);
  }
  /// The parts of some bundles.
  Range parts_of(Range bundles) const {
    constexpr auto most = static_cast<std::ptrdiff_t>(parts_a_bundle);
    return {bundles.first * most, std::min(parts_, bundles.past * most)};
  }
  /// Bundles that cannot be finished before other separators, or the ranks beside, have been heard.
  bool waits(std::ptrdiff_t bundle) const {
    return coupled_ || (bundle == 0 && follows_) || bundle + 1 == static_cast<std::ptrdiff_t>(bundles_.size());
  }
  /// body(chain of the bundle, border it starts at).
  template <class Body>
  void for_borders(std::ptrdiff_t bundle, Body body) const {
    const Range parts = parts_of({bundle, bundle + 1});
    for (std::ptrdiff_t p = parts.first; p < parts.past; ++p) {
      const auto lane = static_cast<std::size_t>(2 * (p - parts.first));
      if (bordered(p)) body(lane, p);
      if (bordered(p + 1)) body(lane + 1, p + 1);
    }
  }

  template <int C>
  void load_borders(const Work& work, NodeFiller* filler) const;
  template <int C>
  void forward(const Work& work, NodeFiller* filler, std::ptrdiff_t bundle) const;
  template <int C>
  void backward(const Work& work, std::ptrdiff_t bundle) const;
  template <int C>
  void finish_separators(const Work& work, std::ptrdiff_t bundle) const;
  template <int C>
  Panel<B, C> load(const Columns& x, std::ptrdiff_t node) const;
  template <int C>
  void store(const Panel<B, C>& panel, const Columns& x, std::ptrdiff_t node) const;

  Extent<B> block_;
  std::ptrdiff_t nodes_;
  std::ptrdiff_t parts_;
  std::vector<std::ptrdiff_t> begins_;  // the parts' first nodes, their separators where they are bordered; past all
  bool follows_;
  bool followed_;
  std::vector<Bundle<B>> bundles_;
  SchurPart<B> schur_;

  // The separators within the rank. Where the fill of none of the parts reaches its middle they do not see each other,
  // and each is solved as soon as the parts on both its sides are eliminated. Else they are a system of their own, this
  // rank's first node included if it is a separator.
  bool coupled_ = false;
  std::unique_ptr<LocalFactor<B>> coarse_;
  BlockTridiagonal coarse_matrix_;
  std::vector<double> coarse_diagonal_;  // their diagonal entries in the matrix given
  std::vector<Block<B>> separator_inverse_;

  std::ptrdiff_t border_stride_;
  std::vector<double> borders_;  // the separators' unknowns, column after column
};

}  // namespace traverse::solve
