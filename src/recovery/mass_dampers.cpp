// Travels are sums over this rank's unknowns, and then over the ranks.
#include "recovery/mass_dampers.hpp"

#include <algorithm>
#include <cmath>

#include "beam/assembly.hpp"

namespace traverse::recovery {

MassDampers::MassDampers(const beam::Beam& beam) : beam_(beam), sums_(2 * dampers().size()), largest_(sums_.size()) {
  const std::vector<beam::DamperPlace> places = places_of_dampers(beam.bridge(), beam.layout());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto add = [&](int unknown, double factor) {
      const int local = unknown < 0 ? -1 : beam.local(unknown);
      if (local >= 0 && factor != 0.0) terms_.push_back({i, beam::index(local), factor});
    };
    add(places[i].unknown, 1.0);
    for (std::size_t j = 0; j < places[i].beam.unknown.size(); ++j)
      add(places[i].beam.unknown[j], -places[i].beam.shape[j]);
  }
}

void MassDampers::evaluate(double t, const double* v, const double* w) {
  std::fill(sums_.begin(), sums_.end(), 0.0);
  for (const Term& term : terms_) {
    sums_[2 * term.damper] += term.factor * v[term.unknown];
    sums_[2 * term.damper + 1] += term.factor * w[term.unknown];
  }
  MPI_Allreduce(MPI_IN_PLACE, sums_.data(), static_cast<int>(sums_.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
  for (std::size_t i = 0; i < dampers().size(); ++i) {
    largest_[2 * i].raise(std::abs(travel(i)), t, i);
    largest_[2 * i + 1].raise(std::abs(force(i)), t, i);
  }
}

std::vector<base::DamperPeaks> MassDampers::largest() const {
  std::vector<base::DamperPeaks> all;
  for (std::size_t i = 0; i < dampers().size(); ++i)
    all.push_back({dampers()[i].name, largest_[2 * i], largest_[2 * i + 1]});
  return all;
}

double MassDampers::force(std::size_t i) const {
  const beam::MassDamper& damper = dampers()[i];
  return damper.k * sums_[2 * i] + damper.c * sums_[2 * i + 1];
}

}  // namespace traverse::recovery
