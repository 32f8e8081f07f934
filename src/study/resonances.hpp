// Speeds at which a train of regular axles should set a bridge swinging, and at which an axle should leave it at rest.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "results/resonance.hpp"
#include "results/study_table.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// The distance (m, above 0) by which a train has to be shifted so that most of its weight meets axles again, each pair
/// counted by the lesser force; 0 where that is never more than half of the weight. Of equal ones the shortest. x in m.
double regular_distance(std::span<const double> x, std::span<const double> forces);

/// Hz, ascending: the distinct frequencies of bending that resonances are predicted from, three at most; none where
/// so long a bridge makes them dear.
std::vector<double> resonant_frequencies(const SharedBeam& shared);

/// v = f d/i for i = 1 to 4 within these speeds (m/s), by train, frequency and i.
std::vector<results::Resonance> resonances_of(const Scene& scene, std::span<const double> frequencies, double slowest,
                                              double fastest);

/// Of uniform spans L, each simply supported and nothing else: v = 2 f_n L/(n + 2 k), at which a constant force leaves
/// no motion behind in mode n without damping. A force drives the mode by sin(n pi v t/L); what is left after it is
/// proportional to cos(n pi) - cos(omega L/v) and to sin(omega L/v), both zero where omega L/v = (n + 2 k) pi, but for
/// k = 0, where the drive itself is in resonance.
std::vector<results::Cancellation> cancellations_of(const beam::BeamModel& beam, std::span<const double> frequencies,
                                                    double slowest, double fastest);

/// Fills in where the sweep's own curves have their peaks near each resonance.
void find_peaks(const results::StudyTable& sweep, std::vector<results::Resonance>& resonances);

/// Those of the speeds of resonance that stand so far from all of `speeds` (ascending) that their peaks may lie unseen
/// between two of these.
std::vector<double> unseen(std::span<const results::Resonance> resonances, std::span<const double> speeds);

}  // namespace traverse::app
