// Splits the cubics at their zeros and integrates them. Between two breaks a load model's effect is a quartic, whose
// maxima are found by bisection between the zeros of its derivatives.
#include "norm/influence_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace traverse::norm {
namespace {

constexpr double negligible =
    1e-10;  // relative to the line's greatest value: smaller values on distant spans are neglected
constexpr double shortest = 1e-13;  // shortest piece, relative to the line's length
constexpr int halvings = 60;
constexpr std::size_t renewal_interval =
    64;  // number of stops after which sums are computed anew, so that rounding errors do not accumulate
constexpr std::size_t before = static_cast<std::size_t>(-1);  // index of a piece: before the line

using Quartic = std::array<double, 5>;  // coefficients by powers

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
  std::vector<double> ends = sign_changes(std::span(slope).first(c.size() - 1), h), zeros;
  ends.push_back(h);
  double start = 0.0, start_value = c[0];
  for (const double end : ends) {
    const double end_value = at(c, end);
    if (start_value * end_value < 0.0) {
      double low = start, high = end;
      for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (at(c, middle) * start_value > 0.0 ? low : high) = middle;
      }
      zeros.push_back(0.5 * (low + high));
    }
    start = end;
    start_value = end_value;
  }
  return zeros;
}

/// The area below c from 0 on, plus `constant`, as a quartic.
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
  split_at_zeros();
  integrate();
}

// Removes spans at both ends on which the line is negligible.
void InfluenceLine::trim() {
  std::vector<double> size;
  for (std::size_t i = 0; i < pieces_.size(); ++i) size.push_back(largest_in(pieces_[i], breaks_[i + 1] - breaks_[i]));
  const double least = negligible * *std::max_element(size.begin(), size.end());
  const auto matters = [least](double one) { return one > least; };
  const auto end = std::find_if(size.rbegin(), size.rend(), matters).base() - size.begin();
  const auto first = std::min(std::find_if(size.begin(), size.end(), matters) - size.begin(), end);
  if (first == end) {
    pieces_ = {beam::Cubic{}};
    breaks_ = {breaks_.front(), breaks_.back()};
    return;
  }
  pieces_ = {pieces_.begin() + first, pieces_.begin() + end};
  breaks_ = {breaks_.begin() + first, breaks_.begin() + end + 1};
}

void InfluenceLine::split_at_zeros() {
  std::vector<double> breaks = {breaks_.front()};
  std::vector<beam::Cubic> pieces;
  const double least = shortest * (breaks_.back() - breaks_.front());
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const double h = breaks_[i + 1] - breaks_[i];
    double start = 0.0;
    for (const double x : sign_changes(pieces_[i], h)) {
      if (x - start < least || h - x < least) continue;
      pieces.push_back(beam::shifted(pieces_[i], start));
      breaks.push_back(breaks_[i] + x);
      start = x;
    }
    pieces.push_back(beam::shifted(pieces_[i], start));
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
  const auto next = std::upper_bound(breaks_.begin() + 1, breaks_.end() - 1, x);
  return static_cast<std::size_t>(next - breaks_.begin()) - 1;
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

/// A load model that moves along a line: the sum of terms factor*f(s + x), where s is the position of the model's x = 0
/// and f the line itself, its area, or its area above 0.
struct MovingLoadModel {
  enum Kind { value, area, above };
  struct Term {
    double factor, x;
    Kind kind;
  };

  MovingLoadModel(const InfluenceLine& of, const LoadModel& model) : line(of) {
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

  /// The positions at which a term passes a break, ascending.
  struct Stop {
    double s;
    std::size_t term, piece;  // the piece that begins there for the term
  };
  std::vector<Stop> stops() const {
    std::vector<Stop> all;
    all.reserve(terms.size() * line.breaks_.size());
    for (std::size_t t = 0; t < terms.size(); ++t)
      for (std::size_t i = 0; i < line.breaks_.size(); ++i) all.push_back({line.breaks_[i] - terms[t].x, t, i});
    std::sort(all.begin(), all.end(), [](const Stop& a, const Stop& b) { return a.s < b.s; });
    return all;
  }

  /// Adds sign times a term on a piece (one past the last: behind the line) as a polynomial of the distance from s on.
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
  const MovingLoadModel moving(line, model);
  const std::vector<MovingLoadModel::Stop> stops = moving.stops();
  std::vector<std::size_t> piece(moving.terms.size(), before);
  Placed best;
  Quartic c{};  // polynomial of the distance from the last stop
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const double from = stops[i].s, h = stops[i + 1].s - from;
    const std::size_t term = stops[i].term;
    if (i % renewal_interval == 0) {
      piece[term] = stops[i].piece;
      c = {moving.constant};
      for (std::size_t t = 0; t < piece.size(); ++t)
        if (piece[t] != before) moving.add(1.0, moving.terms[t], piece[t], from, c);
    } else {
      if (piece[term] != before) moving.add(-1.0, moving.terms[term], piece[term], from, c);
      piece[term] = stops[i].piece;
      moving.add(1.0, moving.terms[term], piece[term], from, c);
    }
    double bound = c[0], power = h;
    for (std::size_t k = 1; k < c.size(); ++k, power *= h) bound += std::max(0.0, c[k] * power);
    const double low = std::max(0.0, model.first - from), high = std::min(h, model.last - from);
    if (bound > best.value && low <= high) {
      const Quartic slope = {c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4]};
      std::vector<double> candidates = sign_changes(std::span(slope).first(4), h);
      candidates.insert(candidates.end(), {low, high});
      for (const double x : candidates)
        if (const double value = at(c, x); x >= low && x <= high && value > best.value) best = {value, from + x};
    }
    c = shifted(c, h);
  }
  return best;
}

}  // namespace traverse::norm
