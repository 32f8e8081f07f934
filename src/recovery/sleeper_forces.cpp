// Pad and ballast forces as linear combinations of the displacements and velocities above and below each spring, summed
// over ranks.
#include "recovery/sleeper_forces.hpp"

#include <algorithm>
#include <cmath>

#include "beam/assembly.hpp"
#include "beam/layered_track.hpp"
#include "beam/shape.hpp"

namespace traverse::recovery {

SleeperForces::SleeperForces(const beam::Beam& beam, const std::vector<double>& stations)
    : beam_(beam), sums_(2 * stations.size(), 0.0) {
  const std::vector<beam::Sleeper> all = beam::sleepers_of(beam.bridge(), 0, beam.columns());
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const auto nearest = std::min_element(all.begin(), all.end(), [&](const beam::Sleeper& a, const beam::Sleeper& b) {
      return std::abs(a.x - stations[i]) < std::abs(b.x - stations[i]);
    });
    x_.push_back(nearest->x);
    add_sleeper(i, *nearest);
  }
}

void SleeperForces::add_sleeper(std::size_t i, const beam::Sleeper& s) {
  const beam::Layout& layout = beam_.layout();
  const std::size_t pad = 2 * i, ballast = pad + 1;
  add(pad, s.rail_node * layout.block + layout.place[beam::rail_v], s.values.pad, -1.0);
  if (!s.sleeper_moves) {  // the pad acts on the bridge or on the ground
    if (s.on_bridge) add_bridge(pad, s, s.values.pad);
    return;
  }
  add(pad, s.unknown(layout), s.values.pad, 1.0);
  add(ballast, s.unknown(layout), s.linear_ballast(), -1.0);
  if (s.ballast_moves)
    add(ballast, s.ballast_unknown(layout), s.linear_ballast(), 1.0);
  else if (s.on_bridge)
    add_bridge(ballast, s, s.linear_ballast());
}

void SleeperForces::add_bridge(std::size_t sum, const beam::Sleeper& s, const beam::Spring& spring) {
  const beam::Element& element = beam_.mesh().element(s.at.element);
  const auto psi = beam::hermite(s.at.xi, element.length, element.shear).value;
  const auto places = beam_.bridge().transverse(s.at.element);
  for (std::size_t i = 0; i < 4; ++i) add(sum, places[i], spring, psi[i]);
}

void SleeperForces::add(std::size_t sum, int unknown, const beam::Spring& spring, double factor) {
  const int local = unknown < 0 ? -1 : beam_.local(unknown);
  if (local >= 0) terms_.push_back({sum, beam::index(local), factor * spring.c, factor * spring.k});
}

void SleeperForces::evaluate(const double* v, const double* w) {
  std::fill(sums_.begin(), sums_.end(), 0.0);
  for (const Term& t : terms_) sums_[t.sum] += t.c * w[t.unknown] + t.k * v[t.unknown];
  MPI_Allreduce(MPI_IN_PLACE, sums_.data(), static_cast<int>(sums_.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
}

}  // namespace traverse::recovery
