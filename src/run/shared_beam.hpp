// Data that all runs of a scene share: the beam with its damping, its operator, its modes.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "modes/modes.hpp"
#include "structure/beam_operator.hpp"
#include "structure/modal_bridge.hpp"
#include "structure/support_motion.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

struct SharedBeam {
  /// Collective. Checks and assembles the beam, if there is one. Its description is appended to `notes`.
  SharedBeam(MPI_Comm comm, const scene::Scene& scene, std::vector<std::string>& notes);
  SharedBeam(const SharedBeam&) = delete;
  SharedBeam& operator=(const SharedBeam&) = delete;

  /// Collective, once. Sets the scene's Rayleigh damping. Computes the first distinct modes if damping ratios need them
  /// or frequencies_wanted is true.
  void damp(const scene::Scene& scene, bool frequencies_wanted, std::vector<std::string>& notes);
  /// Collective, after damp. Computes factorisation or modes for transient and static runs.
  void prepare(const scene::Scene& scene, std::vector<std::string>& notes);
  /// Both, which is all that a run needs.
  void set_up(const scene::Scene& scene, bool frequencies_wanted, std::vector<std::string>& notes) {
    damp(scene, frequencies_wanted, notes);
    prepare(scene, notes);
  }

  /// The damping ratios of the first distinct modes, or of the modes that represent the bridge (after prepare), by the
  /// beam's own damping and by dampers. Springs add none. Empty: unknown.
  struct RatioOfMode {
    double omega, beam, dampers;  // rad/s
  };
  std::vector<RatioOfMode> damping_ratios() const;
  /// The first of these ratios in words; empty: unknown.
  std::string damping_text() const;

  const beam::Beam* bridge() const { return beam ? &*beam : nullptr; }
  double first_period() const;  // s; 0: unknown

  MPI_Comm comm;
  std::optional<beam::Beam> beam;
  std::vector<modes::BendingMode> first_modes;     // the first distinct ones of small motions, with the mass of a track
  std::optional<std::pair<double, double>> omega;  // rad/s: the pair of frequencies of the Rayleigh damping
  beam::Rayleigh rayleigh;                         // zero if each mode has its own damping ratio
  std::shared_ptr<structure::BeamOperator> statics;           // with its factorisations
  std::optional<structure::ModalBridge> modal;                // with model_modes
  std::shared_ptr<structure::SupportMotion> moving_supports;  // null: the supports are at rest

 private:
  void set_rayleigh_from_ratios(const scene::Damping& damping, std::vector<std::string>& notes);
};

}  // namespace traverse::run
