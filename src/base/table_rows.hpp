// The check of a table of arguments and values.
#pragma once

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "traverse/base/error.hpp"

namespace traverse::base {

/// Throws InputError unless there are at least two rows of finite numbers whose arguments increase strictly. table: the
/// first words of the message, such as "a table over time".
inline void check_rows(const std::vector<double>& x, const std::vector<double>& values, const std::string& table) {
  std::ostringstream why;
  if (x.size() != values.size())
    why << "needs as many values as arguments, it has " << values.size() << " and " << x.size();
  else if (x.size() < 2)
    why << "needs at least two rows";
  for (std::size_t i = 0; i < x.size() && why.str().empty(); ++i)
    if (!std::isfinite(x[i]) || !std::isfinite(values[i]))
      why << "has a number in row " << i + 1 << " that is not finite";
    else if (i > 0 && !(x[i] > x[i - 1]))
      why << "must increase strictly in its first column: row " << i + 1 << " has " << x[i] << " after " << x[i - 1];
  if (!why.str().empty()) throw InputError(table + " " + why.str());
}

}  // namespace traverse::base
