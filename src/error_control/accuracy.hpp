// Chooses mesh and step for the option `accuracy` as far as the user left them open.
//
// Trial runs compute the whole scene with meshes and steps that are refined until the changes of deflection,
// acceleration, moment and wheel force from one run to the next are small enough. A quantity whose error does not
// converge is reported without an estimate.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "error_control/model_choice.hpp"
#include "run/response_extremes.hpp"
#include "traverse/options/entry.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

class ModelSearch;

/// Whether mesh and step are chosen for this quantity: accuracy_of contains it, or accuracy_of is not given; then shear
/// is excluded, and axial quantities are included only if trains push the beam along x. Low-passed accelerations are
/// included only in scenes that filter them.
bool is_controlled(const scene::Scene& scene, std::size_t quantity);
/// Whether the quantity gets an error estimate if its error is small enough, without influence on mesh and step.
bool is_optional(const scene::Scene& scene, std::size_t quantity);
/// Whether wheel forces are controlled without the accelerations, which reveal too long steps for both.
bool controls_forces_only(const scene::Scene& scene);

/// The reason why a quantity is not controlled.
std::string why_not_controlled(const scene::Scene& scene, std::size_t quantity);
inline constexpr const char* no_sum =
    "without damping that grows with the frequency the sum of the accelerations of all modes does not converge";
/// Whether the scene has damping that grows with the frequency.
bool damps_high_modes(const scene::Scene& scene);
/// Whether every mode of the bridge is damped, however it is described.
bool damps_all_modes(const scene::Scene& scene);

/// Whether mesh or step is open, and a moving train or force allows trial runs.
bool chooses(const scene::Scene& scene);
/// Sets the mesh of the first trial run if the mesh is open.
void set_first_mesh(scene::Scene& scene);

/// Collective. Sets the cut-off frequency of filtered deck accelerations if the scene leaves it open. It is computed
/// once, with the mesh of the first trial run, because it differs a little between meshes and all compared runs need
/// the same one.
void set_low_pass(MPI_Comm comm, scene::Scene& scene, std::vector<std::string>& notes);

/// The option by which the integrator controls its steps itself or treats contacts separately; null: none.
const options::Entry* adaptive_step_option(const scene::Scene& scene);

/// Collective. Chooses mesh, step and tolerances that the scene does not prescribe, and returns the model. Appends the
/// choice to `notes`. Throws the InputError that the scene's own run would throw. open: if it is given, the last run of
/// the search may be left to the caller, with the search in it.
Choice choose(MPI_Comm comm, const scene::Scene& scene, std::vector<std::string>& notes,
              std::shared_ptr<ModelSearch>* open = nullptr);

/// Collective. Compares the error estimates with the peaks of a refined run, and prints a table. False if an estimate
/// is exceeded.
bool report(MPI_Comm comm, const scene::Scene& scene, const Accuracy& accuracy, const run::ResponseExtremes& peaks);

}  // namespace traverse::error_control
