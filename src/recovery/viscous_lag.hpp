// Elastic forces of a beam with stiffness-proportional damping under loads inside elements.
#pragma once

#include <array>
#include <vector>

#include "base/bytes.hpp"
#include "recovery/load_movement.hpp"
#include "recovery/recovery.hpp"

namespace traverse::recovery {

/// With damping b K (eq. 19) a section transmits M + b dM/dt, M = EI v''. Equilibrium of an element determines this
/// sum. The contribution c of loads, inertia and foundation inside the element therefore enters the elastic forces as m
/// with m + b dm/dt = c: the moment below a passing wheel has no kink and lags by b; the shear does not jump but
/// changes with the time constant b.
class ViscousLag {
 public:
  /// The lag at the stations of `recovery`, under the loads of `movement`; both must outlive this object. b in s, above
  /// 0.
  ViscousLag(const Recovery& recovery, const LoadMovement& movement, double b)
      : recovery_(recovery), movement_(movement), b_(b), inner_(recovery.stations().size()) {}

  /// Replaces c by m in moment, shear and axial force of all stations, and sets moment_rate and the unrelaxed forces,
  /// at the latest instant of the movement. Between instants the loads move uniformly and all other parts of c change
  /// linearly; at the first call the beam is at rest, m = c.
  void apply(std::vector<Response>& responses);
  void keep(base::Bytes& bytes) { bytes(inner_, first_); }

 private:
  static constexpr std::size_t parts =
      16;  // divisions of an interval in which a load passes through a station's element
  using History = std::array<Forces, parts + 1>;
  struct Inner {
    Forces c{}, m{}, unrelaxed{};  // unrelaxed: parts of jumps that m does not contain yet
  };
  /// The passage of a load at a station, `ago` s before the present call, with the jump of c.
  struct Jump {
    Forces by;
    double ago;
  };

  bool add_passing_loads(std::size_t station, History& by_loads);
  void advance_lag(std::size_t station, const Forces& c);

  const Recovery& recovery_;
  const LoadMovement& movement_;
  double b_;
  std::vector<Inner> inner_;  // state of each station
  std::vector<Jump> jumps_;   // at the present station
  bool first_ = true;
};

}  // namespace traverse::recovery
