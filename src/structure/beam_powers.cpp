// Powers and energies of the moving beam, tile by tile.
#include <algorithm>

#include "beam_motion_tile.hpp"

namespace traverse::structure {

/// The scalar product of `nodes` columns of x and of forces.
double BeamMotion::product_of(int block, int nodes, const Tile& x, const Tile& forces) {
  double sum = 0.0;
  for (int c = 0; c < block; ++c) {
    constexpr int lanes = 8;
    std::array<double, lanes> sums{};
    const double *const a = x.plane[c].data() + 1, *const b = forces.plane[c].data();
    int i = 0;
    for (; i + lanes <= nodes; i += lanes)
      for (int lane = 0; lane < lanes; ++lane) sums[lane] += a[i + lane] * b[i + lane];
    for (; i < nodes; ++i) sums[0] += a[i] * b[i];
    for (double part : sums) sum += part;
  }
  return sum;
}

// w^T C w and, with Rayleigh damping only, 2 A_0^T C w. ghosts: w in the columns next to this rank's.
void BeamMotion::measure_dissipation(int first, int past, const Ghosts& ghosts, Tile& rate, Tile& force) {
  Tile none;
  none.clear(block_, past - first + 2);
  force.clear(block_, past - first);
  const Sum of_w{0.0, 1.0, {}};
  combine(std::array{Summand{of_w, ghosts, rate}}, first, past);
  add_forces(first, past, none, &rate, force);
  if (!proportional_) {
    dissipation_.power += product_of(block_, past - first, rate, force);
    return;
  }
  const std::ptrdiff_t offset = block_ * static_cast<std::ptrdiff_t>(first - view_.first);
  const double* const a0 = view_.stored[0] + offset;
  constexpr int lanes = 8;
  std::array<double, lanes> by_w{}, by_a{};
  with_block(block_, [&](auto B) {
    const int b = B > 0 ? B : block_;
    for (int c = 0; c < b; ++c) {
      const auto add = [&](int lane, int i) {
        by_w[lane] += rate.plane[c][i + 1] * force.plane[c][i];
        by_a[lane] += a0[b * i + c] * force.plane[c][i];
      };
      int i = 0;
      for (; i + lanes <= past - first; i += lanes)
        for (int lane = 0; lane < lanes; ++lane) add(lane, i + lane);
      for (; i < past - first; ++i) add(0, i);
    }
  });
  for (int lane = 0; lane < lanes; ++lane) {
    dissipation_.power += by_w[lane];
    dissipation_.rate += 2.0 * by_a[lane];
  }
}

double BeamMotion::power(std::size_t stage, const double* v, const double* w) {
  const Sum& rate = stages_[stage].w;
  view_ = view_of(v, w);
  exchange_borders({&rate});
  double power = 0.0;
  Tile rates, none, force;
  for (const Range& r : ranges_)
    for (int first = r.first; first < r.past; first += tile) {
      const int past = std::min(r.past, first + tile);
      combine(std::array{Summand{rate, ghosts_[0], rates}}, first, past);
      none.clear(block_, past - first + 2);
      force.clear(block_, past - first);
      add_forces(first, past, none, &rates, force);
      power += product_of(block_, past - first, rates, force);
    }
  return power;
}

BeamMotion::Dissipation BeamMotion::dissipation(const std::vector<Range>& nodes, const double* v, const double* w) {
  const Sum rate{0.0, 1.0, {}};
  view_ = view_of(v, w);
  exchange_borders({&rate});
  dissipation_ = {};
  Tile rates, force;
  for (const Range& r : nodes)
    for (int from = r.first; from < r.past; from += tile)
      measure_dissipation(from, std::min(r.past, from + tile), ghosts_[0], rates, force);
  return dissipation_;
}

// Energy of displacements and rates on a tile, from the forces K* v and M w.
BeamMotion::Energy BeamMotion::energy_of(int first, int past, Tile& v, Tile& w) const {
  Energy energy;
  Tile force;
  force.clear(block_, past - first);
  add_forces(first, past, v, nullptr, force);
  energy.strain = 0.5 * product_of(block_, past - first, v, force);
  force.clear(block_, past - first);
  operator_.mass().products.add(first, past, w.planes(), force.planes());
  energy.kinetic = 0.5 * product_of(block_, past - first, w, force);
  return energy;
}

BeamMotion::Energy BeamMotion::energy_of(const Sum& displacement, const Sum& rate, const std::vector<Range>& nodes) {
  exchange_borders({&displacement, &rate});
  Tile v, w;
  Energy energy;
  for (const Range& r : nodes)
    for (int from = r.first; from < r.past; from += tile) {
      const int to = std::min(r.past, from + tile);
      combine(std::array{Summand{displacement, ghosts_[0], v}, Summand{rate, ghosts_[1], w}}, from, to);
      const Energy more = energy_of(from, to, v, w);
      energy.strain += more.strain;
      energy.kinetic += more.kinetic;
    }
  return energy;
}

BeamMotion::Energy BeamMotion::energy(const std::vector<Range>& nodes, const double* v, const double* w) {
  view_ = view_of(v, w);
  return energy_of({1.0, 0.0, {}}, {0.0, 1.0, {}}, nodes);
}

double BeamMotion::error_energy() {
  const Energy energy = energy_of(v_error_, w_error_, ranges_);
  return energy.strain + energy.kinetic;
}

double BeamMotion::set_to_rest(int first, int past, const double* rest, double* v, double* w) {
  double energy = 0.0;
  for (int from = first; from < past; from += tile) {
    const int to = std::min(past, from + tile), begin = std::max(from - 1, 0), end = std::min(to + 1, nodes_);
    Tile displacement, rate;
    displacement.clear(block_, to - from + 2);
    rate.clear(block_, to - from + 2);
    for (int node = begin; node < end; ++node) {
      for (int c = 0; c < block_; ++c) {
        const int i = node - (from - 1), k = block_ * node + c;
        displacement.plane[c][i] = v[k] - (rest != nullptr ? rest[k] : 0.0);
        rate.plane[c][i] = w[k];
      }
    }
    const Energy more = energy_of(from, to, displacement, rate);
    energy += more.strain + more.kinetic;
  }
  for (int k = block_ * first; k < block_ * past; ++k) {
    v[k] = rest != nullptr ? rest[k] : 0.0;
    w[k] = 0.0;
    for (std::vector<double>& a : stored_)
      if (!a.empty()) a[k] = 0.0;
  }
  return energy;
}

}  // namespace traverse::structure
