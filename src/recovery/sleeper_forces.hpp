// Forces in the pads of sleepers of a layered track and in the ballast below them.
#pragma once

#include <vector>

#include "beam/beam.hpp"
#include "beam/layered_track.hpp"

namespace traverse::recovery {

class SleeperForces {
 public:
  /// Forces of the sleepers nearest to these stations of a layered track, m.
  SleeperForces(const beam::Beam& beam, const std::vector<double>& stations);

  /// Collective, from this rank's slices of the nodal displacements and their rates; complete on every rank.
  void evaluate(const double* v, const double* w);

  /// Stations of the sleepers, m.
  const std::vector<double>& x() const { return x_; }
  /// Forces of springs and dampers in the order of the stations, N, positive in compression: between rail and sleeper,
  /// and between the sleeper and the layer below its ballast, without ballast that acts over a gap.
  double pad(std::size_t i) const { return sums_[2 * i]; }
  double ballast(std::size_t i) const { return sums_[2 * i + 1]; }

 private:
  /// The term c w + k v of one local unknown in one sum.
  struct Term {
    std::size_t sum, unknown;
    double c, k;
  };
  /// Adds `factor` times the displacement of an unknown to the compression of a spring; -1: it does not move.
  void add(std::size_t sum, int unknown, const beam::Spring& spring, double factor);
  /// Adds the bridge's deflection below a sleeper to the compression of a spring.
  void add_bridge(std::size_t sum, const beam::Sleeper& s, const beam::Spring& spring);
  void add_sleeper(std::size_t i, const beam::Sleeper& s);

  const beam::Beam& beam_;
  std::vector<double> x_;
  std::vector<Term> terms_;
  std::vector<double> sums_;
};

}  // namespace traverse::recovery
