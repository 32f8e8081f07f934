// The static shapes of unit displacements of the supports, from beams with one settled support each, and their inertia.
#include "structure/support_motion.hpp"

#include <algorithm>

#include "structure/element_structure.hpp"

namespace traverse::structure {

SupportMotion::SupportMotion(const beam::Beam& beam, std::vector<base::TimeFunction> upward,
                             std::vector<base::TimeFunction> along)
    : function_{std::move(upward), std::move(along)} {
  const std::size_t size = static_cast<std::size_t>(beam.local_unknowns()), supports = beam.model().supports.size();
  for (std::vector<double>& x : moved_) x.assign(size, 0.0);
  load_.assign(size, 0.0);
  for (std::size_t direction = 0; direction < function_.size(); ++direction) {
    now_[direction].resize(supports);
    for (std::size_t s = 0; s < function_[direction].size(); ++s) {
      const base::TimeFunction& f = function_[direction][s];
      if (!f.straight() || f.value(0.0) != 0.0 || f.rate(0.0) != 0.0) add_unit(beam, direction, s);
    }
  }
}

void SupportMotion::add_unit(const beam::Beam& beam, std::size_t direction, std::size_t support) {
  beam::BeamModel model = beam.model();
  model.temperature.reset();
  model.settlement.assign(model.supports.size(), 0.0);
  model.shift.assign(model.supports.size(), 0.0);
  (direction == 0 ? model.settlement : model.shift)[support] = 1.0;
  beam::Beam moved(beam.comm(), std::move(model));
  moved.set_rayleigh({});
  if (!moved.has_imposed()) return;  // the support does not hold the beam in this direction
  ElementStructure structure(moved, 0.0);
  Unit unit{direction, support, structure.displacements_without_traffic(), std::vector<double>(load_.size()), {}, {}};
  structure.statics().multiply(1.0, unit.shape.data(), nullptr, nullptr, unit.inertia.data());
  for (std::size_t i = 0; i < load_.size(); ++i) unit.inertia[i] += moved.inertia_of_imposed()[i];
  structure.release_held(unit.inertia.data());
  const std::vector<double> zero(load_.size(), 0.0);
  moved.reactions(zero.data(), zero.data(), zero.data(), zero.data(), unit.by_displacement);
  moved.reactions_of_imposed_acceleration(unit.by_acceleration);
  units_.push_back(std::move(unit));
}

bool SupportMotion::select_sides(double t) {
  bool changed = false;
  for (std::vector<base::TimeFunction>& functions : function_)
    for (base::TimeFunction& f : functions) changed = f.select_side(t) || changed;
  return changed;
}

std::vector<double> SupportMotion::rows() const {
  std::vector<double> rows;
  for (const std::vector<base::TimeFunction>& functions : function_)
    for (const base::TimeFunction& f : functions) rows.insert(rows.end(), f.rows().begin(), f.rows().end());
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

void SupportMotion::set_time(double t) {
  for (std::vector<double>& x : moved_) std::fill(x.begin(), x.end(), 0.0);
  std::fill(load_.begin(), load_.end(), 0.0);
  for (const Unit& unit : units_) {
    const base::TimeFunction& f = function_[unit.direction][unit.support];
    Movement& now = now_[unit.direction][unit.support];
    now = {f.value(t), f.rate(t), f.acceleration(t)};
    const auto [displacement, velocity, acceleration] = now;
    for (std::size_t i = 0; i < load_.size(); ++i) {
      moved_[0][i] += displacement * unit.shape[i];
      moved_[1][i] += velocity * unit.shape[i];
      moved_[2][i] += acceleration * unit.shape[i];
      load_[i] -= acceleration * unit.inertia[i];
    }
  }
}

void SupportMotion::add_reactions(std::vector<beam::Reaction>& reactions) const {
  for (const Unit& unit : units_) {
    const Movement& now = now_[unit.direction][unit.support];
    for (std::size_t end = 0; end < unit.by_displacement.size(); ++end)
      for (std::size_t c = 0; c < reactions[end].size(); ++c)
        reactions[end][c] +=
            now.displacement * unit.by_displacement[end][c] + now.acceleration * unit.by_acceleration[end][c];
  }
}

}  // namespace traverse::structure
