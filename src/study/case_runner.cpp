#include "case_runner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "integrate/modal_peaks.hpp"
#include "lanes/processor.hpp"
#include "lanes/speed_class.hpp"
#include "run/by_lanes.hpp"
#include "run/signals.hpp"
#include "run/watch.hpp"

namespace traverse::app {
namespace {

// As measured. Peaks by modes take that much at each instant for every mode, and for every mode and probe;
// with modes that dampers couple, whose runs go one by one, several times that.
constexpr double seconds_a_mode = 2e-9, seconds_a_probe = 4e-10;
// Of a run side by side with seven others, a stage.
constexpr double seconds_a_lane_vehicle = 2e-8, seconds_a_lane_mode = 4e-9;
constexpr double coupled_over_uncoupled = 8.0;
constexpr double seconds_a_step = 5e-6, seconds_a_body = 5e-6, seconds_an_element = 1e-7;

}  // namespace

CaseRunner::CaseRunner(const Scene& scene, std::vector<std::string>& notes)
    : scene_(scene), speeds_(scene.sweep->speeds), loads_(scene.sweep->loads), shared_(PETSC_COMM_SELF, scene, notes) {
  if (speeds_.empty()) speeds_ = {scene.vehicles.empty() ? scene.load.speed : scene.train.speed};
  if (loads_.empty()) loads_ = {scene.load};
  for (const double x : wheels_at_start(scene)) last_wheel_ = std::min(last_wheel_, x);
  shared_.damp(scene_, !scene_.time_step || scene_.model_modes > 0, notes);
  shared_.prepare(scene_, notes);
  if (scene_.exact_in_time())
    shared_.modal->add_probes(scene_.output.probes, scene_.self_weight ? scene_.gravity : 0.0);
  std::vector<std::string> ignored;
  for (std::size_t train = 0; train < trains(); ++train) {
    for (const double speed : {speeds_.front(), speeds_.back()})
      const Passage checked(scene_of(train, speed), shared_, train == 0 && speed == speeds_.front() ? notes : ignored);
  }
  set_up_lanes();
}

void CaseRunner::set_up_lanes() {
  if (scene_.exact_in_time()) return;
  why_no_lanes_ = scene_.sweep->lanes == 0 ? "sweep_lanes 0 asks for that" : lanes_obstacle(scene_, shared_);
  if (!why_no_lanes_.empty()) return;
  scene_of(0, speeds_.front());
  lanes_.emplace(scene_, shared_);
  why_no_lanes_ = lanes_->obstacle();
  if (!why_no_lanes_.empty()) return lanes_.reset();
  static_deflection_[0] = lanes_->static_deflection();
}

std::vector<std::vector<std::size_t>> CaseRunner::groups() const {
  std::vector<std::vector<std::size_t>> groups;
  std::size_t most = lanes_ ? scene_.sweep->lanes : 1;
  if (scene_.exact_in_time() && !shared_.modal->dampers_couple())
    most = std::clamp<std::size_t>(scene_.sweep->lanes, 1, lanes::best_width());
  for (std::size_t i = 0; i < speeds_.size(); ++i) {
    const bool joins = !groups.empty() && groups.back().size() < most &&
                       lanes::speed_class(speeds_[groups.back().front()]) == lanes::speed_class(speeds_[i]);
    if (!joins) groups.emplace_back();
    groups.back().push_back(i);
  }
  return groups;
}

std::vector<CaseResult> CaseRunner::run_group(std::size_t train, const std::vector<std::size_t>& speeds,
                                              const std::function<void(double)>& reached) {
  std::vector<CaseResult> results;
  std::vector<double> own, ends;
  for (const std::size_t i : speeds) {
    own.push_back(speeds_[i]);
    ends.push_back(duration(train, speeds_[i]));
  }
  if (scene_.exact_in_time()) return run_by_modes(train, own);
  if (!lanes_) {
    for (const double speed : own) results.push_back(run(train, speed, reached));
    return results;
  }
  for (const lanes::CrossingResult& crossing : lanes_->run(own, ends, lanes_->steps())) {
    const double speed = own[results.size()];
    if (caught_signal() != 0) return std::vector<CaseResult>(speeds.size());
    if (crossing.trouble != lanes::none || lanes_->defect(crossing) > scene_.most_defect) {
      ++alone_;
      results.push_back(run(train, speed, reached));
      continue;
    }
    CaseResult& result = results.emplace_back();
    const auto peak = [](const lanes::CrossingPeak& p) { return integrate::Peak{p.value, p.time}; };
    for (std::size_t p = 0; p < crossing.deflection.size(); ++p)
      result.peaks.push_back({peak(crossing.deflection[p]), peak(crossing.acceleration[p]), peak(crossing.moment[p])});
    result.static_deflection = static_deflection_[train];
    result.least_wheel_force = crossing.least_force;
    result.greatest_wheel_force = crossing.greatest_force;
    result.ended = true;
  }
  return results;
}

const Scene& CaseRunner::scene_of(std::size_t train, double speed) {
  scene_.load.forces = loads_[train].forces;
  scene_.load.positions = loads_[train].positions;
  scene_.load.speed = scene_.load.forces.empty() ? 0.0 : speed;
  scene_.train.speed = scene_.vehicles.empty() ? 0.0 : speed;
  return scene_;
}

double CaseRunner::duration(std::size_t train, double speed) const {
  if (scene_.end_time) return *scene_.end_time;
  double last = last_wheel_;
  for (const double x : loads_[train].positions) last = std::min(last, x);
  return (scene_.beam->length() - last) / speed + scene_.tail.value_or(0.0);
}

double CaseRunner::cost() const {
  if (scene_.exact_in_time()) {
    const std::vector<double>& omega = shared_.modal->omega();
    const double instants = scene_.sweep->instants * omega.back() / (2.0 * std::numbers::pi);
    const double an_instant = seconds_a_mode + seconds_a_probe * static_cast<double>(scene_.output.probes.size());
    const double coupled = shared_.modal->dampers_couple() ? coupled_over_uncoupled : 1.0;
    return coupled * instants * static_cast<double>(omega.size()) * an_instant;
  }
  if (lanes_) {
    const SideBySide::Steps steps = lanes_->steps();
    const double a_stage = seconds_a_lane_vehicle * static_cast<double>(scene_.train.vehicles.size()) +
                           seconds_a_lane_mode * static_cast<double>(shared_.modal->modes());
    return a_stage * static_cast<double>(steps.method.stages.size()) / steps.longest;
  }
  double bodies = 0.0;
  for (const int type : scene_.train.vehicles)
    bodies += static_cast<double>(scene_.vehicles[static_cast<std::size_t>(type)].mechanism.bodies.size());
  const double a_step = seconds_a_step + seconds_a_body * bodies + seconds_an_element * shared_.beam->mesh().elements();
  return a_step / scene_.time_step.value_or(1.0);
}

double CaseRunner::cost_of_all() const {
  double motion = 0.0;
  for (std::size_t train = 0; train < trains(); ++train)
    for (const double speed : speeds_) motion += duration(train, speed);
  return cost() * motion;
}

CaseResult CaseRunner::run(std::size_t train, double speed, const std::function<void(double)>& reached) {
  return scene_.exact_in_time() ? run_by_modes(train, {speed}).front() : run_by_elements(train, speed, reached);
}

CaseResult CaseRunner::run_by_elements(std::size_t train, double speed, const std::function<void(double)>& reached) {
  std::vector<std::string> ignored;
  const Scene& scene = scene_of(train, speed);
  // Factorisations of other runs would serve shifts that are equal but for rounding: results would depend on which runs
  // this rank has had.
  shared_.statics->forget_steps();
  Passage passage(scene, shared_, ignored);
  passage.start(ignored);
  results::Recorder none(PETSC_COMM_SELF, "", {}, {}, {});
  Watch watch(scene, passage.system(), shared_.bridge(), none);
  CaseResult result;
  result.peaks.resize(scene.output.probes.size());
  const auto sample = [&](const integrate::Instant& instant) { watch.sample(instant); };
  const auto step = [&](double t, long) {
    watch.step(t);
    if (reached) reached(t);
    return caught_signal() == 0;
  };
  passage.run(sample, step);
  result.ended = caught_signal() == 0;
  if (!result.ended) return result;
  if (passage.system().defect() > scene.most_defect) return run_with_mechanisms(train, speed, reached);
  check_balance(scene, watch.extremes());
  const Peaks& peaks = watch.finished_peaks();
  for (std::size_t p = 0; p < result.peaks.size(); ++p) {
    const auto peak = [&](Quantity q) {
      const Peak& found = peaks.largest_of_each(q)[p];
      return integrate::Peak{std::abs(found.value), found.time};
    };
    result.peaks[p] = {peak(deflection), peak(acceleration), peak(moment)};
  }
  const results::Summary& extremes = watch.finished_extremes();
  result.least_wheel_force = extremes.least_wheel_force;
  result.greatest_wheel_force = extremes.greatest_wheel_force;
  result.contact_losses = extremes.contact_losses;
  result.longest_loss = extremes.longest_loss;
  std::vector<double>& at_rest = static_deflection_[train];
  if (at_rest.empty() || !passage.system().weights().pass_together(watch.paths())) {
    at_rest.clear();
    for (const double x : scene.output.probes) {
      if (caught_signal() != 0) break;
      at_rest.push_back(passage.system().weights().static_peak(x, watch.paths(), watch.last_time()));
    }
  }
  result.ended = caught_signal() == 0;
  result.static_deflection = at_rest;
  return result;
}

// Linear vehicles have left out too much.
CaseResult CaseRunner::run_with_mechanisms(std::size_t train, double speed,
                                           const std::function<void(double)>& reached) {
  scene_.vehicle_model = VehicleModel::full;
  CaseResult result = run_by_elements(train, speed, reached);
  scene_.vehicle_model = VehicleModel::linear;
  return result;
}

std::vector<CaseResult> CaseRunner::run_by_modes(std::size_t train, const std::vector<double>& speeds) {
  auto place = passages_.find(train);
  if (place == passages_.end()) {
    const train::MovingLoad& load = scene_of(train, speeds.front()).load;
    place = passages_.try_emplace(train, *shared_.modal, load, scene_.start == Start::equilibrium).first;
    static_deflection_[train] = place->second.static_peaks();
  }
  std::vector<double> ends;
  for (const double speed : speeds) ends.push_back(duration(train, speed));
  std::vector<CaseResult> results(speeds.size());
  const auto going = [] { return caught_signal() == 0; };
  std::vector<std::vector<integrate::ProbePeaks>> peaks;
  if (shared_.modal->dampers_couple())
    for (std::size_t i = 0; i < speeds.size(); ++i)
      peaks.push_back(integrate::modal_peaks(*shared_.modal, place->second.history(), speeds[i],
                                             scene_.start == Start::equilibrium, ends[i], scene_.sweep->instants,
                                             going));
  else
    peaks = place->second.peaks(speeds, ends, scene_.sweep->instants, going);
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    results[i].peaks = peaks[i];
    results[i].static_deflection = static_deflection_[train];
    results[i].ended = caught_signal() == 0;
  }
  return results;
}

}  // namespace traverse::app
