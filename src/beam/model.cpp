// Checks of a beam model's spans, properties, joints, cracks, supports and foundation, the displacements that supports
// fix (section 3.1 of the paper), and the linearised model.
#include "traverse/beam/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>

#include "layered_track.hpp"
#include "traverse/base/error.hpp"

namespace traverse::beam {
namespace {

constexpr double min_distance = 1e-3;  // m, least distance of nodes and of span ends
constexpr double max_shear = 1e11;     // 12 EI/(GA h^2), with a relative rounding error of 1e-5

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

void require(bool condition, const std::string& option, const std::string& value, const std::string& allowed) {
  if (!condition) throw InputError(option + " is " + value + "; " + allowed);
}

void require_positive(const Distribution& d, const std::string& option, const std::string& unit) {
  for (double value : {d.minimum(), d.maximum()}) {
    require(std::isfinite(value) && value > 0.0, option, number(value), "it must be positive (" + unit + ")");
  }
}

void require_not_negative(double value, const std::string& option, const std::string& unit) {
  require(std::isfinite(value) && value >= 0.0, option, number(value), "it must not be negative (" + unit + ")");
}

void check_spans(const BeamModel& model) {
  require(!model.spans.empty(), "beam_spans", "empty", "at least one span is needed (m)");
  for (double span : model.spans) {
    require(std::isfinite(span) && span > 0.0, "beam_spans", number(span), "every span must be positive (m)");
  }
  require(model.elements.size() == model.spans.size(), "beam_elements_per_span",
          std::to_string(model.elements.size()) + " numbers",
          "one for each of the " + std::to_string(model.spans.size()) + " spans is needed");
  for (int n : model.elements) {
    require(n >= 1, "beam_elements_per_span", std::to_string(n), "every span needs at least 1 element");
  }
  // Traverse and PETSc count unknowns in 32 bits.
  const long long unknowns = 3 * (std::accumulate(model.elements.begin(), model.elements.end(), 0LL) +
                                  static_cast<long long>(model.spans.size()));
  require(unknowns < (1LL << 31), "beam_elements_per_span", std::to_string(unknowns) + " unknowns in all",
          "fewer than 2^31 are possible");
  require(model.supports.size() == model.spans.size() + 1, "support_types",
          std::to_string(model.supports.size()) + " supports",
          "one at every span end is needed: " + std::to_string(model.spans.size() + 1));
}

void check_law(const FoundationLaw& law, const std::string& option, const FoundationUnits& units) {
  require_not_negative(law.gap, option + "_gap", std::string(units.gap));
  require_not_negative(law.cubic, option + "_cubic", std::string(units.cubic));
}

/// Checks that a point that slides is a spring without other properties.
void check_sliding(const PointFoundation& p, const std::string& option) {
  require_not_negative(p.law.slides_at, option + "_limit", "N");
  if (p.law.slides_at == 0.0) return;
  require(p.k > 0.0 && p.c == 0.0 && p.law.gap == 0.0 && p.law.cubic == 0.0, option + "_limit", number(p.law.slides_at),
          "what slides is a spring: " + option + "_k above 0, without _c, _gap and _cubic");
}

void check_foundation(const Foundation& foundation, double length) {
  for_points(foundation, [&](const FoundationKind& kind, const std::vector<PointFoundation>& points) {
    const std::string option = "foundation_" + std::string(kind.name);
    const FoundationUnits units = units_of(kind);
    for (const PointFoundation& p : points) {
      require(std::isfinite(p.x) && p.x >= 0.0 && p.x <= length, option + "_x", number(p.x),
              "it must lie on the beam, from 0 to " + number(length) + " m");
      require_not_negative(p.k, option + "_k", std::string(units.k));
      require_not_negative(p.c, option + "_c", std::string(units.c));
      check_law(p.law, option, units);
      check_sliding(p, option);
    }
  });
  for_beds(foundation, [&](const FoundationKind& kind, const Bed& bed) {
    const std::string option = "foundation_" + std::string(kind.name);
    const FoundationUnits units = units_of(kind);
    const bool compression = kind.bed == &Foundation::rotational_bed && bed.k.maximum() <= 0.0;  // beam_tension below 0
    for (double value : {bed.k.minimum(), bed.k.maximum()})
      if (!compression) require_not_negative(value, option + "_k", std::string(units.k));
    for (double value : {bed.c.minimum(), bed.c.maximum()})
      require_not_negative(value, option + "_c", std::string(units.c));
    check_law(bed.law, option, units);
  });
}

/// Checks GA. The bending of an element has the factor 1 + 12 EI/(GA h^2); if this is too large, rounding errors
/// dominate.
void check_shear(const BeamModel& model) {
  require_positive(*model.GA, "beam_GA", "N");
  if (model.track || model.elements.size() != model.spans.size()) return;
  for (std::size_t i = 0; i < model.spans.size(); ++i) {
    const double h = model.spans[i] / std::max(1, model.elements[i]);
    const double least = 12.0 * model.EI.maximum() / (max_shear * h * h);
    require(model.GA->minimum() >= least, "beam_GA", number(model.GA->minimum()),
            fmt::format("beside beam_EI, in elements of {:.3g} m, rounding hides bending below {:.2g} N", h, least));
  }
}

void check_joints(const BeamModel& model) {
  const std::size_t inner = model.spans.size() - 1;
  require(model.joints.size() <= 1 || model.joints.size() == inner, "beam_continuity",
          std::to_string(model.joints.size()) + " joints",
          "one for all or one at every inner span end is needed: " + std::to_string(inner));
  double previous = model.start;
  for (double x : model.hinges) {
    require(std::isfinite(x) && x > previous && x < model.end(), "beam_hinges", number(x),
            "hinges lie within the beam, from left to right");
    previous = x;
  }
}

void check_cracks(const BeamModel& model) {
  double previous = model.start;
  for (const Crack& crack : model.cracks) {
    require(std::isfinite(crack.x) && crack.x > previous && crack.x < model.end(), "beam_cracks_x", number(crack.x),
            "cracks lie within the beam, from left to right, each at a station of its own");
    require(std::isfinite(crack.k) && crack.k > 0.0, "beam_cracks_k", number(crack.k),
            "it must be positive (N m/rad); without stiffness it is a hinge (beam_hinges)");
    previous = crack.x;
    require(std::find(model.hinges.begin(), model.hinges.end(), crack.x) == model.hinges.end(), "beam_cracks_x",
            number(crack.x), "there is a hinge there (beam_hinges)");
    double end = model.start;
    for (std::size_t i = 1; i < model.spans.size(); ++i) {
      end += model.spans[i - 1];
      require(end != crack.x || model.joint(static_cast<int>(i)) == Joint::continuous, "beam_cracks_x", number(crack.x),
              "the beam does not go through there (beam_continuity)");
    }
  }
  if (model.track && !model.cuts.empty())
    throw InputError(
        "beam_cracks_width: the rail sets the bridge's nodes under a layered track; allowed there: beam_cracks_k");
  for (const double x : model.cuts)
    require(std::isfinite(x) && x >= model.start && x <= model.end(), "beam_cracks_width", number(x),
            "a crack of a width lies within the beam");
}

/// Checks the distances of the nodes that divide the beam. Short elements between close nodes cause rounding errors.
void check_divisions(const BeamModel& model) {
  const bool masses = !model.point_masses.empty() || !model.dampers.empty();
  if (model.track || (model.cracks.empty() && model.cuts.empty() && model.hinges.empty() && !masses)) return;
  std::vector<double> x = model.hinges;
  for (const Crack& crack : model.cracks) x.push_back(crack.x);
  for (const PointMass& mass : model.point_masses) x.push_back(mass.x);
  for (const MassDamper& damper : model.dampers) x.push_back(damper.x);
  x.insert(x.end(), model.cuts.begin(), model.cuts.end());
  x.push_back(model.start);
  double end = model.start;
  for (const double span : model.spans) x.push_back(end += span);
  std::sort(x.begin(), x.end());
  const std::string option = !model.cuts.empty()           ? "beam_cracks_width"
                             : !model.cracks.empty()       ? "beam_cracks_x"
                             : !model.hinges.empty()       ? "beam_hinges"
                             : !model.point_masses.empty() ? "beam_point_masses_x"
                                                           : "beam_dampers";
  for (std::size_t i = 1; i < x.size(); ++i)
    if (x[i] - x[i - 1] > 0.0 && x[i] - x[i - 1] < min_distance)
      throw InputError(
          fmt::format("{}: what divides the beam (ends of spans and of cracks, hinges, masses on it) at x = {:.9g} and "
                      "{:.9g} m is {:.3g} m apart; allowed: 0, or at least {:g} m",
                      option, x[i - 1], x[i], x[i] - x[i - 1], min_distance));
}

void check_torsion(const BeamModel& model) {
  const Torsion& torsion = *model.torsion;
  require_positive(torsion.GJ, "beam_GJ", "N m2");
  if (torsion.warping) require_positive(*torsion.warping, "beam_ECw", "N m4");
  require_positive(torsion.inertia, "beam_polar_inertia", "kg m");
  require(std::isfinite(torsion.mass_centre), "beam_mass_centre", number(torsion.mass_centre), "it must be a number");
  require(torsion.held.size() == model.supports.size(), "support_torsion",
          std::to_string(torsion.held.size()) + " words", "one at every span end is needed");
  // The motions of a beam with a layered track are not searched for what nothing holds.
  require(!model.track || std::ranges::any_of(torsion.held, [](char one) { return one != 0; }), "support_torsion",
          "free", "nothing holds the twist; allowed: held at a support");
}

void check_strains(const BeamModel& model) {
  require(model.settlement.empty() || model.settlement.size() == model.supports.size(), "support_settlement",
          std::to_string(model.settlement.size()) + " numbers", "one at every span end is needed");
  for (std::size_t i = 0; i < model.settlement.size(); ++i)
    require(std::isfinite(model.settlement[i]) && (model.settlement[i] == 0.0 || fixes_vertical(model.supports[i])),
            "support_settlement", number(model.settlement[i]),
            "what settles holds the beam vertically; 0 elsewhere (m)");
  require(model.shift.empty() || model.shift.size() == model.supports.size(), "support_motion_along",
          std::to_string(model.shift.size()) + " numbers", "one at every span end is needed");
  if (!model.temperature) return;
  const Temperature& t = *model.temperature;
  for (const double value : {t.uniform, t.gradient, t.expansion, t.strain(), t.curvature()})
    require(std::isfinite(value), "beam_temperature", number(value), "it must be a number");
}

}  // namespace

bool fixes_axial(Support s) {
  return s == Support::pinned || s == Support::clamped || s == Support::guided || s == Support::along;
}
bool fixes_vertical(Support s) { return s == Support::roller || s == Support::pinned || s == Support::clamped; }
bool fixes_rotation(Support s) { return s == Support::clamped || s == Support::guided; }

double BeamModel::length() const { return std::accumulate(spans.begin(), spans.end(), 0.0); }

Joint BeamModel::joint(int span_end) const {
  if (joints.empty()) return Joint::continuous;
  return joints.size() == 1 ? joints.front() : joints[static_cast<std::size_t>(span_end) - 1];
}

BeamModel linearised(const BeamModel& model) {
  BeamModel linear = model;
  for_points(linear.foundation, [](const FoundationKind&, std::vector<PointFoundation>& points) {
    for (PointFoundation& p : points) {
      if (p.law.gap > 0.0) p.k = p.c = 0.0;
      p.law = {};
    }
  });
  for_beds(linear.foundation, [&](const FoundationKind& kind, Bed& bed) {
    if (bed.law.gap > 0.0) {
      (linear.foundation.*kind.bed).reset();
    } else {
      bed.law = {};
    }
  });
  if (linear.track) linear.track->gaps_stay_open = linear.track->sliding_disabled = true;
  return linear;
}

bool BeamModel::strained() const {
  return (temperature && (temperature->strain() != 0.0 || temperature->curvature() != 0.0)) ||
         (track && axial && track->rail_temperature * track->rail_expansion != 0.0) ||
         std::any_of(settlement.begin(), settlement.end(), [](double s) { return s != 0.0; }) ||
         std::any_of(shift.begin(), shift.end(), [](double s) { return s != 0.0; });
}

bool BeamModel::all_separate() const {
  return !joints.empty() && std::all_of(joints.begin(), joints.end(), [](Joint j) { return j == Joint::separate; });
}

void check(const BeamModel& model) {
  check_spans(model);
  require_positive(model.EI, "beam_EI", "N m2");
  if (model.axial) require_positive(model.EA, "beam_EA", "N");
  if (model.GA) check_shear(model);
  require_positive(model.mass, "beam_mass", "kg/m");
  for (const double value : {model.rotary_inertia.minimum(), model.rotary_inertia.maximum()})
    require_not_negative(value, "beam_rotary_inertia", "kg m");
  check_joints(model);
  check_cracks(model);
  check_divisions(model);
  check_strains(model);
  if (model.track) check_track(model);
  if (model.torsion) check_torsion(model);
  check_foundation(model.foundation, model.length());
}

}  // namespace traverse::beam
