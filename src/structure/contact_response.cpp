// The response to the forces of all contacts, on the nodes near them (equation of a stage: element_structure.hpp).
#include "structure/contact_response.hpp"

#include <algorithm>

namespace traverse::structure {
namespace {

constexpr std::size_t many_elements = 4;  // from this number on one solution costs less than a column for each unknown

}  // namespace

ContactResponse::ContactResponse(const beam::Beam& beam, const BeamOperator& op)
    : beam_(beam), operator_(op), line_(beam.running()) {
  const auto unknowns = static_cast<std::size_t>(2 * line_.per_node);
  for (int e = 0; e < line_.mesh.elements(); ++e) {
    const auto of = line_.unknowns(e);
    for (std::size_t k = 0; k < unknowns; ++k) {
      const int offset = of[k] - of[0];
      if (e == 0) field_.offset[k] = offset;
      uniform_ = uniform_ && offset == field_.offset[k];
    }
  }
}

// If the beam has a track, the responses extend over few columns, so that columns of the compliance are cheap.
bool ContactResponse::worthwhile(std::size_t elements) const {
  return uniform_ && !line_.has_tracks_beside() && !operator_.shared() && beam_.block() == line_.per_node &&
         elements >= many_elements;
}

void ContactResponse::place(const std::vector<int>& elements, const std::vector<Range>& stepped) {
  if (elements == elements_ && stepped == stepped_) return;
  elements_ = elements;
  stepped_ = stepped;
  if (z_.empty()) {
    const auto unknowns = static_cast<std::size_t>(beam_.local_unknowns()),
               extra = static_cast<std::size_t>(2 * line_.per_node);
    for (std::vector<double>* x : {&z_, &v_free_, &w_free_, &v_, &w_}) x->assign(unknowns + extra, 0.0);
    field_.ground = static_cast<int>(unknowns);
    field_.v = v_.data();
    field_.w = w_.data();
    field_.load = z_.data();
  }
  field_.slot.clear();
  held_.clear();
  for (const int element : elements) {
    field_.slot.push_back(beam_.local(line_.unknowns(element)[0]));
    for (int k = 0; k < 2 * line_.per_node; ++k) {
      const auto unknown = static_cast<std::size_t>(field_.slot.back() + field_.offset[static_cast<std::size_t>(k)]);
      if (beam_.fixed()[unknown] != 0) held_.push_back(unknown);
    }
  }
  find_runs();
}

void ContactResponse::find_runs() {
  runs_.clear();
  const solve::Parts* parts = operator_.parts();
  if (parts == nullptr) {
    for (const Range& r : stepped_) runs_.push_back({r.first, r.past, nullptr, 1});
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
                       parts->group_end(last->part, part->past) > part;
    if (joins) {
      ++last->count;
      last->past = part->past;
    } else {
      runs_.push_back({part->first, part->past, part, 1});
    }
  }
}

void ContactResponse::clear() {
  for_runs([&](std::ptrdiff_t from, std::ptrdiff_t size) { std::fill_n(z_.begin() + from, size, 0.0); });
}

void ContactResponse::solve(const BeamFactor& factor) {
  for (const std::size_t unknown : held_) z_[unknown] = 0.0;
  for (const Run& run : runs_) {
    double* const z = z_.data() + run.first * beam_.block();
    if (run.part != nullptr)
      factor.parts().solve_group(*run.part, z, run.count);
    else
      factor.solve_local(z, 1, run.first, run.past);
  }
  operator_.solves += 1;
  for_runs([&](std::ptrdiff_t from, std::ptrdiff_t size) {
    const double *free = v_free_.data() + from, *z = z_.data() + from;
    double* v = v_.data() + from;
    for (std::ptrdiff_t i = 0; i < size; ++i) v[i] = free[i] + z[i];
  });
}

void ContactResponse::find_rates(double shift) {
  for_runs([&](std::ptrdiff_t from, std::ptrdiff_t size) {
    const double *free = w_free_.data() + from, *z = z_.data() + from;
    double* w = w_.data() + from;
    for (std::ptrdiff_t i = 0; i < size; ++i) w[i] = free[i] + shift * z[i];
  });
}

void ContactResponse::add(double factor, double* x) const {
  for_runs([&](std::ptrdiff_t from, std::ptrdiff_t size) {
    for (std::ptrdiff_t i = from; i < from + size; ++i) x[i] += factor * z_[static_cast<std::size_t>(i)];
  });
}

}  // namespace traverse::structure
