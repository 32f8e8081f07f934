// Files of limits: a YAML list of {clause, quantity, value, text}.
#pragma once

#include <string>
#include <vector>

#include "traverse/options/verdict_limit.hpp"

namespace traverse::options {

/// Throws InputError naming file and line for what is no such list.
std::vector<VerdictLimit> read_verdict_limits(const std::string& path);

/// The same from text in memory; `name` stands for the file in messages.
std::vector<VerdictLimit> parse_verdict_limits(const std::string& text, const std::string& name);

}  // namespace traverse::options
