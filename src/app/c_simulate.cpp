// The functions of traverse.h for problems and their results.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "c_call.hpp"
#include "traverse/problem.hpp"
#include "traverse/simulate.hpp"
#include "traverse/traverse.h"

using traverse::InputError;
using traverse::app::call_and_catch;
using traverse::app::require_not_null;

struct traverse_problem {
  traverse::Problem problem;
};

namespace {

/// One number of a run, of its probe or limit k; unknown if it does not have it.
using Number = double (*)(const traverse::Result& run, std::size_t k);

struct Row {
  const char *name, *unit, *dimensions;
  Number number;
};

using traverse::Result;

constexpr Row rows[] = {
    {"probes_x", "m", "run probe", [](const Result& r, std::size_t k) { return r.probes[k].x; }},
    {"peak_deflection", "m", "run probe", [](const Result& r, std::size_t k) { return r.probes[k].deflection.value; }},
    {"peak_deflection_time", "s", "run probe",
     [](const Result& r, std::size_t k) { return r.probes[k].deflection.time; }},
    {"peak_acceleration", "m/s2", "run probe",
     [](const Result& r, std::size_t k) { return r.probes[k].acceleration.value; }},
    {"peak_acceleration_time", "s", "run probe",
     [](const Result& r, std::size_t k) { return r.probes[k].acceleration.time; }},
    {"peak_moment", "N m", "run probe", [](const Result& r, std::size_t k) { return r.probes[k].moment.value; }},
    {"peak_moment_time", "s", "run probe", [](const Result& r, std::size_t k) { return r.probes[k].moment.time; }},
    {"static_deflection", "m", "run probe",
     [](const Result& r, std::size_t k) { return r.probes[k].static_deflection; }},
    {"judged", "as criterion", "run criterion", [](const Result& r, std::size_t k) { return r.limits[k].value; }},
    {"judged_bound", "as criterion", "run criterion", [](const Result& r, std::size_t k) { return r.limits[k].bound; }},
    {"judged_x", "m", "run criterion", [](const Result& r, std::size_t k) { return r.limits[k].x; }},
    {"least_wheel_force", "N", "run", [](const Result& r, std::size_t) { return r.least_wheel_force; }},
    {"greatest_wheel_force", "N", "run", [](const Result& r, std::size_t) { return r.greatest_wheel_force; }},
    {"contact_losses", "1", "run", [](const Result& r, std::size_t) { return r.contact_losses; }},
    {"longest_loss", "s", "run", [](const Result& r, std::size_t) { return r.longest_loss; }},
    {"energy_residual", "1", "run", [](const Result& r, std::size_t) { return r.energy_residual; }},
    {"linearisation_residual", "1", "run", [](const Result& r, std::size_t) { return r.linearisation_residual; }},
    {"steps", "1", "run", [](const Result& r, std::size_t) { return r.steps; }},
};

}  // namespace

struct traverse_results {
  /// Numbers of all runs: one a run, or one for each probe or limit of a run.
  struct Quantity {
    const char *name, *unit, *dimensions;
    std::vector<std::size_t> shape;
    std::vector<double> values;
  };
  std::vector<Quantity> quantities;
  std::vector<std::string> models, criteria, unusual;
};

namespace {

using Quantity = traverse_results::Quantity;

std::unique_ptr<traverse_results> results_of(const std::vector<Result>& runs) {
  auto all = std::make_unique<traverse_results>();
  std::size_t probes = 0, limits = 0;
  for (const Result& run : runs) {
    probes = std::max(probes, run.probes.size());
    limits = std::max(limits, run.limits.size());
    all->models.push_back(run.model);
    all->unusual.insert(all->unusual.end(), run.unusual.begin(), run.unusual.end());
    for (std::size_t l = all->criteria.size(); l < run.limits.size(); ++l) all->criteria.push_back(run.limits[l].name);
  }
  for (const Row& row : rows) {
    const std::string dimensions = row.dimensions;
    const bool of_probes = dimensions == "run probe", of_limits = dimensions == "run criterion";
    const std::size_t width = of_probes ? probes : of_limits ? limits : 1;
    if (of_limits && limits == 0) continue;
    Quantity quantity{row.name, row.unit, row.dimensions, {runs.size()}, {}};
    if (of_probes || of_limits) quantity.shape.push_back(width);
    for (const Result& run : runs)
      for (std::size_t k = 0; k < width; ++k) {
        const std::size_t own = of_probes ? run.probes.size() : of_limits ? run.limits.size() : 1;
        quantity.values.push_back(k < own ? row.number(run, k) : traverse::unknown);
      }
    const bool known = std::ranges::any_of(quantity.values, [](double value) { return !std::isnan(value); });
    if (known || of_probes) all->quantities.push_back(std::move(quantity));
  }
  return all;
}

const Quantity& quantity_of(const traverse_results* results, const std::string& name) {
  for (const Quantity& quantity : require_not_null(results, "results")->quantities)
    if (quantity.name == name) return quantity;
  throw InputError("there is no result " + name + "; traverse_results_describe lists the available results");
}

}  // namespace

int traverse_problem_new(const char* text, traverse_problem** problem) {
  return call_and_catch([&] {
    *require_not_null(problem, "problem") = nullptr;
    auto made = std::make_unique<traverse_problem>();
    if (text != nullptr) made->problem = traverse::Problem::from_yaml(text);
    *problem = made.release();
  });
}

int traverse_problem_read(const char* file, traverse_problem** problem) {
  return call_and_catch([&] {
    *require_not_null(problem, "problem") = nullptr;
    *problem = new traverse_problem{traverse::Problem::read(require_not_null(file, "file"))};
  });
}

int traverse_problem_set(traverse_problem* problem, const char* name, const char* value) {
  return call_and_catch([&] {
    traverse::Problem& set = require_not_null(problem, "problem")->problem;
    require_not_null(name, "name");
    value == nullptr ? set.remove(name) : set.set(name, value);
  });
}

int traverse_problem_table(traverse_problem* problem, const char* name, size_t rows_of_table, size_t columns,
                           const double* values) {
  return call_and_catch([&] {
    require_not_null(values, "values");
    std::vector<std::vector<double>> table(columns);
    for (std::size_t i = 0; i < rows_of_table * columns; ++i) table[i % columns].push_back(values[i]);
    require_not_null(problem, "problem")->problem.table(require_not_null(name, "name"), table);
  });
}

void traverse_problem_free(traverse_problem* problem) { delete problem; }

int traverse_open_problem(const traverse_problem* problem, traverse_passage** passage) {
  return call_and_catch([&] {
    *require_not_null(passage, "passage") = nullptr;
    traverse::app::start_libraries();
    *passage = traverse::app::open_passage(require_not_null(problem, "problem")->problem);
  });
}

int traverse_simulate(size_t count, const traverse_problem* const* problems, int all_ranks,
                      int (*go_on)(void* context, double done), void* context, traverse_results** results) {
  return call_and_catch([&] {
    *require_not_null(results, "results") = nullptr;
    std::vector<traverse::Problem> all;
    for (const traverse_problem* problem : std::span(require_not_null(problems, "problems"), count))
      all.push_back(require_not_null(problem, "a problem")->problem);
    traverse::app::start_libraries();
    const traverse::Progress progress = [&](double done) { return go_on == nullptr || go_on(context, done) != 0; };
    try {
      *results =
          results_of(traverse::simulate(all, progress, all_ranks != 0 ? MPI_COMM_WORLD : MPI_COMM_SELF)).release();
    } catch (const traverse::RunsFailed& failure) {
      *results = results_of(failure.results).release();
      throw;
    }
  });
}

int traverse_finish(traverse_passage* passage, traverse_results** results) {
  return call_and_catch([&] {
    *require_not_null(results, "results") = nullptr;
    *results = results_of({traverse::app::require_open(passage).result()}).release();
  });
}

size_t traverse_results_count(const traverse_results* results) {
  return results == nullptr ? 0 : results->quantities.size();
}

int traverse_results_describe(const traverse_results* results, size_t i, traverse_quantity* quantity) {
  return call_and_catch([&] {
    const std::vector<Quantity>& all = require_not_null(results, "results")->quantities;
    require_not_null(quantity, "quantity");
    if (i >= all.size()) throw InputError("there is no result number " + std::to_string(i));
    *quantity = {all[i].name, all[i].unit, all[i].shape.size(), {0, 0}, 0, all[i].dimensions};
    std::copy(all[i].shape.begin(), all[i].shape.end(), quantity->shape);
  });
}

int traverse_results_read(const traverse_results* results, const char* name, double* values, size_t count) {
  return call_and_catch([&] {
    const std::vector<double>& found = quantity_of(results, require_not_null(name, "name")).values;
    if (found.size() != count)
      throw InputError(std::string(name) + " has " + std::to_string(found.size()) + " numbers, not " +
                       std::to_string(count));
    if (count > 0) std::copy(found.begin(), found.end(), require_not_null(values, "values"));
  });
}

const char* traverse_results_text(const traverse_results* results, const char* what, size_t i) {
  const char* found = nullptr;
  (void)call_and_catch([&] {
    require_not_null(results, "results");
    const std::string kind = require_not_null(what, "what");
    for (const auto& [name, texts] : {std::pair("model", &results->models), std::pair("criterion", &results->criteria),
                                      std::pair("unusual", &results->unusual)})
      if (kind == name && i < texts->size()) found = (*texts)[i].c_str();
  });
  return found;
}

void traverse_results_free(traverse_results* results) { delete results; }
