#include "recovery/recovery.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "beam/assembly.hpp"
#include "beam/gauss.hpp"
#include "beam/held_element.hpp"
#include "beam/layered_track.hpp"
#include "beam/nonlinear_points.hpp"
#include "beam/section.hpp"
#include "beam/shape.hpp"

namespace traverse::beam {

struct Recovery::Section {
  Section(const Line& line, double x);

  void add_foundation(const Line& line);
  void hold(const BeamModel& model, const std::vector<InnerSpring>& springs, const std::vector<InnerSpring>& dampers);
  template <class Sum>
  void along_held(const Distribution& density, bool moments, Sum sum) const;
  void note_riders(const Beam& beam);
  void add_strains(const BeamModel& model);
  void add_weight(const BeamModel& model, double gravity);
  void add_weight_at_points(const Bed& bed, const Distribution& mass_per_length, double gravity);
  void add_load(const ElementLoad& load, Response& r) const;

  /// A sleeper of a layered track on this element.
  struct Rider {
    Ride ride;
    double xi = 0.0;
  };

  Station at;
  Element element;
  std::array<int, 6> unknowns;  // global: u1, v1, theta1, u2, v2, theta2; -1: not there
  double EI = 0.0, EA = 0.0;    // in the element's middle, for the fixed-end deflections
  Hermite psi;
  std::array<double, 2> phi;
  SectionForms bending;                   // K_e of the beam, for nodal values less the element's rigid motion
  SectionForms stiffness, damping, mass;  // K_e and C_e of the foundation, M_e
  Response weight;                        // of the beam's own weight and temperature: deflection and forces
  /// Where a foundation acts inside the element: the deflection that the shape functions leave out, under loads, and
  /// under what the foundation and inertia do to the beam as it moves by them.
  std::optional<HeldElement> held;
  std::array<double, 4> held_by_stiffness{}, held_by_damping{}, held_by_mass{};
  std::vector<Rider> riders;
};

Recovery::Section::Section(const Line& line, double x)
    : at(line.mesh.locate(x)),
      element(line.mesh.element(at.element)),
      psi(hermite(at.xi, element.length, element.shear)),
      phi(linear(at.xi)),
      bending(element, at.xi),
      stiffness(element, at.xi),
      damping(element, at.xi),
      mass(element, at.xi) {
  const BeamModel& model = line.model;
  const auto [v1, theta1, v2, theta2] = line.transverse(at.element);
  const auto [u1, u2] = line.axial(at.element);
  unknowns = {u1, v1, theta1, u2, v2, theta2};
  const double middle = element.x + 0.5 * element.length;
  EI = model.EI.at(middle, element.x);
  const ElementMatrices matrices = element_matrices(model, element);
  bending.add_end_forces(matrices.stiffness);
  mass.add_end_forces(matrices.mass);
  mass.add_transverse_density(model.mass);
  if (model.rotary_inertia.maximum() > 0.0) mass.add_rotational_density(model.rotary_inertia);
  if (model.axial) {
    EA = model.EA.at(middle, element.x);
    bending.add_end_forces(matrices.axial_stiffness);
    mass.add_end_forces(matrices.axial_mass);
    mass.add_axial_density(model.mass);
  }
  add_foundation(line);
  if (model.temperature) add_strains(model);
}

/// What the forces at the left end are less by: the elastic strain is the whole one less the temperature's.
void Recovery::Section::add_strains(const BeamModel& model) {
  const auto bent = strain_load(model, element);
  weight.shear -= bent[0];
  weight.moment -= at.xi * element.length * bent[0] - bent[1];
  weight.axial_force += axial_strain_load(model, element)[0];
}

void Recovery::Section::note_riders(const Beam& beam) {
  if (beam.rail() == nullptr) return;
  const int column = beam.bridge().first_column + element.left;
  for (const Sleeper& s : sleepers_of(beam.bridge(), column - 1, column + 3)) {
    if (s.on_bridge && s.at.element == at.element)
      riders.push_back({ride_of(s, *beam.model().track, beam.layout()), s.at.xi});
  }
}

void Recovery::Section::add_foundation(const Line& line) {
  const BeamModel& model = line.model;
  const Foundation& f = model.foundation;
  std::vector<InnerSpring> springs, dampers;
  for_points(f, [&](const FoundationKind& kind, const std::vector<PointFoundation>& points) {
    if (!acts(kind, model)) return;
    for (const PointFoundation& p : points) {
      if (p.law.nonlinear() || p.depth != 0.0) continue;  // a load, or at a node
      // locate() is the judge, as in the assembly; a glance at x spares most of the calls.
      if (p.x < element.x - element.length || p.x > element.x + 2.0 * element.length) continue;
      const Station s = station_of(line.mesh, p);
      if (s.element != at.element) continue;
      stiffness.add_spring(kind.direction, p.k, s.xi);
      damping.add_spring(kind.direction, p.c, s.xi);
      if (kind.direction == Direction::longitudinal || s.xi <= 0.0 || s.xi >= 1.0) continue;
      springs.push_back({s.xi, p.k, kind.direction == Direction::rotational});
      dampers.push_back({s.xi, p.c, kind.direction == Direction::rotational});
    }
  });
  bool bends = !springs.empty();
  for_beds(f, [&](const FoundationKind& kind, const Bed& bed) {
    if (!acts(kind, model) || bed.law.nonlinear()) return;
    stiffness.add_bed(kind.direction, bed.k);
    damping.add_bed(kind.direction, bed.c);
    bends = bends || kind.direction != Direction::longitudinal;
  });
  if (bends) hold(model, springs, dampers);
}

/// Integrates over the held element: calls sum(s, weight*density(s), G(s)), where G is its line under a force, or under
/// a moment.
template <class Sum>
void Recovery::Section::along_held(const Distribution& density, bool moments, Sum sum) const {
  const std::vector<double> ends = held->ends();
  const double h = element.length, x = element.x;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    integrate(density, x + h * ends[i], x + h * ends[i + 1], [&](double s, double piece) {
      const double xi = (s - x) / h;
      sum(xi, piece * (moments ? held->by_moment(xi) : held->by_force(xi)));
    });
}

/// The element is held by its springs and by the mean of a vertical bed. What a bed that holds the slope does to the
/// deflection between held ends is left out; that is a part k h^2/(40 EI) of it.
void Recovery::Section::hold(const BeamModel& model, const std::vector<InnerSpring>& springs,
                             const std::vector<InnerSpring>& dampers) {
  const double h = element.length;
  double mean = 0.0;
  for_beds(model.foundation, [&](const FoundationKind& kind, const Bed& bed) {
    if (kind.direction == Direction::vertical && !bed.law.nonlinear())
      integrate(bed.k, element.x, element.x + h, [&](double, double piece) { mean += piece / h; });
  });
  held.emplace(at.xi, h, EI, mean, springs, element.shear);
  const auto add = [&](const Distribution& density, Direction direction, std::array<double, 4>& form) {
    along_held(density, direction == Direction::rotational, [&](double s, double line) {
      const auto shape = shape_of(direction, s, element);
      for (std::size_t i = 0; i < 4; ++i) form[i] -= line * shape[i];
    });
  };
  const auto add_points = [&](const std::vector<InnerSpring>& points, std::array<double, 4>& form) {
    for (const InnerSpring& p : points) {
      const auto shape = shape_of(p.rotational ? Direction::rotational : Direction::vertical, p.xi, element);
      const double line = p.k * (p.rotational ? held->by_moment(p.xi) : held->by_force(p.xi));
      for (std::size_t i = 0; i < 4; ++i) form[i] -= line * shape[i];
    }
  };
  add(model.mass, Direction::vertical, held_by_mass);
  if (model.rotary_inertia.maximum() > 0.0) add(model.rotary_inertia, Direction::rotational, held_by_mass);
  for_beds(model.foundation, [&](const FoundationKind& kind, const Bed& bed) {
    if (kind.direction == Direction::longitudinal || bed.law.nonlinear()) return;
    add(bed.k, kind.direction, held_by_stiffness);
    add(bed.c, kind.direction, held_by_damping);
  });
  add_points(springs, held_by_stiffness);
  add_points(dampers, held_by_damping);
}

void Recovery::Section::add_weight(const BeamModel& model, double gravity) {
  const double h = element.length, x = at.xi * h;
  const auto end = transverse_load(model.mass, element);
  weight.shear += gravity * end[0];
  weight.moment += gravity * (x * end[0] - end[1]);
  const Bed* pushing = nullptr;
  for_beds(model.foundation, [&](const FoundationKind& kind, const Bed& bed) {
    if (kind.direction == Direction::vertical && bed.law.nonlinear()) pushing = &bed;
  });
  if (pushing != nullptr) return add_weight_at_points(*pushing, model.mass, gravity);
  integrate(model.mass, element.x, element.x + x, [&](double s, double piece) {
    weight.shear -= gravity * piece;
    weight.moment -= gravity * piece * (element.x + x - s);
  });
  if (held) {
    along_held(model.mass, false, [&](double, double line) { weight.deflection -= gravity * line; });
    return;
  }
  const double bubble = at.xi * (1.0 - at.xi) * h * h, middle = element.x + 0.5 * h;
  const double bent = bubble * (bubble + element.shear * h * h);
  weight.deflection = -gravity * model.mass.at(middle, element.x) * bent / (24.0 * EI);
}

/// Where a bed pushes at its points of integration the weight acts there too: it cancels where the beam rests.
void Recovery::Section::add_weight_at_points(const Bed& bed, const Distribution& mass_per_length, double gravity) {
  for (const auto& [left, right] : bed_pieces(bed, element)) {
    integrate(mass_per_length, left, right, [&](double s, double piece) {
      const double xi = (s - element.x) / element.length, force = gravity * piece;
      weight.deflection -=
          force * (held ? held->by_force(xi) : fixed_end_by_force(at.xi, xi, element.length, EI, element.shear));
      if (!is_left(xi, at.xi)) return;
      weight.shear -= force;
      weight.moment -= force * (at.xi - xi) * element.length;
    });
  }
}

void Recovery::Section::add_load(const ElementLoad& load, Response& r) const {
  const double h = element.length, x = at.xi * h;
  const Hermite s = hermite(load.xi, h, element.shear);
  const auto turn = element.shear == 0.0 ? s.slope : rotation(load.xi, h, element.shear);
  const double f1 = -load.fy * s.value[0] - load.moment * turn[0];
  const double m1 = -load.fy * s.value[1] - load.moment * turn[1];
  r.shear += f1;
  r.moment += f1 * x - m1;
  if (held)
    r.deflection +=
        load.fy * held->by_force(load.xi) + (load.moment == 0.0 ? 0.0 : load.moment * held->by_moment(load.xi));
  else
    r.deflection += load.fy * fixed_end_by_force(at.xi, load.xi, h, EI, element.shear) +
                    load.moment * fixed_end_by_moment(at.xi, load.xi, h, EI, element.shear);
  const bool left = is_left(load.xi, at.xi);
  if (left) {
    r.shear += load.fy;
    r.moment += load.fy * (at.xi - load.xi) * h - load.moment;
  }
  if (EA <= 0.0) return;
  r.axial_force += load.fx * (left ? -load.xi : 1.0 - load.xi);
  r.axial_displacement += load.fx * h / EA * (left ? load.xi * (1.0 - at.xi) : at.xi * (1.0 - load.xi));
}

Recovery::Recovery(const Beam& beam, const Line& line, std::vector<double> stations, double self_weight)
    : beam_(beam), line_(line), stations_(std::move(stations)), gravity_(self_weight) {
  std::size_t size = 0;
  for (double x : stations_) {
    if (!std::isfinite(x) || x < line.mesh.start() || x > line.mesh.end()) {
      char text[160];
      std::snprintf(text, sizeof text,
                    "output_probes has a station at x = %.10g; it must lie on the beam, from %.10g to %.10g m", x,
                    line.mesh.start(), line.mesh.end());
      throw InputError(text);
    }
    sections_.emplace_back(line, x);
    sections_.back().add_weight(line.model, self_weight);
    if (&line == &beam.bridge()) sections_.back().note_riders(beam);
    size += 18 + 4 * sections_.back().riders.size();
  }
  gathered_.resize(size);
  for (std::size_t i = 0; i < sections_.size(); ++i) by_element_.push_back({sections_[i].at.element, i});
  std::sort(by_element_.begin(), by_element_.end(), [](const Place& a, const Place& b) {
    return a.element != b.element ? a.element < b.element : a.section < b.section;
  });
}

Recovery::Recovery(Recovery&&) noexcept = default;
Recovery::~Recovery() = default;

std::pair<double, double> Recovery::element_of(std::size_t station) const {
  const Element& e = sections_[station].element;
  return {e.x, e.x + e.length};
}

Forces Recovery::inside(std::size_t station, double x, ElementLoad load) const {
  const Section& s = sections_[station];
  load.xi = (x - s.element.x) / s.element.length;
  if (load.xi < 0.0 || load.xi > 1.0) return {};
  Response added;
  s.add_load(load, added);
  return {added.moment, added.shear, added.axial_force};
}

Response Recovery::inside_response(std::size_t station, const ElementLoad& load) const {
  const Section& s = sections_[station];
  Response added;
  if (load.element == s.at.element) s.add_load(load, added);
  return added;
}

double Recovery::deflection_inside(std::size_t station, const ElementLoad& load) const {
  return inside_response(station, load).deflection;
}

double Recovery::add_deflection_form(std::size_t station, double factor, double* forces) const {
  const Section& s = sections_[station];
  constexpr std::array<std::size_t, 4> transverse = {1, 2, 4, 5};
  for (std::size_t i = 0; i < 4; ++i) {
    const int local = beam_.local(s.unknowns[transverse[i]]);
    if (local >= 0) forces[local] += factor * (s.psi.value[i] + s.held_by_stiffness[i]);
  }
  return s.weight.deflection;
}

void Recovery::gather(const double* v, const double* w, const double* a) {
  std::size_t at = 0;
  const auto take = [&](const double* vector, int unknown) {
    const int local = unknown < 0 ? -1 : beam_.local(unknown);
    gathered_[at++] = local < 0 ? 0.0 : vector[local];
  };
  for (const Section& s : sections_) {
    for (const double* vector : {v, w, a}) {
      for (int unknown : s.unknowns) take(vector, unknown);
    }
    for (const Section::Rider& rider : s.riders) {
      for (int unknown : {rider.ride.unknown, rider.ride.along}) {
        take(v, unknown);
        take(w, unknown);
      }
    }
  }
  if (gathered_.empty()) return;
  MPI_Allreduce(MPI_IN_PLACE, gathered_.data(), static_cast<int>(gathered_.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
}

Response Recovery::respond(const Section& s, const Values& v, const Values& w, const Values& a) const {
  const auto transverse = [](const std::array<double, 4>& form, const Values& y) {
    return form[0] * y[1] + form[1] * y[2] + form[2] * y[4] + form[3] * y[5];
  };
  const auto axial = [](const std::array<double, 2>& form, const Values& y) { return form[0] * y[0] + form[1] * y[3]; };
  Values inertial = a;  // mass-proportional damping acts like inertia
  const double drag = &line_ == &beam_.bridge() ? beam_.rayleigh().a : 0.0;
  for (std::size_t i = 0; i < 6; ++i) inertial[i] += drag * w[i];

  // Of the displacements what bends and stretches: the rest would cancel, but for its rounding.
  const double h = s.element.length;
  const auto bending_part = [h](const Values& y) {
    return Values{0.0, 0.0, 0.0, y[3] - y[0], y[4] - y[1] - h * y[2], y[5] - y[2]};
  };
  const Values bent = bending_part(v);

  Response r = s.weight;
  r.deflection += transverse(s.psi.value, v);
  if (s.held)
    r.deflection +=
        transverse(s.held_by_stiffness, v) + transverse(s.held_by_damping, w) + transverse(s.held_by_mass, inertial);
  r.velocity = transverse(s.psi.value, w);
  r.acceleration = transverse(s.psi.value, a);
  r.nodal_moment = transverse(s.bending.moment(), bent);
  r.nodal_shear = transverse(s.bending.shear(), bent);
  r.nodal_axial_force = axial(s.bending.axial_force(), bent);
  r.nodal_moment_rate = transverse(s.bending.moment(), bending_part(w));
  r.moment += r.nodal_moment + transverse(s.stiffness.moment(), v) + transverse(s.damping.moment(), w) +
              transverse(s.mass.moment(), inertial);
  r.shear += r.nodal_shear + transverse(s.stiffness.shear(), v) + transverse(s.damping.shear(), w) +
             transverse(s.mass.shear(), inertial);
  r.axial_displacement = axial(s.phi, v);
  r.axial_force += r.nodal_axial_force + axial(s.stiffness.axial_force(), v) + axial(s.damping.axial_force(), w) +
                   axial(s.mass.axial_force(), inertial);
  return r;
}

// What the sleepers on the element do to it: the spring below each, the mass that rides, the spring along x.
void Recovery::add_riders(const Section& s, const Values* values, const double* riders, Response& r) const {
  for (const Section::Rider& rider : s.riders) {
    const auto psi = hermite(rider.xi, s.element.length, s.element.shear).value;
    const auto beam = [&](const Values& y) { return psi[0] * y[1] + psi[1] * y[2] + psi[2] * y[4] + psi[3] * y[5]; };
    const double force = rider.ride.spring.k * (riders[0] - beam(values[0])) +
                         rider.ride.spring.c * (riders[1] - beam(values[1])) -
                         rider.ride.mass * (beam(values[2]) + gravity_);
    double along = 0.0;
    if (rider.ride.along >= 0) {
      const auto phi = linear(rider.xi);
      const auto turns = rotation(rider.xi, s.element.length, s.element.shear);
      const double e = line_.model.surface_height;
      const auto surface = [&](const Values& y) {
        const double turn = turns[0] * y[1] + turns[1] * y[2] + turns[2] * y[4] + turns[3] * y[5];
        return phi[0] * y[0] + phi[1] * y[3] - e * turn;
      };
      const Spring& spring = rider.ride.spring_along;
      along = spring.k * (riders[2] - surface(values[0])) + spring.c * (riders[3] - surface(values[1]));
    }
    s.add_load({s.at.element, rider.xi, along, force, -line_.model.surface_height * along}, r);
    riders += 4;
  }
}

void Recovery::evaluate(const double* v, const double* w, const double* a, const std::vector<ElementLoad>& loads,
                        std::vector<Response>& out) {
  gather(v, w, a);
  out.resize(sections_.size());
  const double* at = gathered_.data();
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const Section& s = sections_[i];
    std::array<Values, 3> values;
    for (Values& y : values) {
      std::copy_n(at, 6, y.begin());
      at += 6;
    }
    out[i] = respond(s, values[0], values[1], values[2]);
    add_riders(s, values.data(), at, out[i]);
    at += 4 * s.riders.size();
  }
  for (const ElementLoad& load : loads) {
    const auto [first, past] =
        std::equal_range(by_element_.begin(), by_element_.end(), Place{load.element, 0},
                         [](const Place& one, const Place& other) { return one.element < other.element; });
    for (auto place = first; place != past; ++place) sections_[place->section].add_load(load, out[place->section]);
  }
}

}  // namespace traverse::beam
