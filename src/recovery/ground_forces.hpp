// Forces on the structure other than loads and support reactions: the linear part of the foundation of section 3, the
// ground under a layered track, and the resultants of inertia, all linear in the nodal values. With loads, reactions
// and the nonlinear part of the foundation their sum is zero. Also forces in the pads of sleepers of a layered track
// and in the ballast below them, and openings of its rail expansion devices.
#pragma once

#include <array>
#include <vector>

#include "beam/beam.hpp"
#include "beam/layered_track.hpp"

namespace traverse::recovery {

class GroundForces {
 public:
  explicit GroundForces(const beam::Beam& beam);

  /// Collective, from this rank's slices of the nodal vectors; the results are complete on every rank.
  void evaluate(const double* v, const double* w, const double* a);

  /// Forces of a kind of foundation on the structure, N upward or to the right, or N m. Points are in the model's
  /// order; a bed has its resultant over each span. Longitudinal kinds exist only with axial unknowns.
  const double* of_kind(std::size_t kind) const { return &sums_[first_[kind]]; }
  /// Resultants {x, y}: of all forces of the foundation and the ground under a layered track; of this ground alone; of
  /// the inertia forces; of the drag a M w of mass-proportional damping.
  std::array<double, 2> foundation() const;
  std::array<double, 2> track_bed() const { return {sums_[track_], sums_[track_ + 1]}; }
  std::array<double, 2> inertia() const { return {sums_[inertia_], sums_[inertia_ + 1]}; }
  std::array<double, 2> drag() const;
  /// Mass of all parts that move vertically, kg.
  double mass() const { return mass_; }

 private:
  /// The term -(c w + k v) of one unknown in one sum.
  struct Term {
    std::size_t sum, unknown;
    double c, k;
  };
  /// The inertia forces along x and y per unit acceleration of each local unknown.
  using Masses = std::array<std::vector<double>, 2>;
  void add(std::size_t sum, int unknown, double c, double k);
  void add_mass(std::vector<double>& masses, int unknown, double mass) const;
  void add_points(std::size_t kind, const beam::Line& line);
  void add_bed(std::size_t kind, const beam::Line& line);
  void add_masses(const beam::Line& line, Masses& masses) const;
  void add_track();

  const beam::Beam& beam_;
  std::vector<Term> terms_;
  Masses masses_, bridge_masses_;
  std::vector<double> sums_;
  std::array<std::size_t, beam::foundation_kind_count + 1> first_{};  // first sum of each kind, and past the last
  std::size_t track_ = 0, inertia_ = 0, drag_ = 0;
  double mass_ = 0.0;
};

/// Forces in the pads of sleepers of a layered track and in the ballast below them.
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

/// Openings of the rail expansion devices of a layered track.
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
