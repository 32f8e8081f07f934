// Groups cases into studies of problems that differ in the values of options only, and single runs, shares both over
// the ranks, and collects the results.
#include "traverse/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <map>
#include <utility>

#include "base/broadcast.hpp"
#include "base/bytes.hpp"
#include "check/unusual.hpp"
#include "ensemble/parallel_cases.hpp"
#include "options/parse_number.hpp"
#include "process_start.hpp"
#include "run/process.hpp"
#include "step_by_step.hpp"
#include "study/prepared_study.hpp"
#include "traverse/options/input.hpp"

namespace traverse {
namespace {

using app::StepByStep;
using scene::Scene;
using Indices = std::vector<std::size_t>;

/// Cases that are computed together: the runs of a study, or one alone if no value differs.
struct Group {
  Indices cases;
  std::vector<std::string> varied;  // options whose values differ
};

const std::string& value_of(const Problem& problem, const std::string& name) {
  return problem.entries().find(name)->value;
}

/// The names of all options, with the values that are no numbers.
std::string fixed_part(const Problem& problem) {
  std::string text;
  for (const options::Entry& entry : problem.entries()) {
    double number = 0.0;
    text += fmt::format("{}={}\n", entry.name, options::parse_speed(entry.value, number) ? "" : entry.value);
  }
  return text;
}

/// Cases with the same names, tables and changes, in parts whose values differ only where those of a study may.
std::vector<Group> groups_of(std::span<const Case> cases) {
  std::map<std::string, std::vector<Indices>> alike;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    std::vector<Indices>& parts = alike[fixed_part(cases[i].problem)];
    const auto known = std::ranges::find_if(parts, [&](const Indices& part) {
      const Case& first = cases[part.front()];
      return first.observers.empty() && cases[i].observers.empty() &&
             first.problem.differs_in_options_only(cases[i].problem);
    });
    known != parts.end() ? known->push_back(i) : parts.push_back({i});
  }
  std::vector<Group> groups;
  for (const auto& [text, parts] : alike)
    for (const Indices& part : parts) {
      const Problem& first = cases[part.front()].problem;
      std::vector<std::string> varied;
      for (const options::Entry& entry : first.entries())
        if (std::ranges::any_of(part,
                                [&](std::size_t i) { return value_of(cases[i].problem, entry.name) != entry.value; }))
          varied.push_back(entry.name);
      const std::vector<std::string> fixed = scene::not_varied(options::Options(first.entries()), varied);
      std::erase_if(varied, [&](const std::string& name) { return std::ranges::find(fixed, name) != fixed.end(); });
      std::map<std::vector<std::string>, Indices> by_fixed;
      for (const std::size_t i : part) {
        std::vector<std::string> values;
        for (const std::string& name : fixed) values.push_back(value_of(cases[i].problem, name));
        by_fixed[values].push_back(i);
      }
      for (auto& [values, some] : by_fixed) groups.push_back({std::move(some), varied});
    }
  std::ranges::sort(groups, {}, [](const Group& group) { return group.cases.front(); });
  return groups;
}

/// The options of a study whose runs are the cases of a group.
options::Entries study_of(std::span<const Case> cases, const Group& group) {
  options::Entries entries = cases[group.cases.front()].problem.entries();
  for (const std::string& name : group.varied) {
    std::string values;
    for (const std::size_t i : group.cases) values += (values.empty() ? "" : ",") + value_of(cases[i].problem, name);
    entries.set({"study_vary_" + name, std::move(values), "problem", 0});
  }
  entries.set({"study_combine", "together", "problem", 0});
  return entries;
}

Result result_of(const results::StudyTable& table, std::size_t run, const std::string& model) {
  Result result;
  if (!table.finished(run)) return result;
  const auto number = [&](const char* name, std::size_t k = 0) {
    const results::StudyTable::Column* column = table.find(name);
    return column == nullptr ? unknown : column->values[run * column->width + k];
  };
  for (std::size_t p = 0; p < table.probes(); ++p)
    result.probes.push_back({number("probes_x", p),
                             {number("peak_deflection", p), number("peak_deflection_time", p)},
                             {number("peak_acceleration", p), number("peak_acceleration_time", p)},
                             {number("peak_moment", p), number("peak_moment_time", p)},
                             number("static_deflection", p)});
  result.least_wheel_force = number("least_wheel_force");
  result.greatest_wheel_force = number("greatest_wheel_force");
  result.contact_losses = number("contact_losses");
  result.longest_loss = number("longest_loss");
  const std::vector<std::string> names = results::names_of_limits(table.limits());
  for (std::size_t l = 0; l < table.limits().size(); ++l) {
    const options::VerdictLimit& limit = table.limits()[l];
    result.limits.push_back({names[l], limit.quantity, std::string(options::limit_quantity(limit.quantity)->unit),
                             limit.value, number("judged", l), number("judged_x", l), table.reason(l)});
  }
  result.model = model;
  return result;
}

/// A run by itself: with mechanisms or shorter steps again if linear vehicles or the selected step were not accurate
/// enough.
Result run_alone(const Scene& scene, const std::vector<Observer*>& observers) {
  app::ChosenScene chosen = app::choose_for_one_run(scene);
  for (int halvings = scene.step_open ? app::most_halvings : 0;;) {
    StepByStep run(chosen);
    try {
      for (Observer* observer : observers) observer->begin(run);
      bool goes_on = true;
      while (goes_on && run.time() < run.end()) {
        run.advance(observers.empty() ? run.end() : std::min(run.time() + run.interval(), run.end()));
        for (Observer* observer : observers) goes_on = observer->sample(run) && goes_on;
      }
      Result result = run.result();
      if (!(result.linearisation_residual > chosen.scene.model.residual_limit)) {
        for (Observer* observer : observers) observer->end(result);
        return result;
      }
      chosen.scene.model.vehicles = scene::VehicleModel::full;
    } catch (const StepTooLong&) {
      if (halvings-- == 0) throw;
      chosen.scene.model.step = 0.5 * run.step_length();
    }
  }
}

/// A result as bytes for other ranks, or from them.
void keep(base::Bytes& bytes, Result& result) {
  bytes(result.probes, result.least_wheel_force, result.greatest_wheel_force, result.contact_losses,
        result.longest_loss, result.energy_residual, result.linearisation_residual, result.steps, result.model,
        result.unusual);
  auto count = result.limits.size();
  bytes(count);
  result.limits.resize(count);
  for (LimitResult& limit : result.limits)
    bytes(limit.name, limit.quantity, limit.unit, limit.bound, limit.value, limit.x, limit.why);
}

/// Collective. The result of the rank `owner` on all ranks.
void broadcast(MPI_Comm comm, Result& result, int owner) {
  base::Bytes written;
  keep(written, result);
  const std::string bytes = base::broadcast(comm, written.written(), owner);
  base::Bytes read{std::span<const char>(bytes)};
  keep(read, result);
}

/// The cases of one call, and their results.
class Runs {
 public:
  Runs(std::span<const Case> cases, const Progress& progress, MPI_Comm comm)
      : cases_(cases), progress_(progress), comm_(comm), results_(cases.size()) {
    PetscBool running = PETSC_FALSE;
    if (PetscInitialized(&running) != 0 || running == PETSC_FALSE)
      throw InputError("simulate: PETSc is not started; a traverse::Session starts it");
    MPI_Comm_rank(comm, &rank_);
    MPI_Comm_size(comm, &ranks_);
    for (const Group& group : groups_of(cases)) read(group);
  }

  std::vector<Result> run() {
    const run::StopRequest stop([this] {
      const double all = static_cast<double>(cases_.size());
      return !progress_ || progress_(static_cast<double>(done_) / all);
    });
    for (const Study& study : studies_) compute(study);
    compute_alone();
    for (const auto& [copy, of] : copies_) results_[copy] = results_[of];
    return std::move(results_);
  }

 private:
  struct Study {
    Group group;
    Scene scene;
  };

  /// Reads the scenes of a group. Throws InputError with the number of the problem if there are several.
  void read(const Group& group) {
    const std::size_t first = group.cases.front();
    std::map<std::size_t, Scene> scenes;
    scenes.emplace(first, scene_of(first));
    const bool is_study = !group.varied.empty() && group.cases.size() > 1 && scenes.at(first).beam &&
                          scenes.at(first).analysis == options::Analysis::transient;
    if (is_study) {
      try {
        const Problem& problem = cases_[first].problem;
        Scene scene = problem.scene(
            [&] { return scene::read_scene(options::Options(options::complete(study_of(cases_, group), "problem"))); });
        studies_.push_back({group, std::move(scene)});
        return;
      } catch (const InputError&) {  // one of them is invalid, or no study has such runs
      }
    }
    for (const std::size_t i : group.cases) {
      if (i != first && group.varied.empty()) {
        copies_.emplace_back(i, first);
        continue;
      }
      if (i != first) scenes.emplace(i, scene_of(i));
      alone_.emplace_back(i, std::move(scenes.at(i)));
    }
  }

  Scene scene_of(std::size_t i) const {
    try {
      for (const char* prefix :
           {"study_", "sweep_", "find_", "fit_", "screen_", "describe", "restart", "help", "version"})
        for (const options::Entry& entry : cases_[i].problem.entries())
          if (entry.name.starts_with(prefix))
            throw InputError(fmt::format("{}: a problem is one run; simulate has lists of problems", entry.given()));
      Scene scene = cases_[i].problem.scene();
      if (!cases_[i].observers.empty() && !cases_[i].problem.entries().has("model_vehicles"))
        scene.model.vehicles = scene::VehicleModel::full;
      return scene;
    } catch (const InputError& error) {
      if (cases_.size() == 1) throw;
      throw InputError(fmt::format("problem {}: {}", i, error.what()));
    }
  }

  void compute(const Study& study) {
    const Problem& problem = cases_[study.group.cases.front()].problem;
    const options::InPetsc petsc(problem.entries());
    study::PreparedStudy prepared(comm_, study.scene, [&](const auto& values) {
      return problem.scene([&] { return scene::read_scene_of_study(options::Options(*study.scene.given), values); });
    });
    const std::size_t before = done_;
    ensemble::RunFailure failure = prepared.compute(comm_, [this] { ++done_; });
    done_ = before + study.group.cases.size();
    const std::string model = results::method_of(prepared.model);
    for (std::size_t run = 0; run < study.group.cases.size(); ++run)
      results_[study.group.cases[run]] = result_of(prepared.table(), run, model);
    results_[study.group.cases.front()].unusual = check::unusual_in(study.scene);
    check(failure);
  }

  /// Collective. Throws the failure of a rank, or that the runs were stopped.
  void check(const ensemble::RunFailure& failure) {
    if (failure.failed()) throw RunsFailed(failure.message, failure.status, std::move(results_));
    if (const int signal = run::signal_on_any(comm_); signal != 0)
      throw RunsFailed("the runs were stopped", 128 + signal, std::move(results_));
  }

  /// Each case by the next rank that is free.
  void compute_alone() {
    std::vector<int> owners(alone_.size(), -1);
    ensemble::SharedWork work;
    work.pieces.assign(alone_.size(), {1, 1.0});
    if (cases_.size() > 1)
      work.name = [this](std::size_t piece) { return fmt::format("problem {}", alone_[piece].first); };
    std::exception_ptr of_observer;
    work.compute = [&](std::size_t piece, const std::function<void(double)>&) {
      const auto& [i, scene] = alone_[piece];
      const options::InPetsc petsc(cases_[i].problem.entries());
      owners[piece] = rank_;
      try {
        results_[i] = run_alone(scene, cases_[i].observers);
      } catch (const Error&) {
        throw;
      } catch (...) {
        if (!cases_[i].observers.empty()) of_observer = std::current_exception();
        throw;
      }
      results_[i].unusual = check::unusual_in(scene);
      ++done_;
    };
    ensemble::RunFailure failure = ensemble::run_cases_in_parallel(comm_, work, true);
    if (of_observer && ranks_ == 1) std::rethrow_exception(of_observer);
    failure = ensemble::first_of(comm_, std::move(failure));
    if (ranks_ > 1) {
      MPI_Allreduce(MPI_IN_PLACE, owners.data(), static_cast<int>(owners.size()), MPI_INT, MPI_MAX, comm_);
      for (std::size_t piece = 0; piece < owners.size(); ++piece)
        if (owners[piece] >= 0) broadcast(comm_, results_[alone_[piece].first], owners[piece]);
    }
    check(failure);
  }

  std::span<const Case> cases_;
  const Progress& progress_;
  MPI_Comm comm_;
  int rank_ = 0, ranks_ = 1;
  std::vector<Study> studies_;
  std::vector<std::pair<std::size_t, Scene>> alone_;
  std::vector<std::pair<std::size_t, std::size_t>> copies_;  // a case, and the one of which it is a copy
  std::size_t done_ = 0;
  std::vector<Result> results_;
};

}  // namespace

Extreme Result::largest(Extreme ProbeResult::*quantity) const {
  Extreme largest;
  for (const ProbeResult& probe : probes)
    if (!((probe.*quantity).value <= largest.value)) largest = probe.*quantity;
  return largest;
}

std::vector<Result> simulate(std::span<const Case> cases, const Progress& progress, MPI_Comm comm) {
  const app::OneThreadOfBlas one_thread;
  return Runs(cases, progress, comm).run();
}

std::vector<Result> simulate(std::span<const Problem> problems, const Progress& progress, MPI_Comm comm) {
  std::vector<Case> cases;
  for (const Problem& problem : problems) cases.push_back({problem});
  return simulate(cases, progress, comm);
}

Result simulate(const Problem& problem, const std::vector<Observer*>& observers) {
  const Case one{problem, observers};
  return simulate(std::span(&one, 1)).front();
}

}  // namespace traverse
