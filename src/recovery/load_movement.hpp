// The moving loads of two successive instants, where they were and are, and which stations they have passed; and
// elastic forces of a beam with stiffness-proportional damping under loads inside elements.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/bytes.hpp"
#include "recovery/recovery.hpp"

namespace traverse::recovery {

/// A load has passed a station: it is on the other side than at the previous instant.
struct StationPassage {
  std::size_t station = 0;  // its index
  double time = 0.0;        // s, if the load has moved uniformly
};

class LoadMovement {
 public:
  /// A load that has moved since the previous instant: its previous and its present values and positions, m. A load
  /// that has entered or left the beam since then has one position outside, and the same value in both.
  struct Moved {
    ElementLoad from, to;
    double x_from, x_to;
  };

  /// Of the stations of `recovery`, which must outlive this object.
  explicit LoadMovement(const Recovery& recovery);

  /// The next instant, with all loads of Recovery::evaluate(). The times must be ascending; a repeated time replaces
  /// the loads.
  void advance(double t, const std::vector<ElementLoad>& loads);

  /// s since the previous instant; 0: there is none.
  double interval() const { return interval_; }
  /// Those that may have been between two places of the line, m, in the order of the lesser of their positions.
  std::span<const Moved> moved(double from, double to) const;
  /// By station, then by time.
  std::span<const StationPassage> passages() const { return passages_; }
  void keep(base::Bytes& bytes) { bytes(time_, loads_, first_); }

 private:
  void record_moved(const std::vector<ElementLoad>& loads);
  void record_passages();

  const Recovery& recovery_;
  double time_ = 0.0, interval_ = 0.0;
  bool first_ = true;
  std::vector<ElementLoad> loads_;  // of the latest instant
  std::vector<Moved> moved_;        // in the order of the lesser of both positions
  double longest_way_ = 0.0;        // m, of these loads
  std::vector<char> found_;         // for each of loads_: whether it is on the beam at the present instant too
  std::vector<std::size_t> along_;  // the stations in ascending order of x
  std::vector<StationPassage> passages_;
};

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
  void apply(std::vector<Response>& responses) { apply(responses, recovery_.all()); }
  /// The same for the stations `which` only; at all others the beam remains at rest.
  void apply(std::vector<Response>& responses, const std::vector<std::size_t>& which);
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
