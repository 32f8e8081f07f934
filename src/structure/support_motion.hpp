// Supports that move vertically and along the beam by given displacements u_s(t), as in an earthquake or beside a pile
// driver. The motion of the beam is
//
//   v = sum of R_s u_s + z,   M z'' + C z' + K z = P - sum of M R_s u_s''
//
// with the static displacements R_s of the whole beam under a unit displacement of support s, and z = 0 at the
// supports. The structure's state is z. Damping acts on z alone, as usual for base excitation. Different motions of the
// supports deform the beam by R_s statically; equal ones carry it as a rigid body.
#pragma once

#include <array>
#include <vector>

#include "beam/beam.hpp"
#include "traverse/base/time_function.hpp"

namespace traverse::structure {

/// A displacement (m) and its rates.
struct Movement {
  double displacement = 0.0, velocity = 0.0, acceleration = 0.0;
};

class SupportMotion {
 public:
  /// Collective. The displacement of the support at each span end upward and along the beam, m; empty: none. Supports
  /// that do not hold the beam along x do not move it along x.
  SupportMotion(const beam::Beam& beam, std::vector<base::TimeFunction> upward, std::vector<base::TimeFunction> along);

  /// Sets all following quantities to their values at t.
  void set_time(double t);
  /// Before a time step around t: the accelerations within the step apply at its ends. Returns whether they jump.
  bool select_sides(double t);
  /// The times of the rows of all tables, s.
  std::vector<double> rows() const;

  /// Sum of R_s u_s and its rates: this rank's unknowns of the beam, held ones included.
  const std::vector<double>& displacement() const { return moved_[0]; }
  const std::vector<double>& velocity() const { return moved_[1]; }
  const std::vector<double>& acceleration() const { return moved_[2]; }
  /// The load -sum of M R_s u_s'' on this rank's free unknowns, N and N m.
  const std::vector<double>& load() const { return load_; }
  /// The motion of the support at each span end upward, and along the beam.
  const std::vector<Movement>& upward() const { return now_[0]; }
  const std::vector<Movement>& along() const { return now_[1]; }
  /// The parts of the reactions that come from the motion of the held unknowns themselves (Beam::reactions has those of
  /// the free ones): {fx, fy, moment} at every span end.
  void add_reactions(std::vector<beam::Reaction>& reactions) const;

 private:
  struct Unit {  // a unit displacement of one support: upward (0) or along the beam (1)
    std::size_t direction = 0, support = 0;
    std::vector<double> shape, inertia;                            // R_s and M R_s
    std::vector<beam::Reaction> by_displacement, by_acceleration;  // reactions
  };
  void add_unit(const beam::Beam& beam, std::size_t direction, std::size_t support);

  std::array<std::vector<base::TimeFunction>, 2> function_;  // upward, along the beam
  std::vector<Unit> units_;
  std::array<std::vector<Movement>, 2> now_;
  std::array<std::vector<double>, 3> moved_;
  std::vector<double> load_;
};

}  // namespace traverse::structure
