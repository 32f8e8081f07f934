// Natural modes of the bridge, undamped and damped.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "analyses.hpp"
#include "modes/modes.hpp"
#include "results/recorder.hpp"
#include "results/stage.hpp"
#include "results/terminal.hpp"
#include "run/model_record.hpp"
#include "run/outputs.hpp"
#include "run/process.hpp"

namespace traverse::app {

namespace {

modes::Modes given_modes(const beam::Beam& beam, int count, const beam::ShapePoints& points) {
  modes::Modes modes = modes::as_stored(beam, modes::given_basis(beam, count), points);
  const std::vector<double>& ratio = beam.model().given->ratio;
  modes.ratio.assign(ratio.begin(), ratio.begin() + static_cast<std::ptrdiff_t>(modes.omega.size()));
  return modes;
}

/// The damped modes for given damping ratios. A mode above critical damping becomes two modes that do not oscillate.
modes::DampedModes damped_by_ratios(const modes::Modes& modes) {
  std::vector<std::pair<std::complex<double>, std::size_t>> found;  // lambda, and the index of its mode
  for (std::size_t i = 0; i < modes.omega.size(); ++i) {
    const double omega = modes.omega[i], ratio = modes.ratio[i], part = std::sqrt(std::abs(1.0 - ratio * ratio));
    if (ratio < 1.0)
      found.emplace_back(std::complex<double>(-ratio * omega, part * omega), i);
    else
      for (const double sign : {1.0, -1.0}) found.emplace_back((sign * part - ratio) * omega, i);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.first) < std::abs(b.first); });
  modes::DampedModes damped;
  for (const auto& [lambda, i] : found) {
    damped.lambda.push_back(lambda);
    damped.motion.push_back(modes.motion[i]);
    damped.shape.emplace_back(modes.shape[i].begin(), modes.shape[i].end());
  }
  return damped;
}

}  // namespace

int run_modes(Job job) {
  const MPI_Comm comm = job.comm;
  const scene::Scene& scene = job.scene;
  run::SharedBeam& shared = job.beam;
  std::vector<std::string>& notes = job.notes;
  shared.damp(scene, true, notes);
  const beam::Beam& beam = *shared.beam;
  const auto [omega1, omega2] = *shared.omega;
  const beam::Rayleigh ab = shared.rayleigh;
  run::print_notes(comm, scene, notes);
  const bool of_each_mode = !scene.damping_of_modes.empty() && beam.dampers() == nullptr;
  const beam::ShapePoints points(beam.mesh());
  const modes::Modes found = [&] {
    const results::Stage stage("computation of the natural modes");
    if (scene.by_given_modes()) return given_modes(beam, scene.mode_count, points);
    modes::Modes natural = modes::natural_modes(beam, scene.mode_count, points);
    if (of_each_mode) natural.ratio.assign(natural.omega.size(), scene.damping_of_modes.front());
    if (of_each_mode) natural.beam_ratio = natural.ratio;
    return natural;
  }();
  const bool damping = scene.by_given_modes() || of_each_mode || modes::damped(beam);
  const modes::DampedModes damped = [&] {
    const results::Stage stage("computation of the damped modes");
    if (scene.by_given_modes() || of_each_mode) return damped_by_ratios(found);
    return damping ? modes::damped_modes(beam, scene.mode_count, points) : modes::DampedModes();
  }();
  results::Layout layout;
  layout.constants = run::stations({}, beam.mesh().span_ends());
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0) results::print_modes(found, omega1, omega2, ab.a, ab.b, damped);
  if (rank == 0 && ab.b != 0.0 && damped.size() < found.omega.size())
    fmt::print(
        "  damped modes are listed below |lambda| = 1/b = {:.6g} rad/s: above it the elements decide, not the beam\n",
        1.0 / std::abs(ab.b));
  if (scene.output.file.empty()) return 0;
  const run::DeferredSignals noted;  // signals are delayed until the file is complete
  results::Recorder recorder(comm, std::move(job.place), layout, run::attributes(comm, scene), scene.options);
  run::record_model(scene, notes, recorder);
  recorder.modes(found, ab.a, ab.b, omega1, omega2);
  if (damping) recorder.damped_modes(damped);
  std::vector<results::Attribute> summary = {{"ended", "reached its end"}};
  for (const auto& [quantity, error] : job.accuracy.expected())
    summary.push_back({"expected_error_" + quantity, error});
  recorder.finish_with(summary);
  if (rank == 0) fmt::print("results  {}\n", scene.output.file);
  return 0;
}

}  // namespace traverse::app
