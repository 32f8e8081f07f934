// The option table by groups, as -help, the manual page and the shell's completion show it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "traverse/options/table.hpp"

namespace traverse::options {

/// Options under one heading.
struct HelpGroup {
  struct Option {
    std::string name;  // whole, with NAME and PART for what users name themselves
    const Row* row;
  };
  std::string name;     // as -help takes it
  std::string heading;  // in words
  std::vector<Option> options;
};

/// Every row of the table once. Options with a fixed name are grouped by their first word.
std::vector<HelpGroup> help_groups();

/// The manual page as troff source; integrators: the list of them.
std::string manual_page(const std::string& integrators);

/// A script that completes names and values of options in bash; ts_types: those of -ts_type.
std::string bash_completion(const std::vector<std::string>& ts_types);

}  // namespace traverse::options
