// Stores wheel positions at a limited number of instants; when the limit is reached every second one is removed and the
// stride is doubled.
#include "train/wheel_paths.hpp"

#include <algorithm>
#include <cmath>

#include "train/fleet.hpp"

namespace traverse::train {
namespace {

constexpr std::size_t most_instants = 4096;

}  // namespace

void WheelPaths::add(double t, const Fleet& fleet) {
  if (count_++ % stride_ != 0) return;
  wheels_ = fleet.wheels.size();
  time_.push_back(t);
  for (const WheelContact& c : fleet.wheels) x_.push_back(fleet.coordinates(c).x());
  const double* now = &x_[x_.size() - wheels_];
  for (std::size_t i = 1; i < wheels_; ++i) drift_ = std::max(drift_, std::abs((now[i] - now[0]) - (x_[i] - x_[0])));
  if (time_.size() == most_instants) thin_out();
}

// Removes every second instant.
void WheelPaths::thin_out() {
  for (std::size_t i = 1; 2 * i < time_.size(); ++i) {
    time_[i] = time_[2 * i];
    std::copy_n(x_.begin() + static_cast<std::ptrdiff_t>(2 * i * wheels_), wheels_,
                x_.begin() + static_cast<std::ptrdiff_t>(i * wheels_));
  }
  time_.resize((time_.size() + 1) / 2);
  x_.resize(time_.size() * wheels_);
  stride_ *= 2;
}

}  // namespace traverse::train
