// Builds the coupled system and its time integrator from a scene: by elements or by modes, with the known events at
// which steps end, and with the checks of mesh and step and of tables over time that end before the run.
#include "run/passage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "base/notes.hpp"
#include "integrate/integrators.hpp"
#include "results/stage.hpp"
#include "run/exit_states.hpp"
#include "run/process.hpp"
#include "run/profile_record.hpp"
#include "structure/active_window.hpp"
#include "structure/modal_structure.hpp"
#include "traverse/base/error.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {
namespace {

/// What a table determines: a displacement cannot jump in rate, a force of 0 needs no note.
enum class Table { displacement, length, force };

using Use = std::function<void(const std::string&, const base::TimeFunction&, Table)>;

void of_vehicles(const scene::Scene& scene, const Use& use) {
  for (const int type : std::set<int>(scene.train.vehicles.begin(), scene.train.vehicles.end())) {
    const train::Vehicle& vehicle = scene.vehicles[static_cast<std::size_t>(type)];
    const auto option = [&](const std::string& part, const char* word) {
      return fmt::format("vehicle_{}_{}_{}", vehicle.name, part, word);
    };
    for (const multibody::Driver& d : vehicle.mechanism.drivers)
      use(option(d.name, "table"), d.value, Table::displacement);
    for (const multibody::Spring& s : vehicle.mechanism.springs)
      if (s.winding) use(option(s.name, "winding_table"), *s.winding, Table::length);
    for (const multibody::Rope& r : vehicle.mechanism.ropes)
      if (r.winding) use(option(r.name, "winding_table"), *r.winding, Table::length);
    for (const multibody::Actuator& a : vehicle.mechanism.actuators)
      for (const base::TimeFunction& action : a.action) use(option(a.name, "table"), action, Table::force);
  }
}

void of_scene(const scene::Scene& scene, const Use& use) {
  for (const base::TimeFunction& f : scene.support_motion) use("support_motion", f, Table::displacement);
  for (const base::TimeFunction& f : scene.support_motion_along) use("support_motion_along", f, Table::displacement);
  for (const train::Course& course : scene.load.courses)
    if (course.variation.table) use(course.name + "_table", *course.variation.table, Table::force);
  of_vehicles(scene, use);
}

void refuse_jolt(const std::string& option, const base::TimeFunction& f, double end) {
  const std::vector<double>& rows = f.rows();
  for (const std::size_t row : {std::size_t{0}, rows.size() - 1}) {
    const double t = rows[row], jump = f.jump_of_rate(row);
    if (!(t > 0.0 && t < end) || jump == 0.0) continue;
    throw InputError(fmt::format(
        "{}: the table {} at {:g} s, where the displacement would {} at once with a jump in speed of {:.4g}, by an "
        "infinite force; allowed: a table from 0 to the end of the run at {:g} s, or two equal {} rows",
        option, row == 0 ? "begins" : "ends", t, row == 0 ? "start" : "stop", std::abs(jump), end,
        row == 0 ? "first" : "last"));
  }
}

void add_note(const std::string& note, std::vector<std::string>& notes) {
  if (notes.empty() || notes.back() != note) notes.push_back(note);
}

/// Appends a note for each table that ends before a run until `end` (s) while its values still change. InputError, with
/// the option, for a displacement of supports or drivers that would start or stop at once, which needs an infinite
/// force.
void check_table_ends(const scene::Scene& scene, double end, std::vector<std::string>& notes) {
  of_scene(scene, [&](const std::string& option, const base::TimeFunction& f, Table table) {
    if (f.straight()) return;
    if (table == Table::displacement) refuse_jolt(option, f, end);
    const std::vector<double>& rows = f.rows();
    const double last = f.value(rows.back());
    if (!(rows.back() < end) || f.value(rows[rows.size() - 2]) == last) return;
    if (table == Table::force && last == 0.0) return;
    const double rate = f.rate(rows.back() + end);  // far behind the table
    add_note(fmt::format("{}: the table ends at {:g} s, the run at {:g} s; {}", option, rows.back(), end,
                         rate != 0.0 ? fmt::format("without acceleration it goes on at {:.4g} m/s", rate)
                                     : std::string("the last value holds")),
             notes);
  });
  const auto of_speeds = [&](const std::vector<train::Course>& courses) {
    for (const train::Course& course : courses) {
      const std::vector<double> rows = course.speed.kinks();
      if (rows.size() < 2 || !(rows.back() < end) || course.speed.standstill() <= rows.back()) continue;
      if (course.speed.speed(rows[rows.size() - 2]) == course.speed.speed(rows.back())) continue;
      add_note(fmt::format("{}: the table of its motion ends at {:g} s, the run at {:g} s; the last speed holds",
                           course.name, rows.back(), end),
               notes);
    }
  };
  of_speeds(scene.train.courses);
  of_speeds(scene.load.courses);
}

constexpr double min_steps = 5.0;  // steps for each crossing of a probe

constexpr double default_solves = 5.0;  // stage solves of the default method, for which contact_impact_steps is defined

/// The times at which a wheel or force crosses a probe; empty if there are too many of them for the steps, or if wheels
/// run on the rail of a layered track. Wheels without a prescribed speed have none.
std::vector<double> crossing_times(const scene::Scene& scene, const Plan& plan) {
  std::vector<double> times;
  if (!scene.beam || scene.beam->track || scene.analysis != options::Analysis::transient) return times;
  const auto add = [&](double x, const base::SpeedLaw& law) {
    if (law.direction() == 0.0) return;
    for (const double probe : scene.output.probes)
      if (const double t = law.time_of(probe - x); t > 0.0 && t < plan.end_time) times.push_back(t);
  };
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i)
    if (drive_of(scene.train, i) == train::Drive::constant)
      for (const double x : scene::wheels_at_start(scene, i)) add(x, law_of(scene.train, i));
  for (std::size_t i = 0; i < scene.load.positions.size(); ++i)
    if (length_of(scene.load, i) == 0.0) add(scene.load.positions[i], law_of(scene.load, i));
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  if (static_cast<double>(times.size()) * min_steps > plan.end_time / plan.time_step) times.clear();
  return times;
}

}  // namespace

coupling::SystemInput system_input(const scene::Scene& scene, bool static_only) {
  coupling::SystemInput input = {scene.vehicles, scene.train,       scene.load,         scene.profile,
                                 scene.gravity,  scene.self_weight, scene.impact_steps, scene.model.local_compliance};
  input.contact_points = scene.output.contact_points;
  input.only_on_bridge = !scene.output.series && scene.start == scene::Start::equilibrium;
  if (!static_only) {
    const auto own = integrate::own_method(scene.model.method);
    const double solves = own ? static_cast<double>(own->stages.size()) : default_solves;
    input.impact_steps *= static_cast<int>(std::max(1.0, default_solves / solves));
    return input;
  }
  input.train.speed = input.load.speed = 0.0;
  for (std::vector<train::Course>* courses : {&input.train.courses, &input.load.courses})
    for (train::Course& course : *courses) course.speed = base::SpeedLaw();
  return input;
}

std::unique_ptr<structure::MovingStructure> carrier(const scene::Scene& scene, const SharedBeam& shared,
                                                    const coupling::SystemInput& input) {
  if (!shared.modal || scene.exact_in_time()) {
    std::unique_ptr<structure::MovingStructure> elements =
        coupling::by_elements(shared.bridge(), input, shared.statics);
    if (shared.moving_supports) elements->move_supports(shared.moving_supports);
    return elements;
  }
  return std::make_unique<structure::ModalStructure>(*shared.modal, input.self_weight ? input.gravity : 0.0,
                                                     shared.statics);
}

Passage::Passage(const scene::Scene& scene, const SharedBeam& shared, std::vector<std::string>& notes,
                 const Plan* earlier)
    : scene_(scene),
      shared_(shared),
      static_only_(scene.analysis != options::Analysis::transient),
      input_(system_input(scene, static_only_)),
      system_(shared.comm, carrier(scene, shared, input_), input_) {
  check_mesh(scene, notes);
  if (!static_only_) {
    plan_ = make_plan(scene, system_, shared.first_period(), notes);
    check_table_ends(scene, plan_.end_time, notes);
    if (scene.output.profile != 0.0) ProfileRecord(scene, system_.fleet(), plan_.end_time);  // throws if it is too fine
  }
  if (earlier != nullptr) {
    plan_.time_step = earlier->time_step;
    plan_.interval = earlier->interval;
    plan_.stored = earlier->stored;
  }
  std::string method;
  if (scene.exact_in_time()) {
    modal_.emplace(system_, *shared.modal, *shared.statics, input_, scene.start == scene::Start::equilibrium,
                   plan_.end_time, plan_.interval, plan_.stored);
    method = modal_->method();
  } else {
    limit_to_active_window(notes);
    integrate::Settings settings{plan_.end_time, plan_.time_step, plan_.interval,
                                 system_.known_events(plan_.end_time, scene.model.step_kinks),
                                 scene.contact_tolerance.value_or(1e-3 * plan_.time_step)};
    if (scene.model.step_probes) settings.crossing_times = crossing_times(scene, plan_);
    if (!static_only_) add_axle_passages(settings.crossing_times);
    settings.stored = plan_.stored;
    settings.type = scene.model.method;
    settings.kinks = scene.model.step_kinks && !static_only_;
    stepper_.emplace(system_, std::move(settings));
    if (!static_only_) check_times(plan_);
    if (!static_only_ && stepper_->hides_long_steps())
      check_steps(scene, plan_, shared.first_period(), stepper_->high_order(), notes);
    method = fmt::format("{}, steps of at most {:g} s", stepper_->method(), plan_.time_step);
  }
  notes.push_back(
      base::detail(fmt::format("vehicles {}, their degrees of freedom {}, moving forces {}",
                               system_.fleet().members.size(), system_.freedom(), scene.load.forces.size())));
  if (!static_only_)
    notes.push_back(
        base::detail(fmt::format("integrator {} to {:g} s, samples every {:g} s{}", method, plan_.end_time,
                                 plan_.interval * static_cast<double>(plan_.stored),
                                 plan_.ends_at_sample() || scene.sweep ? "" : ", the end's own apart under /end")));
}

void Passage::add_axle_passages(std::vector<double>& times) const {
  const std::vector<double> more = axle_passage_times(scene_);
  times.insert(times.end(), more.begin(), more.end());
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
}

void Passage::limit_to_active_window(std::vector<std::string>& notes) {
  const beam::Beam* beam = system_.beam();
  if (static_only_ || beam == nullptr || scene_.model.modes > 0) return;
  const bool separate = beam->parts().size() > 2;
  const double tolerance = scene_.model.window_tolerance >= 0.0 ? scene_.model.window_tolerance
                           : separate                           ? structure::ActiveWindow::quiet
                                                                : 0.0;
  if (tolerance == 0.0) return;
  constexpr double quiet = structure::ActiveWindow::quiet;  // series show motion that peaks do not contain
  const double at_probes = scene_.output.series ? std::min(quiet, tolerance) : tolerance;
  system_.limit_to_active_window({tolerance, at_probes}, scene_.output.probes);
  notes.push_back(base::detail(
      fmt::format("parts of the bridge that move less than {:g} of the largest motion are not computed in a step{}",
                  tolerance, scene_.model.window_tolerance >= 0.0 ? "" : "; -model_window 0 computes all")));
}

void Passage::start(std::vector<std::string>& notes) {
  const results::Stage stage("search for the static equilibrium");
  if (modal_) {  // the modes have their own start; the system stores the static wheel loads
    std::vector<double> y(static_cast<std::size_t>(system_.local_size()));
    system_.start(scene_.start == scene::Start::equilibrium, y.data());
    return;
  }
  double* y = stepper_->state();
  for (const std::string& line :
       system_.start(static_only_ || scene_.start == scene::Start::equilibrium, y, static_only_))
    notes.push_back(line);
  if (scene_.model.vehicles == scene::VehicleModel::linear && !static_only_)
    for (const std::string& line : system_.linearise_vehicles(y)) notes.push_back(base::detail(line));
  if (!static_only_ && stepper_->hides_long_steps()) check_contacts(scene_, plan_, system_.fleet(), notes);
  stepper_->restore_state(&y);
}

void Passage::run(const std::function<void(const integrate::Instant&)>& sample,
                  const std::function<bool(double, long)>& step, const std::function<void(double)>& between) {
  if (modal_) {
    modal_->run(sample, step, between);
  } else {
    stepper_->run(sample, step, between);
  }
}

void serve_trains(MPI_Comm comm, const scene::Scene& scene) {
  auto sharing = std::make_unique<coupling::TrainSharing>(comm);
  try {
    std::vector<std::string> notes;
    SharedBeam shared(MPI_COMM_SELF, scene, notes);
    shared.set_up(scene, false, notes);
    Passage passage(scene, shared, notes);
    passage.start(notes);
    passage.system().share_trains(std::move(sharing));
    passage.serve();
  } catch (const std::exception& failure) {
    if (sharing != nullptr && sharing->next().what() == coupling::TrainSharing::end) return;  // the first rank says why
    fmt::print(stderr, "traverse: {}\n", failure.what());
    MPI_Abort(comm, as_error(failure).status());
  }
}

void Passage::keep(base::Archive& archive) {
  if (modal_)
    modal_->keep(archive);
  else
    stepper_->keep(archive);
}

}  // namespace traverse::run
