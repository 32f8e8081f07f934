// Splits the cubics at their zeros and integrates them; between two breaks a load model's effect is a quartic, whose
// maxima are found by bisection between the zeros of its derivatives.
#include "norm/influence_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace traverse::norm {
namespace {

constexpr double negligible = 1e-10;  // of the line's greatest value: spans far away
constexpr double shortest = 1e-13;    // of the line's length: a piece
constexpr int halvings = 60;
constexpr std::size_t renewed_each = 64;  // stops: sums are made anew, so that rounding does not gather in them
constexpr std::size_t before = static_cast<std::size_t>(-1);  // a piece: the line has not begun

using Quartic = std::array<double, 5>;  // by powers

double at(std::span<const double> c, double x) {
  double sum = 0.0;
  for (std::size_t k = c.size(); k-- > 0;) sum = sum * x + c[k];
  return sum;
}

/// The zeros in (0, h) at which a polynomial changes its sign, ascending.
std::vector<double> sign_changes(std::span<const double> c, double h) {
  if (c.size() < 2) return {};
  std::array<double, 4> slope{};
  for (std::size_t k = 1; k < c.size(); ++k) slope[k - 1] = static_cast<double>(k) * c[k];
  std::vector<double> ends = sign_changes(std::span(slope).first(c.size() - 1), h), found;
  ends.push_back(h);
  double left = 0.0, of_left = c[0];
  for (const double end : ends) {
    const double of_right = at(c, end);
    if (of_left * of_right < 0.0) {
      double low = left, high = end;
      for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (at(c, middle) * of_left > 0.0 ? low : high) = middle;
      }
      found.push_back(0.5 * (low + high));
    }
    left = end;
    of_left = of_right;
  }
  return found;
}

/// The area below c from 0 on, as a quartic that begins with `constant`.
Quartic area_of(const beam::Cubic& c, double constant) { return {constant, c[0], c[1] / 2.0, c[2] / 3.0, c[3] / 4.0}; }

Quartic shifted(const Quartic& c, double d) {
  Quartic r = c;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 4; k-- > i;) r[k] += d * r[k + 1];
  return r;
}

double largest_in(const beam::Cubic& c, double h) {
  double largest = 0.0;
  for (const double x : {0.0, 0.25 * h, 0.5 * h, 0.75 * h, h}) largest = std::max(largest, std::abs(at(c, x)));
  return largest;
}

}  // namespace

InfluenceLine::InfluenceLine(std::vector<double> breaks, std::vector<beam::Cubic> pieces)
    : breaks_(std::move(breaks)), pieces_(std::move(pieces)) {
  trim();
  split_where_it_changes_sign();
  integrate();
}

// Spans that do not feel the force, or nearly so.
void InfluenceLine::trim() {
  std::vector<double> size;
  for (std::size_t i = 0; i < pieces_.size(); ++i) size.push_back(largest_in(pieces_[i], breaks_[i + 1] - breaks_[i]));
  const double least = negligible * *std::max_element(size.begin(), size.end());
  const auto counts = [least](double one) { return one > least; };
  const auto past = std::find_if(size.rbegin(), size.rend(), counts).base() - size.begin();
  const auto first = std::min(std::find_if(size.begin(), size.end(), counts) - size.begin(), past);
  if (first == past) {
    pieces_ = {beam::Cubic{}};
    breaks_ = {breaks_.front(), breaks_.back()};
    return;
  }
  pieces_ = {pieces_.begin() + first, pieces_.begin() + past};
  breaks_ = {breaks_.begin() + first, breaks_.begin() + past + 1};
}

void InfluenceLine::split_where_it_changes_sign() {
  std::vector<double> breaks = {breaks_.front()};
  std::vector<beam::Cubic> pieces;
  const double least = shortest * (breaks_.back() - breaks_.front());
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const double h = breaks_[i + 1] - breaks_[i];
    double left = 0.0;
    for (const double x : sign_changes(pieces_[i], h)) {
      if (x - left < least || h - x < least) continue;
      pieces.push_back(beam::shifted(pieces_[i], left));
      breaks.push_back(breaks_[i] + x);
      left = x;
    }
    pieces.push_back(beam::shifted(pieces_[i], left));
    breaks.push_back(breaks_[i + 1]);
  }
  breaks_ = std::move(breaks);
  pieces_ = std::move(pieces);
}

void InfluenceLine::integrate() {
  area_ = above_ = {0.0};
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const double more = at(area_of(pieces_[i], 0.0), breaks_[i + 1] - breaks_[i]);
    area_.push_back(area_.back() + more);
    above_.push_back(above_.back() + std::max(more, 0.0));
  }
}

std::size_t InfluenceLine::piece_at(double x) const {
  const auto past = std::upper_bound(breaks_.begin() + 1, breaks_.end() - 1, x);
  return static_cast<std::size_t>(past - breaks_.begin()) - 1;
}

double InfluenceLine::value(double x) const {
  if (x < breaks_.front() || x > breaks_.back()) return 0.0;
  const std::size_t i = piece_at(x);
  return at(pieces_[i], x - breaks_[i]);
}

InfluenceLine InfluenceLine::times(double factor) const {
  InfluenceLine line = *this;
  for (beam::Cubic& piece : line.pieces_)
    for (double& c : piece) c *= factor;
  line.integrate();
  return line;
}

/// A load model on its way along a line: the sum of terms factor*f(s + x), where s is the place of the model's x = 0
/// and f the line itself, its area, or its area above 0.
struct Passing {
  enum Kind { value, area, above };
  struct Term {
    double factor, x;
    Kind kind;
  };

  Passing(const InfluenceLine& of, const LoadModel& model) : line(of) {
    for (const LoadModel::Force& f : model.forces) terms.push_back({f.force, f.x, value});
    const auto add = [&](double load, double from, double to, Kind kind) {
      terms.push_back({load, to, kind});
      terms.push_back({-load, from, kind});
    };
    for (const LoadModel::Uniform& u : model.uniform) add(u.load, u.from, u.to, area);
    if (model.free_load == 0.0) return;
    add(-model.free_load, model.free_from, model.free_to, above);
    constant = model.free_load * line.area_above();
  }

  /// Where a term passes a break, ascending.
  struct Stop {
    double s;
    std::size_t term, piece;  // that begins there for the term
  };
  std::vector<Stop> stops() const {
    std::vector<Stop> all;
    all.reserve(terms.size() * line.breaks_.size());
    for (std::size_t t = 0; t < terms.size(); ++t)
      for (std::size_t i = 0; i < line.breaks_.size(); ++i) all.push_back({line.breaks_[i] - terms[t].x, t, i});
    std::sort(all.begin(), all.end(), [](const Stop& a, const Stop& b) { return a.s < b.s; });
    return all;
  }

  /// Adds sign times a term on a piece (one past the last: behind the line) as a polynomial of the way from s on.
  void add(double sign, const Term& term, std::size_t piece, double s, Quartic& sum) const {
    if (piece == line.pieces_.size()) {
      if (term.kind != value) sum[0] += sign * term.factor * (term.kind == area ? line.area() : line.area_above());
      return;
    }
    const Quartic more = shifted(polynomial(term.kind, piece), s + term.x - line.breaks_[piece]);
    for (std::size_t k = 0; k < more.size(); ++k) sum[k] += sign * term.factor * more[k];
  }

  Quartic polynomial(Kind kind, std::size_t i) const {
    const beam::Cubic& c = line.pieces_[i];
    if (kind == value) return {c[0], c[1], c[2], c[3], 0.0};
    if (kind == area) return area_of(c, line.area_[i]);
    return line.above_[i + 1] > line.above_[i] ? area_of(c, line.above_[i]) : Quartic{line.above_[i]};
  }

  const InfluenceLine& line;
  std::vector<Term> terms;
  double constant = 0.0;
};

Placed greatest(const InfluenceLine& line, const LoadModel& model) {
  const Passing passing(line, model);
  const std::vector<Passing::Stop> stops = passing.stops();
  std::vector<std::size_t> piece(passing.terms.size(), before);
  Placed best;
  Quartic c{};  // of the way since the last stop
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const double from = stops[i].s, h = stops[i + 1].s - from;
    const std::size_t passes = stops[i].term;
    if (i % renewed_each == 0) {
      piece[passes] = stops[i].piece;
      c = {passing.constant};
      for (std::size_t t = 0; t < piece.size(); ++t)
        if (piece[t] != before) passing.add(1.0, passing.terms[t], piece[t], from, c);
    } else {
      if (piece[passes] != before) passing.add(-1.0, passing.terms[passes], piece[passes], from, c);
      piece[passes] = stops[i].piece;
      passing.add(1.0, passing.terms[passes], piece[passes], from, c);
    }
    double bound = c[0], power = h;
    for (std::size_t k = 1; k < c.size(); ++k, power *= h) bound += std::max(0.0, c[k] * power);
    if (bound > best.value) {
      const Quartic slope = {c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4]};
      std::vector<double> tops = sign_changes(std::span(slope).first(4), h);
      tops.insert(tops.end(), {0.0, h});
      for (const double x : tops)
        if (const double value = at(c, x); value > best.value) best = {value, from + x};
    }
    c = shifted(c, h);
  }
  return best;
}

}  // namespace traverse::norm
