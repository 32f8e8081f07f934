// Products of a matrix that couples two bodies with the sensitivity B.
#pragma once

#include "multibody/mechanism.hpp"

namespace traverse::multibody {

/// product += K B for the matrix K of a pair of bodies.
void add_pair_times_B(int first, int second, const PairMatrix& K, const MechanismState& s, Eigen::MatrixXd& product);

}  // namespace traverse::multibody
