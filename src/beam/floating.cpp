// Finds the motions of a beam that nothing, or only a spring, resists. A part between its ends and separate joints is a
// chain of rigid pieces between hinges; the deflections of the pieces' ends describe its motion.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "traverse/base/error.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::beam {
namespace {

constexpr double rounding = 10.0 * std::numeric_limits<double>::epsilon();  // of a sum of elements' stiffnesses
constexpr double rank_tolerance = 1e-10;  // relative to the largest pivot: below it conditions are linearly dependent

/// Neighbouring pieces that are one body or a chain of bodies.
struct Part {
  int first_end = 0, last_end = 0;  // span ends
  std::vector<double> x;            // stations of its ends and hinges
  double left() const { return x.front(); }
  double right() const { return x.back(); }
};

std::vector<Part> parts_of(const BeamModel& model) {
  std::vector<Part> parts;
  bool open = false;
  for (const Piece& piece : pieces_of(model)) {
    if (!open) parts.push_back({piece.span, piece.span, {piece.left}});
    Part& part = parts.back();
    part.last_end = piece.span + 1;
    open = piece.next != Joint::separate;
    if (piece.next == Joint::hinge || piece.next == Joint::separate) part.x.push_back(piece.right);
  }
  return parts;
}

/// The foundations that are included: none, those in the matrices, or all that may push.
enum class Springs { none, linear, all };

bool is_included(const FoundationLaw& law, Springs springs) {
  return springs == Springs::all || (springs == Springs::linear && !law.nonlinear());
}

/// Whether a point of the foundation is an included spring of this part.
bool is_spring_of(const PointFoundation& p, const Part& part, const BeamModel& model, Springs springs) {
  const bool after_left = p.x > part.left() || (p.x == part.left() && (!p.from_left || p.x == model.start));
  const bool before_right = p.x < part.right() || (p.x == part.right() && (p.from_left || p.x == model.end()));
  return is_included(p.law, springs) && (p.k > 0.0 || p.law.cubic > 0.0) && after_left && before_right;
}

/// The ranges of the part, between its hinges and the breaks of the bed, along which the bed has stiffness.
std::vector<std::pair<double, double>> bed_ranges(const Bed& bed, const Part& part, Springs springs) {
  std::vector<std::pair<double, double>> stretches;
  if (!is_included(bed.law, springs)) return stretches;
  for (std::size_t i = 1; i < part.x.size(); ++i) {
    auto ends = bed.k.breaks(part.x[i - 1], part.x[i]);
    ends.push_back(part.x[i]);
    double left = part.x[i - 1];
    for (double right : ends) {  // linear in between
      if (bed.law.cubic > 0.0 || bed.k.at(left, right) > 0.0 || bed.k.at(right, left) > 0.0)
        stretches.emplace_back(left, right);
      left = right;
    }
  }
  return stretches;
}

/// Linear combinations of the deflections at the part's stations x, and of the twist if the part twists, that must be
/// zero; each row has the coefficients of one.
class Conditions {
 public:
  Conditions(const Part& part, bool twists)
      : part_(part), stations_(static_cast<Eigen::Index>(part.x.size())), unknowns_(stations_ + (twists ? 1 : 0)) {}

  void add_zero_deflection(double x, double eccentricity = 0.0) {
    const Eigen::Index i = piece_of(x, false);
    const double xi = (x - part_.x[i]) / (part_.x[i + 1] - part_.x[i]);
    add(i, 1.0 - xi, xi);
    if (eccentricity != 0.0) rows_.back()[stations_] = eccentricity;
  }
  void add_zero_slope(double x, bool from_left) { add(piece_of(x, from_left), -1.0, 1.0); }
  void add_zero_twist() {
    rows_.emplace_back(Eigen::RowVectorXd::Zero(unknowns_));
    rows_.back()[stations_] = 1.0;
  }

  /// The motions that satisfy all conditions, one per column. A free body has a vertical motion and one about its
  /// middle.
  Eigen::MatrixXd motions() const {
    if (rows_.empty() && unknowns_ == 2) return Eigen::Matrix2d{{1.0, -1.0}, {1.0, 1.0}};
    if (rows_.empty()) return Eigen::MatrixXd::Identity(unknowns_, unknowns_);
    Eigen::MatrixXd A(static_cast<Eigen::Index>(rows_.size()), unknowns_);
    for (std::size_t i = 0; i < rows_.size(); ++i) A.row(static_cast<Eigen::Index>(i)) = rows_[i];
    Eigen::FullPivLU<Eigen::MatrixXd> lu(A);
    lu.setThreshold(rank_tolerance);
    return lu.rank() == unknowns_ ? Eigen::MatrixXd(unknowns_, 0) : Eigen::MatrixXd(lu.kernel());
  }

 private:
  Eigen::Index piece_of(double x, bool from_left) const {
    const auto& s = part_.x;
    const auto after = from_left ? std::lower_bound(s.begin(), s.end(), x) : std::upper_bound(s.begin(), s.end(), x);
    return std::clamp<Eigen::Index>(after - s.begin() - 1, 0, stations_ - 2);
  }
  void add(Eigen::Index i, double left, double right) {
    rows_.emplace_back(Eigen::RowVectorXd::Zero(unknowns_));
    rows_.back()[i] = left;
    rows_.back()[i + 1] = right;
  }

  const Part& part_;
  Eigen::Index stations_, unknowns_;
  std::vector<Eigen::RowVectorXd> rows_;
};

Conditions bending_conditions(const BeamModel& model, const Part& part, const std::vector<double>& span_ends,
                              Springs springs) {
  Conditions conditions(part, model.torsion.has_value());
  for (int end = part.first_end; end <= part.last_end; ++end) {
    const double x = span_ends[static_cast<std::size_t>(end)];
    if (fixes_vertical(model.supports[end])) conditions.add_zero_deflection(x);
    if (model.torsion && model.torsion->held[static_cast<std::size_t>(end)] != 0) conditions.add_zero_twist();
    if (!fixes_rotation(model.supports[end])) continue;
    conditions.add_zero_slope(x, false);
    conditions.add_zero_slope(x, true);
  }
  for_points(model.foundation, [&](const FoundationKind& kind, const std::vector<PointFoundation>& points) {
    for (const PointFoundation& p : points) {
      if (!is_spring_of(p, part, model, springs)) continue;
      if (kind.direction == Direction::vertical) conditions.add_zero_deflection(p.x, p.eccentricity);
      if (kind.direction == Direction::rotational) conditions.add_zero_slope(p.x, p.from_left);
    }
  });
  for_beds(model.foundation, [&](const FoundationKind& kind, const Bed& bed) {
    if (kind.direction == Direction::longitudinal) return;
    for (const auto& [left, right] : bed_ranges(bed, part, springs)) {
      if (kind.direction == Direction::vertical) conditions.add_zero_deflection(0.5 * (left + right));
      conditions.add_zero_slope(0.5 * (left + right), false);
    }
  });
  return conditions;
}

bool supported_axially(const BeamModel& model, const Part& part, Springs springs) {
  bool held = false;
  for_points(model.foundation, [&](const FoundationKind& kind, const std::vector<PointFoundation>& points) {
    if (kind.direction != Direction::longitudinal) return;
    for (const PointFoundation& p : points) held = held || is_spring_of(p, part, model, springs);
  });
  for_beds(model.foundation, [&](const FoundationKind& kind, const Bed& bed) {
    if (kind.direction == Direction::longitudinal) held = held || !bed_ranges(bed, part, springs).empty();
  });
  for (int end = part.first_end; end <= part.last_end; ++end) held = held || fixes_axial(model.supports[end]);
  return held;
}

std::vector<RigidMotion> bending_motions(const Part& part, const Conditions& conditions) {
  std::vector<RigidMotion> motions;
  const Eigen::MatrixXd basis = conditions.motions();
  for (Eigen::Index i = 0; i < basis.cols(); ++i) {
    const Eigen::VectorXd motion = basis.col(i) / basis.col(i).lpNorm<Eigen::Infinity>();
    const auto stations = static_cast<std::ptrdiff_t>(part.x.size());
    motions.push_back({part.left(), part.right(), false, part.x, {motion.begin(), motion.begin() + stations}});
    if (motion.size() > stations) motions.back().twist = motion[stations];
  }
  return motions;
}

RigidMotion along_x(const Part& part) {
  return {part.left(), part.right(), true, {part.left(), part.right()}, {1.0, 1.0}};
}

std::vector<double> ends_of(const BeamModel& model) {
  std::vector<double> ends{model.start};
  for (double span : model.spans) ends.push_back(ends.back() + span);
  return ends;
}

/// The description of the motions of one part; at least one motion is needed.
std::string describe(const std::vector<RigidMotion>& of_part) {
  const RigidMotion& m = of_part.front();
  if (std::ranges::any_of(of_part, [](const RigidMotion& one) { return std::abs(one.twist) > rank_tolerance; }))
    return "can twist (support_torsion)";
  if (m.axial) return "can move along x";
  if (m.x.size() > 2) return "can move with its hinges as a mechanism";
  if (of_part.size() > 1 && !of_part[1].axial) return "can move vertically and rotate";
  const double a = m.deflection[0], b = m.deflection[1];
  if (std::abs(a - b) <= rank_tolerance) return "can move vertically";
  char text[64];
  std::snprintf(text, sizeof text, "can rotate about x = %.6g m", m.x[0] + (m.x[1] - m.x[0]) * a / (a - b));
  return text;
}

std::size_t segment_of(const RigidMotion& m, double station, bool from_left) {
  const auto after =
      from_left ? std::lower_bound(m.x.begin(), m.x.end(), station) : std::upper_bound(m.x.begin(), m.x.end(), station);
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after - m.x.begin() - 1, 0, std::ssize(m.x) - 2));
}

std::vector<RigidMotion> motions_of(const BeamModel& model, Springs springs) {
  std::vector<RigidMotion> motions;
  if (model.track) return motions;
  const auto span_ends = ends_of(model);
  const auto parts = parts_of(model);
  for (const Part& part : parts) {
    for (RigidMotion& m : bending_motions(part, bending_conditions(model, part, span_ends, springs)))
      motions.push_back(std::move(m));
    // With several parts, one that nothing holds along x has a bearing.
    const bool has_bearing = parts.size() > 1 && !supported_axially(model, part, Springs::all);
    if (model.axial && !has_bearing && !supported_axially(model, part, springs)) motions.push_back(along_x(part));
  }
  return motions;
}

/// Calls use(kind, spring, x, from_left, k in N/m or N m/rad) for all linear springs of a part; a bed is three springs
/// in each range, by Simpson's rule.
template <class Use>
void for_springs(const BeamModel& model, const Part& part, Use use) {
  for_points(model.foundation, [&](const FoundationKind& kind, const std::vector<PointFoundation>& points) {
    for (const PointFoundation& p : points)
      if (is_spring_of(p, part, model, Springs::linear)) use(kind, p, p.x, p.from_left, p.k);
  });
  for_beds(model.foundation, [&](const FoundationKind& kind, const Bed& bed) {
    for (const auto& [left, right] : bed_ranges(bed, part, Springs::linear)) {
      const double middle = 0.5 * (left + right), sixth = (right - left) / 6.0;
      for (const auto& [x, weight] : {std::pair(left, 1.0), {middle, 4.0}, {right, 1.0}})
        use(kind, bed, x, x == right, weight * sixth * bed.k.at(x, middle));
    }
  });
}

double eccentricity_of(const PointFoundation& point) { return point.eccentricity; }
double eccentricity_of(const Bed&) { return 0.0; }

/// The motions of a part without springs, `all`, of which springs resist all but `free`.
struct HeldMotions {
  std::vector<RigidMotion> all;
  std::size_t free = 0;
};

/// The least stiffness by which springs resist a held motion, N/m at its largest displacement.
double least_stiffness(const BeamModel& model, const Part& part, const HeldMotions& held) {
  const auto n = static_cast<Eigen::Index>(held.all.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  for_springs(model, part, [&](const FoundationKind& kind, const auto& spring, double x, bool from_left, double k) {
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const RigidMotion& motion = held.all[static_cast<std::size_t>(i)];
      if (motion.axial != (kind.direction == Direction::longitudinal)) continue;
      displacement[i] = kind.direction == Direction::rotational
                            ? motion.slope(x, from_left)
                            : motion.value(x) + eccentricity_of(spring) * motion.twist;
    }
    K += k * displacement * displacement.transpose();
  });
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K, Eigen::EigenvaluesOnly)
      .eigenvalues()[static_cast<Eigen::Index>(held.free)];
}

/// Throws InputError if rounding of the elements' stiffness, N/m, hides the springs that hold these motions.
void check_held(const BeamModel& model, const Part& part, const HeldMotions& held, double element) {
  if (held.all.size() <= held.free) return;
  const double stiffness = least_stiffness(model, part, held), least = rounding * element;
  if (stiffness >= least) return;
  std::set<std::string> options;
  for_springs(model, part, [&](const FoundationKind& kind, const auto& spring, double, bool, double) {
    if (held.all.front().axial == (kind.direction == Direction::longitudinal))
      options.insert(stiffness_option(kind, spring));
  });
  throw InputError(fmt::format(
      "{}: the beam is held by {:.3g} N/m only, which rounding hides beside the {:.3g} N/m of its elements; allowed: "
      "above {:.2g} N/m, a support (support_types), or fewer beam_elements_per_span",
      fmt::join(options, ", "), stiffness, element, least));
}

/// The length of the shortest element by beam_elements_per_span, m.
double shortest_element(const BeamModel& model) {
  double shortest = model.length();
  for (std::size_t i = 0; i < model.spans.size(); ++i)
    shortest = std::min(shortest, model.spans[i] / std::max(1, model.elements[i]));
  return shortest;
}

}  // namespace

void check_springs(const BeamModel& model) {
  if (model.track) return;
  const double h = shortest_element(model), shear = model.GA ? h / model.GA->maximum() : 0.0;
  const double bending = 1.0 / (std::pow(h, 3) / (12.0 * model.EI.maximum()) + shear);
  const auto span_ends = ends_of(model);
  for (const Part& part : parts_of(model)) {
    const auto bending_of = [&](Springs springs) {
      return bending_motions(part, bending_conditions(model, part, span_ends, springs));
    };
    check_held(model, part, {bending_of(Springs::none), bending_of(Springs::linear).size()}, bending);
    if (model.axial && supported_axially(model, part, Springs::linear) &&
        !supported_axially(model, part, Springs::none))
      check_held(model, part, {{along_x(part)}, 0}, model.EA.maximum() / h);
  }
}

double RigidMotion::slope(double station, bool from_left) const {
  const std::size_t i = segment_of(*this, station, from_left);
  return (deflection[i + 1] - deflection[i]) / (x[i + 1] - x[i]);
}

double RigidMotion::value(double station) const {
  const std::size_t i = segment_of(*this, station, false);
  return deflection[i] + (station - x[i]) * slope(station, false);
}

std::vector<char> axial_bearings(const BeamModel& model) {
  std::vector<char> needed(model.spans.size(), 0);
  if (!model.axial || model.track) return needed;
  const auto parts = parts_of(model);
  for (const Part& part : parts) {
    if (parts.size() > 1) needed[part.first_end] = supported_axially(model, part, Springs::all) ? 0 : 1;
  }
  return needed;
}

std::vector<RigidMotion> rigid_motions(const BeamModel& model) { return motions_of(model, Springs::linear); }

std::string floating_motion(const BeamModel& model) {
  const auto motions = motions_of(model, Springs::all);
  if (motions.empty()) return {};
  const double left = motions.front().left;
  std::vector<RigidMotion> of_part;
  for (const RigidMotion& m : motions) {
    if (m.left == left) of_part.push_back(m);
  }
  const auto parts = parts_of(model);
  const Part& part = *std::find_if(parts.begin(), parts.end(), [&](const Part& p) { return p.left() == left; });
  std::string name = "the beam ";
  if (parts.size() > 1) {
    name = "span " + std::to_string(part.first_end + 1) + " ";
    if (part.last_end > part.first_end + 1)
      name = "spans " + std::to_string(part.first_end + 1) + " to " + std::to_string(part.last_end) + " ";
  }
  return name + describe(of_part);
}

}  // namespace traverse::beam
