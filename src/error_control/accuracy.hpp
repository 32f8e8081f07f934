// `accuracy`: mesh and step that keep the errors of peaks below what the user wants, where the user left them open.
//
// Chosen by measuring: the beginning of the scene, until its first vehicle has crossed the first spans, is run with a
// few meshes and steps, each halved until what that changes tells the errors of deflection, acceleration, moment and
// wheel force and how fast they fall. A quantity that does not settle is named and not promised.
#pragma once

#include <string>
#include <vector>

#include "error_control/model_choice.hpp"
#include "run/response_extremes.hpp"
#include "traverse/options/entry.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Whether the scene's accuracy_of holds it, or is left out: then not the shear, and what is axial only where trains
/// push the beam along. Low-passed accelerations only where its runs have them.
bool asks_for(const Scene& scene, std::size_t quantity);
/// Whether it is promised where its error turns out to be small enough, but does not ask for mesh and step.
bool is_welcome(const Scene& scene, std::size_t quantity);
/// Whether wheel forces are asked for without the accelerations that show what too long steps do to both.
bool asks_for_forces_alone(const Scene& scene);

/// Of one that is not asked for.
std::string why_not_asked(const Scene& scene, std::size_t quantity);
inline constexpr const char* no_sum =
    "without damping that grows with the frequency the accelerations of all modes have no sum";
/// Whether the scene asks for damping that grows with the frequency.
bool damps_high_modes(const Scene& scene);
/// Whether every mode of the bridge is damped, however it is described.
bool damps_all_modes(const Scene& scene);

/// Whether there is something to choose, and something moves that it can be chosen by.
bool chooses(const Scene& scene);
/// The mesh that trial runs begin with, where it is open.
void set_first_mesh(Scene& scene);

/// Collective. Where the deck's accelerations are filtered, and the scene leaves open where: computes the frequency
/// that counts, by the elements that trial runs begin with, and fills it in. One for all runs that are compared, as it
/// differs a little from mesh to mesh.
void fix_low_pass(MPI_Comm comm, Scene& scene, std::vector<std::string>& notes);

/// The option that makes the integrator choose its steps by a measure of its own, or treat contacts apart; null: none.
const options::Entry* own_measure();

/// Collective. The scene's model, with its mesh, step and tolerances found as far as they are open; `notes` says so.
/// InputError as the scene's own run would throw it.
Choice choose(MPI_Comm comm, const Scene& scene, std::vector<std::string>& notes);

/// The scene with twice the elements in every span (or sleeper bay) and half the step.
Scene refined(const Scene& scene);

}  // namespace traverse::app
