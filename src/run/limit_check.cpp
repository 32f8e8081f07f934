// One function for each quantity of a limit, listed in a table by its name. It returns the extreme with time and place,
// or the reason why it is unknown. Also rotations of the nodes at the bridge's ends and at joints between decks, and
// vertical accelerations of the heaviest body of every vehicle.
#include "run/limit_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>

namespace traverse::run {

using results::EvaluatedQuantity;

/// One function for each quantity that may have a limit.
struct Quantities {
  const LimitCheck& check;
  const results::Summary& summary;
  std::span<const Extreme> deflections;  // largest deflection at each probe

  EvaluatedQuantity deck_acceleration() const {
    if (!summary.probes) return no_bridge();
    if (!summary.low_passed) return unknown("deck accelerations are not low-passed in this run");
    return at(summary.low_passed->extreme);
  }

  EvaluatedQuantity unfiltered_deck_acceleration() const {
    return summary.probes ? at(summary.acceleration) : no_bridge();
  }

  EvaluatedQuantity deflection_over_span() const {
    if (!summary.probes) return no_bridge();
    EvaluatedQuantity found;
    for (std::size_t p = 0; p < deflections.size(); ++p) {
      const double ratio = std::abs(deflections[p].value) / span_of(check.scene_.output.probes[p]);
      if (p == 0 || ratio > found.value) found = at(ratio, deflections[p].time, check.scene_.output.probes[p]);
    }
    return found;
  }

  EvaluatedQuantity end_rotation() const {
    if (!check.rotations_ || check.rotations_->at_ends().value < 0.0) return no_bridge();
    const Extreme& largest = check.rotations_->at_ends();
    return at(largest.value, largest.time, largest.place == 0 ? 0.0 : check.scene_.beam->length());
  }

  EvaluatedQuantity joint_rotation() const {
    if (!check.rotations_) return no_bridge();
    const Extreme& largest = check.rotations_->at_joints();
    if (largest.value < 0.0) return unknown("no two decks meet at a joint");
    return at(largest.value, largest.time, check.rotations_->joints()[largest.place]);
  }

  EvaluatedQuantity track_twist() const {
    if (check.twist_.value < 0.0) return unknown("the beam does not twist (beam_GJ)");
    return at(check.twist_.value, check.twist_.time, check.scene_.output.probes[check.twist_.place]);
  }

  EvaluatedQuantity bearing_uplift() const {
    if (check.uplift_.value < 0.0) return unknown("no support has two bearings (support_bearing_spacing)");
    const std::vector<double>& spans = check.scene_.beam->spans;
    const auto before = spans.begin() + static_cast<std::ptrdiff_t>(check.uplift_.place);
    return at(check.uplift_.value, check.uplift_.time, std::accumulate(spans.begin(), before, 0.0));
  }

  EvaluatedQuantity car_acceleration() const {
    const Extreme& largest = check.cars_.largest();
    if (largest.value < 0.0) return unknown("the scene has no vehicles");
    return of(largest, fmt::format("vehicle {}, {}", largest.place, check.cars_.body(largest.place)));
  }

  EvaluatedQuantity wheel_unloading() const {
    if (!summary.unloading) return no_wheels();
    return {summary.unloading->value, summary.unloading->time, EvaluatedQuantity::unknown, summary.unloading->wheel,
            ""};
  }

  EvaluatedQuantity filtered_wheel_unloading() const {
    if (!summary.filtered_unloading) return not_filtered();
    const results::Unloading& found = summary.filtered_unloading->extreme;
    return {found.value, found.time, EvaluatedQuantity::unknown, found.wheel, ""};
  }

  EvaluatedQuantity unloading_time() const {
    if (!summary.filtered_unloading) return not_filtered();
    const results::FilteredUnloading& found = *summary.filtered_unloading;
    const double from = found.longest > 0.0 ? found.longest_from : EvaluatedQuantity::unknown;
    return {found.longest, from, EvaluatedQuantity::unknown, found.longest_wheel, ""};
  }

  EvaluatedQuantity contact_loss() const {
    if (summary.least_wheel.empty()) return unknown("the scene has no wheels");
    return of({summary.longest_loss, EvaluatedQuantity::unknown, 0}, "");
  }

  EvaluatedQuantity amplification() const {
    if (!summary.probes) return no_bridge();
    if (summary.amplification <= 0.0) return unknown("the static deflection is not known");
    return at(summary.amplification, summary.deflection.time, summary.deflection.place);
  }

  /// Evaluated by norm::NormCheck, if there is one.
  EvaluatedQuantity of_norm() const { return unknown("static effects of EN 1991-2 are not computed here"); }
  EvaluatedQuantity of_rail() const { return unknown("scene_analysis rail finds it"); }

 private:
  static EvaluatedQuantity at(double value, double time, double x) { return {value, time, x, "", ""}; }
  static EvaluatedQuantity at(const results::Extreme& extreme) {
    return at(std::abs(extreme.value), extreme.time, extreme.place);
  }
  static EvaluatedQuantity of(const Extreme& largest, const std::string& thing) {
    return {largest.value, largest.time, EvaluatedQuantity::unknown, thing, ""};
  }
  static EvaluatedQuantity unknown(const char* why) {
    EvaluatedQuantity found;
    found.why = why;
    return found;
  }
  EvaluatedQuantity no_wheels() const {
    return unknown(check.scene_.start == scene::Start::given ? "with scene_start given no wheel force at rest is known"
                                                             : "the scene has no wheels");
  }
  EvaluatedQuantity not_filtered() const {
    return summary.unloading ? unknown("wheel forces are not low-passed in this run") : no_wheels();
  }
  static EvaluatedQuantity no_bridge() { return unknown("the scene has no bridge with probes"); }

  /// The length of the span that contains x; at a support the shorter one.
  double span_of(double x) const {
    double start = 0.0, length = std::numeric_limits<double>::infinity();
    for (const double span : check.scene_.beam->spans) {
      if (x >= start && x <= start + span) length = std::min(length, span);
      start += span;
    }
    return std::isfinite(length) ? length : check.scene_.beam->spans.back();
  }
};

namespace {

struct QuantityRow {
  std::string_view quantity;
  EvaluatedQuantity (Quantities::*evaluate)() const;
};

constexpr QuantityRow quantity_rows[] = {
    {"deck_acceleration", &Quantities::deck_acceleration},
    {"unfiltered_deck_acceleration", &Quantities::unfiltered_deck_acceleration},
    {"deflection_over_span", &Quantities::deflection_over_span},
    {"end_rotation", &Quantities::end_rotation},
    {"joint_rotation", &Quantities::joint_rotation},
    {"track_twist", &Quantities::track_twist},
    {"bearing_uplift", &Quantities::bearing_uplift},
    {"car_acceleration", &Quantities::car_acceleration},
    {"wheel_unloading", &Quantities::wheel_unloading},
    {"filtered_wheel_unloading", &Quantities::filtered_wheel_unloading},
    {"unloading_time", &Quantities::unloading_time},
    {"contact_loss", &Quantities::contact_loss},
    {"amplification", &Quantities::amplification},
    {"lm71_deflection_over_span", &Quantities::of_norm},
    {"lm71_end_rotation", &Quantities::of_norm},
    {"lm71_joint_rotation", &Quantities::of_norm},
    {"lm71_track_twist", &Quantities::of_norm},
    {"train_over_lm71", &Quantities::of_norm},
    {"rail_tension", &Quantities::of_rail},
    {"rail_compression", &Quantities::of_rail},
    {"rail_slip", &Quantities::of_rail},
    {"deck_displacement", &Quantities::of_rail},
    {"deck_end_displacement", &Quantities::of_rail},
    {"rail_device_opening", &Quantities::of_rail},
};

constexpr const QuantityRow* row_of(std::string_view quantity) {
  for (const QuantityRow& row : quantity_rows)
    if (row.quantity == quantity) return &row;
  return nullptr;
}

static_assert(std::all_of(std::begin(options::limit_quantities), std::end(options::limit_quantities),
                          [](const options::LimitQuantity& row) { return row_of(row.name) != nullptr; }),
              "every quantity that a limit may be of has its line in quantity_rows");

constexpr int rotation = 2, rotation_right = 3;  // unknowns of a node

}  // namespace

LimitCheck::LimitCheck(const scene::Scene& scene, const train::Fleet& fleet, const beam::Beam* beam)
    : scene_(scene), fleet_(fleet), cars_(fleet) {
  if (beam != nullptr) rotations_.emplace(*beam);
  if (beam != nullptr && beam->model().torsion) torsion_ = &*beam->model().torsion;
}

void LimitCheck::sample(double t, const double* v, std::span<const beam::Reaction> supports) {
  if (rotations_) rotations_->add(t, v);
  cars_.add(t);
  if (torsion_ == nullptr) return;
  for (std::size_t end = 0; end < torsion_->bearing_spacing.size() && end < supports.size(); ++end) {
    if (torsion_->held[end] == 0 || torsion_->bearing_spacing[end] == 0.0) continue;
    const auto [left, right] = beam::bearing_forces(*torsion_, end, supports[end]);
    uplift_.raise(std::max(0.0, -std::min(left, right)), t, end);
  }
}

std::vector<results::Verdict> LimitCheck::verdicts(const results::Summary& summary, const ResponseExtremes& peaks) {
  const Extreme& twist = peaks.largest(twist_of_track);
  if (torsion_ != nullptr) twist_.raise(std::abs(twist.value), twist.time, twist.place);
  return verdicts(summary, peaks.largest_of_each(deflection));
}

std::vector<results::Verdict> LimitCheck::verdicts(const results::Summary& summary,
                                                   std::span<const Extreme> deflections) const {
  const Quantities quantities{*this, summary, deflections};
  std::vector<results::Verdict> list;
  for (const options::VerdictLimit& limit : scene_.limits) {
    EvaluatedQuantity found = (quantities.*row_of(limit.quantity)->evaluate)();
    found.value *= limit.factor;
    list.push_back({limit, std::string(options::limit_quantity(limit.quantity)->unit), std::move(found), 1, 0});
  }
  return list;
}

std::vector<results::EvaluatedQuantity> LimitCheck::evaluate(results::Summary summary,
                                                             std::span<const base::ProbePeaks> peaks,
                                                             std::span<const double> static_deflection) const {
  summary.probes = !peaks.empty();
  std::vector<Extreme> deflections;
  for (std::size_t p = 0; p < peaks.size(); ++p) {
    const auto record_largest = [&](const Extreme& peak, results::Extreme& largest) {
      if (peak.value <= largest.value) return false;
      largest = {peak.value, peak.time, scene_.output.probes[p]};
      return true;
    };
    deflections.push_back({peaks[p].deflection.value, peaks[p].deflection.time, p});
    record_largest(peaks[p].acceleration, summary.acceleration);
    if (record_largest(peaks[p].deflection, summary.deflection))
      summary.amplification = static_deflection[p] > 0.0 ? peaks[p].deflection.value / static_deflection[p] : 0.0;
  }
  std::vector<EvaluatedQuantity> evaluated;
  for (const results::Verdict& verdict : verdicts(summary, deflections)) evaluated.push_back(verdict.found);
  return evaluated;
}

DeckRotations::DeckRotations(const beam::Beam& beam) : beam_(beam) {
  const beam::Line& line = beam.bridge();
  const beam::Mesh& mesh = line.mesh;
  unknowns_ = {line.unknown(0, rotation), line.unknown(mesh.nodes() - 1, rotation)};
  for (int i = 1; i < mesh.spans(); ++i) {
    const auto [left, right] = mesh.nodes_at(i);
    if (left == right && !mesh.hinged(left)) continue;
    unknowns_.push_back(line.unknown(left, rotation));
    unknowns_.push_back(line.unknown(right, left == right ? rotation_right : rotation));
    x_.push_back(mesh.span_ends()[static_cast<std::size_t>(i)]);
  }
  slopes_.resize(unknowns_.size());
}

std::vector<std::pair<int, int>> DeckRotations::differences() const {
  std::vector<std::pair<int, int>> all;
  for (std::size_t i = 0; i < ends; ++i) all.emplace_back(unknowns_[i], -1);
  for (std::size_t i = ends; i < unknowns_.size(); i += 2) all.emplace_back(unknowns_[i], unknowns_[i + 1]);
  return all;
}

void DeckRotations::add(double t, const double* v) {
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const int local = beam_.local(unknowns_[i]);
    slopes_[i] = local >= 0 ? v[local] : 0.0;
  }
  MPI_Allreduce(MPI_IN_PLACE, slopes_.data(), static_cast<int>(slopes_.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
  record(t, slopes_);
}

CarAccelerations::CarAccelerations(const train::Fleet& fleet) : fleet_(fleet) {
  for (const train::Member& member : fleet.members) {
    const std::vector<multibody::Body>& bodies = member.type->mechanism.bodies;
    const auto lighter = [](const multibody::Body& a, const multibody::Body& b) { return a.mass < b.mass; };
    const auto heaviest = std::max_element(bodies.begin(), bodies.end(), lighter) - bodies.begin();
    bodies_.emplace_back(static_cast<std::size_t>(member.unit), member.first_body + heaviest);
  }
}

void CarAccelerations::add(double t) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const auto [vehicle, body] = bodies_[i];
    largest_.raise(std::abs(fleet_.vehicles[vehicle].state.qdd[3 * body + 1]), t, i);
  }
}

const std::string& CarAccelerations::body(std::size_t vehicle) const {
  const train::Member& member = fleet_.members[vehicle];
  return member.type->mechanism.bodies[static_cast<std::size_t>(bodies_[vehicle].second - member.first_body)].name;
}

}  // namespace traverse::run
