// Stores the entries of all structures lane by lane, unless they are one structure. Of matrices it lists the entries
// other than zero, those apart that are equal in all lanes. Each column's own unknowns are eliminated first, those with
// the fewest links before others. The outer unknowns, which are coupled to another column, are taken as linked with one
// another: so they are after the elimination of a neighbour, whichever it is.
#include "engine/structure_lanes.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace traverse::engine {
namespace {

constexpr std::array matrices = {&ColumnBlocks::mass, &ColumnBlocks::damping, &ColumnBlocks::stiffness};

double value(const double* blocks, std::size_t place) { return blocks == nullptr ? 0.0 : blocks[place]; }

}  // namespace

StructureLanes::StructureLanes(std::span<const BatchStructure* const> of_lanes)
    : of_lanes_(of_lanes), task_(of_lanes.front()->task_) {
  const BatchStructure& first = *of_lanes.front();
  task_.shared =
      std::all_of(of_lanes.begin(), of_lanes.end(), [&](const BatchStructure* one) { return one == &first; });
  const auto of = [&](std::vector<double> BatchStructure::*numbers) {
    return entries((first.*numbers).size(), [&](const BatchStructure& one) { return (one.*numbers).data(); });
  };
  if (first.modal_ == nullptr) {
    std::vector<ColumnBlocks> blocks;
    for (const BatchStructure* one : task_.shared ? of_lanes.first(1) : of_lanes)
      blocks.push_back(
          {one->mass_.data(), task_.proportional ? nullptr : one->damping_.data(), one->stiffness_.data()});
    matrices_.emplace(task_.block, first.held_, std::move(blocks));
    matrices_->set(task_);
  } else {
    task_.shape = of(&BatchStructure::shape_);
    task_.modal_damping = of(&BatchStructure::damping_);
    task_.modal_stiffness = of(&BatchStructure::stiffness_);
  }
  task_.dead = of(&BatchStructure::dead_load_);
  task_.by_mass = row_of([](const BatchStructure& one) { return one.by_mass_; });
  task_.by_stiffness = row_of([](const BatchStructure& one) { return one.by_stiffness_; });
  if (first.lever_ != 0.0) task_.lever = row_of([](const BatchStructure& one) { return one.lever_; });
  for (std::size_t i = 0; i < first.probes_.size(); ++i) add_probe(i);
  for (std::size_t i = 0; i < first.rotations_.size(); ++i) {
    LinearForm& form = rotations_.emplace_back(first.rotations_[i]);
    form.coefficient = entries(static_cast<std::size_t>(form.count),
                               [i](const BatchStructure& one) { return one.rotations_[i].coefficient; });
    form.constant = entries(1, [i](const BatchStructure& one) { return one.rotations_[i].constant; });
  }
  for (std::size_t lane = 0; lane < of_lanes_.size(); ++lane) {
    first_surface_.push_back(task_.shared ? 0 : surfaces_.size());
    if (task_.shared && lane > 0) continue;
    const std::vector<SurfaceTable>& own = of_lanes_[lane]->surfaces_.tables();
    surfaces_.insert(surfaces_.end(), own.begin(), own.end());
  }
}

std::size_t StructureLanes::surface(std::size_t lane, double radius) const {
  return first_surface_[lane] + of_lanes_[lane]->surfaces_.number(radius, 0);
}

template <class Numbers>
const double* StructureLanes::row_of(Numbers number) {
  double* row = numbers_.emplace_back(std::make_unique<Aligned>(of_lanes_.size()))->data();
  for (std::size_t lane = 0; lane < of_lanes_.size(); ++lane) row[lane] = number(*of_lanes_[lane]);
  return row;
}

/// `count` entries (BeamTask): the numbers of the shared structure, or those of all structures in rows.
template <class Numbers>
const double* StructureLanes::entries(std::size_t count, Numbers numbers) {
  return task_.shared ? numbers(*of_lanes_.front()) : in_rows(count, numbers);
}

/// A copy of `count` numbers of all structures in rows.
template <class Numbers>
const double* StructureLanes::in_rows(std::size_t count, Numbers numbers) {
  const std::size_t lanes = of_lanes_.size();
  double* rows = numbers_.emplace_back(std::make_unique<Aligned>(count * lanes))->data();
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const double* own = numbers(*of_lanes_[lane]);
    for (std::size_t i = 0; i < count; ++i) rows[i * lanes + lane] = own[i];
  }
  return rows;
}

void StructureLanes::add_probe(std::size_t index) {
  ProbeForms& p = probes_.emplace_back(of_lanes_.front()->probes_[index]);
  const auto count = static_cast<std::size_t>(p.count);
  const auto of = [&](std::size_t size, auto get) {
    return entries(size, [&](const BatchStructure& one) { return get(one.probes_[index]); });
  };
  for (int d = 0; d < 3; ++d) {
    p.deflection[d] = of(count, [d](const ProbeForms& own) { return own.deflection[d]; });
    p.moment[d] = of(count, [d](const ProbeForms& own) { return own.moment[d]; });
  }
  p.acceleration = of(count, [](const ProbeForms& own) { return own.acceleration; });
  p.nodal_moment = of(count, [](const ProbeForms& own) { return own.nodal_moment; });
  p.constant = of(2, [](const ProbeForms& own) { return own.constant; });
  p.inside = of(ProbeForms::inner, [](const ProbeForms& own) { return own.inside; });
}

MatrixLanes::MatrixLanes(int block, const std::vector<char>& held, std::vector<ColumnBlocks> of_lanes)
    : block_(block),
      of_lanes_(std::move(of_lanes)),
      order_(block, static_cast<int>(held.size()) / block, [this](int i, int j) { return !is_zero(place(i, j)); }) {
  const int unknowns = static_cast<int>(held.size());
  std::vector<int> value_at(static_cast<std::size_t>(2 * unknowns * block), -1);
  std::vector<std::size_t> places[2];
  for (int i = 0; i < unknowns; ++i) {
    const int column = i / block;
    const int end = held[static_cast<std::size_t>(i)] != 0 ? 0 : std::min(unknowns, (column + 2) * block);
    for (int j = std::max(0, (column - 1) * block); j < end; ++j) {
      const std::size_t at = place(i, j);
      if (is_zero(at)) continue;
      const bool equal = is_equal(at);
      if (value_at[at] < 0) {
        value_at[at] = static_cast<int>(places[equal ? 0 : 1].size());
        places[equal ? 0 : 1].push_back(at);
      }
      Entries& entries = equal ? equal_ : different_;
      entries.unknown.push_back(j);
      entries.value.push_back(value_at[at]);
    }
    for (Entries* entries : {&equal_, &different_}) entries->begin.push_back(static_cast<int>(entries->unknown.size()));
  }
  copy_values(equal_, places[0], true);
  copy_values(different_, places[1], false);
}

/// The place of a coefficient in the blocks, which is the same on both sides of the diagonal.
std::size_t MatrixLanes::place(int i, int j) const {
  if (i > j) std::swap(i, j);
  const int column = i / block_, next = j / block_ - column;
  return static_cast<std::size_t>(((2 * column + next) * block_ + j % block_) * block_ + i % block_);
}

bool MatrixLanes::is_zero(std::size_t place) const {
  return std::all_of(of_lanes_.begin(), of_lanes_.end(), [&](const ColumnBlocks& one) {
    return std::all_of(matrices.begin(), matrices.end(), [&](auto of) { return value(one.*of, place) == 0.0; });
  });
}

bool MatrixLanes::is_equal(std::size_t place) const {
  return std::all_of(of_lanes_.begin(), of_lanes_.end(), [&](const ColumnBlocks& one) {
    return std::all_of(matrices.begin(), matrices.end(),
                       [&](auto of) { return value(one.*of, place) == value(of_lanes_.front().*of, place); });
  });
}

void MatrixLanes::copy_values(Entries& to, const std::vector<std::size_t>& places, bool equal) {
  const std::size_t width = equal ? 1 : of_lanes_.size();
  std::array stored = {&to.mass, &to.damping, &to.stiffness};
  for (std::size_t m = 0; m < matrices.size(); ++m) {
    *stored[m] = std::make_unique<Aligned>(places.size() * width);
    double* next = (*stored[m])->data();
    for (const std::size_t place : places)
      for (std::size_t lane = 0; lane < width; ++lane) *next++ = value(of_lanes_[lane].*matrices[m], place);
  }
}

MatrixEntries MatrixLanes::Entries::task() const {
  return {begin.data(), unknown.data(), value.data(), mass->data(), damping->data(), stiffness->data()};
}

void MatrixLanes::set(BeamTask& task) const {
  task.equal = equal_.task();
  task.different = different_.task();
  order_.set(task);
}

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
