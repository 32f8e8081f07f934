// Elastic forces of a beam with stiffness-proportional damping, where loads act inside elements.
#pragma once

#include <array>
#include <vector>

#include "base/bytes.hpp"
#include "recovery/recovery.hpp"

namespace traverse::beam {

/// With damping b K (eq. 19) a section carries M + b dM/dt, M = EI v''. Equilibrium within an element gives this sum,
/// so what loads, inertia and foundation inside it add, c, reaches the elastic forces by m + b dm/dt = c: the moment
/// under a passing wheel has no kink, but follows b behind; the shear does not jump, but relaxes within b.
class ViscousLag {
 public:
  /// Of the stations of `recovery`, which must outlive it; b in s, above 0.
  ViscousLag(const Recovery& recovery, double b) : recovery_(recovery), b_(b), inner_(recovery.stations().size()) {}

  /// Of all stations at ascending times, with the loads that were given to evaluate(): replaces what c adds to moment,
  /// shear and axial force by m, and fills in moment_rate and unrelaxed_shear. Between calls loads have moved evenly,
  /// and what else is in c has changed evenly; at the first one the beam is at rest, m = c.
  void apply(double t, const std::vector<ElementLoad>& loads, std::vector<Response>& responses);
  void keep(base::Bytes& bytes) { bytes(time_, interval_, inner_, loads_, first_); }

 private:
  static constexpr std::size_t parts = 16;  // of an interval in which a load passes through a station's element
  using History = std::array<Forces, parts + 1>;
  struct Inner {
    Forces c{}, m{}, unrelaxed{};  // unrelaxed: of jumps, in m
  };
  /// A load that has moved since the call before: as it was then, and is now, and where, m. One that has come onto the
  /// beam since was not there then, one that has left it is not there now.
  struct Moved {
    ElementLoad from, to;
    double x_from, x_to;
    bool was_there, is_there;
  };
  /// A load that has passed a station, s before now, and by how much c has jumped.
  struct Jump {
    Forces by;
    double ago;
  };

  void record_moved(const std::vector<ElementLoad>& loads);
  bool passing(std::size_t station, History& by_loads);
  void follow(std::size_t station, const Forces& c);

  const Recovery& recovery_;
  double b_;
  double time_ = 0.0, interval_ = 0.0;  // of the latest call, and since the one before, s
  std::vector<Inner> inner_;            // of each station
  std::vector<ElementLoad> loads_;      // of the latest call
  std::vector<Moved> moved_;
  std::vector<char> found_;  // of loads_: whether it has moved and still is there
  std::vector<Jump> jumps_;  // at the station that is looked at
  bool first_ = true;
};

}  // namespace traverse::beam
