// A train of linear vehicles as the numbers that runs side by side take, and what its being linear leaves out.
#pragma once

#include <string>
#include <vector>

#include "lanes/crossing.hpp"
#include "train/fleet.hpp"

namespace traverse::lanes {

/// Why a train cannot run side by side, in words; empty: it can.
std::string obstacle(const train::Fleet& fleet);

/// Of a fleet whose vehicles are linear, at its start with its contact forces; it is moved and comes back.
TrainNumbers train_numbers(train::Fleet& fleet);

/// How far the mechanisms are out of balance, over their weights, at coordinates x from where they start (metres and
/// radians, CrossingResult::bent).
double defect(train::Fleet& fleet, const std::vector<double>& x);

/// What a wheel's lowest point follows on the track from x = `from` to `to` (m): the track itself, but where the wheel
/// (radius in m) rolls over what is narrower than itself, with stations `distance` apart.
TrackNumbers track_numbers(const track::Profile& profile, double radius, double from, double to, double distance);
/// How far apart stations may be for that, m. InputError where cubics between stations would take more memory than they
/// may.
double track_distance(const track::Profile& profile, double radius, double from, double to);

}  // namespace traverse::lanes
