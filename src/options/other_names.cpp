// Converts option names between the older and the newer ones of PETSc by the table of renamed options.
#include "options/other_names.hpp"

#include <fmt/format.h>

#include "base/petsc_versions.hpp"
#include "traverse/base/error.hpp"

namespace traverse::options {

void use_own_names(Entries& entries) {
  const auto rename = [&](const char* from, const char* to) {
    const Entry *one = entries.find(to), *other = entries.find(from);
    if (other == nullptr) return;
    if (one != nullptr)
      throw InputError(
          fmt::format("{}: this is another name of {}; give only one of the two", other->given(), one->given()));
    entries.rename(from, to);
  };
  for (const base::RenamedOption& option : base::renamed_options) rename(option.newer, option.name);
  rename("check", "describe");  // its name before `traverse check`, the verdict of EN 1991-2
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

}  // namespace traverse::options
