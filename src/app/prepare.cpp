// Chooses the model by trial runs, or reads an earlier choice from the cache, then computes the bridge's damping,
// factorisation and modes and the frequency of the low-pass filter.
#include "prepare.hpp"

#include <algorithm>
#include <optional>

#include "error_control/mode_mesh.hpp"
#include "error_control/trial_runs.hpp"
#include "run/deck_acceleration.hpp"
#include "run/wheel_unloading.hpp"

namespace traverse::app {
namespace {

error_control::Choice try_models(MPI_Comm comm, scene::Scene scene, std::vector<std::string>& notes,
                                 std::shared_ptr<error_control::ModelSearch>* open) {
  if (error_control::chooses_mode_mesh(scene)) return error_control::choose_mode_mesh(comm, scene, notes);
  if (error_control::chooses(scene)) error_control::set_low_pass(comm, scene, notes);
  error_control::Choice choice = error_control::choose(comm, scene, notes, open);
  choice.low_pass = scene.output.low_pass;
  return choice;
}

/// Continues the search of a stored choice, if it is open. False if that is not possible.
bool continue_search(MPI_Comm comm, scene::Scene scene, const error_control::Choice& choice, bool leaves_last,
                     std::shared_ptr<error_control::ModelSearch>& search) {
  if (choice.open_search.empty()) return true;
  if (!leaves_last) return false;
  if (choice.low_pass) scene.output.low_pass = choice.low_pass;
  error_control::set_first_mesh(scene);
  try {
    search = std::make_shared<error_control::ModelSearch>(comm, scene, choice.open_search);
    return search->open();
  } catch (const FileError&) {  // damaged content
    search.reset();
    return false;
  }
}

}  // namespace

bool OpenChoice::add(const scene::NumericalModel& model, error_control::RunPeaks run) {
  search_->add_last(model, std::move(run));
  const double seconds = choice_.accuracy.seconds;
  error_control::Choice now = search_->choice();
  choice_.accuracy = std::move(now.accuracy);
  choice_.accuracy.seconds = seconds;
  choice_.model.elements = now.model.elements;
  choice_.model.step = now.model.step;
  choice_.open_search = search_->open() ? search_->state() : "";
  if (search_->open()) return false;
  for (const std::string& line : choice_.accuracy.lines()) notes_.push_back(line);
  cache_.write(notes_, choice_);
  return true;
}

error_control::Accuracy choose_model(MPI_Comm comm, scene::Scene& scene, std::vector<std::string>& notes,
                                     std::optional<OpenChoice>* open) {
  error_control::ChoiceCache kept(comm, scene);
  error_control::Choice choice;
  std::vector<std::string> own;
  std::shared_ptr<error_control::ModelSearch> search;
  if (kept.read(scene, own, choice) && continue_search(comm, scene, choice, open != nullptr, search)) {
    notes.emplace_back(error_control::ChoiceCache::said);
  } else {
    own.clear();
    choice = try_models(comm, scene, own, open != nullptr ? &search : nullptr);
    if (search) choice.open_search = search->state();
    if (choice.accuracy.measured) kept.write(own, choice);
  }
  notes.insert(notes.end(), own.begin(), own.end());
  if (search) open->emplace(std::move(search), std::move(kept), choice, std::move(own));
  scene = error_control::with(scene, choice.model);
  if (choice.low_pass) scene.output.low_pass = choice.low_pass;
  return choice.accuracy;
}

double prepare(scene::Scene& scene, const error_control::Accuracy& accuracy, run::SharedBeam& shared,
               std::vector<std::string>& notes) {
  const bool moves = scene.analysis != options::Analysis::static_response;
  const beam::Beam* beam = shared.bridge();
  const bool cheap = beam != nullptr && run::frequencies_are_cheap(*beam);
  if (beam != nullptr)
    shared.damp(scene, moves && (accuracy.measured || !scene.model.step || scene.model.modes > 0 || cheap), notes);
  shared.prepare(scene, notes);
  const bool limited = scene.limits_deck_acceleration();
  const double counting =
      limited || scene.output.low_pass_requested ? run::cutoff_frequency(scene, shared, cheap || limited, notes) : 0.0;
  if (counting > 0.0) scene.sampling_interval = run::spacing_for(counting);
  if (run::filters_wheels(scene))
    scene.sampling_interval = std::min(scene.sampling_interval, run::spacing_for(scene.output.wheel_low_pass));
  return counting;
}

}  // namespace traverse::app
