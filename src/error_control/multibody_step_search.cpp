// Chooses the time step of a mechanism without a bridge: positions, joint reactions and contact forces of whole runs
// are compared at equal instants.
#include "error_control/multibody_step_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>

#include "error_control/companion_search.hpp"
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

/// Runs of a whole scene with several steps. The first numbers of PeakErrors are those of the MultibodyQuantity.
class Runs : public Companions {
 public:
  Runs(MPI_Comm comm, const scene::Scene& scene) : scene_(scene), shared_(comm, scene, ignored_) {
    scene_.quiet = true;
    scene_.output.interval = first_multibody_step(scene);
  }

  bool run(const Discretisation& model) override { return curves_of(model.step).has_value(); }
  PeakErrors change(const Discretisation& coarse, const Discretisation& fine) override {
    PeakErrors changes{};
    for (std::size_t q = 0; q < multibody_quantities; ++q)
      changes[q] = difference(coarse.step, fine.step, static_cast<MultibodyQuantity>(q));
    return changes;
  }
  double seconds(const Discretisation& model) override {
    return *scene_.end_time / model.step * run::step_seconds(scene_);
  }
  std::size_t count() const { return curves_.size(); }

  /// Collective. Returns the curves of a run with this step; empty if the run failed.
  const std::optional<Curves>& curves_of(double step) {
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
    const std::optional<Curves>& curves = curves_of(step);
    for (std::size_t kind = 0; curves && kind < kinds; ++kind)
      if (quantity_of[kind] == q && size_of(*curves, kind) > 0.0) return true;
    return false;
  }

  /// The largest difference of a quantity at any instant, relative to its largest value; 1 if one of the runs failed.
  double difference(double rough, double fine, MultibodyQuantity q) {
    const std::optional<Curves>&a = curves_of(rough), &b = curves_of(fine);
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
  SearchTask task;
  task.accuracy = scene.accuracy;
  task.coarse.step = first_multibody_step(scene);
  task.fine.step = 0.5 * task.coarse.step;
  task.open_mesh = false;
  // Contacts that open and close again in the first run have pulses as forces.
  runs.run(task.coarse);
  const bool impacts = runs.lost_contact();
  for (std::size_t q = 0; q < multibody_quantities; ++q) task.wanted[q] = q != contact_force || !impacts;
  CompanionSearch search(runs, task);
  search.run();

  Choice choice{scene.model, {}, {}, {}};
  Accuracy& result = choice.accuracy;
  result.measured = true;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const double step = search.model().step;
  choice.model.step = step;
  notes.push_back(fmt::format("accuracy {:g}: steps of {:.3g} s; {} trial runs of the whole scene took {:.2g} s",
                              scene.accuracy, step, runs.count(), result.seconds));
  std::string expected;
  for (std::size_t q = 0; q < multibody_quantities; ++q) {
    ErrorEstimate& estimate = result.multibody[q];
    estimate.present = runs.has(static_cast<MultibodyQuantity>(q), step);
    estimate.expected = search.errors()[q];
    const bool pulses = q == contact_force && runs.lost_contact();
    estimate.why_not = pulses ? "contacts open and close again, and impact forces are pulses" : search.why_not(q);
    estimate.accepted = estimate.why_not.empty();
    if (estimate.present && estimate.accepted)
      expected += fmt::format("{}{} {:.1g}", expected.empty() ? "" : ", ", multibody_names[q], estimate.expected);
  }
  if (!expected.empty()) notes.push_back("estimated errors: " + expected);
  for (std::size_t q = 0; q < multibody_quantities; ++q)
    if (result.multibody[q].present && !result.multibody[q].accepted)
      notes.push_back(fmt::format("error not estimated: {}: {}", multibody_names[q], result.multibody[q].why_not));
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
