// Lists the events in order and adds the modal forces of the axles by recursion from event to event.
#include "screen/train_events.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace traverse::screen {
namespace {

using Complex = std::complex<double>;

constexpr double same_place = 1e-9;  // m

}  // namespace

void TrainEvents::set(const BridgeModel& model, const Formation& formation) {
  modes_ = model.modes().size();
  list_events(model, formation);
  find_gaps();
  sums_.assign(count() * modes_, {});
  for (std::size_t mode = 0; mode < modes_; ++mode) {
    add_up(model, mode);
    set_bounds(model.modes()[mode].beta, mode);
  }
}

void TrainEvents::list_events(const BridgeModel& model, const Formation& formation) {
  events_.clear();
  for (std::size_t k = 0; k < formation.loads.size(); ++k)
    for (std::size_t j = 0; j < model.supports().size(); ++j)
      events_.push_back({formation.distance[k] + model.supports()[j], static_cast<int>(j), formation.loads[k]});
  std::sort(events_.begin(), events_.end(), [](const Event& a, const Event& b) {
    return a.place != b.place ? a.place < b.place : a.support < b.support;
  });
  load_.clear();
  support_.clear();
  length_.clear();
  for (std::size_t i = 0; i < events_.size(); ++i) {
    load_.push_back(events_[i].load);
    support_.push_back(events_[i].support);
    length_.push_back(i + 1 < events_.size() ? events_[i + 1].place - events_[i].place : 0.0);
  }
}

void TrainEvents::find_gaps() {
  gaps_.clear();
  for (const double length : length_)
    if (length > same_place) gaps_.push_back(length);
  std::sort(gaps_.begin(), gaps_.end());
  gaps_.erase(std::unique(gaps_.begin(), gaps_.end(), [](double a, double b) { return b - a < same_place; }),
              gaps_.end());
  gap_.clear();
  for (const double length : length_) {
    const auto next = std::upper_bound(gaps_.begin(), gaps_.end(), length + same_place);
    gap_.push_back(length > same_place ? static_cast<int>(next - gaps_.begin()) - 1 : -1);
  }
}

/// The harmonic and the falling sums from the first event on, the rising ones from the last event back: rounding errors
/// never grow.
void TrainEvents::add_up(const BridgeModel& model, std::size_t mode) {
  const ModeOfBridge& own = model.modes()[mode];
  const std::vector<double>& spans = model.bridge().spans;
  const int last = static_cast<int>(spans.size());
  const auto shape = [&](int j) { return own.shape[static_cast<std::size_t>(j)]; };
  const auto phase = [&](int j) { return own.beta * spans[static_cast<std::size_t>(j)]; };
  Complex E = 0.0;
  double falling = 0.0, rising = 0.0;
  std::vector<Complex> turns;
  for (const double gap : gaps_) turns.push_back(std::polar(1.0, own.beta * gap));
  for (std::size_t i = 0; i < count(); ++i) {
    const int j = support_[i];
    if (j > 0) {
      E -= load_[i] * Complex(shape(j - 1).b, -shape(j - 1).a) * std::polar(1.0, phase(j - 1));
      falling -= load_[i] * shape(j - 1).c * std::exp(-phase(j - 1));
    }
    if (j < last) {
      E += load_[i] * Complex(shape(j).b, -shape(j).a);
      falling += load_[i] * shape(j).c;
    }
    ModeSums& sums = sums_[i * modes_ + mode];
    sums.E_real = E.real();
    sums.E_imag = E.imag();
    sums.falling = falling;
    if (gap_[i] < 0) continue;
    E *= turns[static_cast<std::size_t>(gap_[i])];
    if (model.continuous()) falling *= std::exp(-own.beta * length_[i]);
  }
  if (!model.continuous()) return;
  for (std::size_t i = count(); i-- > 0;) {
    rising *= std::exp(-own.beta * length_[i]);
    sums_[i * modes_ + mode].rising = rising;
    const int j = support_[i];  // backward the axle enters the span before the support
    if (j < last) rising -= load_[i] * shape(j).d * std::exp(-phase(j));
    if (j > 0) rising += load_[i] * shape(j - 1).d;
  }
}

void TrainEvents::set_bounds(double beta, std::size_t mode) {
  for (std::size_t i = 0; i + 1 < count(); ++i) {
    ModeSums& sums = sums_[i * modes_ + mode];
    const double angle = beta * length_[i];
    const Complex E(sums.E_real, sums.E_imag), end = E * std::polar(1.0, angle);
    sums.amplitude = std::abs(E);
    const bool crest = angle >= std::numbers::pi || E.imag() * end.imag() <= 0.0;
    sums.harmonic = crest ? sums.amplitude : std::max(std::abs(E.real()), std::abs(end.real()));
    const double fall = std::max(std::exp(-angle), 1e-300), falling = sums.falling * fall, rising = sums.rising / fall;
    sums.ends = std::max(std::abs(sums.falling + sums.rising), std::abs(falling + rising));
    sums.ends_amplitude =
        std::max(std::abs(sums.falling) + std::abs(sums.rising), std::abs(falling) + std::abs(rising));
  }
}

}  // namespace traverse::screen
