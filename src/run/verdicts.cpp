#include "run/verdicts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace traverse::app {

using results::Finding;

/// One function for each quantity that a limit may be of.
struct Findings {
  const Judge& judge;
  const results::Summary& summary;
  const Peaks& peaks;

  Finding deck_acceleration() const {
    if (!summary.probes) return no_bridge();
    if (!summary.low_passed) return unknown("deck accelerations are not low-passed in this run");
    return at(summary.low_passed->extreme);
  }

  Finding unfiltered_deck_acceleration() const { return summary.probes ? at(summary.acceleration) : no_bridge(); }

  Finding deflection_over_span() const {
    if (!summary.probes) return no_bridge();
    Finding found{0.0, 0.0, "", ""};
    const std::vector<Peak>& each = peaks.largest_of_each(deflection);
    for (std::size_t p = 0; p < each.size(); ++p) {
      const double ratio = std::abs(each[p].value) / span_of(judge.scene_.output.probes[p]);
      if (p == 0 || ratio > found.value) found = {ratio, each[p].time, station(judge.scene_.output.probes[p]), ""};
    }
    return found;
  }

  Finding end_rotation() const {
    if (!judge.rotations_ || !judge.rotations_->at_ends().known()) return no_bridge();
    const Largest& largest = judge.rotations_->at_ends();
    return {largest.value, largest.time, station(largest.which == 0 ? 0.0 : judge.scene_.beam->length()), ""};
  }

  Finding joint_rotation() const {
    if (!judge.rotations_) return no_bridge();
    const Largest& largest = judge.rotations_->at_joints();
    if (!largest.known()) return unknown("no two decks meet at a joint");
    return {largest.value, largest.time, station(judge.rotations_->joints()[largest.which]), ""};
  }

  Finding car_acceleration() const {
    const Largest& largest = judge.cars_.largest();
    if (!largest.known()) return unknown("the scene has no vehicles");
    return {largest.value, largest.time, fmt::format("vehicle {}, {}", largest.which, judge.cars_.body(largest.which)),
            ""};
  }

  Finding wheel_unloading() const {
    const Largest& largest = judge.unloading_.largest();
    if (!largest.known()) return unknown("the scene has no wheels");
    if (judge.scene_.start == Start::given) return unknown("with scene_start given no wheel force at rest is known");
    return {largest.value, largest.time, wheel_name(largest.which), ""};
  }

  Finding contact_loss() const {
    if (summary.least_wheel.empty()) return unknown("the scene has no wheels");
    return {summary.longest_loss, std::numeric_limits<double>::quiet_NaN(), "", ""};
  }

  Finding amplification() const {
    if (!summary.probes) return no_bridge();
    if (summary.amplification <= 0.0) return unknown("the static deflection is not known");
    return {summary.amplification, summary.deflection.time, station(summary.deflection.place), ""};
  }

 private:
  static std::string station(double x) { return fmt::format("x = {:.6g} m", x); }
  static Finding at(const results::Extreme& extreme) {
    return {std::abs(extreme.value), extreme.time, station(extreme.place), ""};
  }
  static Finding unknown(const char* why) {
    Finding found;
    found.why = why;
    return found;
  }
  static Finding no_bridge() { return unknown("the scene has no bridge with probes"); }

  /// Of the span that holds x; at a support the shorter one.
  double span_of(double x) const {
    double left = 0.0, length = std::numeric_limits<double>::infinity();
    for (const double span : judge.scene_.beam->spans) {
      if (x >= left && x <= left + span) length = std::min(length, span);
      left += span;
    }
    return std::isfinite(length) ? length : judge.scene_.beam->spans.back();
  }

  std::string wheel_name(std::size_t wanted) const {
    std::size_t wheel = 0;
    for (std::size_t i = 0; i < judge.fleet_.wheels.size(); ++i) {
      const train::WheelContact& c = judge.fleet_.wheels[i];
      if (!c.is_further && wheel++ == wanted)
        return fmt::format("vehicle {}, {}", judge.fleet_.member(static_cast<int>(i)), judge.fleet_.wheel(c).name);
    }
    return "";
  }
};

namespace {

struct FindingRow {
  std::string_view quantity;
  Finding (Findings::*find)() const;
};

constexpr FindingRow finding_rows[] = {
    {"deck_acceleration", &Findings::deck_acceleration},
    {"unfiltered_deck_acceleration", &Findings::unfiltered_deck_acceleration},
    {"deflection_over_span", &Findings::deflection_over_span},
    {"end_rotation", &Findings::end_rotation},
    {"joint_rotation", &Findings::joint_rotation},
    {"car_acceleration", &Findings::car_acceleration},
    {"wheel_unloading", &Findings::wheel_unloading},
    {"contact_loss", &Findings::contact_loss},
    {"amplification", &Findings::amplification},
};

constexpr const FindingRow* row_of(std::string_view quantity) {
  for (const FindingRow& row : finding_rows)
    if (row.quantity == quantity) return &row;
  return nullptr;
}

static_assert(std::all_of(std::begin(options::limit_quantities), std::end(options::limit_quantities),
                          [](const options::LimitQuantity& row) { return row_of(row.name) != nullptr; }),
              "every quantity that a limit may be of has its line in finding_rows");

}  // namespace

Judge::Judge(const Scene& scene, const train::Fleet& fleet, const beam::Beam* beam)
    : scene_(scene), fleet_(fleet), cars_(fleet), unloading_(fleet.wheels.size()) {
  if (beam != nullptr) rotations_.emplace(*beam);
}

void Judge::sample(double t, const double* v) {
  if (rotations_) rotations_->add(t, v);
  cars_.add(t);
}

std::vector<results::Verdict> Judge::verdicts(const results::Summary& summary, const Peaks& peaks) const {
  const Findings findings{*this, summary, peaks};
  std::vector<results::Verdict> list;
  for (const options::VerdictLimit& limit : scene_.limits)
    list.push_back({limit, std::string(options::limit_quantity(limit.quantity)->unit),
                    (findings.*row_of(limit.quantity)->find)()});
  return list;
}

}  // namespace traverse::app
