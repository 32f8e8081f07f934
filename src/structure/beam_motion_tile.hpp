// The sums of vectors on a tile, for the source files of BeamMotion.
#pragma once

#include <algorithm>
#include <type_traits>

#include "structure/beam_motion.hpp"

namespace traverse::structure {

inline constexpr int tile = beam::tile;
inline constexpr int most_terms = base::most_accelerations + 2;  // with v and w

template <class Call>
void with_count(int count, Call call) {
  switch (count) {
    case 0:
      return call(std::integral_constant<int, 0>());
    case 1:
      return call(std::integral_constant<int, 1>());
    case 2:
      return call(std::integral_constant<int, 2>());
    case 3:
      return call(std::integral_constant<int, 3>());
    case 4:
      return call(std::integral_constant<int, 4>());
    case 5:
      return call(std::integral_constant<int, 5>());
    case 6:
      return call(std::integral_constant<int, 6>());
    case 7:
      return call(std::integral_constant<int, 7>());
    default:
      return call(std::integral_constant<int, most_terms>());
  }
}

// Computes `outputs` sums of N vectors' entries [from, from + size) together.
template <int N, int outputs>
void add_up(const std::array<const double*, most_terms>& vectors,
            const std::array<std::array<double, outputs>, most_terms>& weight, std::ptrdiff_t from, int size,
            const std::array<double*, outputs>& to) {
  std::array<const double*, N> x;
  for (int j = 0; j < N; ++j) x[j] = vectors[j] + from;
#pragma GCC ivdep
  for (int i = 0; i < size; ++i) {
    std::array<double, outputs> sum{};
    for (int j = 0; j < N; ++j)
      for (int k = 0; k < outputs; ++k) sum[k] += weight[j][k] * x[j][i];
    for (int k = 0; k < outputs; ++k) to[k][i] = sum[k];
  }
}

/// The vectors and their weights in `outputs` sums.
template <int outputs>
struct BeamMotion::Terms {
  std::array<const double*, most_terms> x{};
  std::array<std::array<double, outputs>, most_terms> weight{};
  int count = 0;

  void add(const double* vector, const std::array<double, outputs>& weights) {
    if (std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0.0; })) return;
    x[count] = vector;
    weight[count++] = weights;
  }
  void evaluate(std::ptrdiff_t from, int size, const std::array<double*, outputs>& to) const {
    with_count(count, [&](auto N) { add_up<N, outputs>(x, weight, from, size, to); });
  }
};

template <int outputs>
BeamMotion::Terms<outputs> BeamMotion::terms_of(const std::array<const Sum*, outputs>& sums, const View& view) const {
  Terms<outputs> terms;
  const auto add = [&](const double* vector, auto weight_of) {
    std::array<double, outputs> weights;
    for (int k = 0; k < outputs; ++k) weights[k] = weight_of(*sums[k]);
    terms.add(vector, weights);
  };
  add(view.v, [](const Sum& s) { return s.v; });
  add(view.w, [](const Sum& s) { return s.w; });
  for (std::size_t j = 0; j <= stages_.size(); ++j) add(view.stored[j], [j](const Sum& s) { return s.stored[j]; });
  return terms;
}

// Sums on a tile and its two neighbouring columns, with the ghost values outside the view's nodes.
template <std::size_t outputs>
void BeamMotion::combine(const std::array<Summand, outputs>& sums, int first, int past) const {
  constexpr int count_of = static_cast<int>(outputs);
  const int from = std::max(first - 1, view_.first), count = std::min(past + 1, view_.past) - from;
  std::array<std::array<double, (tile + 2) * beam::kinds>, outputs> columns;
  std::array<const Sum*, outputs> of;
  std::array<double*, outputs> to;
  for (std::size_t k = 0; k < outputs; ++k) {
    of[k] = &sums[k].sum;
    to[k] = columns[k].data();
  }
  terms_of<count_of>(of, view_).evaluate(block_ * static_cast<std::ptrdiff_t>(from - view_.first), block_ * count, to);
  for (std::size_t k = 0; k < outputs; ++k) {
    Tile& tile_of = sums[k].to;
    tile_of.separate(block_, to[k], from - (first - 1), count);
    if (first == view_.first) tile_of.set(block_, 0, sums[k].ghosts.data());
    if (past == view_.past) tile_of.set(block_, past - first + 1, sums[k].ghosts.data() + beam::kinds);
  }
}

}  // namespace traverse::structure
