// Gathers the nodal values of the stations' elements over ranks, applies the precomputed coefficients of each section,
// and adds the loads and sleepers inside the element.
#include "recovery/recovery.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "beam/mesh.hpp"
#include "recovery/recovery_section.hpp"

namespace traverse::recovery {
namespace {

bool is_among(const std::vector<std::size_t>& which, std::size_t station) {
  return std::binary_search(which.begin(), which.end(), station);
}

constexpr double standing_speed = 1e-6;  // m/s: a slower load stands; rounding errors are far smaller

}  // namespace

Recovery::Recovery(const beam::Beam& beam, const beam::Line& line, std::vector<double> stations, double self_weight,
                   const std::vector<double>& eccentricities)
    : beam_(beam), line_(line), stations_(std::move(stations)), gravity_(self_weight) {
  for (double x : stations_) {
    all_.push_back(all_.size());
    if (!std::isfinite(x) || x < line.mesh.start() || x > line.mesh.end()) {
      char text[160];
      std::snprintf(text, sizeof text,
                    "output_probes has a station at x = %.10g; it must lie on the beam, from %.10g to %.10g m", x,
                    line.mesh.start(), line.mesh.end());
      throw InputError(text);
    }
    sections_.emplace_back(line, x);
    RecoverySection& section = sections_.back();
    if (section.twisting)
      section.twisting->eccentricity =
          eccentricities.empty() ? line.eccentricity(0) : eccentricities[sections_.size() - 1];
    section.add_weight(line.model, self_weight);
    if (&line == &beam.bridge()) {
      section.record_sleepers(beam);
      section.support_line = beam.support_lines().at(x).height(beam.model().settlement);
    }
  }
  for (std::size_t i = 0; i < sections_.size(); ++i) by_element_.push_back({sections_[i].at.element, i});
  std::sort(by_element_.begin(), by_element_.end(), [](const Place& a, const Place& b) {
    return a.element != b.element ? a.element < b.element : a.section < b.section;
  });
}

Recovery::Recovery(Recovery&&) noexcept = default;
Recovery::~Recovery() = default;

int Recovery::node_of(std::size_t station) const { return line_.mesh.element(sections_[station].at.element).left; }

std::pair<double, double> Recovery::element_of(std::size_t station) const {
  const beam::Element& e = sections_[station].element;
  return {e.x, e.x + e.length};
}

Forces Recovery::inside(std::size_t station, double x, ElementLoad load) const {
  const RecoverySection& s = sections_[station];
  load.xi = (x - s.element.x) / s.element.length;
  if (load.xi < 0.0 || load.xi > 1.0) return {};
  Response added;
  s.add_load(load, added);
  return {added.moment, added.shear, added.axial_force};
}

Forces Recovery::inside(std::size_t station, double x, const ElementLoad& load, bool as_left) const {
  const RecoverySection& s = sections_[station];
  Forces added = inside(station, x, load);
  const double xi = (x - s.element.x) / s.element.length;
  if (beam::is_left(xi, s.at.xi) == as_left) return added;
  const Forces by = jump(station, load);
  for (std::size_t f = 0; f < added.size(); ++f) added[f] += as_left ? by[f] : -by[f];
  return added;
}

bool Recovery::is_left_of(std::size_t station, double x) const {
  const RecoverySection& s = sections_[station];
  return beam::is_left((x - s.element.x) / s.element.length, s.at.xi);
}

bool Recovery::is_outside(double x) const {
  const beam::Mesh& mesh = line_.mesh;
  const auto tolerance = [&](int element) { return beam::section_tolerance * mesh.element(element).length; };
  return x < mesh.start() + tolerance(0) || x > mesh.end() - tolerance(mesh.elements() - 1);
}

Forces Recovery::jump(std::size_t station, const ElementLoad& load) const {
  return {-load.moment, load.fy, sections_[station].EA > 0.0 ? -load.fx : 0.0};
}

Response Recovery::inside_response(std::size_t station, const ElementLoad& load) const {
  const RecoverySection& s = sections_[station];
  Response added;
  if (load.element == s.at.element) s.add_load(load, added);
  return added;
}

double Recovery::deflection_inside(std::size_t station, const ElementLoad& load) const {
  return inside_response(station, load).deflection;
}

double Recovery::add_deflection_form(std::size_t station, double factor, double* forces) const {
  const RecoverySection& s = sections_[station];
  constexpr std::array<std::size_t, 4> transverse = {1, 2, 4, 5};
  for (std::size_t i = 0; i < 4; ++i) {
    const int local = beam_.local(s.unknowns[transverse[i]]);
    if (local >= 0) forces[local] += factor * (s.psi.value[i] + s.held_by_stiffness[i]);
  }
  if (!s.twisting) return s.weight.deflection;
  const double e = s.twisting->eccentricity;
  for (std::size_t k = 0; k < 4; ++k)
    if (const int local = beam_.local(s.twisting->unknowns[k]); local >= 0)
      forces[local] += factor * e * s.twisting->psi[k];
  return s.weight.deflection + e * s.weight.twist;
}

void Recovery::gather(const double* v, const double* w, const double* a, const std::vector<std::size_t>& which) {
  gathered_.clear();
  const auto append = [&](const double* vector, int unknown) {
    const int local = unknown < 0 ? -1 : beam_.local(unknown);
    gathered_.push_back(local < 0 ? 0.0 : vector[local]);
  };
  for (const std::size_t station : which) {
    const RecoverySection& s = sections_[station];
    for (const double* vector : {v, w, a}) {
      for (int unknown : s.unknowns) append(vector, unknown);
      for (std::size_t k = 0; s.twisting && k < 4; ++k) append(vector, s.twisting->unknowns[k]);
    }
    for (const RecoverySection::ConnectedSleeper& connected : s.sleepers) {
      for (int unknown : {connected.connection.unknown, connected.connection.along}) {
        append(v, unknown);
        append(w, unknown);
      }
    }
  }
  if (gathered_.empty()) return;
  MPI_Allreduce(MPI_IN_PLACE, gathered_.data(), static_cast<int>(gathered_.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
}

/// The deflection at xi of a section's element, beside the shear centre, by the element's nodal values and twists.
double Recovery::deflection_at(const RecoverySection& s, double xi, double eccentricity, const Values& y,
                               const std::array<double, 4>& twists) {
  const auto psi = beam::hermite(xi, s.element.length, s.element.shear).value;
  double sum = psi[0] * y[1] + psi[1] * y[2] + psi[2] * y[4] + psi[3] * y[5];
  if (eccentricity == 0.0) return sum;
  const auto of_twist = beam::hermite(xi, s.element.length).value;
  for (std::size_t k = 0; k < 4; ++k) sum += eccentricity * of_twist[k] * twists[k];
  return sum;
}

Response Recovery::evaluate_section(const RecoverySection& s, const Values& v, const Values& w, const Values& a,
                                    const Twists& twists) const {
  const auto transverse = [](const std::array<double, 4>& form, const Values& y) {
    return form[0] * y[1] + form[1] * y[2] + form[2] * y[4] + form[3] * y[5];
  };
  const auto axial = [](const std::array<double, 2>& form, const Values& y) { return form[0] * y[0] + form[1] * y[3]; };
  Values inertial = a;  // mass-proportional damping acts like inertia
  const double drag = &line_ == &beam_.bridge() ? beam_.rayleigh().a : 0.0;
  for (std::size_t i = 0; i < 6; ++i) inertial[i] += drag * w[i];

  // The part of the displacements that bends and stretches; the rigid part would cancel, except for rounding.
  const double h = s.element.length;
  const auto bending_part = [h](const Values& y) {
    return Values{0.0, 0.0, 0.0, y[3] - y[0], y[4] - y[1] - h * y[2], y[5] - y[2]};
  };
  const Values bending_values = bending_part(v);

  Response r = s.weight;
  r.deflection += transverse(s.psi.value, v);
  if (s.held)
    r.deflection +=
        transverse(s.held_by_stiffness, v) + transverse(s.held_by_damping, w) + transverse(s.held_by_mass, inertial);
  r.velocity = transverse(s.psi.value, w);
  r.acceleration = transverse(s.psi.value, a);
  r.nodal_moment = transverse(s.bending.moment(), bending_values);
  r.nodal_shear = transverse(s.bending.shear(), bending_values);
  r.nodal_axial_force = axial(s.bending.axial_force(), bending_values);
  r.nodal_moment_rate = transverse(s.bending.moment(), bending_part(w));
  r.moment += r.nodal_moment + transverse(s.stiffness.moment(), v) + transverse(s.damping.moment(), w) +
              transverse(s.mass.moment(), inertial);
  r.shear += r.nodal_shear + transverse(s.stiffness.shear(), v) + transverse(s.damping.shear(), w) +
             transverse(s.mass.shear(), inertial);
  if (s.twisting) {
    const RecoverySection::Twisting& t = *s.twisting;
    const auto sum = [](const std::array<double, 4>& form, const std::array<double, 4>& y) {
      return form[0] * y[0] + form[1] * y[1] + form[2] * y[2] + form[3] * y[3];
    };
    std::array<double, 4> inertial_twist{};
    for (std::size_t k = 0; k < 4; ++k) inertial_twist[k] = twists[2][k] + drag * twists[1][k];
    r.twist += sum(t.psi, twists[0]);
    r.twist_along += sum(t.slope, twists[0]);
    r.deflection += t.eccentricity * r.twist;
    r.velocity += t.eccentricity * sum(t.psi, twists[1]);
    r.acceleration += t.eccentricity * sum(t.psi, twists[2]);
    r.torsional_moment +=
        sum(t.moment, twists[0]) + sum(t.moment_by_twist, inertial_twist) + transverse(t.moment_by_bending, inertial);
  }
  r.axial_displacement += axial(s.phi, v);
  r.axial_force += r.nodal_axial_force + axial(s.stiffness.axial_force(), v) + axial(s.damping.axial_force(), w) +
                   axial(s.mass.axial_force(), inertial);
  for (const RecoverySection::EccentricSpring& spring : s.eccentric_springs) {
    const double force = -spring.k * deflection_at(s, spring.xi, spring.eccentricity, v, twists[0]) -
                         spring.c * deflection_at(s, spring.xi, spring.eccentricity, w, twists[1]);
    ElementLoad load{s.at.element, spring.xi, 0.0, force};
    load.torque = spring.eccentricity * force;
    s.add_load(load, r);
  }
  return r;
}

StationForms Recovery::forms(std::size_t station) const {
  const RecoverySection& s = sections_[station];
  std::array<Values, 3> values{};
  Twists twists{};
  std::vector<double> sleepers(4 * s.sleepers.size(), 0.0);
  const auto response = [&] {
    Response r = evaluate_section(s, values[0], values[1], values[2], twists);
    add_sleepers(s, values.data(), twists, sleepers.data(), r);
    return r;
  };
  StationForms f;
  const Response none = response();
  f.element = s.at.element;
  f.constant_deflection = none.deflection;
  f.constant_moment = none.moment;
  f.support_line = s.support_line;
  // `of`: pointers to v, w and a of the unknown among these values; null if the response does not depend on it.
  const auto add = [&](int unknown, const std::array<double*, 3>& of) {
    if (unknown < 0) return;
    f.unknown.push_back(unknown);
    for (std::size_t d = 0; d < 3; ++d) {
      Response r = none;
      if (of[d] != nullptr) {
        *of[d] = 1.0;
        r = response();
        *of[d] = 0.0;
      }
      f.deflection[d].push_back(r.deflection - none.deflection);
      f.moment[d].push_back(r.moment - r.nodal_moment - none.moment);
      if (d == 0) f.nodal_moment.push_back(r.nodal_moment);
      if (d == 2) f.acceleration.push_back(r.acceleration);
    }
  };
  for (std::size_t k = 0; k < s.unknowns.size(); ++k) add(s.unknowns[k], {&values[0][k], &values[1][k], &values[2][k]});
  for (std::size_t k = 0; s.twisting && k < 4; ++k)
    add(s.twisting->unknowns[k], {&twists[0][k], &twists[1][k], &twists[2][k]});
  double* sleeper_value = sleepers.data();
  for (const RecoverySection::ConnectedSleeper& connected : s.sleepers)
    for (const int unknown : {connected.connection.unknown, connected.connection.along}) {
      add(unknown, {sleeper_value, sleeper_value + 1, nullptr});
      sleeper_value += 2;
    }
  return f;
}

// Adds the forces of the sleepers on the element: the spring below each, the mass on the beam, the spring along x.
void Recovery::add_sleepers(const RecoverySection& s, const Values* values, const Twists& twists,
                            const double* sleepers, Response& r) const {
  const double eccentricity = line_.eccentricity(0);
  for (const RecoverySection::ConnectedSleeper& connected : s.sleepers) {
    const auto beam = [&](std::size_t d) { return deflection_at(s, connected.xi, eccentricity, values[d], twists[d]); };
    const double force = connected.connection.spring.k * (sleepers[0] - beam(0)) +
                         connected.connection.spring.c * (sleepers[1] - beam(1)) -
                         connected.connection.mass * (beam(2) + gravity_);
    double along = 0.0;
    if (connected.connection.along >= 0) {
      const auto phi = beam::linear(connected.xi);
      const auto theta_form = beam::rotation(connected.xi, s.element.length, s.element.shear);
      const double e = line_.model.surface_height;
      const auto surface = [&](const Values& y) {
        const double theta = theta_form[0] * y[1] + theta_form[1] * y[2] + theta_form[2] * y[4] + theta_form[3] * y[5];
        return phi[0] * y[0] + phi[1] * y[3] - e * theta;
      };
      const beam::Spring& spring = connected.connection.spring_along;
      along = spring.k * (sleepers[2] - surface(values[0])) + spring.c * (sleepers[3] - surface(values[1]));
    }
    ElementLoad load{s.at.element, connected.xi, along, force, -line_.model.surface_height * along};
    load.torque = eccentricity * force;
    s.add_load(load, r);
    sleepers += 4;
  }
}

void Recovery::evaluate(const double* v, const double* w, const double* a, const std::vector<ElementLoad>& loads,
                        const std::vector<std::size_t>& which, std::vector<Response>& out) {
  gather(v, w, a, which);
  out.resize(sections_.size());
  const double* at = gathered_.data();
  for (const std::size_t i : which) {
    const RecoverySection& s = sections_[i];
    std::array<Values, 3> values;
    Twists twists{};
    for (std::size_t d = 0; d < 3; ++d) {
      std::copy_n(at, 6, values[d].begin());
      at += 6;
      if (!s.twisting) continue;
      std::copy_n(at, 4, twists[d].begin());
      at += 4;
    }
    out[i] = evaluate_section(s, values[0], values[1], values[2], twists);
    add_sleepers(s, values.data(), twists, at, out[i]);
    at += 4 * s.sleepers.size();
  }
  for (const ElementLoad& given : loads) {
    const ElementLoad load = in_own_element(given);
    for (const Place& place : sections_of(load.element))
      if (is_among(which, place.section)) sections_[place.section].add_load(load, out[place.section]);
    if (std::abs(load.speed) > standing_speed) add_beside(load, which, out);
  }
  for (const std::size_t i : which) out[i].relative_deflection = out[i].deflection - sections_[i].support_line;
}

ElementLoad Recovery::in_own_element(ElementLoad load) const {
  if (load.xi >= 0.0 && load.xi <= 1.0) {
    load.element %= line_.mesh.elements();
    return load;
  }
  const beam::Station at = line_.mesh.locate(x_of(load));
  load.element = at.element;
  load.xi = at.xi;
  return load;
}

std::span<const Recovery::Place> Recovery::sections_of(int element) const {
  const auto [first, past] =
      std::equal_range(by_element_.begin(), by_element_.end(), Place{element, 0},
                       [](const Place& one, const Place& other) { return one.element < other.element; });
  return {first, past};
}

// A station at a node belongs to the element on its right, but a load also passes it in the element on its left. A load
// that stands there passes nothing: it is on the side of is_left().
void Recovery::add_beside(const ElementLoad& load, const std::vector<std::size_t>& which,
                          std::vector<Response>& out) const {
  const auto add_at = [&](int element, double xi) {
    for (const Place& place : sections_of(element)) {
      if (std::abs(xi - sections_[place.section].at.xi) > beam::section_tolerance) continue;
      if (!is_among(which, place.section)) continue;
      const Forces by = jump(place.section, load);
      const bool left = is_left_of(place.section, x_of(load)), from_left = load.speed > 0.0;
      const std::size_t side = left == from_left ? 1 : 0;
      out[place.section].shear_beside[side] += left ? -by[1] : by[1];
      out[place.section].axial_force_beside[side] += left ? -by[2] : by[2];
      const RecoverySection& s = sections_[place.section];
      const double rate = s.twisting ? load.torque * s.twisting->flexibility / s.element.length : 0.0;
      out[place.section].twist_along_beside[side] += left ? rate : -rate;
    }
  };
  add_at(load.element, load.xi);
  if (load.xi > 1.0 - beam::section_tolerance) add_at(load.element + 1, load.xi - 1.0);
}

}  // namespace traverse::recovery
