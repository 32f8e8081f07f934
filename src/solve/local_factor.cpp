#include "local_factor.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::solve {
namespace {

// The fill is dropped from the first node on where every entry is below this part of its largest value so far: far
// below rounding, so that the solution is the exact one, and far above the range where numbers lose their digits.
constexpr double negligible = 1e-30;

}  // namespace

/// What a chain carries from one node to the next while factoring.
template <int B>
struct LocalFactor<B>::Front {
  Block<B> update;     // U^T D^{-1} U: taken from the next node's diagonal block
  Block<B> fill;       // S: the separator's coupling with the next node
  Block<B> separator;  // sum of S D^{-1} S^T: taken from the separator's diagonal block
  Block<B> peak;       // largest sizes of the stored fill's entries
  bool filling = false;
};

template <int B>
LocalFactor<B>::LocalFactor(Extent<B> block, std::ptrdiff_t nodes, bool follows, bool followed)
    : block_(block), inner_(follows ? 1 : 0), follows_(follows), followed_(followed) {
  const std::ptrdiff_t inner_nodes = nodes - inner_;
  if (inner_nodes > 0) middle_ = inner_ + inner_nodes / 2;
  chains_[0] = {.first = inner_, .count = inner_nodes / 2, .direction = 1, .lower = {}, .inverse = {}, .fill = {}};
  chains_[1] = {
      .first = nodes - 1, .count = nodes - 1 - middle_, .direction = -1, .lower = {}, .inverse = {}, .fill = {}};
  if (middle_ < 0) chains_[1].count = 0;
  for (Chain<B>& chain : chains_) {
    chain.lower.resize(static_cast<std::size_t>(chain.count * block_.area()));
    chain.inverse.resize(chain.lower.size());
  }
}

template <int B>
bool LocalFactor<B>::factor(const Slice<B>& slice, PivotRecord& record) {
  const Block<B> zero(block_);
  if (middle_ < 0) {
    schur_ = {slice.diagonal(0), followed_ ? slice.upper(0) : zero, zero};
    return true;
  }
  std::array<Front, 2> fronts;
  for (Front& front : fronts) front = {zero, zero, zero, zero};
  if (follows_) fronts[0].fill = slice.upper(0);
  if (followed_) fronts[1].fill = slice.upper(chains_[1].first).transpose();
  for (std::size_t side : {0, 1}) {
    Chain<B>& chain = chains_[side];
    fronts[side].filling = side == 0 ? follows_ : followed_;
    chain.fill.clear();
  }
  // Both chains in one loop, for the divisions of one to run while the other waits for its own.
  const std::ptrdiff_t longest = std::max(chains_[0].count, chains_[1].count);
  for (std::ptrdiff_t k = 0; k < longest; ++k) {
    for (std::size_t side : {0, 1}) {
      if (k < chains_[side].count && !eliminate_node(slice, side, k, fronts[side], record)) return false;
    }
  }
  pad_fill();
  return eliminate_middle(slice, fronts, record);
}

template <int B>
void LocalFactor<B>::pad_fill() {
  reach_ = 0;
  for (const Chain<B>& chain : chains_) {
    reach_ = std::max(reach_, static_cast<std::ptrdiff_t>(chain.fill.size()) / block_.area());
  }
  for (Chain<B>& chain : chains_) {
    chain.fill.resize(static_cast<std::size_t>(std::min(reach_, chain.count) * block_.area()), 0.0);
  }
}

template <int B>
TRAVERSE_FLATTEN bool LocalFactor<B>::eliminate_node(const Slice<B>& slice, std::size_t side, std::ptrdiff_t k,
                                                     Front& front, PivotRecord& record) {
  Chain<B>& chain = chains_[side];
  const std::ptrdiff_t node = chain.first + k * chain.direction;
  Block<B> inverse = slice.diagonal(node);
  inverse -= front.update;
  if (!invert(inverse, slice, node, record)) return false;
  const Block<B> upper = chain.direction > 0 ? slice.upper(node) : slice.upper(node - 1).transpose();
  const Block<B> lower = upper.transpose() * inverse;
  std::copy_n(inverse.data(), block_.area(), chain.inverse.data() + k * block_.area());
  std::copy_n(lower.data(), block_.area(), chain.lower.data() + k * block_.area());
  front.update = lower * upper;
  if (front.filling) extend_fill(chain, inverse, upper, front);
  return true;
}

template <int B>
void LocalFactor<B>::extend_fill(Chain<B>& chain, const Block<B>& inverse, const Block<B>& upper, Front& front) {
  const Block<B> fill = front.fill * inverse;
  front.filling = false;
  for (std::ptrdiff_t e = 0; e < block_.area(); ++e) {
    const double size = std::abs(fill.data()[e]);
    double& peak = front.peak.data()[e];
    peak = std::max(peak, size);
    front.filling = front.filling || !(size <= negligible * peak);  // a NaN goes on, to be found
  }
  if (!front.filling) {
    front.fill = Block<B>(block_);
    return;
  }
  chain.fill.insert(chain.fill.end(), fill.data(), fill.data() + block_.area());
  front.separator += fill * front.fill.transpose();
  front.fill = -(fill * upper);
}

template <int B>
bool LocalFactor<B>::eliminate_middle(const Slice<B>& slice, std::array<Front, 2>& fronts, PivotRecord& record) {
  middle_inverse_ = slice.diagonal(middle_);
  for (const Front& front : fronts) middle_inverse_ -= front.update;
  if (!invert(middle_inverse_, slice, middle_, record)) return false;
  for (std::size_t side : {0, 1}) {
    middle_fill_[side] = fronts[side].fill * middle_inverse_;
    fronts[side].separator += middle_fill_[side] * fronts[side].fill.transpose();
  }
  schur_.own = -fronts[0].separator;
  if (follows_) schur_.own += slice.diagonal(0);
  schur_.coupling = -(middle_fill_[0] * fronts[1].fill.transpose());
  schur_.next = -fronts[1].separator;
  return true;
}

template <int B>
ChainView LocalFactor<B>::view(const Chain<B>& chain, double* x) const {
  return {chain.lower.data(), chain.inverse.data(), chain.fill.data(), x + chain.first * block_.size(),
          static_cast<std::ptrdiff_t>(chain.direction) * block_.size()};
}

template <int B>
template <int C>
void LocalFactor<B>::eliminate(double* x, std::ptrdiff_t stride, SeparatorPanels<B, C>& separators) const {
  Borders<B, C, 2> borders = {};
  if (follows_) borders[0].load(block_, x, stride);
  if (middle_ >= 0) {
    const std::array<ChainView, 2> both = {view(chains_[0], x), view(chains_[1], x)};
    const std::ptrdiff_t filled = std::min(reach_, chains_[1].count);
    sweep_forward<true>(block_, both, 0, filled, stride, borders);
    sweep_forward<false>(block_, both, filled, chains_[1].count, stride, borders);
    Borders<B, C, 1> first = {borders[0]};
    const std::ptrdiff_t last_filled = std::clamp(reach_, chains_[1].count, chains_[0].count);
    sweep_forward<true>(block_, std::array{both[0]}, chains_[1].count, last_filled, stride, first);
    sweep_forward<false>(block_, std::array{both[0]}, last_filled, chains_[0].count, stride, first);
    borders[0] = first[0];
    Panel<B, C> middle;
    middle.load(block_, x + middle_ * block_.size(), stride);
    for (std::size_t side : {0, 1}) borders[side].subtract(block_, middle_fill_[side].data(), middle);
  }
  separators = {borders[0], borders[1]};
}

template <int B>
template <int C>
void LocalFactor<B>::substitute(double* x, std::ptrdiff_t stride, const SeparatorPanels<B, C>& separators) const {
  if (follows_) separators.own.store(block_, x, stride);
  if (middle_ < 0) return;
  const Borders<B, C, 2> borders = {separators.own, separators.next};
  double* here = x + middle_ * block_.size();
  Panel<B, C> reduced, middle;
  reduced.load(block_, here, stride);
  middle.multiply(block_, middle_inverse_.data(), reduced);
  for (std::size_t side : {0, 1}) middle.subtract_transposed(block_, middle_fill_[side].data(), borders[side]);
  middle.store(block_, here, stride);

  const std::array<ChainView, 2> both = {view(chains_[0], x), view(chains_[1], x)};
  const Borders<B, C, 1> first = {borders[0]};
  const std::ptrdiff_t last_filled = std::clamp(reach_, chains_[1].count, chains_[0].count);
  sweep_backward<false>(block_, std::array{both[0]}, last_filled, chains_[0].count, stride, first);
  sweep_backward<true>(block_, std::array{both[0]}, chains_[1].count, last_filled, stride, first);
  const std::ptrdiff_t filled = std::min(reach_, chains_[1].count);
  sweep_backward<false>(block_, both, filled, chains_[1].count, stride, borders);
  sweep_backward<true>(block_, both, 0, filled, stride, borders);
}

#define TRAVERSE_INSTANTIATE_COLUMNS(B, C)                                                           \
  template void LocalFactor<B>::eliminate<C>(double*, std::ptrdiff_t, SeparatorPanels<B, C>&) const; \
  template void LocalFactor<B>::substitute<C>(double*, std::ptrdiff_t, const SeparatorPanels<B, C>&) const;
#define TRAVERSE_INSTANTIATE(B)      \
  template class LocalFactor<B>;     \
  TRAVERSE_INSTANTIATE_COLUMNS(B, 1) \
  TRAVERSE_INSTANTIATE_COLUMNS(B, 2) \
  TRAVERSE_INSTANTIATE_COLUMNS(B, 4)
TRAVERSE_INSTANTIATE(2)
TRAVERSE_INSTANTIATE(3)
TRAVERSE_INSTANTIATE(4)
TRAVERSE_INSTANTIATE(5)
TRAVERSE_INSTANTIATE(6)
TRAVERSE_INSTANTIATE(7)
TRAVERSE_INSTANTIATE(any_block)

}  // namespace traverse::solve
