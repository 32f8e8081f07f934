// Rail expansion devices of a layered track: how far each is open.
#pragma once

#include <vector>

#include "beam/beam.hpp"

namespace traverse::beam {

class RailDevices {
 public:
  explicit RailDevices(const Beam& beam);

  /// Collective, complete on every rank: from this rank's slice of the nodal displacements.
  void evaluate(const double* v);

  /// Where the devices stand, from left to right, m; empty: there are none, or the beam has no axial unknowns.
  const std::vector<double>& x() const { return x_; }
  /// Displacement along x of the rail to the right of each less that to its left, m: above 0 it has opened.
  const std::vector<double>& openings() const { return openings_; }

 private:
  const Beam& beam_;
  std::vector<double> x_, openings_;
  std::vector<int> left_, right_;  // global unknowns
};

}  // namespace traverse::beam
