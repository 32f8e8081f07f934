// Reads files of limits: a YAML list of {clause, quantity, value, text}.
#pragma once

#include <string>
#include <vector>

#include "traverse/options/verdict_limit.hpp"

namespace traverse::options {

/// The limits of a file. Throws InputError with file and line if it is not such a list.
std::vector<VerdictLimit> read_verdict_limits(const std::string& path);

/// The limits of a text in memory; `name` is the name of the file in messages.
std::vector<VerdictLimit> parse_verdict_limits(const std::string& text, const std::string& name);

}  // namespace traverse::options
