// Sets the parameters of single runs in the scene that all of them share.
#include "ensemble/case_set.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>

#include "ensemble/case_batch.hpp"
#include "run/deck_acceleration.hpp"
#include "run/rank_choice.hpp"
#include "run/wheel_unloading.hpp"

namespace traverse::ensemble {

CaseSet::CaseSet(const scene::Scene& scene, std::vector<std::string>& notes, std::shared_ptr<run::SharedBeam> beam)
    : scene_(scene), speeds_(scene.sweep->speeds), loads_(scene.sweep->loads), beam_(std::move(beam)) {
  if (speeds_.empty()) speeds_ = {scene::moving_speed(scene)};
  if (loads_.empty()) loads_ = {scene.load};
  if (scene.train.speed > 0.0)
    for (const double x : scene::wheels_at_start(scene)) last_wheel_ = std::min(last_wheel_, x);
  if (beam_ == nullptr) {
    beam_ = std::make_shared<run::SharedBeam>(PETSC_COMM_SELF, scene_, notes);
    beam_->set_up(scene_, !scene_.model.step || scene_.model.modes > 0, notes);
    if (scene_.exact_in_time())
      beam_->modal->add_probes(scene_.output.probes, scene_.self_weight ? scene_.gravity : 0.0,
                               scene_.output.eccentricities);
  }
  if (run::filters_wheels(scene_)) scene_.sampling_interval = run::spacing_for(scene_.output.wheel_low_pass);
  if (!scene_.limits_deck_acceleration()) return;
  cutoff_frequency_ = run::cutoff_frequency(scene_, *beam_, true, notes);
  if (cutoff_frequency_ > 0.0)
    scene_.sampling_interval = std::min(scene_.sampling_interval, run::spacing_for(cutoff_frequency_));
}

const scene::Scene& CaseSet::of(std::size_t train, const CaseRun& run) {
  scene_.load.forces = loads_[train].forces;
  scene_.load.positions = loads_[train].positions;
  scene::set_speed(scene_, run.speed);
  if (run.seed) scene_.profile = scene_.roughness->profile(*run.seed);
  return scene_;
}

double CaseSet::duration(std::size_t train, double speed) const {
  if (scene_.end_time) return *scene_.end_time;
  double last = last_wheel_;
  if (scene_.load.speed > 0.0)
    for (const double x : loads_[train].positions) last = std::min(last, x);
  return (scene_.beam->length() - last) / speed + scene_.tail.value_or(0.0);
}

double CaseSet::seconds_by_modes() const {
  const structure::ModalBridge& modal = *beam_->modal;
  const double instants = scene_.sweep->instants * modal.fastest_oscillation() / (2.0 * std::numbers::pi);
  return instants * run::modal_instant_seconds(scene_, static_cast<double>(modal.modes()), dampers_couple_modes());
}

double CaseSet::seconds_in_batches() const {
  return run::batch_stage_seconds(scene_, beam_->beam->mesh().elements()) *
         static_cast<double>(method_of(scene_).stages.size()) /
         scene_.model.step.value_or(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace traverse::ensemble
