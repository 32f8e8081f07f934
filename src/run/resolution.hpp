// What the mesh and the step that the user gives cannot resolve. An implicit integrator stays stable and its energy
// balances at any step, and a mesh always gives some answer: neither shows by itself that the answer is none.
#pragma once

#include <string>
#include <vector>

#include "run/plan.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// InputError where elements are longer than the waves in which the beam bends on its bed. Where they are merely so
/// long that results are rough, a line in `notes` says so.
void check_mesh(const Scene& scene, std::vector<std::string>& notes);

/// InputError where rounding hides the run's end or its samples.
void check_times(const Plan& plan);

/// InputError where a given step passes over periods of the bridge or waves of the track. Where it is merely so long
/// that results are rough, a line in `notes` says so. first_period: of the beam, s, 0 where not known; high_order:
/// whether the integrator's order is above 2.
void check_steps(const Scene& scene, const Plan& plan, double first_period, bool high_order,
                 std::vector<std::string>& notes);

/// After the start: in `notes` whether steps pass over the wheels' oscillation on their contacts, where the track or
/// their shape stirs it.
void check_contacts(const Scene& scene, const Plan& plan, const train::Fleet& fleet, std::vector<std::string>& notes);

}  // namespace traverse::app
