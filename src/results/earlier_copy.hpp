// Keeps the results of an interrupted study until the file that continues them is written.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "results/place.hpp"
#include "traverse/base/error.hpp"

namespace traverse::results {

/// A copy of the file of an interrupted study or screen. It exists until the new file is complete on the disk.
class EarlierCopy {
 public:
  EarlierCopy(const Place& place, bool wanted) : original_(wanted ? place.path() : "") {
    std::error_code failed;
    if (original_.empty()) return;
    std::filesystem::copy_file(original_, original_ + ".before", std::filesystem::copy_options::overwrite_existing,
                               failed);
    if (failed) throw FileError(fmt::format("cannot copy the results file {}: {}", original_, failed.message()));
  }
  void remove() const {
    std::error_code ignored;
    if (!original_.empty()) std::filesystem::remove(original_ + ".before", ignored);
  }

 private:
  std::string original_;
};

}  // namespace traverse::results
