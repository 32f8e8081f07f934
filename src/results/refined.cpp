// Prints how many speeds were added and the remaining uncertainty of the peaks.
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
  std::string remaining = "no speed between the computed ones can have a higher peak";
  if (refined.wanted == 0.0)
    remaining =
        refined.uncertainty > 0.0
            ? fmt::format(
                  "between two computed speeds a limit may still be exceeded ({}); -sweep_refine 1e-2 adds more speeds",
                  refined.curve)
            : "every limit that is satisfied at the computed speeds is also satisfied between them";
  else if (refined.uncertainty > 0.0)
    remaining = fmt::format("between the computed speeds, peaks can be at most {:.1g} higher than found ({}){}",
                            refined.uncertainty, refined.curve,
                            refined.uncertainty > refined.wanted ? ", more than the requested accuracy" : "");
  fmt::print("  {} speeds added to {}; {}\n", added, given, remaining);
}

void add_to(std::vector<Attribute>& summary, const Refined& refined) {
  summary.push_back({"speeds_added", added_speeds(refined)});
  summary.push_back({"peak_uncertainty", refined.uncertainty});
  summary.push_back({"peak_uncertainty_of", refined.curve});
}

}  // namespace traverse::results
