// Forces on the structure other than loads and support reactions: the linear part of the foundation of section 3, the
// ground under a layered track, and the resultants of inertia, all linear in the nodal values. With loads, reactions
// and the nonlinear part of the foundation their sum is zero.
#pragma once

#include <array>
#include <vector>

#include "beam/beam.hpp"

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

}  // namespace traverse::recovery
