#include "options/other_names.hpp"

#include <fmt/format.h>

#include <array>

#include "base/petsc.hpp"

namespace traverse::options {

void take_other_names(Entries& entries) {
  for (const base::RenamedOption& option : base::renamed_options) {
    const Entry *one = entries.find(option.name), *other = entries.find(option.newer);
    if (other == nullptr) continue;
    if (one != nullptr)
      throw InputError(fmt::format("{}: another name of {}; allowed: one of the two", other->given(), one->given()));
    entries.rename(option.newer, option.name);
  }
}

std::string name_in_petsc(const std::string& name) {
  for (const base::RenamedOption& option : base::renamed_options)
    if (name == option.name) return option.known();
  return name;
}

std::string own_name(const std::string& name) {
  for (const base::RenamedOption& option : base::renamed_options)
    if (name == option.newer) return option.name;
  return name;
}

void rename_in_petsc() {
  for (const base::RenamedOption& option : base::renamed_options) {
    const std::string unknown = std::string("-") + option.unknown(), known = std::string("-") + option.known();
    std::array<char, 64> value{};
    PetscBool given = PETSC_FALSE, twice = PETSC_FALSE;
    base::check(PetscOptionsGetString(nullptr, nullptr, unknown.c_str(), value.data(), value.size(), &given));
    if (given == PETSC_FALSE) continue;
    base::check(PetscOptionsHasName(nullptr, nullptr, known.c_str(), &twice));
    base::check(PetscOptionsClearValue(nullptr, unknown.c_str()));
    if (twice == PETSC_FALSE) base::check(PetscOptionsSetValue(nullptr, known.c_str(), value.data()));
  }
}

}  // namespace traverse::options
