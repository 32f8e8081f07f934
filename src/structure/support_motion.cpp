// The static shapes of unit displacements of the supports, from beams with one settled support each, and their inertia.
#include "structure/support_motion.hpp"

#include "structure/element_structure.hpp"

namespace traverse::structure {

SupportMotion::SupportMotion(const beam::Beam& beam, std::vector<base::TimeFunction> displacement)
    : function_(std::move(displacement)), now_(function_.size()) {
  const auto size = static_cast<std::size_t>(beam.local_unknowns());
  for (std::vector<double>& x : moved_) x.assign(size, 0.0);
  load_.assign(size, 0.0);
  for (std::size_t s = 0; s < function_.size(); ++s) {
    const base::TimeFunction& f = function_[s];
    if (f.straight() && f.value(0.0) == 0.0 && f.rate(0.0) == 0.0) continue;
    beam::BeamModel model = beam.model();
    model.temperature.reset();
    model.settlement.assign(function_.size(), 0.0);
    model.settlement[s] = 1.0;
    beam::Beam settled(beam.comm(), std::move(model));
    settled.set_rayleigh({});
    ElementStructure one(settled, 0.0);
    Unit unit{s, one.displacements_without_traffic(), std::vector<double>(size), {}, {}};
    one.statics().multiply(1.0, unit.shape.data(), nullptr, nullptr, unit.inertia.data());
    for (std::size_t i = 0; i < size; ++i) unit.inertia[i] += settled.inertia_of_imposed()[i];
    one.release_held(unit.inertia.data());
    const std::vector<double> zero(size, 0.0);
    settled.reactions(zero.data(), zero.data(), zero.data(), zero.data(), unit.by_displacement);
    settled.reactions_of_imposed_acceleration(unit.by_acceleration);
    units_.push_back(std::move(unit));
  }
}

void SupportMotion::set_time(double t) {
  for (std::vector<double>& x : moved_) std::fill(x.begin(), x.end(), 0.0);
  std::fill(load_.begin(), load_.end(), 0.0);
  for (const Unit& unit : units_) {
    const base::TimeFunction& f = function_[unit.support];
    now_[unit.support] = {f.value(t), f.rate(t), f.acceleration(t)};
    const auto [displacement, velocity, acceleration] = now_[unit.support];
    for (std::size_t i = 0; i < load_.size(); ++i) {
      moved_[0][i] += displacement * unit.shape[i];
      moved_[1][i] += velocity * unit.shape[i];
      moved_[2][i] += acceleration * unit.shape[i];
      load_[i] -= acceleration * unit.inertia[i];
    }
  }
}

void SupportMotion::add_reactions(std::vector<std::array<double, 3>>& reactions) const {
  for (const Unit& unit : units_)
    for (std::size_t end = 0; end < unit.by_displacement.size(); ++end)
      for (std::size_t c = 0; c < 3; ++c)
        reactions[end][c] += now_[unit.support].displacement * unit.by_displacement[end][c] +
                             now_[unit.support].acceleration * unit.by_acceleration[end][c];
}

}  // namespace traverse::structure
