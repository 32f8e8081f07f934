// What a run is computed with: the user may say it, or leave it to the accuracy that is wanted.
#pragma once

#include <limits>
#include <optional>
#include <string>

namespace traverse::app {

/// Vehicles as mechanisms, or linear, those that can be; automatic: linear where a search for the accuracy finds that
/// it does not matter, until then mechanisms.
enum class VehicleModel { full, linear, automatic };

struct NumericalModel {
  int modes = 0;               // of the bridge; 0: by its elements
  int elements = 0;            // of its longest span, or of the rail in a sleeper bay; 0: as the beam says
  std::optional<double> step;  // s; none: left open, or exact in time
  std::string method;          // of integration, as -ts_type names it; empty: as the options say
  VehicleModel vehicles = VehicleModel::full;
  /// What linear vehicles may be out of balance by over their weights; beyond, the run is repeated with the mechanisms.
  double most_residual = std::numeric_limits<double>::infinity();
  /// m of every run's way that trial runs have seen, and whether wheels lost contact in them.
  double trials_reach = std::numeric_limits<double>::infinity();
  bool trials_lost_contact = false;
  double rest_tolerance = -1.0;   // below which motion far from the train is left out, of the largest one; -1: auto
  bool local_compliance = false;  // a bridge's elements bend between their nodes under wheels
  bool step_kinks = true;         // steps end where wheels pass kinks
  bool step_probes = false;       // they end where wheels pass probes, and peaks are looked for at every step

  bool operator==(const NumericalModel&) const = default;
};

}  // namespace traverse::app
