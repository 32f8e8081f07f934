// Assembles the beam, determines Rayleigh damping from its first distinct natural modes (equations 19 and 20 of the
// paper), and computes factorisation and modes. The buckling load of a beam under compression (beam_tension below 0) is
// N = 1/mu times the given compression, with the largest mu of G x = mu K x: G is the stiffness that the compression
// removes and K the stiffness without it. Power iteration with Rayleigh's quotient, whose error is the square of that
// of the shape.
#include "run/shared_beam.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/notes.hpp"
#include "base/petsc.hpp"
#include "beam/beam.hpp"
#include "results/stage.hpp"
#include "traverse/base/error.hpp"

namespace traverse::run {
namespace {

constexpr int most_iterations = 5000;
constexpr double converged = 1e-12;  // relative change of the quotient

double sum_over_ranks(MPI_Comm comm, const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, comm);
  return sum;
}

/// Collective. The largest magnitude of the compression along the beam, N, at which the beam buckles, for compression
/// distributed as in its model. Its rotational bed is the compression: a stiffness below 0.
double buckling_load(const beam::Beam& loaded) {
  beam::BeamModel model = loaded.model();
  const double largest = -model.foundation.rotational_bed->k.minimum();
  model.foundation.rotational_bed.reset();
  beam::Beam straight(loaded.comm(), std::move(model));
  straight.set_rayleigh({});
  structure::BeamOperator stiffness(straight);
  const Mat removed = loaded.foundation().of("rotational_bed")[0];

  const auto size = static_cast<std::size_t>(straight.local_unknowns());
  base::Handle<Vec> in, out;
  base::check(MatCreateVecs(removed, in.out(), out.out()));
  const auto multiply = [&](const std::vector<double>& x, std::vector<double>& y) {
    double* to = nullptr;
    base::check(VecGetArray(in, &to));
    std::copy(x.begin(), x.end(), to);
    base::check(VecRestoreArray(in, &to));
    base::check(MatMult(removed, in, out));
    const double* from = nullptr;
    base::check(VecGetArrayRead(out, &from));
    for (std::size_t i = 0; i < size; ++i) y[i] = -from[i];
    base::check(VecRestoreArrayRead(out, &from));
  };

  std::vector<double> x(size), Gx(size), y(size), Gy(size);
  for (std::size_t i = 0; i < size; ++i)
    x[i] = straight.fixed()[i] != 0 ? 0.0 : 1.0 + std::sin(1.0 + static_cast<double>(i) + straight.first_column());
  multiply(x, Gx);
  double mu = 0.0;
  for (int i = 0; i < most_iterations; ++i) {
    y = Gx;
    stiffness.solve_static(y.data());  // K y = G x
    multiply(y, Gy);
    const double before =
        std::exchange(mu, sum_over_ranks(straight.comm(), y, Gy) / sum_over_ranks(straight.comm(), y, Gx));
    if (std::abs(mu - before) <= converged * mu) return largest / mu;
    const double length = std::sqrt(sum_over_ranks(straight.comm(), y, Gy));
    for (std::size_t k = 0; k < size; ++k) Gx[k] = Gy[k] / length;
  }
  throw SolverError("beam_tension: the buckling load does not converge");
}

constexpr double distinct = 1e-6;  // relative difference of two frequencies
// Number of distinct modes whose damping ratios are known; with springs the pair of eq. 20 may be any of them.
constexpr std::size_t modes_without = 4, modes_with_springs = 10, most_shown = 6;

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

double hertz(double omega) { return omega / (2.0 * std::numbers::pi); }

/// The first distinct modes of small motions: of the bridge without the rail and mass dampers, but with the mass of the
/// track.
std::vector<modes::BendingMode> distinct_modes_of(const beam::Beam& beam) {
  const beam::BeamModel& model = beam.model();
  const bool sprung = beam.springs() != nullptr || beam.rail() != nullptr || model.foundation.nonlinear();
  const std::size_t count = sprung ? modes_with_springs : modes_without;
  if (beam.rail() == nullptr && model.dampers.empty() && !model.foundation.nonlinear())
    return modes::distinct_modes(beam, count);
  beam::BeamModel small = linearised(bridge_alone(model));
  const beam::Beam with_track(beam.comm(), small);
  if (beam.rail() == nullptr) return modes::distinct_modes(with_track, count);
  small.mass = model.mass;
  return modes::distinct_modes(with_track, count, beam::Beam(beam.comm(), small).mass());
}

/// Whether the scene asks for natural modes that nothing couples, so that each can have its own damping ratio.
bool computes_uncoupled_modes(const scene::Scene& scene, const beam::Beam& beam) {
  return scene.analysis == options::Analysis::modes && beam.dampers() == nullptr;
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

SharedBeam::SharedBeam(MPI_Comm communicator, const scene::Scene& scene, std::vector<std::string>& notes)
    : comm(communicator) {
  if (!scene.beam) return;
  const results::Stage stage("assembly of the beam");
  const std::string floating =
      scene.analysis == options::Analysis::modes || scene.beam->given ? "" : beam::floating_motion(*scene.beam);
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
        "gaps open");
  beam.emplace(comm, nonlinear && scene.analysis == options::Analysis::modes ? linearised(*scene.beam) : *scene.beam);
  if (!scene.beam->given) beam::check_springs(beam->model());
  check_compression(*beam);
  notes.push_back(base::detail(scene.beam->given ? given_modes_text(*beam) : beam_text(*beam)));
  if (beam->rail() != nullptr) notes.push_back(base::detail(track_text(*beam)));
}

void SharedBeam::damp(const scene::Scene& scene, bool frequencies_wanted, std::vector<std::string>& notes) {
  if (beam->model().given) {
    const std::vector<double>& given = beam->model().given->omega;
    const auto second =
        std::find_if(given.begin(), given.end(), [&](double one) { return one > given.front() * (1.0 + distinct); });
    omega = {given.front(), second == given.end() ? given.front() : *second};
    return;
  }
  const results::Stage stage("search for the first frequencies");
  const scene::Damping& damping = scene.damping;
  const bool each_has_one = !scene.damping_of_modes.empty();
  const bool of_each_mode = each_has_one && (scene.model.modes > 0 || computes_uncoupled_modes(scene, *beam));
  const bool by_ratios = damping.ratios && !of_each_mode;
  if (by_ratios || frequencies_wanted) first_modes = distinct_modes_of(*beam);
  if (frequencies_wanted && !damping.frequencies) omega = modes::first_two(first_modes);
  if (damping.rayleigh) rayleigh = {damping.rayleigh->first, damping.rayleigh->second};
  if (by_ratios) set_rayleigh_from_ratios(damping, notes);
  beam->set_rayleigh(rayleigh);
  if (omega)
    notes.push_back(base::detail(fmt::format("frequencies {:.6g} and {:.6g} Hz; Rayleigh a = {:.6g} 1/s, b = {:.6g} s",
                                             hertz(omega->first), hertz(omega->second), rayleigh.a, rayleigh.b)));
  if (of_each_mode && damping.ratios)
    notes.push_back(
        fmt::format("each mode has the damping ratio of the norm, {:.4g} %", 100.0 * scene.damping_of_modes.front()));
  if (!by_ratios) return;
  const std::string ratios = "damping ratios by a and b: " + damping_text();
  notes.push_back(each_has_one ? ratios + "; elements have that of the norm in two modes only, unlike model_modes"
                               : base::detail(ratios));
}

/// Gives the ratios to the first two distinct modes, or to modes at the given frequencies.
void SharedBeam::set_rayleigh_from_ratios(const scene::Damping& damping, std::vector<std::string>& notes) {
  const auto [zeta1, zeta2] = *damping.ratios;
  if (damping.frequencies) {
    omega = {2.0 * std::numbers::pi * damping.frequencies->first, 2.0 * std::numbers::pi * damping.frequencies->second};
    rayleigh = modes::rayleigh(modes::between(first_modes, omega->first), modes::between(first_modes, omega->second),
                               zeta1, zeta2);
    return;
  }
  const auto [ab, second] = modes::rayleigh_pair(first_modes, zeta1, zeta2);
  rayleigh = ab;
  omega = {first_modes[0].omega, first_modes[second].omega};
  if (second == 1) return;
  notes.push_back(fmt::format(
      "the damping ratio {:g} is that of modes 1 and {}, {:.4g} and {:.4g} Hz: with a and b >= 0 modes 1 and 2 "
      "cannot both have it, because the springs carry mode 2 with little bending of the beam; mode 2 has {:.3g} %",
      zeta1, second + 1, hertz(omega->first), hertz(omega->second), 100.0 * first_modes[1].ratio(rayleigh)));
}

std::string SharedBeam::damping_text() const {
  const std::vector<RatioOfMode> ratios = damping_ratios();
  const std::size_t shown = std::min(ratios.size(), most_shown);
  std::string by_beam, by_dampers;
  for (std::size_t i = 0; i < shown; ++i) {
    by_beam += fmt::format("{}{:.4g}", i == 0 ? "" : ", ", 100.0 * ratios[i].beam);
    by_dampers += fmt::format("{}{:.4g}", i == 0 ? "" : ", ", 100.0 * ratios[i].dampers);
  }
  if (shown == 0) return "";
  if (std::all_of(ratios.begin(), ratios.end(), [](const RatioOfMode& r) { return r.beam == 0.0 && r.dampers == 0.0; }))
    return "none";
  const bool damped = std::any_of(ratios.begin(), ratios.end(), [](const RatioOfMode& r) { return r.dampers != 0.0; });
  return fmt::format("{} % in modes 1 to {}{}", by_beam, shown,
                     damped ? fmt::format(", and by dampers {} %", by_dampers) : "");
}

std::vector<SharedBeam::RatioOfMode> SharedBeam::damping_ratios() const {
  std::vector<RatioOfMode> ratios;
  if (modal) {
    for (std::size_t i = 0; i < modal->modes(); ++i) {
      const double one = modal->omega()[i], dampers = modal->damper_sigma()[i] / one;
      ratios.push_back({one, modal->sigma()[i] / one - dampers, dampers});
    }
  } else if (beam && !beam->model().given) {
    for (const modes::BendingMode& mode : first_modes)
      ratios.push_back({mode.omega, mode.ratio(rayleigh), mode.damper_ratio()});
  }
  return ratios;
}

void SharedBeam::prepare(const scene::Scene& scene, std::vector<std::string>& notes) {
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
  notes.push_back(
      base::detail(fmt::format("the bridge by {} modes up to {:.6g} Hz{}, the others static{}", modal->modes(),
                               hertz(modal->omega().back()), scene.exact_in_time() ? ", exact in time" : "",
                               static_cast<int>(modal->modes()) > scene.model.modes
                                   ? fmt::format(" ({} asked for: all copies of the last frequency)", scene.model.modes)
                                   : "")));
}

double SharedBeam::first_period() const { return omega ? 2.0 * std::numbers::pi / omega->first : 0.0; }

}  // namespace traverse::run
