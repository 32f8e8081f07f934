// The contacts of a crossing over spans: where wheels are, and which forces agree with how vehicles and spans yield.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "beam/shape.hpp"
#include "lanes/span_crossing.hpp"

namespace traverse::lanes {

namespace {

using Numbers = Eigen::Map<const Eigen::VectorXd>;

}  // namespace

// The wheels' heights over the bridge as it stands.
void SpanCrossing::start_wheels() {
  place(0.0);
  lean_at(q_);
  for (std::size_t j = 0; j < wheels_.size(); ++j) {
    Wheel& wheel = wheels_[j];
    const double lean2 = wheel.lean * wheel.lean;
    wheel.delta = wheel.end = train_.penetration[j] * (1.0 + 0.5 * lean2);
    wheel.offset = wheel.delta - 0.5 * train_.radius * lean2 - surface(j, q_);
    law(j, wheel.delta);
    show(j);
  }
  given_[0] = given_now(0);
}

void SpanCrossing::show(std::size_t j) {
  const Wheel& wheel = wheels_[j];
  shown_[j] = {wheel.force * (1.0 + 0.5 * wheel.lean * wheel.lean), wheel.span, wheel.element, wheel.xi};
}

void SpanCrossing::place(double gone) {
  for (std::size_t j = 0; j < wheels_.size(); ++j) place_wheel(j, train_.x[j] + gone);
}

// On a span the shapes' values and slopes under the wheel.
void SpanCrossing::place_wheel(std::size_t j, double x) {
  Wheel& wheel = wheels_[j];
  const int spans = static_cast<int>(plan_.spans.size());
  if (x < plan_.spans.front().x || x > plan_.spans.back().end) {
    wheel.span = -1;
    return;
  }
  int s = std::clamp(wheel.span < 0 ? first_ : wheel.span, 0, spans - 1);
  while (s > 0 && x < plan_.spans[static_cast<std::size_t>(s)].x) --s;
  while (s + 1 < spans && x >= plan_.spans[static_cast<std::size_t>(s)].end) ++s;
  wheel.span = s;
  const SpanKind& of = kind(s);
  const double along = (x - plan_.spans[static_cast<std::size_t>(s)].x) / of.length;
  wheel.element = std::clamp(static_cast<int>(along), 0, of.elements - 1);
  wheel.xi = std::clamp(along - wheel.element, 0.0, 1.0);
  const beam::Hermite psi = beam::hermite(wheel.xi, of.length);
  const int modes = of.modes();
  const double* shape = of.shape.data() + static_cast<std::ptrdiff_t>(2 * wheel.element) * modes;
  double *phi = phi_.data() + j * static_cast<std::size_t>(stride_),
         *rise = phi_slope_.data() + j * static_cast<std::size_t>(stride_);
  for (int i = 0; i < modes; ++i) {
    const double y0 = shape[i], y1 = shape[modes + i], y2 = shape[2 * modes + i], y3 = shape[3 * modes + i];
    phi[i] = psi.value[0] * y0 + psi.value[1] * y1 + psi.value[2] * y2 + psi.value[3] * y3;
    rise[i] = psi.slope[0] * y0 + psi.slope[1] * y1 + psi.slope[2] * y2 + psi.slope[3] * y3;
  }
}

double SpanCrossing::surface(std::size_t j, const std::vector<double>& q) const {
  const int span = wheels_[j].span;
  if (span < 0) return 0.0;
  const int modes = kind(span).modes();
  return Numbers(phi_.data() + j * static_cast<std::size_t>(stride_), modes).dot(Numbers(at(q, span), modes));
}

// The slopes of the surface under the wheels, which contacts' normals follow.
void SpanCrossing::lean_at(const std::vector<double>& q) {
  for (std::size_t j = 0; j < wheels_.size(); ++j) {
    Wheel& wheel = wheels_[j];
    wheel.lean = 0.0;
    if (wheel.span < 0) continue;
    const int modes = kind(wheel.span).modes();
    wheel.lean = Numbers(phi_slope_.data() + j * static_cast<std::size_t>(stride_), modes)
                     .dot(Numbers(at(q, wheel.span), modes));
  }
}

// Forces as they are expected, and the slopes of the bridge under them, which hardly change with what is found.
void SpanCrossing::guess_forces(std::size_t stage) {
  const double ahead = h_before_ > 0.0 ? method_.stages[stage].time / h_before_ : 0.0;
  const auto stride = static_cast<std::ptrdiff_t>(stride_);
  std::vector<double>& expected = b_[stage + 1];  // of the modes; the accelerations come later
  std::copy(z_.begin() + first_ * stride, z_.begin() + past_ * stride, expected.begin() + first_ * stride);
  for (std::size_t j = 0; j < wheels_.size(); ++j) {
    Wheel& wheel = wheels_[j];
    wheel.delta = std::max(wheel.end + ahead * wheel.slope, 0.5 * wheel.end);
    law(j, wheel.delta);
    if (wheel.span < 0) continue;
    const int modes = kind(wheel.span).modes();
    const double* yields = S_inverse_[plan_.spans[static_cast<std::size_t>(wheel.span)].kind].data();
    const double* phi = &phi_[j * static_cast<std::size_t>(stride_)];
    double* q = at(expected, wheel.span);
    for (int m = 0; m < modes; ++m) q[m] -= yields[m] * phi[m] * wheel.force;
  }
  lean_at(expected);
}

// The shapes where wheels touch: they have moved along the track, and on a slope they touch ahead of their centres,
// where that is higher.
void SpanCrossing::touch_ahead(const std::vector<double>& modes_at) {
  for (std::size_t j = 0; j < wheels_.size(); ++j) {
    Wheel& wheel = wheels_[j];
    if (wheel.span < 0) continue;
    const std::size_t row = j * static_cast<std::size_t>(stride_);
    const double ahead = train_.arm[j] * wheel.lean + wheel.along;
    const double* yields = S_inverse_[plan_.spans[static_cast<std::size_t>(wheel.span)].kind].data();
    for (int m = 0; m < kind(wheel.span).modes(); ++m) {
      const std::size_t at = row + static_cast<std::size_t>(m);
      phi_[at] += ahead * phi_slope_[at];
      scaled_[at] = yields[m] * phi_[at];
    }
    wheel.free += surface(j, modes_at) - 0.5 * train_.radius * wheel.lean * wheel.lean;
  }
}

/// The vertical force at a vertical penetration delta: on a slope cos and 1/cos of those along the normal.
void SpanCrossing::law(std::size_t j, double delta) {
  Wheel& wheel = wheels_[j];
  const bool hertz = train_.hertz[j] != 0;
  const double k = train_.stiffness[j] * (1.0 - (hertz ? 1.25 : 1.0) * wheel.lean * wheel.lean);
  delta = std::max(delta, least_penetration);
  wheel.k = hertz ? 1.5 * k * std::sqrt(delta) : k;
  wheel.force = hertz ? k * delta * std::sqrt(delta) : k * delta;
}

// How forces on the wheels move them: H of the vehicles, and the spans' compliance; with that of the contacts, 1/k.
void SpanCrossing::fill_forces() {
  const auto count = static_cast<int>(wheels_.size());
  int band = 0;
  for (const TrainNumbers::Vehicle& vehicle : train_.vehicles)
    band = std::max(band, train_.kinds[vehicle.kind].wheels - 1);
  for (int i = 0, first = 0; i < count; ++i) {  // wheels on one span follow each other, vehicle by vehicle
    while (!share_span(first, i)) ++first;
    band = std::max(band, i - first);
  }
  forces_.set_zero(count, band);
  for (const Group& group : groups_)
    for (const int v : group.vehicle) {
      const int first = train_.vehicles[static_cast<std::size_t>(v)].first_wheel, w = group.numbers->wheels;
      for (int i = 0; i < w; ++i)
        for (int j = 0; j <= i; ++j) forces_.at(first + i, first + j) = group.H[static_cast<std::size_t>(i * w + j)];
    }
  for (int i = 0; i < count; ++i) {
    const auto row = static_cast<std::size_t>(i) * static_cast<std::size_t>(stride_);
    const int span = wheels_[static_cast<std::size_t>(i)].span;
    yield_[static_cast<std::size_t>(i)] = 1.0 / wheels_[static_cast<std::size_t>(i)].k;
    forces_.at(i, i) += yield_[static_cast<std::size_t>(i)];
    if (span < 0) continue;
    const int modes = kind(span).modes();
    for (int j = std::max(0, i - forces_.band()); j <= i; ++j)
      if (wheels_[static_cast<std::size_t>(j)].span == span)
        forces_.at(i, j) +=
            Numbers(&scaled_[row], modes)
                .dot(Numbers(&phi_[static_cast<std::size_t>(j) * static_cast<std::size_t>(stride_)], modes));
  }
}

bool SpanCrossing::share_span(int first, int last) const {
  const int span = wheels_[static_cast<std::size_t>(last)].span;
  return first == last || (span >= 0 && wheels_[static_cast<std::size_t>(first)].span == span);
}

// The contact's force, with the penetration that belongs to it; false where there is none.
bool SpanCrossing::take_force(std::size_t j, double force) {
  Wheel& wheel = wheels_[j];
  if (!(force > 0.0)) return false;
  for (int i = 0; i < law_steps; ++i) {
    law(j, wheel.delta);
    wheel.delta += (force - wheel.force) / wheel.k;
  }
  wheel.force = force;
  return wheel.delta > least_penetration;
}

// From the forces guessed with their penetrations to those that agree with how all yield. Masses yield far more than
// contacts in long steps: what a force's change makes of the contact's own compliance hardly matters, so that the
// matrix serves as it is.
Trouble SpanCrossing::solve_contacts() {
  const std::size_t count = wheels_.size();
  double before = 0.0;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    if (iteration % fresh_after == 0) {
      fill_forces();
      forces_.factor();
    }
    for (std::size_t j = 0; j < count; ++j)
      residual_[j] = wheels_[j].free - wheels_[j].delta + yield_[j] * wheels_[j].force;
    forces_.solve(residual_.data());
    double change = 0.0;
    for (std::size_t j = 0; j < count; ++j) {
      change = std::max(change, std::abs(residual_[j] - wheels_[j].force));
      if (!std::isfinite(residual_[j])) return not_finite;
      if (!take_force(j, residual_[j])) return contact_lost;
    }
    const double next = iteration == 0 ? change : change * std::min(1.0, change / before);
    if (next <= force_tolerance * train_.force_scale) return none;
    before = change;
  }
  return not_converged;
}

// The accelerations under the contacts' forces; z becomes where the modes are.
void SpanCrossing::take_forces(std::size_t stage) {
  for (Group& group : groups_) {
    const int n = group.count, f = group.numbers->freedom, w = group.numbers->wheels;
    double* a = group.a[stage + 1].data();
    std::copy(group.a_free.begin(), group.a_free.end(), a);
    for (int v = 0; v < n; ++v) {
      const auto first = static_cast<std::size_t>(
          train_.vehicles[static_cast<std::size_t>(group.vehicle[static_cast<std::size_t>(v)])].first_wheel);
      for (int i = 0; i < f; ++i)
        for (int j = 0; j < w; ++j)
          a[i * n + v] +=
              group.Y[static_cast<std::size_t>(i * w + j)] * wheels_[first + static_cast<std::size_t>(j)].force;
    }
  }
  for (std::size_t j = 0; j < wheels_.size(); ++j) {
    const int span = wheels_[j].span;
    if (span < 0) continue;
    const int modes = kind(span).modes();
    const double *scaled = &scaled_[j * static_cast<std::size_t>(stride_)], force = wheels_[j].force;
    double* z = at(z_, span);
    for (int i = 0; i < modes; ++i) z[i] -= scaled[i] * force;
  }
  const std::size_t from = static_cast<std::size_t>(first_) * static_cast<std::size_t>(stride_),
                    to = static_cast<std::size_t>(past_) * static_cast<std::size_t>(stride_);
  for (std::size_t i = from; i < to; ++i) b_[stage + 1][i] = (z_[i] - q_still_[i]) / d_;
}

}  // namespace traverse::lanes
