// Stores the entries of all structures lane by lane, unless they are one structure.
#include "engine/structure_lanes.hpp"

#include <algorithm>
#include <utility>

namespace traverse::engine {

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
  for (std::size_t i = 0; i < first.probes_.size(); ++i) add_probe(i);
  for (std::size_t lane = 0; lane < of_lanes_.size(); ++lane) {
    first_surface_.push_back(task_.shared ? 0 : surfaces_.size());
    if (task_.shared && lane > 0) continue;
    const std::vector<SurfaceTable>& own = of_lanes_[lane]->surfaces_.tables();
    surfaces_.insert(surfaces_.end(), own.begin(), own.end());
  }
}

std::size_t StructureLanes::surface(std::size_t lane, double radius) const {
  return first_surface_[lane] + of_lanes_[lane]->surfaces_.number(radius);
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

}  // namespace traverse::engine
