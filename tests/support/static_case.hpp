// A beam under static loads, for tests: displacements, section forces and reactions.
#pragma once

#include <array>
#include <vector>

#include "support/statics.hpp"

namespace traverse::test {

/// A beam under static loads.
struct Case {
  explicit Case(const beam::BeamModel& model) : beam(PETSC_COMM_WORLD, model), P(beam.local_unknowns(), 0.0) {
    beam.set_rayleigh({0.3, 0.01});  // without effect in statics
  }
  Case& load(double x, double fy, double moment = 0.0, double fx = 0.0) {
    loads.push_back(add_load(beam, x, fy, moment, fx, P.data()));
    return *this;
  }
  Case& weight(double g) {
    gravity = g;
    beam.add_self_weight(g, P.data());
    return *this;
  }
  Case& solve() {
    v = static_solution(beam, P);
    return *this;
  }
  recovery::Response at(double x) {
    const std::vector<double> zero(v.size(), 0.0);
    std::vector<recovery::Response> out;
    recovery::Recovery(beam, {x}, gravity).evaluate(v.data(), zero.data(), zero.data(), loads, out);
    return out[0];
  }
  std::vector<beam::Reaction> reactions() {
    const std::vector<double> zero(v.size(), 0.0);
    std::vector<beam::Reaction> out;
    beam.reactions(v.data(), zero.data(), zero.data(), P.data(), out);
    return out;
  }

  beam::Beam beam;
  std::vector<double> P, v;
  std::vector<recovery::ElementLoad> loads;
  double gravity = 0.0;
};

}  // namespace traverse::test
