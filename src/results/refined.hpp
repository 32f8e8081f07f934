// The speeds that were added to those of a sweep or a study.
#pragma once

#include <string>
#include <vector>

#include "results/recorder.hpp"

namespace traverse::results {

struct Refined {
  std::vector<double> added;  // for each speed: 1 if it was added, else 0
  double wanted = 0.0;        // relative, of every peak over the speed; 0: refined near limits only
  double uncertainty = 0.0;   // relative, remaining
  std::string curve{};        // the curve with this uncertainty
};
void print(const Refined& refined);
/// Adds speeds_added, peak_uncertainty, peak_uncertainty_of.
void add_to(std::vector<Attribute>& summary, const Refined& refined);

}  // namespace traverse::results
