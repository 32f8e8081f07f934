#include "traverse/beam/model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>

#include "check_track.hpp"
#include "traverse/base/error.hpp"

namespace traverse::beam {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

void require(bool holds, const std::string& option, const std::string& value, const std::string& allowed) {
  if (!holds) throw InputError(option + " is " + value + "; " + allowed);
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
  // Unknowns are counted in 32 bits, here and in PETSc.
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
    }
  });
  for_beds(foundation, [&](const FoundationKind& kind, const Bed& bed) {
    const std::string option = "foundation_" + std::string(kind.name);
    const FoundationUnits units = units_of(kind);
    for (double value : {bed.k.minimum(), bed.k.maximum()})
      require_not_negative(value, option + "_k", std::string(units.k));
    for (double value : {bed.c.minimum(), bed.c.maximum()})
      require_not_negative(value, option + "_c", std::string(units.c));
    check_law(bed.law, option, units);
  });
}

void check_joints(const BeamModel& model) {
  const std::size_t inner = model.spans.size() - 1;
  require(model.joints.size() <= 1 || model.joints.size() == inner, "beam_continuity",
          std::to_string(model.joints.size()) + " joints",
          "one for all or one at every inner span end is needed: " + std::to_string(inner));
  double before = model.start;
  for (double x : model.hinges) {
    require(std::isfinite(x) && x > before && x < model.end(), "beam_hinges", number(x),
            "hinges lie within the beam, from left to right");
    before = x;
  }
}

}  // namespace

bool fixes_axial(Support s) { return s == Support::pinned || s == Support::clamped || s == Support::guided; }
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
  if (linear.track) linear.track->gaps_stay_open = true;
  return linear;
}

bool BeamModel::all_separate() const {
  return !joints.empty() && std::all_of(joints.begin(), joints.end(), [](Joint j) { return j == Joint::separate; });
}

void check(const BeamModel& model) {
  check_spans(model);
  require_positive(model.EI, "beam_EI", "N m2");
  if (model.axial) require_positive(model.EA, "beam_EA", "N");
  require_positive(model.mass, "beam_mass", "kg/m");
  check_joints(model);
  if (model.track) check_track(model);  // check_track.cpp
  check_foundation(model.foundation, model.length());
}

}  // namespace traverse::beam
