// Openings of the rail expansion devices of a layered track.
#pragma once

#include <vector>

#include "beam/beam.hpp"

namespace traverse::recovery {

class RailDevices {
 public:
  explicit RailDevices(const beam::Beam& beam);

  /// Collective, from this rank's slice of the nodal displacements; the results are complete on every rank.
  void evaluate(const double* v);

  /// Stations of the devices from left to right, m; empty without devices or without axial unknowns.
  const std::vector<double>& x() const { return x_; }
  /// Displacement along x of the rail on the right of each device minus that on its left, m; positive if it opens.
  const std::vector<double>& openings() const { return openings_; }

 private:
  const beam::Beam& beam_;
  std::vector<double> x_, openings_;
  std::vector<int> left_, right_;  // global unknowns
};

}  // namespace traverse::recovery
