// The plain C interface of traverse.h, which the shared library exports: errors become a status and one line.
#include <slepceps.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <limits>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "c_call.hpp"
#include "results/dataset_words.hpp"
#include "traverse/base/version.hpp"
#include "traverse/options/input.hpp"
#include "traverse/traverse.h"

// Closing deletes the scene but not the handle, so that calls with a closed handle are detected.
struct traverse_passage {
  std::unique_ptr<traverse::app::StepByStep> steps;
  std::vector<std::string> names;  // of the dimensions of each quantity
};

namespace {

using traverse::InputError;
using traverse::app::call_and_catch;
using traverse::app::require_not_null;
using traverse::app::require_open;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// Handles are never freed, so a new handle cannot have the address of a closed one.
std::list<traverse_passage>& handles() {
  static std::list<traverse_passage> all;
  return all;
}

/// get(passage) if the passage is open, otherwise `none`; the error is stored.
template <class Value, class Get>
Value value_of(const traverse_passage* passage, Value none, Get&& get) {
  (void)call_and_catch([&] { none = get(require_open(passage)); });
  return none;
}

traverse::Problem problem_of(std::span<const char* const> words) {
  std::vector<std::string> all = {"traverse"};
  for (const char* word : words) all.emplace_back(require_not_null(word, "a word"));
  traverse::options::Arguments arguments(all);
  traverse::options::Input input = traverse::options::read_input(*arguments.argc(), *arguments.argv(), {}, false);
  if (input.help || input.version) throw InputError("traverse_open computes one run in time; remove -help or -version");
  traverse::app::start_libraries({input.petsc_words.begin() + 1, input.petsc_words.end()});
  return traverse::Problem::of(std::move(input.entries));
}

/// The names of the dimensions of all fields, without the time, and of all constants, separated by blanks.
std::vector<std::string> names_of_dimensions(const traverse::results::Layout& layout) {
  std::vector<std::string> all;
  const auto add = [&](const std::string& path, std::size_t rank, std::size_t without) {
    std::string names;
    const std::vector<std::string> dimensions = traverse::results::words_of(path, rank).dimensions;
    for (std::size_t i = without; i < dimensions.size(); ++i)
      names += (names.empty() ? "" : " ") + traverse::results::name_of_dimension(dimensions[i]);
    all.push_back(std::move(names));
  };
  for (const auto& field : layout.fields) add(field.name, field.row.size() + 1, 1);
  for (const auto& constant : layout.constants) add(constant.name, 1, 0);
  return all;
}

}  // namespace

namespace traverse::app {

std::string& last_error() {
  static std::string message;
  return message;
}

void start_libraries(const std::vector<std::string>& petsc_words) {
  static std::optional<Session> session;
  if (session) return;
  session.emplace(petsc_words);
  std::atexit([] { session.reset(); });
}

StepByStep& require_open(const traverse_passage* passage) {
  if (passage == nullptr) throw InputError("the passage is NULL");
  if (passage->steps == nullptr) throw InputError("the passage is closed");
  return *passage->steps;
}

traverse_passage* open_passage(Problem problem) {
  if (!problem.entries().has("model_vehicles")) problem.set("model_vehicles", "full");
  const scene::Scene scene = problem.scene();
  const options::InPetsc petsc(problem.entries());
  auto steps = std::make_unique<StepByStep>(choose_for_one_run(scene));
  std::vector<std::string> names = names_of_dimensions(steps->layout());
  return &handles().emplace_back(traverse_passage{std::move(steps), std::move(names)});
}

}  // namespace traverse::app

int traverse_open(int argc, const char* const* argv, traverse_passage** passage) {
  return call_and_catch([&] {
    *require_not_null(passage, "passage") = nullptr;
    if (argc < 0) throw InputError("argc is negative");
    if (argc > 0) require_not_null(argv, "argv");
    *passage = traverse::app::open_passage(problem_of(std::span(argv, static_cast<std::size_t>(argc))));
  });
}

void traverse_close(traverse_passage* passage) {
  if (passage != nullptr) passage->steps.reset();
}

const char* traverse_version(void) { return traverse::version(); }
const char* traverse_error(void) { return traverse::app::last_error().c_str(); }

double traverse_time(const traverse_passage* passage) {
  return value_of(passage, no_number, [](const auto& steps) { return steps.time(); });
}
double traverse_end(const traverse_passage* passage) {
  return value_of(passage, no_number, [](const auto& steps) { return steps.end(); });
}
double traverse_interval(const traverse_passage* passage) {
  return value_of(passage, no_number, [](const auto& steps) { return steps.interval(); });
}

int traverse_advance(traverse_passage* passage, double t) {
  return call_and_catch([&] { require_open(passage).advance(t); });
}

size_t traverse_quantities(const traverse_passage* passage) {
  return value_of(passage, std::size_t{0},
                  [](const auto& steps) { return steps.layout().fields.size() + steps.layout().constants.size(); });
}

int traverse_describe(const traverse_passage* passage, size_t i, traverse_quantity* quantity) {
  return call_and_catch([&] {
    const auto& layout = require_open(passage).layout();
    require_not_null(quantity, "quantity");
    const auto& fields = layout.fields;
    const auto& constants = layout.constants;
    if (i < fields.size()) {
      const auto& field = fields[i];
      *quantity = {field.name.c_str(), field.unit.c_str(), field.row.size(), {0, 0}, 1, passage->names[i].c_str()};
      std::copy(field.row.begin(), field.row.end(), quantity->shape);
      return;
    }
    const std::size_t k = i - fields.size();
    if (k >= constants.size()) throw InputError("there is no quantity number " + std::to_string(i));
    const auto& [name, values, unit] = constants[k];
    *quantity = {name.c_str(), unit.c_str(), 1, {values.size(), 0}, 0, passage->names[i].c_str()};
  });
}

int traverse_read(const traverse_passage* passage, const char* name, double* values, size_t count) {
  return call_and_catch([&] {
    const std::span<const double> found = require_open(passage).read(require_not_null(name, "name"));
    if (found.size() != count)
      throw InputError(std::string(name) + " has " + std::to_string(found.size()) + " numbers, not " +
                       std::to_string(count));
    if (count > 0) std::copy(found.begin(), found.end(), require_not_null(values, "values"));
  });
}

int traverse_set_body_force(traverse_passage* passage, int vehicle, const char* body, double fx, double fy,
                            double moment) {
  return call_and_catch([&] {
    require_open(passage).set_body_force(vehicle, require_not_null(body, "body"), {fx, fy, moment});
  });
}

int traverse_set_beam_force(traverse_passage* passage, double x, double force) {
  return call_and_catch([&] { require_open(passage).set_beam_force(x, force); });
}
