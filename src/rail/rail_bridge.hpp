// Static equilibrium of rail and bridge under vertical loads and loads along x: a sequence of states, because sliding
// sleepers have a history. The layered track's longitudinal springs connect the rail with the deck's running surface,
// which moves along x by u - e theta if the deck stretches, bends and slips on its bearings.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "recovery/ground_forces.hpp"
#include "structure/beam_operator.hpp"
#include "structure/nonlinear_foundation.hpp"

namespace traverse::rail {

/// Loads of one state.
struct Loads {
  bool strains = false;         // temperatures of deck and rail, settlements
  double from = 0.0, to = 0.0;  // m: ends of a train, below which sleepers are loaded; equal: none
  double weight = 0.0;          // weight of this train, N/m
  double along_from = 0.0, along_to = 0.0, along = 0.0;  // m, N/m: forces on the rail, positive along x
};

struct State {
  std::vector<double> v;  // m and rad, all unknowns
  structure::NonlinearFoundation::History slid;
  std::vector<double> stress;  // stress of each rail element, Pa: EA u'/A, without the stress of a restrained rail
  std::vector<double> displacement;  // displacement of the rail relative to the deck or the ground at each sleeper, m
  std::vector<double> bearings;      // force along x of each bearing on the bridge, N
  std::vector<double> ends;          // displacement along x of the deck's running surface at each end, m
  std::vector<double> openings;      // opening of each expansion device of the rail, m
  double rail_ends = 0.0;            // reaction along x on the rail at its ends, N
};

/// A bridge with a layered track and axial unknowns, on this rank only.
class RailBridge {
 public:
  /// rail_area: area of both rails, m2. greatest_load: largest of all loads, N; residual forces are relative to it.
  RailBridge(const beam::BeamModel& model, double rail_area, double greatest_load);
  RailBridge(const RailBridge&) = delete;
  RailBridge& operator=(const RailBridge&) = delete;

  /// The equilibrium under these loads. earlier: the state before; null: none, the track is free of forces. SolverError
  /// if no equilibrium is found.
  State equilibrium(const Loads& loads, const State* earlier = nullptr);

  const std::vector<double>& elements() const { return elements_; }  // m: the middle of each rail element
  const std::vector<double>& sleepers() const { return sleepers_; }  // m
  /// Supports along x, then longitudinal point springs.
  const std::vector<double>& bearings() const { return bearings_; }    // m
  const std::vector<double>& ends() const { return ends_; }            // left and right end of every span, m
  const std::vector<double>& devices() const { return devices_.x(); }  // m: expansion devices of the rail
  /// Pa, of each rail element: thermal stress of a rail that cannot expand.
  const std::vector<double>& restrained_stress() const { return restrained_stress_; }
  /// N along x: the sum of all forces on rail and bridge, zero in equilibrium.
  double residual(const Loads& loads, const State& state);

 private:
  std::vector<double> nodal_forces(const Loads& loads) const;
  void record_stations();
  void recover(const std::vector<double>& P, State& state);
  double surface(const std::vector<double>& v, const beam::Station& at) const;

  beam::Beam beam_;
  structure::BeamOperator op_;
  structure::NonlinearFoundation nonlinear_;
  recovery::GroundForces ground_;
  recovery::RailDevices devices_;
  double area_;
  std::vector<double> elements_, restrained_stress_, sleepers_, bearings_, ends_;
  std::vector<int> held_ends_;  // span ends whose support holds the bridge along x
  std::vector<beam::Station> end_stations_;
};

}  // namespace traverse::rail
