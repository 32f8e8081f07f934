#include "traverse/multibody/frame.hpp"

#include <cmath>

namespace traverse::multibody {

void Frame::set_angle(double value) {
  angle = value;
  cosine = std::cos(value);
  sine = std::sin(value);
}

}  // namespace traverse::multibody
