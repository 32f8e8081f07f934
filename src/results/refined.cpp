// Prints the speeds that were added near the peaks.
#include "results/refined.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace traverse::results {
namespace {

long added_speeds(const Refined& refined) { return std::count(refined.added.begin(), refined.added.end(), 1.0); }

}  // namespace

void print(const Refined& refined) {
  const long added = added_speeds(refined), given = static_cast<long>(refined.added.size()) - added;
  std::string remaining = "no peak over the speed is above what was found";
  if (refined.wanted == 0.0)
    remaining = refined.uncertainty > 0.0
                    ? fmt::format("a limit may still be broken between two of them ({}); -sweep_refine 1e-2 goes on",
                                  refined.curve)
                    : "no limit that is kept at them can be broken between two of them";
  else if (refined.uncertainty > 0.0)
    remaining = fmt::format("peaks over the speed are at most {:.1g} above what was found ({}){}", refined.uncertainty,
                            refined.curve, refined.uncertainty > refined.wanted ? ", more than was wanted" : "");
  fmt::print("  {} speeds added to {}; {}\n", added, given, remaining);
}

void add_to(std::vector<Attribute>& summary, const Refined& refined) {
  summary.push_back({"speeds_added", added_speeds(refined)});
  summary.push_back({"peak_uncertainty", refined.uncertainty});
  summary.push_back({"peak_uncertainty_of", refined.curve});
}

}  // namespace traverse::results
