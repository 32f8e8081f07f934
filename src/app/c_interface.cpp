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

#include "fast_mpi_init.hpp"
#include "results/dataset_words.hpp"
#include "run/process.hpp"
#include "step_by_step.hpp"
#include "traverse/options/input.hpp"
#include "traverse/traverse.h"

// Closing deletes the scene but not the handle, so that calls with a closed handle are detected.
struct traverse_passage {
  std::unique_ptr<traverse::app::StepByStep> steps;
  std::vector<std::string> names;  // of the dimensions of each quantity
};

namespace {

using traverse::InputError;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

std::string last_error;  // message of the last call that failed

/// Runs `body`. If it throws, stores the message in last_error and returns the status of the exception; otherwise 0.
template <class Body>
int call_and_catch(Body&& body) {
  try {
    body();
    return 0;
  } catch (const std::exception& failure) {
    const traverse::Error error = traverse::app::as_error(failure);
    last_error = error.what();
    return error.status();
  }
}

/// Handles are never freed, so a new handle cannot have the address of a closed one.
std::list<traverse_passage>& handles() {
  static std::list<traverse_passage> all;
  return all;
}

traverse::app::StepByStep& require_open(const traverse_passage* passage) {
  if (passage == nullptr) throw InputError("the passage is NULL");
  if (passage->steps == nullptr) throw InputError("the passage is closed");
  return *passage->steps;
}

/// Returns the pointer; throws InputError if it is NULL.
template <class T>
T* require_not_null(T* pointer, const char* what) {
  if (pointer == nullptr) throw InputError(std::string(what) + " is NULL");
  return pointer;
}

/// get(passage) if the passage is open, otherwise `none`; the error is stored.
template <class Value, class Get>
Value value_of(const traverse_passage* passage, Value none, Get&& get) {
  (void)call_and_catch([&] { none = get(require_open(passage)); });
  return none;
}

/// Hides an environment variable from PETSc during this object's lifetime; it may belong to the host program.
class HiddenVariable {
 public:
  explicit HiddenVariable(const char* name) : name_(name) {
    if (const char* value = std::getenv(name)) value_ = value;
    unsetenv(name_);
  }
  ~HiddenVariable() {
    if (value_) setenv(name_, value_->c_str(), 1);
  }
  HiddenVariable(const HiddenVariable&) = delete;
  HiddenVariable& operator=(const HiddenVariable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> value_;
};

/// Starts PETSc, SLEPc and MPI once per process; later calls delete the PETSc options of the previous passage.
void start_libraries(const std::vector<std::string>& petsc_words) {
  PetscBool running = PETSC_FALSE;
  traverse::base::check(SlepcInitialized(&running));
  if (running == PETSC_TRUE) return traverse::base::check(PetscOptionsClear(nullptr));
  traverse::options::Arguments words(petsc_words);
  const HiddenVariable text("PETSC_OPTIONS"), yaml("PETSC_OPTIONS_YAML");
  traverse::app::start_lightly();
  traverse::base::check(SlepcInitialize(words.argc(), words.argv(), nullptr, nullptr));
  traverse::app::started();
  traverse::base::check(PetscPopSignalHandler());  // signals belong to the host program
  traverse::base::check(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr));
  std::atexit([] { SlepcFinalize(); });
}

traverse::app::Scene scene_of(std::span<const char* const> words) {
  std::vector<std::string> all = {"traverse"};
  for (const char* word : words) all.emplace_back(require_not_null(word, "a word"));
  traverse::options::Arguments arguments(all);
  traverse::options::Input input = traverse::options::read_input(
      *arguments.argc(), *arguments.argv(), {{"model_vehicles", "full", "traverse_open", 0}}, false);
  if (input.help || input.version) throw InputError("traverse_open computes one run in time; remove -help or -version");
  start_libraries(input.petsc_words);
  traverse::options::put_into_petsc(input);
  return traverse::app::read_scene();
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

/// The values of a dataset at the last computed sample.
std::span<const double> values_of(const traverse::app::StepByStep& steps, const std::string& name) {
  std::size_t first = 0;
  for (const auto& field : steps.layout().fields) {
    if (field.name == name) return std::span(steps.values()).subspan(first, field.width());
    first += field.width();
  }
  for (const auto& constant : steps.layout().constants)
    if (constant.name == name) return constant.values;
  throw InputError("there is no quantity " + name + "; traverse_describe lists the available quantities");
}

}  // namespace

int traverse_open(int argc, const char* const* argv, traverse_passage** passage) {
  return call_and_catch([&] {
    *require_not_null(passage, "passage") = nullptr;
    if (argc < 0) throw InputError("argc is negative");
    if (argc > 0) require_not_null(argv, "argv");
    auto steps = std::make_unique<traverse::app::StepByStep>(scene_of(std::span(argv, static_cast<std::size_t>(argc))));
    std::vector<std::string> names = names_of_dimensions(steps->layout());
    *passage = &handles().emplace_back(traverse_passage{std::move(steps), std::move(names)});
  });
}

void traverse_close(traverse_passage* passage) {
  if (passage != nullptr) passage->steps.reset();
}

const char* traverse_error(void) { return last_error.c_str(); }

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
    const std::span<const double> found = values_of(require_open(passage), require_not_null(name, "name"));
    if (found.size() != count)
      throw InputError(std::string(name) + " has " + std::to_string(found.size()) + " numbers, not " +
                       std::to_string(count));
    if (count > 0) std::copy(found.begin(), found.end(), require_not_null(values, "values"));
  });
}

int traverse_set_body_force(traverse_passage* passage, int vehicle, const char* body, double fx, double fy,
                            double moment) {
  return call_and_catch([&] {
    require_open(passage).apply_to_body(vehicle, require_not_null(body, "body"), {fx, fy, moment});
  });
}

int traverse_set_beam_force(traverse_passage* passage, double x, double force) {
  return call_and_catch([&] { require_open(passage).apply_to_beam(x, force); });
}
