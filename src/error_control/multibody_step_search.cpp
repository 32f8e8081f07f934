// Chooses the time step of a mechanism without a bridge: the whole run is repeated with halved steps, and positions,
// joint reactions and contact forces are compared at equal instants.
#include "error_control/multibody_step_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>

#include "error_control/error_model.hpp"
#include "error_control/search_constants.hpp"
#include "results/stage.hpp"
#include "run/rank_choice.hpp"
#include "run/simulation.hpp"
#include "traverse/options/input.hpp"

namespace traverse::error_control {
namespace {

constexpr double instants = 400.0;  // instants of a run at which runs are compared

/// Kinds of compared values; each kind is relative to its own largest value.
enum Kind : std::size_t { places, angles, forces, moments, contacts, kinds };
constexpr std::array<MultibodyQuantity, kinds> quantity_of = {position, position, joint_force, joint_force,
                                                              contact_force};
using Curves = std::array<std::vector<double>, kinds>;

void add(const train::Fleet& fleet, Curves& curves) {
  for (const train::MovingVehicle& vehicle : fleet.vehicles) {
    const Eigen::VectorXd& q = vehicle.state.q;
    for (Eigen::Index i = 0; i < q.size(); ++i) curves[i % 3 == 2 ? angles : places].push_back(q[i]);
    for (int joint = 0; joint < static_cast<int>(vehicle.mechanism.model().joints.size()); ++joint) {
      const Eigen::Vector3d reaction = vehicle.mechanism.joint_reaction(vehicle.state, joint);
      curves[forces].insert(curves[forces].end(), {reaction.x(), reaction.y()});
      curves[moments].push_back(reaction.z());
    }
  }
  for (const train::WheelContact& wheel : fleet.wheels) curves[contacts].push_back(wheel.force.normal);
  for (const train::Contact& pair : fleet.pairs) curves[contacts].push_back(pair.force.normal);
}

/// The largest magnitude of a kind; for positions the largest displacement from the start.
double size_of(const Curves& curves, std::size_t kind) {
  const std::vector<double>& x = curves[kind];
  const std::size_t width = std::max<std::size_t>(1, x.size() / static_cast<std::size_t>(instants + 1.0));
  double size = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    size = std::max(size, std::abs(x[i] - (quantity_of[kind] == position ? x[i % width] : 0.0)));
  return size;
}

/// Runs of a whole scene with several steps.
class Runs {
 public:
  Runs(MPI_Comm comm, const scene::Scene& scene) : scene_(scene), shared_(comm, scene, ignored_) {
    scene_.quiet = true;
    scene_.output.interval = first_multibody_step(scene);
  }

  double seconds(double step) const { return *scene_.end_time / step * run::step_seconds(scene_); }
  std::size_t count() const { return curves_.size(); }

  /// Collective. Returns the curves of a run with this step; empty if the run failed.
  const std::optional<Curves>& run(double step) {
    const auto [place, is_new] = curves_.try_emplace(step);
    if (!is_new) return place->second;
    scene_.model.step = step;
    try {
      Curves curves;
      run::Simulation simulation(scene_, shared_, {}, ignored_);
      run::ObserverBy recorder([&](const integrate::Instant& now) {
        if (integrate::is_stored(now.purpose)) add(simulation.system().fleet(), curves);
      });
      simulation.run({&recorder});
      lost_contact_ = simulation.result().lost_contact || lost_contact_;
      place->second = std::move(curves);
    } catch (const SolverError&) {  // the step is probably too long
    }
    return place->second;
  }

  bool lost_contact() const { return lost_contact_; }  // in one of the runs
  bool has(MultibodyQuantity q, double step) {
    const std::optional<Curves>& curves = run(step);
    for (std::size_t kind = 0; curves && kind < kinds; ++kind)
      if (quantity_of[kind] == q && size_of(*curves, kind) > 0.0) return true;
    return false;
  }

  /// The largest difference of a quantity at any instant, relative to its largest value; 1 if one of the runs failed.
  double difference(double rough, double fine, MultibodyQuantity q) {
    const std::optional<Curves>&a = run(rough), &b = run(fine);
    if (!a || !b) return 1.0;
    double worst = 0.0;
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      const double size = quantity_of[kind] == q ? size_of(*b, kind) : 0.0;
      for (std::size_t i = 0; size > 0.0 && i < std::min((*a)[kind].size(), (*b)[kind].size()); ++i)
        worst = std::max(worst, std::abs((*a)[kind][i] - (*b)[kind][i]) / size);
    }
    return worst;
  }

 private:
  std::vector<std::string> ignored_;
  scene::Scene scene_;
  run::SharedBeam shared_;
  std::map<double, std::optional<Curves>> curves_;  // the key is the step, s
  bool lost_contact_ = false;
};

/// The error of one quantity as steps are halved.
struct Search {
  ErrorModel error;
  int stalls = 0;  // successive halvings with little change

  void add(double change, double step, bool both_ended) {
    error = error_from(change, step, error);
    stalls = both_ended && error.known && error.order < search::stall_order ? stalls + 1 : 0;
  }
  bool done(double wanted) const { return stalls >= search::max_stalls || (error.known && error.value <= wanted); }
};

}  // namespace

bool chooses_multibody_step(const scene::Scene& scene) {
  return !scene.beam && !scene.model.step && scene.end_time && !scene.vehicles.empty() && !scene.sweep &&
         scene.analysis == options::Analysis::transient;
}

double first_multibody_step(const scene::Scene& scene) { return *scene.end_time / instants; }

Choice choose_multibody_step(MPI_Comm comm, const scene::Scene& scene, std::vector<std::string>& notes) {
  const results::Stage stage("trial runs");
  const options::WithoutMonitors without_monitors;
  const auto begin = std::chrono::steady_clock::now();
  Runs runs(comm, scene);
  std::array<Search, multibody_quantities> searches;
  const double wanted = search::share * scene.accuracy;
  const auto rejected = [&](std::size_t q) { return q == contact_force && runs.lost_contact(); };
  const auto done = [&](std::size_t q) { return rejected(q) || searches[q].done(wanted); };
  double step = first_multibody_step(scene), spent = runs.seconds(step);
  for (int i = 0; i < search::max_halvings && !(done(position) && done(joint_force) && done(contact_force)); ++i) {
    step *= 0.5;
    spent += runs.seconds(step);
    const bool both_ended = runs.run(2.0 * step) && runs.run(step);
    for (std::size_t q = 0; q < multibody_quantities; ++q)
      searches[q].add(runs.difference(2.0 * step, step, static_cast<MultibodyQuantity>(q)), step, both_ended);
    if (spent + runs.seconds(0.5 * step) > search::max_seconds) break;
  }
  double longer = search::max_extrapolation;
  for (std::size_t q = 0; q < multibody_quantities; ++q)
    if (!rejected(q) && searches[q].stalls < search::max_stalls)
      longer = std::min(longer, std::max(1.0, searches[q].error.allowed_ratio(wanted)));

  Choice choice{scene.model, {}, {}};
  Accuracy& result = choice.accuracy;
  result.measured = true;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  choice.model.step = longer * step;
  notes.push_back(fmt::format("accuracy {:g}: steps of {:.3g} s; {} trial runs of the whole scene took {:.2g} s",
                              scene.accuracy, *choice.model.step, runs.count(), result.seconds));
  std::string expected;
  for (std::size_t q = 0; q < multibody_quantities; ++q) {
    ErrorEstimate& estimate = result.multibody[q];
    estimate.present = runs.has(static_cast<MultibodyQuantity>(q), step);
    estimate.expected = searches[q].error.at(longer);
    estimate.accepted = !rejected(q) && searches[q].error.known && estimate.expected <= scene.accuracy;
    if (estimate.present && estimate.accepted)
      expected += fmt::format("{}{} {:.1g}", expected.empty() ? "" : ", ", multibody_names[q], estimate.expected);
  }
  if (!expected.empty()) notes.push_back("estimated errors: " + expected);
  for (std::size_t q = 0; q < multibody_quantities; ++q)
    if (result.multibody[q].present && !result.multibody[q].accepted)
      notes.push_back(fmt::format(
          "error not estimated: {}: {}", multibody_names[q],
          rejected(q) ? "contacts open and close again, and impact forces are pulses"
                      : fmt::format("the error with steps of {:.2g} s is {:.1g}{}", step, searches[q].error.value,
                                    searches[q].stalls > 0 ? ", and it does not decrease when they are halved" : "")));
  return choice;
}

bool report_multibody(MPI_Comm comm, const scene::Scene& scene, const Accuracy& accuracy) {
  const results::Stage stage("the refined run of -accuracy_report");
  const options::WithoutMonitors without_monitors;
  Runs runs(comm, scene);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0) report_head("half the step", "of");
  bool all_within = true;
  for (std::size_t q = 0; q < multibody_quantities; ++q) {
    const ErrorEstimate& estimate = accuracy.multibody[q];
    if (!estimate.present) continue;
    const double error = runs.difference(*scene.model.step, 0.5 * *scene.model.step, static_cast<MultibodyQuantity>(q));
    all_within = report_row(multibody_names[q], estimate, scene.accuracy, error, rank == 0) && all_within;
  }
  return all_within;
}

}  // namespace traverse::error_control
