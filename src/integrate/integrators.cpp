// The table of PETSc's integrators that are allowed, each with its order, and the help text on all integrators. Reads
// -ts_type and related PETSc options, and rejects combinations of integrator, order and step control that would be
// wrong or unstable for these equations.
#include "integrate/integrators.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petscts.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "base/petsc.hpp"
#include "integrate/second_order.hpp"
#include "traverse/base/error.hpp"

namespace traverse::integrate {
namespace {

constexpr bool implicitly = true, explicitly = false, multistep = true, one_step = false;

constexpr PetscType types[] = {
    {TSARKIMEX, implicitly, one_step, 4, "the numbers of esdirk4 at twice the cost; takes -ts_adapt_type basic"},
    {TSBDF, implicitly, multistep, 2, "for comparison; -ts_bdf_order 1 or 2"},
    {TSRK, explicitly, one_step, 3, "small scenes, mechanisms without stiff springs and contacts"},
};

std::string line(const char* name, bool implicit, int order, const char* words) {
  return fmt::format("  {:<10}{}, order {}: {}\n", name, implicit ? "implicit" : "explicit", order, words);
}

using base::check;

std::string option(const char* name, const char* otherwise) {
  std::array<char, 128> text{};
  PetscBool given = PETSC_FALSE;
  check(PetscOptionsGetString(nullptr, nullptr, name, text.data(), text.size(), &given));
  return given == PETSC_TRUE ? text.data() : otherwise;
}

bool is_given(const char* name) {
  PetscBool given = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, nullptr, name, &given));
  return given == PETSC_TRUE;
}

/// "esdirk4, genalpha, ... (implicit), rk (explicit, small scenes)".
std::string allowed_types() {
  std::vector<std::string> implicit, others;
  for (const base::MethodRow& row : base::methods()) implicit.emplace_back(row.name);
  for (const PetscType& type : petsc_types()) (type.implicit ? implicit : others).emplace_back(type.name);
  return fmt::format("{} (implicit), {} (explicit, small scenes)", fmt::join(implicit, ", "), fmt::join(others, ", "));
}

std::string types_that_estimate_errors() {
  std::vector<std::string> names;
  for (const base::MethodRow& row : base::methods())
    if (row.estimates_errors()) names.emplace_back(row.name);
  return fmt::format("{}", fmt::join(names, " and "));
}

void check_adapt(const std::string& adapt, const std::string& type) {
  const base::MethodRow* own = base::find_method(type);
  if (adapt == step_level_adapt && (own == nullptr || !own->estimates_errors()))
    throw InputError(fmt::format("ts_adapt_type = ladder: estimates the errors of {} alone; ts_type is {}",
                                 types_that_estimate_errors(), type));
  if (adapt != TSADAPTNONE && adapt != step_level_adapt && own != nullptr)
    throw InputError(
        fmt::format("ts_adapt_type = {}: does not fit {}; allowed: none, ladder (with {}), or a ts_type of "
                    "PETSc's own such as arkimex",
                    adapt, type, types_that_estimate_errors()));
  PetscReal tolerance = 1.0;
  check(PetscOptionsGetReal(nullptr, nullptr, "-ts_rtol", &tolerance, nullptr));
  if (adapt == step_level_adapt && !(tolerance > 0.0))
    throw InputError("ts_rtol = " + std::to_string(tolerance) + ": allowed: above 0");
}

void check_parameter(const base::MethodParameter& parameter) {
  if (parameter.option == nullptr) return;
  PetscReal value = parameter.value;
  check(PetscOptionsGetReal(nullptr, nullptr, parameter.option, &value, nullptr));
  if (!(value >= parameter.least && value <= parameter.most))
    throw InputError(
        fmt::format("{} = {:f}: allowed: {:g} to {:g}", parameter.option + 1, value, parameter.least, parameter.most));
}

}  // namespace

std::span<const PetscType> petsc_types() { return types; }

const PetscType* find_petsc_type(std::string_view name) {
  const auto* type =
      std::find_if(std::begin(types), std::end(types), [&](const PetscType& t) { return name == t.name; });
  return type == std::end(types) ? nullptr : type;
}

std::string integrators_help() {
  std::string text = fmt::format("\nTime integrators, -ts_type NAME (default: {}); those after {} are PETSc's\n",
                                 base::methods().front().name, base::methods().back().name);
  for (const base::MethodRow& row : base::methods()) {
    text += line(row.name, true, row.order, row.words);
    const base::MethodParameter& p = row.parameter;
    if (p.option != nullptr) text += fmt::format("{:12}{} ({}): {}\n", "", p.option, p.value, p.words);
  }
  for (const PetscType& type : types) text += line(type.name, type.implicit, type.order, type.words);
  return text;
}

std::string chosen_type(const std::string& by_accuracy) {
  const std::string adapt = option("-ts_adapt_type", TSADAPTNONE);
  const bool for_arkimex = (adapt != TSADAPTNONE && adapt != step_level_adapt) || is_given("-ts_arkimex_type");
  const std::string otherwise = by_accuracy.empty() ? base::methods().front().name : by_accuracy;
  std::string type = option("-ts_type", for_arkimex ? TSARKIMEX : otherwise.c_str());
  if (base::find_method(type) == nullptr && find_petsc_type(type) == nullptr)
    throw InputError("ts_type = " + type + ": not among the integrators of this program; allowed: " + allowed_types());
  check_adapt(adapt, type);
  PetscInt order = 2;
  check(PetscOptionsGetInt(nullptr, nullptr, "-ts_bdf_order", &order, nullptr));
  if (order < 1 || order > 2)
    throw InputError("ts_bdf_order = " + std::to_string(order) +
                     ": orders above 2 are unstable for lightly damped bridges; allowed: 1, 2");
  for (const base::MethodRow& row : base::methods()) check_parameter(row.parameter);
  return type;
}

bool type_is_given() {
  return is_given("-ts_type") || is_given("-ts_arkimex_type") || option("-ts_adapt_type", TSADAPTNONE) != TSADAPTNONE;
}

std::optional<base::Method> own_method(const std::string& by_accuracy) {
  const base::MethodRow* row = base::find_method(chosen_type(by_accuracy));
  if (row == nullptr) return std::nullopt;
  PetscReal value = row->parameter.value;
  if (row->parameter.option != nullptr)
    check(PetscOptionsGetReal(nullptr, nullptr, row->parameter.option, &value, nullptr));
  return row->make(value);
}

}  // namespace traverse::integrate
