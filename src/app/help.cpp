// Assembles help texts, the manual page and the shell completion from the tables of options and of integrators.
#include "help.hpp"

#include <vector>

#include "base/one_step_methods.hpp"
#include "integrate/integrators.hpp"
#include "options/help_groups.hpp"
#include "traverse/options/table.hpp"

namespace traverse::app {

std::string help_about(const std::string& what) {
  const std::string integrators = integrate::integrators_help();
  if (what == "integrators" || what == "ts_type") return integrators.substr(1);  // without the leading newline
  if (what == "man") return options::manual_page(integrators);
  if (what == "bash") {
    std::vector<std::string> types;
    for (const base::MethodRow& row : base::methods()) types.emplace_back(row.name);
    for (const integrate::PetscType& type : integrate::petsc_types()) types.emplace_back(type.name);
    return options::bash_completion(types);
  }
  return options::help_text(what) + (what.empty() ? integrators : "");
}

}  // namespace traverse::app
