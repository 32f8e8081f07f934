// Former names of Traverse's options. An option that gets another name has a row here with its former one, which is
// read as the present name, with a line that says so, until the version of the row. doc/stability.md lists the rows.
#pragma once

#include <array>
#include <string_view>

namespace traverse::options {

struct OldName {
  std::string_view name, present, until;
};

inline constexpr std::array old_names = {
    OldName{"check", "describe", "2.0.0"},  // traverse check is the verdict of EN 1991-2
};

}  // namespace traverse::options
