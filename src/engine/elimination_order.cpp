// Eliminates each column's own unknowns first, those with the fewest links before others. The outer unknowns, which are
// coupled to another column, are taken as linked with one another: so they are after the elimination of a neighbour,
// whichever it is.
#include "engine/elimination_order.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace traverse::engine {

EliminationOrder::EliminationOrder(int block, int columns, const Coupled& are_coupled) : block_(block) {
  const Coupled coupled = [&](int i, int j) { return block <= most_dense || are_coupled(i, j); };
  std::vector<Offsets> left, right, outer;
  for (int c = 0; c < columns; ++c) {
    left.push_back(c > 0 ? coupled_with(coupled, c, c - 1) : Offsets{});
    right.push_back(c + 1 < columns ? coupled_with(coupled, c, c + 1) : Offsets{});
    Offsets& all = outer.emplace_back();
    std::set_union(left.back().begin(), left.back().end(), right.back().begin(), right.back().end(),
                   std::back_inserter(all));
  }
  int used = 0;
  for (std::size_t c = 0; c < outer.size(); ++c) {
    of_column_.push_back(order_of(coupled, static_cast<int>(c), outer[c]));
    link_begin_.push_back(used);
    used += of_column_.back()->links;
    pair_begin_.push_back(used);
    if (c + 1 == outer.size()) break;
    const PairOrder& to_right = *to_right_.emplace_back(pair_of(outer[c], left[c + 1]));
    const PairOrder& to_left = *to_left_.emplace_back(pair_of(outer[c + 1], right[c]));
    used += std::max(to_right.further_count * to_right.nearer_count, to_left.further_count * to_left.nearer_count);
  }
  factor_size_ = static_cast<std::size_t>(used);
}

/// The unknowns of a column that are coupled to another column.
EliminationOrder::Offsets EliminationOrder::coupled_with(const Coupled& coupled, int column, int other) const {
  Offsets found;
  for (int i = 0; i < block_; ++i)
    for (int j = 0; j < block_; ++j)
      if (coupled(column * block_ + i, other * block_ + j)) {
        found.push_back(i);
        break;
      }
  return found;
}

const ColumnOrder* EliminationOrder::order_of(const Coupled& coupled, int column, const Offsets& outer) {
  std::array<std::array<bool, most_unknowns_of_a_column>, most_unknowns_of_a_column> adjacent{};
  const auto link = [&](int i, int j) {
    adjacent[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = true;
    adjacent[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = true;
  };
  const auto are_linked = [&](int i, int j) {
    return i != j && adjacent[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  };
  Offsets own, order;
  for (int i = 0; i < block_; ++i) {
    const int at = column * block_;
    if (coupled(at + i, at + i) && !std::binary_search(outer.begin(), outer.end(), i)) own.push_back(i);
    for (int j = 0; j < i; ++j)
      if (coupled(at + i, at + j)) link(i, j);
  }
  for (const int i : outer)
    for (const int j : outer) link(i, j);
  const auto later_links = [&](int i) {
    Offsets links;
    for (int j = 0; j < block_; ++j)
      if (are_linked(i, j) && std::find(order.begin(), order.end(), j) == order.end()) links.push_back(j);
    return links;
  };
  while (!own.empty()) {
    const auto next = std::min_element(own.begin(), own.end(),
                                       [&](int i, int j) { return later_links(i).size() < later_links(j).size(); });
    const Offsets links = later_links(*next);
    for (const int i : links)
      for (const int j : links) link(i, j);
    order.push_back(*next);
    own.erase(next);
  }
  order.insert(order.end(), outer.begin(), outer.end());

  ColumnOrder made;
  for (std::size_t i = 0; i < order.size(); ++i) {
    made.unknown[made.count++] = order[i];
    for (std::size_t j = 0; j < i; ++j) {
      if (!are_linked(order[i], order[j])) continue;
      made.later[made.links] = order[i];
      made.earlier[made.links++] = order[j];
    }
  }
  std::vector<int> key(order);
  key.push_back(-1);
  key.insert(key.end(), made.later, made.later + made.links);
  key.insert(key.end(), made.earlier, made.earlier + made.links);
  return &orders_.emplace(std::move(key), made).first->second;
}

const PairOrder* EliminationOrder::pair_of(const Offsets& further, const Offsets& nearer) {
  PairOrder made;
  if (!nearer.empty()) made.further_count = static_cast<int>(further.size());
  made.nearer_count = static_cast<int>(nearer.size());
  std::copy(further.begin(), further.end(), made.further);
  std::copy(nearer.begin(), nearer.end(), made.nearer);
  return &pairs_.emplace(std::vector<Offsets>{further, nearer}, made).first->second;
}

void EliminationOrder::set(BeamTask& task) const {
  task.order = of_column_.data();
  task.to_right = to_right_.data();
  task.to_left = to_left_.data();
  task.link_begin = link_begin_.data();
  task.pair_begin = pair_begin_.data();
}

}  // namespace traverse::engine
