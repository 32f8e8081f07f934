// Elastic forces of a beam with stiffness-proportional damping under loads inside elements.
#pragma once

#include <array>
#include <vector>

#include "base/bytes.hpp"
#include "recovery/recovery.hpp"

namespace traverse::beam {

/// With damping b K (eq. 19) a section transmits M + b dM/dt, M = EI v''. Equilibrium of an element determines this
/// sum. The contribution c of loads, inertia and foundation inside the element therefore enters the elastic forces as m
/// with m + b dm/dt = c: the moment below a passing wheel has no kink and lags by b; the shear does not jump but
/// changes with the time constant b.
class ViscousLag {
 public:
  /// The lag at the stations of `recovery`, which must outlive this object; b in s, above 0.
  ViscousLag(const Recovery& recovery, double b) : recovery_(recovery), b_(b), inner_(recovery.stations().size()) {}

  /// Replaces c by m in moment, shear and axial force of all stations, and sets moment_rate and the unrelaxed forces.
  /// The times of the calls must be ascending; `loads` are the loads of evaluate(). Between calls the loads move
  /// uniformly and all other parts of c change linearly; at the first call the beam is at rest, m = c.
  void apply(double t, const std::vector<ElementLoad>& loads, std::vector<Response>& responses);
  void keep(base::Bytes& bytes) { bytes(time_, interval_, inner_, loads_, first_); }

 private:
  static constexpr std::size_t parts =
      16;  // divisions of an interval in which a load passes through a station's element
  using History = std::array<Forces, parts + 1>;
  struct Inner {
    Forces c{}, m{}, unrelaxed{};  // unrelaxed: parts of jumps that m does not contain yet
  };
  /// A load that has moved since the previous call: its previous and its present values and positions, m. A load that
  /// has entered the beam since then has no previous value, one that has left it no present value.
  struct Moved {
    ElementLoad from, to;
    double x_from, x_to;
    bool was_there, is_there;
  };
  /// The passage of a load at a station, `ago` s before the present call, with the jump of c.
  struct Jump {
    Forces by;
    double ago;
  };

  void record_moved(const std::vector<ElementLoad>& loads);
  bool add_passing_loads(std::size_t station, History& by_loads);
  void advance_lag(std::size_t station, const Forces& c);

  const Recovery& recovery_;
  double b_;
  double time_ = 0.0, interval_ = 0.0;  // time of the latest call, and interval since the previous call, s
  std::vector<Inner> inner_;            // state of each station
  std::vector<ElementLoad> loads_;      // loads of the latest call
  std::vector<Moved> moved_;
  std::vector<char> found_;  // for each of loads_: whether it is on the beam at the present call too
  std::vector<Jump> jumps_;  // at the present station
  bool first_ = true;
};

}  // namespace traverse::beam
