// The solve for the forces of all contacts on the nodes near them (eq. of a stage: element_structure.hpp).
#include "structure/contact_response.hpp"

#include <algorithm>

namespace traverse::structure {
namespace {

constexpr std::size_t many_elements = 4;  // from here on a solve costs less than a column for each of their unknowns

}  // namespace

ContactResponse::ContactResponse(const beam::Beam& beam, const BeamOperator& op)
    : beam_(beam), operator_(op), line_(beam.running()) {}

// Under a track a force is felt nearby, and columns are short.
bool ContactResponse::worthwhile(std::size_t elements) const {
  return !operator_.shared() && beam_.block() == line_.per_node && elements >= many_elements;
}

void ContactResponse::place(const std::vector<int>& elements, int first, int past) {
  if (elements == elements_ && range_ == std::pair(first, past)) return;
  elements_ = elements;
  range_ = {first, past};
  solved_ = false;
  places_.clear();
  for (int element : elements) {
    const auto unknowns = line_.unknowns(element);
    for (int i = 0; i < 2 * line_.per_node; ++i) places_.push_back(beam_.local(unknowns[static_cast<std::size_t>(i)]));
  }
  find_runs(first, past);
  z_.resize(static_cast<std::size_t>(beam_.local_unknowns()));
}

void ContactResponse::find_runs(int first, int past) {
  runs_.clear();
  const solve::Parts* parts = operator_.parts();
  if (parts == nullptr) {
    runs_.push_back({first, past, nullptr, 1});
    return;
  }
  const solve::Parts::Part* const end = parts->parts.data() + parts->parts.size();
  const solve::Parts::Part* part = parts->parts.data();
  for (int element : elements_) {
    const int node = node_of(element);
    if (part != end && node >= part->past) part = &parts->at(node);
    if (!runs_.empty() && node < runs_.back().past) continue;
    Run* last = runs_.empty() ? nullptr : &runs_.back();
    const bool joins = last != nullptr && last->past == part->first && part == last->part + last->count &&
                       parts->together(last->part, part->past) > part;
    if (joins) {
      ++last->count;
      last->past = part->past;
    } else {
      runs_.push_back({part->first, part->past, part, 1});
    }
  }
}

void ContactResponse::solve(const BeamFactor& factor, const std::vector<double>& loads) {
  const int block = beam_.block();
  for (const Run& run : runs_) std::fill(z_.begin() + run.first * block, z_.begin() + run.past * block, 0.0);
  for (std::size_t i = 0; i < places_.size(); ++i) z_[static_cast<std::size_t>(places_[i])] += loads[i];
  for (const int place : places_)
    if (beam_.fixed()[static_cast<std::size_t>(place)] != 0) z_[static_cast<std::size_t>(place)] = 0.0;
  for (const Run& run : runs_) {
    double* const z = z_.data() + run.first * block;
    if (run.part != nullptr)
      factor.parts().solve_together(*run.part, z, run.count);
    else
      factor.solve_local(z, 1, run.first, run.past);
  }
  operator_.solves += 1;
  loads_ = loads;
  solved_ = true;
}

void ContactResponse::add_to_elements(std::vector<double>& values) const {
  for (std::size_t i = 0; i < places_.size(); ++i) values[i] += z_[static_cast<std::size_t>(places_[i])];
}

void ContactResponse::add(double factor, double* x) const {
  const int block = beam_.block();
  for (const Run& run : runs_)
    for (std::ptrdiff_t i = run.first * block; i < run.past * block; ++i)
      x[i] += factor * z_[static_cast<std::size_t>(i)];
}

}  // namespace traverse::structure
