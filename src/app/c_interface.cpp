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
#include "run/process.hpp"
#include "step_by_step.hpp"
#include "traverse/options/input.hpp"
#include "traverse/traverse.h"

// Closing frees the scene. The handle itself stays, so that one that is used again is known to be closed.
struct traverse_passage {
  std::unique_ptr<traverse::app::StepByStep> steps;
};

namespace {

using traverse::InputError;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

std::string said;  // by the last call that failed

/// Runs `body`; an exception becomes its status, and its message `said`.
template <class Body>
int status_of(Body&& body) {
  try {
    body();
    return 0;
  } catch (const std::exception& failure) {
    const traverse::Error error = traverse::app::as_error(failure);
    said = error.what();
    return error.status();
  }
}

/// A handle that traverse_open made is never a closed one by chance.
std::list<traverse_passage>& handles() {
  static std::list<traverse_passage> all;
  return all;
}

traverse::app::StepByStep& open_one(const traverse_passage* passage) {
  if (passage == nullptr) throw InputError("the passage is NULL");
  if (passage->steps == nullptr) throw InputError("the passage is closed");
  return *passage->steps;
}

/// An argument that must not be NULL.
template <class T>
T* there(T* pointer, const char* what) {
  if (pointer == nullptr) throw InputError(std::string(what) + " is NULL");
  return pointer;
}

/// What `get` has of an open passage, or `none`.
template <class Value, class Get>
Value value_of(const traverse_passage* passage, Value none, Get&& get) {
  (void)status_of([&] { none = get(open_one(passage)); });
  return none;
}

/// While it lives PETSc does not see its variable of the environment, which is for the program that embeds this
/// library.
class WithoutVariable {
 public:
  explicit WithoutVariable(const char* name) : name_(name) {
    if (const char* value = std::getenv(name)) value_ = value;
    unsetenv(name_);
  }
  ~WithoutVariable() {
    if (value_) setenv(name_, value_->c_str(), 1);
  }
  WithoutVariable(const WithoutVariable&) = delete;
  WithoutVariable& operator=(const WithoutVariable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> value_;
};

/// PETSc, SLEPc and MPI, once in a process; none of PETSc's options of a passage before are left.
void start_libraries(const std::vector<std::string>& petsc_words) {
  PetscBool running = PETSC_FALSE;
  traverse::base::check(SlepcInitialized(&running));
  if (running == PETSC_TRUE) return traverse::base::check(PetscOptionsClear(nullptr));
  traverse::options::Arguments words(petsc_words);
  const WithoutVariable text("PETSC_OPTIONS"), yaml("PETSC_OPTIONS_YAML");
  traverse::app::start_lightly();
  traverse::base::check(SlepcInitialize(words.argc(), words.argv(), nullptr, nullptr));
  traverse::app::started();
  traverse::base::check(PetscPopSignalHandler());  // signals belong to the program that embeds this library
  traverse::base::check(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr));
  std::atexit([] { SlepcFinalize(); });
}

traverse::app::Scene scene_of(std::span<const char* const> words) {
  std::vector<std::string> all = {"traverse"};
  for (const char* word : words) all.emplace_back(there(word, "a word"));
  traverse::options::Arguments arguments(all);
  traverse::options::Input input = traverse::options::read_input(
      *arguments.argc(), *arguments.argv(), {{"model_vehicles", "full", "traverse_open", 0}}, false);
  if (input.help || input.version) throw InputError("step by step goes one motion in time: leave out -help, -version");
  start_libraries(input.petsc_words);
  traverse::options::put_into_petsc(input);
  return traverse::app::read_scene();
}

/// The numbers of a dataset at the sample that was reached.
std::span<const double> values_of(const traverse::app::StepByStep& steps, const std::string& name) {
  std::size_t first = 0;
  for (const auto& field : steps.layout().fields) {
    if (field.name == name) return std::span(steps.values()).subspan(first, field.width());
    first += field.width();
  }
  for (const auto& constant : steps.layout().constants)
    if (constant.name == name) return constant.values;
  throw InputError("there is no quantity " + name + "; traverse_describe names those there are");
}

}  // namespace

int traverse_open(int argc, const char* const* argv, traverse_passage** passage) {
  return status_of([&] {
    *there(passage, "passage") = nullptr;
    if (argc < 0) throw InputError("argc is negative");
    if (argc > 0) there(argv, "argv");
    auto steps = std::make_unique<traverse::app::StepByStep>(scene_of(std::span(argv, static_cast<std::size_t>(argc))));
    *passage = &handles().emplace_back(traverse_passage{std::move(steps)});
  });
}

void traverse_close(traverse_passage* passage) {
  if (passage != nullptr) passage->steps.reset();
}

const char* traverse_error(void) { return said.c_str(); }

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
  return status_of([&] { open_one(passage).advance(t); });
}

size_t traverse_quantities(const traverse_passage* passage) {
  return value_of(passage, std::size_t{0},
                  [](const auto& steps) { return steps.layout().fields.size() + steps.layout().constants.size(); });
}

int traverse_describe(const traverse_passage* passage, size_t i, traverse_quantity* quantity) {
  return status_of([&] {
    const auto& layout = open_one(passage).layout();
    there(quantity, "quantity");
    const auto& fields = layout.fields;
    const auto& constants = layout.constants;
    if (i < fields.size()) {
      const auto& field = fields[i];
      *quantity = {field.name.c_str(), field.unit.c_str(), field.row.size(), {0, 0}, 1};
      std::copy(field.row.begin(), field.row.end(), quantity->shape);
      return;
    }
    const std::size_t k = i - fields.size();
    if (k >= constants.size()) throw InputError("there is no quantity number " + std::to_string(i));
    *quantity = {constants[k].name.c_str(), constants[k].unit.c_str(), 1, {constants[k].values.size(), 0}, 0};
  });
}

int traverse_read(const traverse_passage* passage, const char* name, double* values, size_t count) {
  return status_of([&] {
    const std::span<const double> found = values_of(open_one(passage), there(name, "name"));
    if (found.size() != count)
      throw InputError(std::string(name) + " has " + std::to_string(found.size()) + " numbers, not " +
                       std::to_string(count));
    if (count > 0) std::copy(found.begin(), found.end(), there(values, "values"));
  });
}

int traverse_set_body_force(traverse_passage* passage, int vehicle, const char* body, double fx, double fy,
                            double moment) {
  return status_of([&] { open_one(passage).apply_to_body(vehicle, there(body, "body"), {fx, fy, moment}); });
}

int traverse_set_beam_force(traverse_passage* passage, double x, double force) {
  return status_of([&] { open_one(passage).apply_to_beam(x, force); });
}
