// Assembles the beam, determines Rayleigh damping from its first two distinct natural frequencies (equations 19 and 20
// of the paper), and computes factorisation and modes.
#include "run/shared_beam.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "base/notes.hpp"
#include "modes/modes.hpp"
#include "results/stage.hpp"
#include "run/buckling_load.hpp"

namespace traverse::app {
namespace {

constexpr double distinct = 1e-6;  // relative difference of two frequencies

std::string track_text(const beam::Beam& beam) {
  const beam::LayeredTrack& t = *beam.model().track;
  const bool shear = t.shear.k > 0.0 || t.shear.c > 0.0;
  return fmt::format(
      "layered track from {:g} to {:g} m: rail with {} elements, sleepers every {:g} m{}{}{}{}, {} unknowns a column",
      beam.rail()->mesh.start(), beam.rail()->mesh.end(), beam.rail()->mesh.elements(), t.spacing,
      t.ballast ? ", ballast" : "",
      !t.subballast ? ""
      : t.own_mass  ? ", sub-ballast"
                    : ", sub-ballast on the ground",
      shear ? ", shear" : "",
      t.stretches.empty()
          ? ""
          : fmt::format(", {} stretch{} of other properties", t.stretches.size(), t.stretches.size() == 1 ? "" : "es"),
      beam.block());
}

std::string given_modes_text(const beam::Beam& beam) {
  const beam::GivenModes& m = *beam.model().given;
  const auto [least, greatest] = std::minmax_element(m.ratio.begin(), m.ratio.end());
  return fmt::format(
      "bridge of {:g} m by given modes: {} from {:.6g} to {:.6g} Hz, damping {}{:.4g} %, shapes at {} stations",
      m.x.back(), m.omega.size(), m.omega.front() / (2.0 * std::numbers::pi), m.omega.back() / (2.0 * std::numbers::pi),
      *least < *greatest ? fmt::format("{:.4g} to ", 100.0 * *least) : "", 100.0 * *greatest, m.x.size());
}

std::string beam_text(const beam::Beam& beam) {
  const beam::BeamModel& m = beam.model();
  return fmt::format("beam of {:g} m, {} span{}{}, {} elements, {} unknowns a node ({})", m.length(), m.spans.size(),
                     m.spans.size() == 1 ? "" : "s", m.all_separate() ? " (each of its own)" : "",
                     beam.mesh().elements(), m.axial ? 3 : 2,
                     m.axial ? "axial, deflection, rotation" : "deflection, rotation");
}

/// Refuses a compression at which the beam buckles.
void check_compression(const beam::Beam& beam) {
  const std::optional<beam::Bed>& tension = beam.model().foundation.rotational_bed;
  if (!tension || !(tension->k.minimum() < 0.0)) return;
  const double load = buckling_load(beam), compression = -tension->k.minimum();
  if (compression >= load)
    throw InputError(
        fmt::format("beam_tension: the beam buckles under a compression of {:.4g} N; its buckling load is "
                    "{:.6g} N",
                    compression, load));
}

}  // namespace

SharedBeam::SharedBeam(MPI_Comm communicator, const Scene& scene, std::vector<std::string>& notes)
    : comm(communicator) {
  if (!scene.beam) return;
  const results::Stage stage("assembly of the beam");
  const std::string floating =
      scene.analysis == Analysis::modes || scene.beam->given ? "" : beam::floating_motion(*scene.beam);
  if (!floating.empty())
    throw InputError("support_types: the beam can float away (" + floating +
                     "); hold it with supports or a foundation");
  const bool nonlinear = scene.beam->nonlinear();
  if (scene.beam->foundation.nonlinear())
    notes.emplace_back(
        "one-sided foundations, those that slide and those with a gap or a cubic term are forces; frequencies are "
        "those of small motions: what has no gap with its k, what has one without");
  if (scene.beam->track && scene.beam->track->hangs())
    notes.emplace_back(
        "sleepers hang over gaps, which close on one side: forces; frequencies are those of small motions, with all "
        "gaps "
        "open");
  beam.emplace(comm, nonlinear && scene.analysis == Analysis::modes ? linearised(*scene.beam) : *scene.beam);
  check_compression(*beam);
  notes.push_back(base::detail(scene.beam->given ? given_modes_text(*beam) : beam_text(*beam)));
  if (beam->rail() != nullptr) notes.push_back(base::detail(track_text(*beam)));
}

void SharedBeam::damp(const Scene& scene, bool frequencies_wanted, std::vector<std::string>& notes) {
  if (beam->model().given) {
    const std::vector<double>& given = beam->model().given->omega;
    const auto second =
        std::find_if(given.begin(), given.end(), [&](double one) { return one > given.front() * (1.0 + distinct); });
    omega = {given.front(), second == given.end() ? given.front() : *second};
    return;
  }
  const results::Stage stage("search for the first frequencies");
  const Damping& damping = scene.damping;
  if (damping.frequencies)
    omega = {2.0 * std::numbers::pi * damping.frequencies->first, 2.0 * std::numbers::pi * damping.frequencies->second};
  else if (damping.ratios || frequencies_wanted)
    omega = beam->rail() == nullptr && !beam->model().foundation.nonlinear()
                ? modes::distinct_pair(*beam)
                : modes::distinct_pair(beam::Beam(beam->comm(), linearised(bridge_alone(beam->model()))));
  if (damping.rayleigh) rayleigh = {damping.rayleigh->first, damping.rayleigh->second};
  if (damping.ratios)
    rayleigh = modes::rayleigh(omega->first, omega->second, damping.ratios->first, damping.ratios->second);
  beam->set_rayleigh(rayleigh);
  if (omega)
    notes.push_back(base::detail(fmt::format(
        "first distinct frequencies {:.6g} and {:.6g} Hz; Rayleigh a = {:.6g} 1/s, b = {:.6g} s",
        omega->first / (2.0 * std::numbers::pi), omega->second / (2.0 * std::numbers::pi), rayleigh.a, rayleigh.b)));
}

void SharedBeam::prepare(const Scene& scene, std::vector<std::string>& notes) {
  if (!beam) return;
  const results::Stage stage(scene.model.modes > 0 ? "computation of the bridge's modes" : "factorisation of the beam");
  statics = std::make_shared<structure::BeamOperator>(*beam);
  if (scene.supports_move())
    moving_supports =
        std::make_shared<structure::SupportMotion>(*beam, scene.support_motion, scene.support_motion_along);
  if (scene.model.modes == 0) return;
  if (scene.by_given_modes())
    modal.emplace(*beam, *statics, scene.model.modes);
  else
    modal.emplace(*beam, *statics, modes::bending_basis(*beam, scene.model.modes), scene.damping_of_modes);
  if (scene.by_given_modes() && modal->modes() < scene.beam->given->omega.size())
    notes.push_back(base::detail(fmt::format("of these modes the {} lowest", modal->modes())));
  if (scene.by_given_modes()) return;
  const auto hertz = [&](double value) { return value / (2.0 * std::numbers::pi); };
  notes.push_back(
      base::detail(fmt::format("the bridge by {} modes up to {:.6g} Hz{}, the others static{}", modal->modes(),
                               hertz(modal->omega().back()), scene.exact_in_time() ? ", exact in time" : "",
                               static_cast<int>(modal->modes()) > scene.model.modes
                                   ? fmt::format(" ({} asked for: all copies of the last frequency)", scene.model.modes)
                                   : "")));
}

double SharedBeam::first_period() const { return omega ? 2.0 * std::numbers::pi / omega->first : 0.0; }

}  // namespace traverse::app
