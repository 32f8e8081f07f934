// The groups of the option table for -help, the manual page and the completion of the shell.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "traverse/options/table.hpp"

namespace traverse::options {

/// Options under one heading.
struct HelpGroup {
  struct Option {
    std::string name;  // complete, with NAME and PART for the names that users choose
    const Row* row;
  };
  std::string name;     // the word after -help
  std::string heading;  // the text of the heading
  std::vector<Option> options;
};

/// All groups. Each row of the table is in one of them, options with a fixed name by their first word.
std::vector<HelpGroup> help_groups();

/// The manual page as troff source. integrators: the text about the time integrators.
std::string manual_page(const std::string& integrators);

/// The bash script that completes names and values of options. ts_types: the values of -ts_type.
std::string bash_completion(const std::vector<std::string>& ts_types);

}  // namespace traverse::options
