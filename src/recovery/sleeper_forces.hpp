// What sleepers of a layered track carry: the forces in their pads and in the ballast below them.
#pragma once

#include <vector>

#include "beam/beam.hpp"

namespace traverse::beam {

struct Sleeper;

class SleeperForces {
 public:
  /// Of the sleepers nearest to these stations of a layered track, m.
  SleeperForces(const Beam& beam, const std::vector<double>& stations);

  /// Collective, complete on every rank: from this rank's slices of the nodal displacements and their rates.
  void evaluate(const double* v, const double* w);

  /// Where the sleepers stand, m.
  const std::vector<double>& x() const { return x_; }
  /// Forces of springs and dampers in the order of the stations, N, where pressed above 0: between rail and sleeper,
  /// and between the sleeper and what is below its ballast, without what acts over a gap.
  double pad(std::size_t i) const { return sums_[2 * i]; }
  double ballast(std::size_t i) const { return sums_[2 * i + 1]; }

 private:
  /// c w + k v of one local unknown, into one sum.
  struct Term {
    std::size_t sum, unknown;
    double c, k;
  };
  /// Adds `factor` times the displacement of an unknown to what presses a spring; -1: it does not move.
  void add(std::size_t sum, int unknown, const Spring& spring, double factor);
  /// The same of the bridge's deflection under a sleeper.
  void add_bridge(std::size_t sum, const Sleeper& s, const Spring& spring);
  void add_sleeper(std::size_t i, const Sleeper& s);

  const Beam& beam_;
  std::vector<double> x_;
  std::vector<Term> terms_;
  std::vector<double> sums_;
};

}  // namespace traverse::beam
