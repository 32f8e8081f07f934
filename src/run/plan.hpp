// Duration, step and sampling of a transient run, and checks whether a given mesh and step resolve the scene. An
// implicit integrator remains stable with a balanced energy for every time step, and every mesh produces a result: a
// wrong result has no other sign.
#pragma once

#include <string>
#include <vector>

#include "coupling/system.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

struct Plan {
  double end_time = 0.0;   // s
  double time_step = 0.0;  // s
  double interval = 0.0;   // s, between samples
  long stored = 1;         // one sample out of this number is stored

  /// Whether the end is a multiple of the interval between stored samples.
  bool ends_at_sample() const;
};

/// The plan of a scene. Open values are chosen, and each choice is appended to `notes`. first_period: first period of
/// the beam, s; 0 if unknown. InputError if the scene has no end.
Plan make_plan(const scene::Scene& scene, const coupling::System& system, double first_period,
               std::vector<std::string>& notes);

/// The plan of a scene that is computed exactly in time and whose end is known.
Plan plan_exact_in_time(const scene::Scene& scene, double end_time, double first_period,
                        std::vector<std::string>& notes);

/// InputError if elements are longer than the bending waves of the beam on its bed. If they are only so long that
/// results are inaccurate, a warning is appended to `notes`.
void check_mesh(const scene::Scene& scene, std::vector<std::string>& notes);

/// InputError if the run or its sampling interval is too short for the resolution of floating-point times.
void check_times(const Plan& plan);

/// InputError if a given step does not resolve periods of the bridge or waves of the track. If it is only so long that
/// results are inaccurate, a warning is appended to `notes`. first_period: first period of the beam, s, 0 if unknown;
/// high_order: the integrator's order is above 2.
void check_steps(const scene::Scene& scene, const Plan& plan, double first_period, bool high_order,
                 std::vector<std::string>& notes);

/// After the start: appends a warning to `notes` if steps do not resolve the wheels' oscillation on their contacts,
/// where the track or the wheels' shape excites it.
void check_contacts(const scene::Scene& scene, const Plan& plan, const train::Fleet& fleet,
                    std::vector<std::string>& notes);

}  // namespace traverse::run
