// The table of PETSc's integrators that are allowed, each with its order, and the help text on all integrators.
#include "integrate/integrators.hpp"

#include <fmt/format.h>
#include <petscts.h>

#include <algorithm>
#include <iterator>

#include "base/one_step_methods.hpp"

namespace traverse::integrate {
namespace {

constexpr bool implicitly = true, explicitly = false, multistep = true, one_step = false;

constexpr PetscType types[] = {
    {TSARKIMEX, implicitly, one_step, 4, "the numbers of esdirk4 at twice the cost; takes -ts_adapt_type basic"},
    {TSCN, implicitly, one_step, 2, "for comparison"},
    {TSBDF, implicitly, multistep, 2, "for comparison; -ts_bdf_order 1 or 2"},
    {TSTHETA, implicitly, one_step, 2, "for comparison"},
    {TSBEULER, implicitly, one_step, 1, "for comparison"},
    {TSRK, explicitly, one_step, 3, "small scenes, mechanisms without stiff springs and contacts"},
};

std::string line(const char* name, bool implicit, int order, const char* words) {
  return fmt::format("  {:<10}{}, order {}: {}\n", name, implicit ? "implicit" : "explicit", order, words);
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

}  // namespace traverse::integrate
