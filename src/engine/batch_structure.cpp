// The shared data of a batch in the form that the kernel reads.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/batch.hpp"
#include "solve/block_tridiagonal.hpp"

namespace traverse::engine {
namespace {

/// [column][2]: the diagonal block, the block above it.
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

/// The unknowns of an element and its twists counted from its first column; -1 unless they are in two neighbouring
/// columns.
std::array<int, most_nodal + 4> places(const beam::Line& line, int block, int element) {
  std::array<int, most_nodal + 4> place{};
  const int first = (line.first_column + line.mesh.element(element).left) * block;
  const auto set = [&](std::size_t k, int unknown, int node) {
    const int at = unknown - first;
    place[k] = at / block == node ? at : -1;
  };
  const auto unknowns = line.unknowns(element);
  for (int k = 0; k < 2 * line.per_node; ++k)
    set(static_cast<std::size_t>(k), unknowns[static_cast<std::size_t>(k)], k / line.per_node);
  if (!line.model.torsion) return place;
  const auto twists = line.twists(element);
  for (int k = 0; k < 4; ++k) set(static_cast<std::size_t>(most_nodal + k), twists[static_cast<std::size_t>(k)], k / 2);
  return place;
}

}  // namespace

std::string BatchStructure::obstacle(const beam::Beam& beam, const structure::ModalBridge* modal) {
  const beam::Line& line = beam.running();
  if (modal != nullptr && !modal->given()) return "the bridge is taken by modes, with what others deflect by at rest";
  if (beam.model().nonlinear()) return "foundations that are not linear carry the beam";
  if (line.tracks() > 1) return "cant or curves turn the beam";
  if (beam.block() > most_unknowns_of_a_column) return "too many unknowns meet in a node";
  const auto first = places(line, beam.block(), 0);
  for (int e = 0; e < line.mesh.elements(); ++e) {
    const auto own = places(line, beam.block(), e);
    if (own != first || std::find(own.begin(), own.end(), -1) != own.end())
      return "joints part the unknowns of its nodes";
  }
  return {};
}

BatchStructure::BatchStructure(const beam::Beam& beam, const structure::ModalBridge* modal, const train::Fleet& fleet,
                               const std::vector<double>& rest, const recovery::Recovery& probes,
                               const std::vector<NodalRotation>& rotations)
    : beam_(beam),
      modal_(modal),
      line_(beam.running()),
      held_(beam.fixed()),
      surfaces_(fleet),
      kinks_(line_.mesh.kinks()) {
  task_.block = beam.block();
  task_.columns = beam.columns();
  by_mass_ = beam.rayleigh().a;
  by_stiffness_ = beam.rayleigh().b;
  if (modal_ != nullptr)
    read_modes(rest);
  else
    read_matrices(rest);
  find_columns();
  for (std::size_t i = 0; i < probes.stations().size(); ++i) add_probe(probes, i);
  for (const NodalRotation& rotation : rotations) add_rotation(rotation, rest);
}

bool BatchStructure::same_layout(const BatchStructure& other) const {
  const auto same_element = [&](int e) {
    const beam::Element &a = line_.mesh.element(e), &b = other.line_.mesh.element(e);
    return a.x == b.x && a.length == b.length && a.span == b.span;
  };
  const auto same_probe = [](const ProbeForms& a, const ProbeForms& b) {
    return a.count == b.count && std::equal(a.unknown, a.unknown + a.count, b.unknown) && a.x == b.x &&
           a.from == b.from && a.to == b.to;
  };
  const auto same_rotation = [](const LinearForm& a, const LinearForm& b) {
    return a.count == b.count && std::equal(a.row, a.row + a.count, b.row);
  };
  if (task_.block != other.task_.block || task_.columns != other.task_.columns ||
      task_.unknowns != other.task_.unknowns || task_.elements != other.task_.elements ||
      task_.proportional != other.task_.proportional || (by_stiffness_ > 0.0) != (other.by_stiffness_ > 0.0) ||
      (modal_ == nullptr) != (other.modal_ == nullptr) ||
      (beam_.rail() == nullptr) != (other.beam_.rail() == nullptr) ||
      line_.model.surface_height != other.line_.model.surface_height || has_shear_ != other.has_shear_ ||
      (lever_ != 0.0) != (other.lever_ != 0.0))
    return false;
  for (int e = 0; e < task_.elements; ++e)
    if (!same_element(e)) return false;
  return held_ == other.held_ && first_column_ == other.first_column_ &&
         std::equal(std::begin(task_.place), std::end(task_.place), std::begin(other.task_.place)) &&
         kinks_ == other.kinks_ &&
         std::equal(probes_.begin(), probes_.end(), other.probes_.begin(), other.probes_.end(), same_probe) &&
         std::equal(rotations_.begin(), rotations_.end(), other.rotations_.begin(), other.rotations_.end(),
                    same_rotation);
}

void BatchStructure::read_matrices(const std::vector<double>& rest) {
  const auto read = [&](Mat matrix) { return solve::BlockTridiagonal::from(matrix, task_.block); };
  const solve::BlockTridiagonal mass = read(beam_.mass()), stiffness = read(beam_.stiffness());
  task_.proportional = beam_.springs() == nullptr && beam_.dampers() == nullptr && beam_.rail() == nullptr;
  mass_ = by_columns(mass);
  if (!task_.proportional) damping_ = by_columns(read(beam_.damping()));
  stiffness_ = by_columns(stiffness);
  dead_load_ = product(stiffness, rest);  // load of these displacements; settlements are not in the matrices' columns
  task_.unknowns = task_.block * task_.columns;
}

void BatchStructure::read_modes(const std::vector<double>& rest) {
  task_.unknowns = static_cast<int>(modal_->modes());
  for (std::size_t u = 0; u < rest.size(); ++u)
    for (std::size_t i = 0; i < modal_->modes(); ++i) shape_.push_back(modal_->shape(i)[u]);
  for (std::size_t i = 0; i < modal_->modes(); ++i) {
    damping_.push_back(2.0 * modal_->sigma()[i]);
    stiffness_.push_back(modal_->omega()[i] * modal_->omega()[i]);
  }
  dead_load_ = rest;
}

void BatchStructure::find_columns() {
  const auto place = places(line_, task_.block, 0);
  std::copy_n(place.begin(), most_nodal, task_.place);
  std::copy_n(place.begin() + most_nodal, 4, task_.twist);
  task_.values = 2 * line_.per_node;
  task_.track_row = (task_.columns + 2) * task_.block;
  lever_ = line_.eccentricity(0);
  task_.transverse[0] = task_.place[line_.per_node - 2];
  task_.transverse[1] = task_.place[line_.per_node - 1];
  for (int e = 0; e < line_.mesh.elements(); ++e) {
    first_column_.push_back(line_.first_column + line_.mesh.element(e).left);
    has_shear_ = has_shear_ || line_.mesh.element(e).shear != 0.0;
  }
  task_.elements = line_.mesh.elements();
  task_.first_column = first_column_.data();
}

/// Converts a form of the station's nodal unknowns to one of the structure's unknowns.
std::vector<double> BatchStructure::form_of_unknowns(const recovery::StationForms& forms,
                                                     const std::vector<double>& form) const {
  if (modal_ == nullptr) return form;
  std::vector<double> of_modes(modal_->modes(), 0.0);
  for (std::size_t i = 0; i < of_modes.size(); ++i)
    for (std::size_t k = 0; k < form.size(); ++k) of_modes[i] += form[k] * modal_->shape(i)[forms.unknown[k]];
  return of_modes;
}

void BatchStructure::add_probe(const recovery::Recovery& recovery, std::size_t station) {
  const recovery::StationForms forms = recovery.forms(station);
  ProbeForms& p = probes_.emplace_back();
  const auto kept = [&](const std::vector<double>& form) { return keep(form_of_unknowns(forms, form)); };
  for (std::size_t d = 0; d < 3; ++d) {
    p.deflection[d] = kept(forms.deflection[d]);
    p.moment[d] = kept(forms.moment[d]);
  }
  p.acceleration = kept(forms.acceleration);
  p.nodal_moment = kept(forms.nodal_moment);
  std::vector<double> constant = {forms.constant_deflection - forms.support_line, forms.constant_moment};
  lists_.push_back(forms.unknown);
  if (modal_ != nullptr) {
    for (std::size_t k = 0; k < forms.unknown.size(); ++k)
      constant[0] += forms.deflection[0][k] * dead_load_[static_cast<std::size_t>(forms.unknown[k])];
    lists_.back().resize(modal_->modes());
    std::iota(lists_.back().begin(), lists_.back().end(), 0);
  }
  p.unknown = lists_.back().data();
  p.count = static_cast<int>(lists_.back().size());
  p.constant = keep(constant);
  std::vector<double> inside(ProbeForms::inner, 0.0);
  if (beam_.rail() == nullptr && modal_ == nullptr) find_inner_responses(recovery, station, forms.element, p, inside);
  p.inside = keep(inside);
}

void BatchStructure::add_rotation(const NodalRotation& rotation, const std::vector<double>& rest) {
  std::vector<int>& rows = lists_.emplace_back();
  std::vector<double> coefficients;
  double constant = 0.0;
  const auto add = [&](int unknown, double sign) {
    if (unknown == NodalRotation::none) return;
    if (modal_ == nullptr) {
      rows.push_back(unknown);
      coefficients.push_back(sign);
      return;
    }
    constant += sign * rest[static_cast<std::size_t>(unknown)];
    coefficients.resize(modal_->modes(), 0.0);
    for (std::size_t i = 0; i < coefficients.size(); ++i) coefficients[i] += sign * modal_->shape(i)[unknown];
  };
  add(rotation.unknown, 1.0);
  add(rotation.other, -1.0);
  if (modal_ != nullptr) {
    rows.resize(coefficients.size());
    std::iota(rows.begin(), rows.end(), 0);
  }
  rotations_.push_back({static_cast<int>(rows.size()), rows.data(), keep(coefficients), keep({constant})});
}

/// Fits the polynomials of both sides to as many loads as they have coefficients.
void BatchStructure::find_inner_responses(const recovery::Recovery& recovery, std::size_t station, int element,
                                          ProbeForms& p, std::vector<double>& inside) const {
  p.x = recovery.stations()[station];
  std::tie(p.from, p.to) = recovery.element_of(station);
  const double xi = (p.x - p.from) / (p.to - p.from);
  constexpr int n = ProbeForms::powers, kinds = ProbeForms::kinds;
  constexpr double recovery::ElementLoad::*loads[] = {&recovery::ElementLoad::fy, &recovery::ElementLoad::moment,
                                                      &recovery::ElementLoad::torque};
  for (int side = 0; side < 2; ++side) {
    const double from = side == 0 ? 0.0 : xi, to = side == 0 ? xi : 1.0;
    if (to - from < 1e-6) continue;
    Eigen::Matrix<double, n, n> powers;
    Eigen::Matrix<double, n, 2 * kinds> values = Eigen::Matrix<double, n, 2 * kinds>::Zero();
    for (int i = 0; i < n; ++i) {
      const double at = from + (to - from) * (i + 0.5) / n;
      for (int k = 0; k < n; ++k) powers(i, k) = std::pow(at, k);
      for (int kind = 0; kind < (line_.model.torsion ? kinds : 2); ++kind) {  // a torque needs a beam that twists
        recovery::ElementLoad load;
        load.element = element;
        load.xi = at;
        load.*loads[kind] = 1.0;
        const recovery::Response r = recovery.inside_response(station, load);
        values(i, 2 * kind) = r.deflection;
        values(i, 2 * kind + 1) = r.moment;
      }
    }
    const Eigen::Matrix<double, n, 2 * kinds> found = powers.fullPivLu().solve(values);
    for (int kind = 0; kind < kinds; ++kind)
      for (int response = 0; response < 2; ++response)
        for (int k = 0; k < n; ++k)
          inside[static_cast<std::size_t>(((kinds * side + kind) * 2 + response) * n + k)] =
              found(k, 2 * kind + response);
  }
}

}  // namespace traverse::engine
