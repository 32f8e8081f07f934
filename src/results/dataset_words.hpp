// The dimensions of the datasets of a results file and what each contains, by their paths (doc/results_file.md).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace traverse::results {

struct DatasetWords {
  /// For each dimension the path of the dataset with its coordinates, or a name if there are none. Empty for the
  /// parts of /model and /input, which have no common dimensions.
  std::vector<std::string> dimensions;
  std::string long_name;
};

/// The words of a dataset with this path and number of dimensions.
DatasetWords words_of(std::string_view path, std::size_t rank);

/// The name of the coordinates at this path that no other coordinates of the file have: "x" for those of the probes,
/// "supports_x" for those of the supports.
std::string name_of_dimension(std::string_view path);

/// The words along a dimension such as "/coordinate": x, y, angle; empty for other dimensions.
std::vector<std::string> words_along(std::string_view dimension);

}  // namespace traverse::results
