// The table of a layered track's properties, and the evaluation of the properties at a sleeper.
#include <algorithm>

#include "traverse/beam/layered_track.hpp"

namespace traverse::beam {
namespace {

constexpr double station_rounding = 1e-9;  // tolerance of stations, relative to the sleepers' spacing

const Distribution* k_of(const std::optional<Layer>& layer) { return layer ? &layer->k : nullptr; }
const Distribution* c_of(const std::optional<Layer>& layer) { return layer ? &layer->c : nullptr; }

}  // namespace

// clang-format off
const std::array<TrackProperty, track_property_count> track_properties = {{
    {"pad_k", "N/m", "stiffness of the pads on a sleeper",
     [](TrackValues& v) -> double& { return v.pad.k; }, [](const LayeredTrack& t) -> const Distribution* { return &t.pad.k; }},
    {"pad_c", "Ns/m", "damping of the pads on a sleeper",
     [](TrackValues& v) -> double& { return v.pad.c; }, [](const LayeredTrack& t) -> const Distribution* { return &t.pad.c; }},
    {"sleeper_mass", "kg", "mass of a sleeper",
     [](TrackValues& v) -> double& { return v.sleeper_mass; }, [](const LayeredTrack& t) -> const Distribution* { return &t.sleeper_mass; }},
    {"ballast_mass", "kg", "ballast mass per sleeper",
     [](TrackValues& v) -> double& { return v.ballast_mass; }, [](const LayeredTrack& t) -> const Distribution* { return &t.ballast_mass; }},
    {"ballast_k", "N/m", "ballast stiffness per sleeper",
     [](TrackValues& v) -> double& { return v.ballast.k; }, [](const LayeredTrack& t) { return k_of(t.ballast); }},
    {"ballast_c", "Ns/m", "ballast damping per sleeper",
     [](TrackValues& v) -> double& { return v.ballast.c; }, [](const LayeredTrack& t) { return c_of(t.ballast); }},
    {"subballast_k", "N/m", "sub-ballast stiffness per sleeper",
     [](TrackValues& v) -> double& { return v.subballast.k; }, [](const LayeredTrack& t) { return k_of(t.subballast); }},
    {"subballast_c", "Ns/m", "sub-ballast damping per sleeper",
     [](TrackValues& v) -> double& { return v.subballast.c; }, [](const LayeredTrack& t) { return c_of(t.subballast); }},
    {"longitudinal_k", "N/m", "stiffness between rail and bridge or ground along x, per sleeper",
     [](TrackValues& v) -> double& { return v.longitudinal.k; }, [](const LayeredTrack& t) -> const Distribution* { return &t.longitudinal.k; }},
    {"longitudinal_c", "Ns/m", "its damping",
     [](TrackValues& v) -> double& { return v.longitudinal.c; }, [](const LayeredTrack& t) -> const Distribution* { return &t.longitudinal.c; }},
    {"longitudinal_limit", "N", "force at which a sleeper slides along x; 0: it holds",
     [](TrackValues& v) -> double& { return v.slides_at; }, [](const LayeredTrack& t) -> const Distribution* { return &t.slides_at; }},
    {"longitudinal_loaded_k", "N/m", "stiffness along x below a train; 0: as without one",
     [](TrackValues& v) -> double& { return v.loaded_k; }, [](const LayeredTrack& t) -> const Distribution* { return &t.loaded_k; }},
    {"longitudinal_loaded_limit", "N", "force at which a sleeper slides below a train; 0: as without one",
     [](TrackValues& v) -> double& { return v.loaded_slides_at; }, [](const LayeredTrack& t) -> const Distribution* { return &t.loaded_slides_at; }},
    {"gap", "m", "gap below the unloaded sleepers, which hang on the rail until it closes",
     [](TrackValues& v) -> double& { return v.gap; }, [](const LayeredTrack& t) -> const Distribution* { return &t.gap; }},
}};
// clang-format on

TrackValues LayeredTrack::at(double x) const {
  const double rounding = station_rounding * spacing, right = x + spacing;
  TrackValues values;
  for (std::size_t i = 0; i < track_property_count; ++i) {
    const TrackProperty& property = track_properties[i];
    const Distribution* value = property.along(*this);
    if (value == nullptr) continue;
    for (const TrackStretch& stretch : stretches)
      if (stretch.values[i] && stretch.contains(x, rounding)) value = &*stretch.values[i];
    property.of(values) = value->at(x + rounding, right);
  }
  if (!has_sleeper(x)) {
    values.pad = values.ballast = values.longitudinal = {};
    values.sleeper_mass = values.gap = values.slides_at = 0.0;
  }
  if (gaps_stay_open && values.gap > 0.0) {
    values.ballast = {};
    values.gap = 0.0;
  }
  if (sliding_disabled) values.slides_at = 0.0;
  return values;
}

bool LayeredTrack::has_sleeper(double x) const {
  bool present = true;
  for (const TrackStretch& stretch : stretches)
    if (stretch.contains(x, station_rounding * spacing)) present = present && stretch.sleepers;
  return present;
}

bool LayeredTrack::any_positive(std::string_view name) const {
  const auto row = static_cast<std::size_t>(
      std::find_if(track_properties.begin(), track_properties.end(), [&](const auto& p) { return p.name == name; }) -
      track_properties.begin());
  const Distribution* everywhere = track_properties[row].along(*this);
  return (everywhere != nullptr && everywhere->maximum() > 0.0) ||
         std::any_of(stretches.begin(), stretches.end(),
                     [row](const TrackStretch& s) { return s.values[row] && s.values[row]->maximum() > 0.0; });
}

bool LayeredTrack::hangs() const { return !gaps_stay_open && any_positive("gap"); }
bool LayeredTrack::slides() const { return !sliding_disabled && any_positive("longitudinal_limit"); }

bool LayeredTrack::uniform() const {
  return stretches.empty() &&
         std::all_of(track_properties.begin(), track_properties.end(), [this](const auto& property) {
           const Distribution* along = property.along(*this);
           return along == nullptr || along->uniform();
         });
}

}  // namespace traverse::beam
