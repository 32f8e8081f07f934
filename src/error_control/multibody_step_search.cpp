// Time step of a mechanism without a bridge: the whole run is repeated with halved steps, and positions, joint
// reactions and contact forces are compared at equal instants.
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
#include "run/passage.hpp"
#include "run/step_cost.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

constexpr double instants = 400.0;  // of a run, at which runs are compared

/// What is compared, of all instants: each kind of numbers by its own size.
enum Kind : std::size_t { places, angles, forces, moments, contacts, kinds };
constexpr std::array<AloneQuantity, kinds> quantity_of = {position, position, joint_force, joint_force, contact_force};
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

/// The largest magnitude of such numbers; of positions the largest way from the start.
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
  Runs(MPI_Comm comm, const Scene& scene) : scene_(scene), shared_(comm, scene, ignored_) {
    scene_.quiet = true;
    scene_.output.interval = longest_step_alone(scene);
  }

  double seconds(double step) const { return *scene_.end_time / step * step_seconds(scene_); }
  std::size_t count() const { return kept_.size(); }

  /// Collective. None where the run failed.
  const std::optional<Curves>& run(double step) {
    const auto [place, is_new] = kept_.try_emplace(step);
    if (!is_new) return place->second;
    scene_.model.step = step;
    try {
      Curves curves;
      Passage passage(scene_, shared_, ignored_);
      passage.start(ignored_);
      coupling::Observation seen;
      passage.run(
          [&](const integrate::Instant& now) {
            passage.system().observe(now.time, now.y, now.acceleration, seen);
            add(passage.system().fleet(), curves);
          },
          [](double, long) { return true; });
      for (const train::Separation& loss : passage.system().contacts().separations().list())
        lost_contact_ = lost_contact_ || !loss.from_start;
      place->second = std::move(curves);
    } catch (const SolverError&) {  // too long a step, most likely
    }
    return place->second;
  }

  bool lost_contact() const { return lost_contact_; }  // in one of the runs
  bool has(AloneQuantity q, double step) {
    const std::optional<Curves>& curves = run(step);
    for (std::size_t kind = 0; curves && kind < kinds; ++kind)
      if (quantity_of[kind] == q && size_of(*curves, kind) > 0.0) return true;
    return false;
  }

  /// The largest difference of a quantity at any instant, over the largest it comes to; 1 where one of the runs failed.
  double difference(double rough, double fine, AloneQuantity q) {
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
  Scene scene_;
  SharedBeam shared_;
  std::map<double, std::optional<Curves>> kept_;  // by their steps
  bool lost_contact_ = false;
};

/// One quantity's error as steps are halved.
struct Search {
  ErrorModel law;
  int crawls = 0;  // halvings in a row that have changed little

  void add(double change, double step, bool both_ended) {
    law = error_from(change, step, law);
    crawls = both_ended && law.known && law.order < search::slow_order ? crawls + 1 : 0;
  }
  bool done(double wanted) const { return crawls >= search::most_crawls || (law.known && law.value <= wanted); }
};

}  // namespace

bool chooses_step_alone(const Scene& scene) {
  return !scene.beam && !scene.model.step && scene.end_time && !scene.vehicles.empty() && !scene.sweep &&
         scene.analysis == Analysis::transient;
}

double longest_step_alone(const Scene& scene) { return *scene.end_time / instants; }

Choice choose_step_alone(MPI_Comm comm, const Scene& scene, std::vector<std::string>& notes) {
  const results::Stage stage("trial runs");
  const options::WithoutMonitors without_monitors;
  const auto begin = std::chrono::steady_clock::now();
  Runs runs(comm, scene);
  std::array<Search, alone_quantities> searches;
  const double wanted = search::share * scene.accuracy;
  const auto refused = [&](std::size_t q) { return q == contact_force && runs.lost_contact(); };
  const auto done = [&](std::size_t q) { return refused(q) || searches[q].done(wanted); };
  double step = longest_step_alone(scene), spent = runs.seconds(step);
  for (int i = 0; i < search::most_halvings && !(done(position) && done(joint_force) && done(contact_force)); ++i) {
    step *= 0.5;
    spent += runs.seconds(step);
    const bool both_ended = runs.run(2.0 * step) && runs.run(step);
    for (std::size_t q = 0; q < alone_quantities; ++q)
      searches[q].add(runs.difference(2.0 * step, step, static_cast<AloneQuantity>(q)), step, both_ended);
    if (spent + runs.seconds(0.5 * step) > search::most_seconds) break;
  }
  double longer = search::farthest;
  for (std::size_t q = 0; q < alone_quantities; ++q)
    if (!refused(q) && searches[q].crawls < search::most_crawls)
      longer = std::min(longer, std::max(1.0, searches[q].law.room(wanted)));

  Choice choice{scene.model, {}, {}};
  Accuracy& result = choice.accuracy;
  result.measured = true;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  choice.model.step = longer * step;
  notes.push_back(fmt::format("accuracy {:g}: steps of {:.3g} s; {} trial runs of the whole scene took {:.2g} s",
                              scene.accuracy, *choice.model.step, runs.count(), result.seconds));
  std::string expected;
  for (std::size_t q = 0; q < alone_quantities; ++q) {
    ErrorEstimate& promise = result.alone[q];
    promise.present = runs.has(static_cast<AloneQuantity>(q), step);
    promise.expected = searches[q].law.at(longer);
    promise.kept = !refused(q) && searches[q].law.known && promise.expected <= scene.accuracy;
    if (promise.present && promise.kept)
      expected += fmt::format("{}{} {:.1g}", expected.empty() ? "" : ", ", alone_names[q], promise.expected);
  }
  if (!expected.empty()) notes.push_back("estimated errors: " + expected);
  for (std::size_t q = 0; q < alone_quantities; ++q)
    if (result.alone[q].present && !result.alone[q].kept)
      notes.push_back(fmt::format(
          "error not estimated: {}: {}", alone_names[q],
          refused(q) ? "contacts are lost and made again, by forces that are pulses"
                     : fmt::format("steps of {:.2g} s leave an error of {:.1g}{}", step, searches[q].law.value,
                                   searches[q].crawls > 0 ? ", which does not fall as they are halved" : "")));
  return choice;
}

bool report_alone(MPI_Comm comm, const Scene& scene, const Accuracy& accuracy) {
  const results::Stage stage("the refined run of -accuracy_report");
  const options::WithoutMonitors without_monitors;
  Runs runs(comm, scene);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0) report_head("half the step", "of");
  bool all_kept = true;
  for (std::size_t q = 0; q < alone_quantities; ++q) {
    const ErrorEstimate& promise = accuracy.alone[q];
    if (!promise.present) continue;
    const double error = runs.difference(*scene.model.step, 0.5 * *scene.model.step, static_cast<AloneQuantity>(q));
    all_kept = report_row(alone_names[q], promise, scene.accuracy, error, rank == 0) && all_kept;
  }
  return all_kept;
}

}  // namespace traverse::app
