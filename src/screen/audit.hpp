// Checks a screen on a random sample of its pairs: all passages at all speeds, without use of the bound.
#pragma once

#include <mpi.h>

#include <string>
#include <vector>

#include "results/recorder.hpp"
#include "screen/screen_file.hpp"

namespace traverse::screen {

struct Audit {
  long pairs = 0, speeds = 0;
  long missed = 0;            // pairs with a higher permitted speed by the screen than by the passages
  long different = 0;         // pairs with another verdict of any kind
  long below = 0;             // speeds with a bound below the computed value
  double median_pair = 0.0;   // median over the pairs of the largest bound over the largest computed value
  double median_speed = 0.0;  // the same over all speeds of all pairs

  std::vector<results::Attribute> attributes() const;
  std::string text() const;
};

/// Collective. Draws `count` pairs at random, the same on every number of ranks; those without a speed are left out.
Audit audit(MPI_Comm comm, const Problem& problem, int count);

}  // namespace traverse::screen
