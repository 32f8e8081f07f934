// What runs side by side have in common, as the kernel reads it.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/batch.hpp"
#include "solve/block_tridiagonal.hpp"

namespace traverse::engine {
namespace {

/// [column][2]: the block on the diagonal, the one above it.
std::vector<double> by_columns(const solve::BlockTridiagonal& A) {
  const auto bb = static_cast<std::size_t>(A.block) * static_cast<std::size_t>(A.block);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < static_cast<std::size_t>(A.nodes); ++i)
    for (const std::vector<double>* of : {&A.diagonal, &A.upper})
      numbers.insert(numbers.end(), of->begin() + static_cast<std::ptrdiff_t>(i * bb),
                     of->begin() + static_cast<std::ptrdiff_t>((i + 1) * bb));
  return numbers;
}

std::vector<double> product(const solve::BlockTridiagonal& A, const std::vector<double>& x) {
  const auto b = static_cast<std::size_t>(A.block), bb = b * b;
  std::vector<double> y(x.size(), 0.0);
  for (std::size_t c = 0; c < static_cast<std::size_t>(A.nodes); ++c)
    for (std::size_t j = 0; j < b; ++j)
      for (std::size_t i = 0; i < b; ++i) {
        y[c * b + i] += A.diagonal[c * bb + i + b * j] * x[c * b + j];
        if (c + 1 == static_cast<std::size_t>(A.nodes)) continue;
        const double coupling = A.upper[c * bb + i + b * j];
        y[c * b + i] += coupling * x[(c + 1) * b + j];
        y[(c + 1) * b + j] += coupling * x[c * b + i];
      }
  return y;
}

/// The unknowns of an element counted from its first column's, or -1 where they are not in two neighbouring ones.
std::array<int, most_nodal> places(const beam::Line& line, int block, int element) {
  std::array<int, most_nodal> place{};
  const auto unknowns = line.unknowns(element);
  const int first = (line.first_column + line.mesh.element(element).left) * block;
  for (int k = 0; k < 2 * line.per_node; ++k) {
    const int at = unknowns[static_cast<std::size_t>(k)] - first;
    place[static_cast<std::size_t>(k)] = at / block == k / line.per_node ? at : -1;
  }
  return place;
}

}  // namespace

std::string BatchStructure::obstacle(const beam::Beam& beam) {
  const beam::Line& line = beam.bridge();
  if (beam.rail() != nullptr) return "a layered track lies on the bridge";
  if (beam.model().nonlinear()) return "foundations that are not linear carry the beam";
  if (beam.block() > most_unknowns_of_a_column) return "too many unknowns meet in a node";
  if (!line.mesh.steps().empty()) return "wheels meet steps of the surface, where the bridge's ends or joints yield";
  const auto first = places(line, beam.block(), 0);
  for (int e = 0; e < line.mesh.elements(); ++e) {
    const auto own = places(line, beam.block(), e);
    if (own != first || std::find(own.begin(), own.end(), -1) != own.end())
      return "joints part the unknowns of its nodes";
  }
  return {};
}

BatchStructure::BatchStructure(const beam::Beam& beam, const train::Fleet& fleet, const std::vector<double>& rest,
                               const std::vector<double>& probes, double gravity)
    : beam_(beam), held_(beam.fixed()), surfaces_(fleet), kinks_(beam.bridge().mesh.kinks()) {
  const int block = beam.block();
  const auto read = [&](Mat matrix) { return solve::BlockTridiagonal::from(matrix, block); };
  const solve::BlockTridiagonal mass = read(beam.mass()), stiffness = read(beam.stiffness());
  solve::BlockTridiagonal damping = mass;
  task_.proportional = beam.springs() == nullptr && beam.dampers() == nullptr;
  task_.by_mass = beam.rayleigh().a;
  task_.by_stiffness = beam.rayleigh().b;
  if (task_.proportional)
    damping.combine(task_.by_mass, mass, 0.0, mass, task_.by_stiffness, stiffness);
  else
    damping = read(beam.damping());
  mass_ = by_columns(mass);
  damping_ = by_columns(damping);
  stiffness_ = by_columns(stiffness);
  task_.block = block;
  task_.columns = beam.columns();
  task_.mass = mass_.data();
  task_.damping = damping_.data();
  task_.stiffness = stiffness_.data();
  task_.held = held_.data();
  dead_ = product(stiffness, rest);  // whatever bends it; settlements are no part of the matrices' columns
  task_.dead = dead_.data();
  find_columns();
  const beam::Recovery recovery(beam, probes, gravity);
  for (std::size_t i = 0; i < probes.size(); ++i) add_probe(recovery, i);
}

void BatchStructure::find_columns() {
  const beam::Line& line = beam_.bridge();
  const auto place = places(line, task_.block, 0);
  std::copy(place.begin(), place.end(), offset_);
  task_.transverse[0] = offset_[line.per_node - 2];
  task_.transverse[1] = offset_[line.per_node - 1];
  for (int e = 0; e < line.mesh.elements(); ++e) {
    first_column_.push_back(line.first_column + line.mesh.element(e).left);
    shears_ = shears_ || line.mesh.element(e).shear != 0.0;
  }
  task_.elements = line.mesh.elements();
  task_.first_column = first_column_.data();
}

void BatchStructure::add_probe(const beam::Recovery& recovery, std::size_t station) {
  const beam::StationForms forms = recovery.forms(station);
  ProbeForms& p = probes_.emplace_back();
  for (std::size_t i = 0; i < 4; ++i) {
    p.unknown[i] = forms.unknown[i];
    p.acceleration[i] = forms.acceleration[i];
    p.nodal_moment[i] = forms.nodal_moment[i];
    for (std::size_t d = 0; d < 3; ++d) {
      p.deflection[d][i] = forms.deflection[d][i];
      p.moment[d][i] = forms.moment[d][i];
    }
  }
  p.constant[0] = forms.constant_deflection;
  p.constant[1] = forms.constant_moment;
  p.x = recovery.stations()[station];
  std::tie(p.from, p.to) = recovery.element_of(station);
  // Each side's polynomials from as many loads as they have powers.
  const double xi = (p.x - p.from) / (p.to - p.from);
  constexpr int n = ProbeForms::powers;
  for (int side = 0; side < 2; ++side) {
    const double from = side == 0 ? 0.0 : xi, to = side == 0 ? xi : 1.0;
    if (to - from < 1e-6) continue;
    Eigen::Matrix<double, n, n> powers;
    Eigen::Matrix<double, n, 4> values;
    for (int i = 0; i < n; ++i) {
      const double at = from + (to - from) * (i + 0.5) / n;
      for (int k = 0; k < n; ++k) powers(i, k) = std::pow(at, k);
      for (int kind = 0; kind < 2; ++kind) {
        beam::ElementLoad load;
        load.element = forms.element;
        load.xi = at;
        (kind == 0 ? load.fy : load.moment) = 1.0;
        const beam::Response r = recovery.inside_response(station, load);
        values(i, 2 * kind) = r.deflection;
        values(i, 2 * kind + 1) = r.moment;
      }
    }
    const Eigen::Matrix<double, n, 4> found = powers.fullPivLu().solve(values);
    for (int kind = 0; kind < 2; ++kind)
      for (int response = 0; response < 2; ++response)
        for (int k = 0; k < n; ++k) p.inside[side][kind][response][k] = found(k, 2 * kind + response);
  }
}

}  // namespace traverse::engine
