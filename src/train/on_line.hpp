// Whether a moving force or a wheel is on the line that it runs along.
#pragma once

namespace traverse::train {

/// Whether something at x with this speed is on the line from `start` to `end` (m). At an end it is only at rest: what
/// moves there has not arrived or has left.
inline bool is_on_line(double start, double end, double x, double speed) {
  if (speed == 0.0) return x >= start && x <= end;
  const double rounding = 1e-13 * (end - start);
  return x > start + rounding && x < end - rounding;
}

}  // namespace traverse::train
