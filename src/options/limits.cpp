// Greatest lengths of lists: one million entries in general, fewer for probes, vehicles, moving forces and named parts
// of a vehicle.
#include "options/limits.hpp"

#include <array>
#include <utility>

namespace traverse::options {
namespace {

constexpr std::size_t most_in_list = 1'000'000;
constexpr std::size_t most_parts = 1'000;  // limit for a vehicle or a train, because their matrices are dense

constexpr std::array<std::pair<std::string_view, std::size_t>, 7> limits = {{
    {"output_probes", 100'000},
    {"train_vehicles", 2'000},
    {"train_positions", 2'000},
    {"train_spacing", 2'000},
    {"load_forces", 100'000},
    {"load_positions", 100'000},
    {"sweep_hslm_a", 10},
}};

}  // namespace

std::size_t most_entries(std::string_view name, const Row& row) {
  for (const auto& [limited, most] : limits)
    if (limited == name || limited == row.name) return most;  // row.name is for a train or load with its own name
  if (name.starts_with("study_vary_")) return most_in_list;
  return row.kind == Kind::texts ? most_parts : most_in_list;
}

}  // namespace traverse::options
