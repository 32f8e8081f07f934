// The names that options may have: those of the table, those that are declared for parts, and those beside an option
// that names a table.
#include <fmt/format.h>

#include <algorithm>

#include "traverse/base/error.hpp"
#include "traverse/options/options.hpp"

namespace traverse::options {

bool Options::declare(const std::string& name, const Row& row) {
  return !knows(name) && declared_.try_emplace(name, &row).second;
}

const Row* Options::find_known(std::string_view name) const {
  if (const Row* fixed = find_row(fixed_rows(), name)) return fixed;
  if (const auto declared = declared_.find(std::string(name)); declared != declared_.end()) return declared->second;
  const auto beside = beside_table(name);
  const Row* table = beside ? find_known(beside->first) : nullptr;
  return table != nullptr && names_table(*table) ? beside->second : nullptr;
}

std::string Options::nearest_known(const std::string& name) const {
  std::vector<std::string> candidates;
  for (const Row& fixed : fixed_rows()) candidates.emplace_back(fixed.name);
  for (const Entry& entry : entries_)
    if (const Row* known = find_known(entry.name); known != nullptr && names_table(*known))
      for (const Row& beside : table_rows()) candidates.push_back(entry.name + "_" + std::string(beside.name));
  const auto fixed = static_cast<std::ptrdiff_t>(candidates.size());
  for (const auto& declared : declared_) candidates.push_back(declared.first);
  std::sort(candidates.begin() + fixed, candidates.end());
  return nearest(name, candidates);  // the first of the table among equally near ones
}

void Options::check_known(std::string_view name, const std::string& other) const {
  if (knows(other)) return;
  const std::string near = nearest_known(other);
  refuse(name,
         fmt::format("there is no option {}{}", other, near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

void Options::check_names() const {
  for (const Entry& entry : entries_) {
    if (knows(entry.name)) continue;
    const std::string near = nearest_known(entry.name);
    const bool part = entry.name.starts_with("vehicle_");
    throw InputError(fmt::format("unknown option {}{}{}; -help lists all options", entry.given(),
                                 near.empty() ? "" : fmt::format("; did you mean {}?", near),
                                 part ? " (each part must be in a list of its vehicle: bodies, springs, ...)" : ""));
  }
}

}  // namespace traverse::options
