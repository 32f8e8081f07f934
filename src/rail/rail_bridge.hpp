// Rail and bridge together at rest, under loads along the track and across it: one state after another, since sleepers
// that slide remember. The layered track's longitudinal springs join the rail to the deck's running surface, which
// moves along x by u - e theta as the deck stretches, bends and slips on its bearings.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "recovery/ground_forces.hpp"
#include "recovery/rail_devices.hpp"
#include "structure/beam_operator.hpp"
#include "structure/nonlinear_foundation.hpp"

namespace traverse::rail {

/// What acts at once.
struct Loads {
  bool strains = false;         // temperatures of deck and rail, settlements
  double from = 0.0, to = 0.0;  // m: where a train stands, and sleepers are loaded; equal: none
  double weight = 0.0;          // N/m, of this train
  double along_from = 0.0, along_to = 0.0, along = 0.0;  // m, N/m: forces on the rail, towards +x
};

struct State {
  std::vector<double> v;  // m and rad, of all unknowns
  structure::NonlinearFoundation::History slid;
  std::vector<double> stress;        // Pa, of each rail element: EA u'/A, without that of a rail which cannot lengthen
  std::vector<double> displacement;  // m, of the rail against the deck or the ground, at each sleeper
  std::vector<double> bearings;      // N along x on the bridge, of each bearing
  std::vector<double> ends;          // m along x, of the deck's running surface at each end
  std::vector<double> openings;      // m, of each expansion device of the rail
  double rail_ends = 0.0;            // N along x on the rail, of what holds its ends
};

/// A bridge with a layered track and axial unknowns, on this rank alone.
class RailBridge {
 public:
  /// rail_area: of both rails, m2. greatest_load: N, of all that will act, and what forces are judged against.
  RailBridge(const beam::BeamModel& model, double rail_area, double greatest_load);
  RailBridge(const RailBridge&) = delete;
  RailBridge& operator=(const RailBridge&) = delete;

  /// At rest under all these loads. before: what has acted until then; null: nothing, the track is free of forces.
  /// SolverError where no equilibrium is found.
  State rest(const Loads& loads, const State* before = nullptr);

  const std::vector<double>& elements() const { return elements_; }  // m: the middle of each rail element
  const std::vector<double>& sleepers() const { return sleepers_; }  // m
  /// What holds the bridge along x: supports, then longitudinal springs at stations.
  const std::vector<double>& bearings() const { return bearings_; }    // m
  const std::vector<double>& ends() const { return ends_; }            // m: of every span, left and right
  const std::vector<double>& devices() const { return devices_.x(); }  // m: expansion devices of the rail
  /// Pa, of each rail element: what its temperature does to a rail that cannot lengthen.
  const std::vector<double>& own_stress() const { return own_stress_; }
  /// N along x: all forces on rail and bridge together, which are in balance.
  double residual(const Loads& loads, const State& state);

 private:
  std::vector<double> nodal_forces(const Loads& loads) const;
  void record_stations();
  void recover(const std::vector<double>& P, State& state);
  double surface(const std::vector<double>& v, const beam::Station& at) const;

  beam::Beam beam_;
  structure::BeamOperator op_;
  structure::NonlinearFoundation nonlinear_;
  beam::GroundForces ground_;
  beam::RailDevices devices_;
  double area_;
  std::vector<double> elements_, own_stress_, sleepers_, bearings_, ends_;
  std::vector<int> held_ends_;  // span ends whose support holds the bridge along x
  std::vector<beam::Station> end_stations_;
};

}  // namespace traverse::rail
