// Speeds that were added to those that a sweep or a study was asked for.
#pragma once

#include <string>
#include <vector>

#include "results/recorder.hpp"

namespace traverse::results {

struct Refined {
  std::vector<double> added;  // of every speed: 1 where it was not asked for, else 0
  double wanted = 0.0;        // relative, of every peak over the speed; 0: only limits asked
  double uncertainty = 0.0;   // the same, what is left
  std::string curve{};        // whose it is
};
void print(const Refined& refined);
/// speeds_added, peak_uncertainty, peak_uncertainty_of.
void add_to(std::vector<Attribute>& summary, const Refined& refined);

}  // namespace traverse::results
