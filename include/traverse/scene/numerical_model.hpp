// The numerical model of a run: given by the user, or selected for the wanted accuracy.
#pragma once

#include <limits>
#include <optional>
#include <string>

namespace traverse::scene {

/// Vehicles as mechanisms (full), or linear where possible. automatic: linear if the search for the accuracy finds the
/// difference negligible, until then mechanisms.
enum class VehicleModel { full, linear, automatic };

/// Representation of the bridge, mesh, method and step, and vehicle model.
struct NumericalModel {
  int modes = 0;  // number of modes of the bridge; 0: elements
  int elements =
      0;  // elements in the longest span, or rail elements in a sleeper bay; 0: the elements of the beam model
  std::optional<double> step;  // s; none: not yet selected, or exact in time
  std::string method;          // time integrator, a name of -ts_type; empty: the integrator in the options
  VehicleModel vehicles = VehicleModel::full;
  /// Largest permitted residual of linear vehicles over their weight, above which the run is repeated with mechanisms.
  double residual_limit = std::numeric_limits<double>::infinity();
  bool trials_lost_contact = false;  // wheels lost contact in trial runs
  double window_tolerance = -1.0;  // relative motion below which parts far from the train are excluded; -1: auto
  bool local_compliance = false;   // bridge elements deflect between their nodes under wheels
  bool step_kinks = true;          // steps end where wheels pass kinks of the surface
  bool step_probes = false;        // steps end where wheels pass probes

  bool operator==(const NumericalModel&) const = default;
};

}  // namespace traverse::scene
