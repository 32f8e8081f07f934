// The spans of a crossing: which are under the train, how these move without contacts, and how the others ring.
#include <algorithm>
#include <cmath>

#include "integrate/free_oscillation.hpp"
#include "lanes/span_crossing.hpp"

namespace traverse::lanes {
namespace {

constexpr double silent = 1e-12;  // of the motion when the train left: a span that has rung down to it rests

}  // namespace

// The spans that wheels are on between two instants. They only go on: what the train has left rings.
void SpanCrossing::find_range(double from, double to) {
  const auto [rear, front] = std::minmax_element(train_.x.begin(), train_.x.end());
  const int spans = static_cast<int>(plan_.spans.size());
  const auto span = [&](int i) { return plan_.spans[static_cast<std::size_t>(i)]; };
  int first = first_, past = past_;
  while (first < spans && span(first).end < *rear + speed_ * from) ++first;
  while (past < spans && span(past).x <= *front + speed_ * to) ++past;
  past = std::max(past, first);
  release(first_, std::min(first, past_));
  first_ = first;
  past_ = past;
}

// Where the modes would be without the contacts: z.
void SpanCrossing::free_modes(const structure::StageRule& rule) {
  for (int s = first_; s < past_; ++s) {
    const SpanKind& of = kind(s);
    const std::size_t begin = static_cast<std::size_t>(s) * static_cast<std::size_t>(stride_);
    const int modes = of.modes();
    double *still = &q_still_[begin], *rate_still = &rate_still_[begin], *z = &z_[begin];
    const double *q = &q_[begin], *rate = &rate_[begin];
    for (int i = 0; i < modes; ++i) {
      still[i] = q[i] + rule.w_in_v * rate[i];
      rate_still[i] = rate[i];
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(rule.known); ++j) {
      const double *b = &b_[j][begin], in_q = rule.a_in_v[j], in_rate = rule.a_in_w[j];
      for (int i = 0; i < modes; ++i) {
        still[i] += in_q * b[i];
        rate_still[i] += in_rate * b[i];
      }
    }
    const double *k = of.omega2.data(), *c = of.damping.data();
    const double* yields = S_inverse_[plan_.spans[static_cast<std::size_t>(s)].kind].data();
    for (int i = 0; i < modes; ++i) z[i] = still[i] - yields[i] * (c[i] * rate_still[i] + k[i] * still[i]);
  }
}

void SpanCrossing::release(int first, int past) {
  for (int s = first; s < past; ++s) {
    left_[static_cast<std::size_t>(s)] = time_;
    const auto [kinetic, strain] = energy(s, at(q_, s), at(rate_, s));
    left_energy_ += kinetic + strain;
  }
}

std::pair<double, double> SpanCrossing::energy(int span, const double* q, const double* rate) const {
  const SpanKind& of = kind(span);
  double kinetic = 0.0, strain = 0.0;
  for (int i = 0; i < of.modes(); ++i) {
    kinetic += 0.5 * rate[i] * rate[i];
    strain += 0.5 * of.omega2[static_cast<std::size_t>(i)] * q[i] * q[i];
  }
  return {kinetic, strain};
}

void SpanCrossing::step_free_spans() {
  for (int s = 0; s < static_cast<int>(plan_.spans.size()); ++s) {
    if (s == first_) s = past_;
    if (s == static_cast<int>(plan_.spans.size())) return;
    const double* goes = goes_[plan_.spans[static_cast<std::size_t>(s)].kind].data();
    double *q = at(q_, s), *rate = at(rate_, s);
    for (int i = 0; i < kind(s).modes(); ++i, goes += 4) {
      const double before = q[i];
      q[i] = goes[0] * before + goes[1] * rate[i];
      rate[i] = goes[2] * before + goes[3] * rate[i];
    }
  }
}

// What has rung out since somebody looked last rests from here on.
void SpanCrossing::rest() {
  if (plan_.all) return;
  while (ringing_ < first_) {
    const double fade = fades_[plan_.spans[static_cast<std::size_t>(ringing_)].kind];
    if (std::exp(-fade * (time_ - left_[static_cast<std::size_t>(ringing_)])) > silent) return;
    ++ringing_;
  }
}

std::pair<int, int> SpanCrossing::moving() const {
  return {ringing_, plan_.all ? static_cast<int>(plan_.spans.size()) : past_};
}

void SpanCrossing::motion(int span, double* q, double* rate, double* acceleration) const {
  const SpanKind& of = kind(span);
  const double *q0 = at(q_, span), *rate0 = at(rate_, span), *b = at(b_[0], span);
  const bool loaded = span >= first_ && span < past_, rings = span < first_ && !plan_.all;
  const double since = time_ - left_[static_cast<std::size_t>(span)];
  for (int i = 0; i < of.modes(); ++i) {
    const auto mode = static_cast<std::size_t>(i);
    const double k = of.omega2[mode], c = of.damping[mode];
    q[i] = q0[i];
    rate[i] = rate0[i];
    if (rings) {
      const integrate::FreeOscillation a = integrate::free_oscillation(std::sqrt(k), 0.5 * c, since);
      q[i] = a.uu * q0[i] + a.uw * rate0[i];
      rate[i] = a.wu * q0[i] + a.ww * rate0[i];
    }
    acceleration[i] = loaded ? b[i] : -c * rate[i] - k * q[i];
  }
}

std::pair<double, double> SpanCrossing::energy_now(int span) const {
  double* q = seen_.data();
  motion(span, q, q + stride_, q + 2 * static_cast<std::ptrdiff_t>(stride_));
  return energy(span, q, q + stride_);
}

double SpanCrossing::lost() const {
  double ringing = 0.0;
  for (int s = ringing_; s < first_; ++s) {
    const auto [kinetic, strain] = energy_now(s);
    ringing += kinetic + strain;
  }
  return lost_total_ + left_energy_ - ringing;
}

}  // namespace traverse::lanes
