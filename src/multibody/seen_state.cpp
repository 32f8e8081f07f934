// The numbers of a state that observers use, as one array.
#include <algorithm>

#include "multibody/mechanism.hpp"

namespace traverse::multibody {
namespace {

template <class State, class Visit>
void visit_observed(State& s, Visit visit) {
  visit(&s.time, 1);
  visit(&s.dissipation, 1);
  for (auto* x : {&s.q, &s.qd, &s.qdd, &s.lambda, &s.friction.force, &s.friction.speed})
    visit(x->data(), static_cast<int>(x->size()));
}

}  // namespace

int Mechanism::observed_size() const {
  return 2 + 3 * coordinates() + constraints() + 2 * static_cast<int>(friction_joints_.size());
}

void Mechanism::write_observed(const MechanismState& s, double* to) const {
  visit_observed(s, [&to](const double* x, int size) { to = std::copy_n(x, size, to); });
}

void Mechanism::read_observed(MechanismState& s, const double* from) const {
  visit_observed(s, [&from](double* x, int size) {
    std::copy_n(from, size, x);
    from += size;
  });
  place_frames(s);
  move_frames(s);
}

}  // namespace traverse::multibody
