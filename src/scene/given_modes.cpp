// Parses frequencies, modal masses, damping ratios, outputs and mode shapes line by line, sorts the modes by frequency
// and scales their shapes to a modal mass of 1 kg.
#include "given_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>

#include "base/text.hpp"
#include "options/input_texts.hpp"
#include "options/parse_number.hpp"
#include "results/origin.hpp"
#include "traverse/base/error.hpp"

namespace traverse::scene {
namespace {

constexpr std::size_t most_given_modes = 10'000, most_shape_stations = 100'000, most_characters = std::size_t{1} << 30;

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line.substr(0, line.find('#')));
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(base::trimmed(cell));
  if (cells.size() == 1 && cells.front().empty()) cells.clear();
  return cells;
}

bool is_name(const std::string& word) {
  return !word.empty() && std::all_of(word.begin(), word.end(),
                                      [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

/// Parses the text of one file line by line.
class ModesParser {
 public:
  ModesParser(std::string path, int track) : path_(std::move(path)), track_(track) {}

  beam::GivenModes read(std::istream& text) {
    for (std::string line; std::getline(text, line);) {
      ++line_;
      if (const std::vector<std::string> cells = cells_of(line); !cells.empty()) parse(cells);
    }
    check_complete();
    normalise();
    return std::move(modes_);
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(fmt::format("{}:{}: {}", path_, line_, why));
  }
  [[noreturn]] void refuse_file(const std::string& why) const { throw InputError(fmt::format("{}: {}", path_, why)); }

  double number(const std::string& word) const {
    double value = 0.0;
    if (!options::parse_number(word, value)) refuse(fmt::format("'{}' is not a finite number", word));
    if (!options::is_quantity(value)) refuse(fmt::format("'{}' is not a possible quantity in SI units", word));
    return value;
  }
  std::vector<double> numbers(const std::vector<std::string>& cells, std::size_t from) const {
    std::vector<double> values;
    for (std::size_t i = from; i < cells.size(); ++i) values.push_back(number(cells[i]));
    return values;
  }
  /// The numbers of a line with one number per mode.
  std::vector<double> modal_numbers(const std::vector<std::string>& cells, std::size_t from) const {
    if (frequency_.empty())
      refuse(fmt::format("{} needs the line frequency before it, which sets the number of modes", cells[0]));
    std::vector<double> values = numbers(cells, from);
    if (values.size() != frequency_.size())
      refuse(fmt::format("{} has {} numbers for {} modes; allowed: one per mode", cells[0], values.size(),
                         frequency_.size()));
    return values;
  }

  void parse(const std::vector<std::string>& cells) {
    const std::string& word = cells.front();
    if (word == "frequency") return parse_frequencies(cells);
    if (word == "modal_mass") return parse_masses(cells);
    if (word == "damping_ratio") return parse_ratios(cells);
    if (word == "output") return parse_output(cells);
    if (word == "track") return parse_track(cells);
    double x = 0.0;
    if (!options::parse_number(word, x))
      refuse(
          fmt::format("'{}' cannot begin a line; allowed: frequency, modal_mass, damping_ratio, output, track, or "
                      "a station in m",
                      word));
    parse_station(cells);
  }

  /// Checks that the number of each mode is above 0, or not below 0 if `zero` is allowed.
  void check_each(const std::vector<double>& values, const char* what, const char* unit, bool zero) const {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!(zero ? values[i] >= 0.0 : values[i] > 0.0))
        refuse(fmt::format("the {} of mode {} is {:g}{}; allowed: {} 0", what, i + 1, values[i], unit,
                           zero ? "not below" : "above"));
  }

  void parse_frequencies(const std::vector<std::string>& cells) {
    if (!frequency_.empty()) refuse("frequency is given twice");
    frequency_ = numbers(cells, 1);
    if (frequency_.empty() || frequency_.size() > most_given_modes)
      refuse(fmt::format("frequency has {} numbers; allowed: 1 to {}", frequency_.size(), most_given_modes));
    check_each(frequency_, "frequency", " Hz", false);
  }

  void parse_masses(const std::vector<std::string>& cells) {
    mass_ = modal_numbers(cells, 1);
    check_each(mass_, "modal mass", " kg", false);
  }

  void parse_ratios(const std::vector<std::string>& cells) {
    ratio_ = cells.size() == 2 && !frequency_.empty() ? std::vector<double>(frequency_.size(), number(cells[1]))
                                                      : modal_numbers(cells, 1);
    check_each(ratio_, "damping ratio", "", true);
    const auto lowest = std::min_element(frequency_.begin(), frequency_.end()) - frequency_.begin();
    if (const double first = ratio_[static_cast<std::size_t>(lowest)]; first >= 1.0)
      refuse(fmt::format(
          "the damping ratio of the lowest mode is {:g}; allowed: below 1 (critical damping), not in per cent", first));
  }

  void parse_output(const std::vector<std::string>& cells) {
    if (cells.size() < 3 || !is_name(cells[1]) || cells[2].empty())
      refuse(
          "allowed for an output: output, NAME, UNIT, one number per mode; the name is a word of letters, digits and "
          "_");
    for (const beam::GivenModes::Output& other : modes_.outputs)
      if (other.name == cells[1]) refuse(fmt::format("two outputs have the name {}", cells[1]));
    modes_.outputs.push_back({cells[1], cells[2], modal_numbers(cells, 3)});
  }

  void parse_track(const std::vector<std::string>& cells) {
    const double number_of = cells.size() == 2 ? number(cells[1]) : 0.0;
    if (number_of != tracks_ + 1.0)
      refuse(fmt::format("allowed here: track, {}; tracks are counted from 1", tracks_ + 1));
    if (tracks_ == 0 && !modes_.x.empty()) refuse("track, 1 must be before the first station");
    ++tracks_;
    last_x_ = 0.0;
    stations_ = 0;
  }

  void parse_station(const std::vector<std::string>& cells) {
    const std::size_t modes = frequency_.size();
    if (modes == 0) refuse("a station needs the line frequency before it, which sets the number of modes");
    if (cells.size() != 1 + modes && cells.size() != 1 + 2 * modes)
      refuse(fmt::format(
          "the station has {} numbers after x for {} modes; allowed: one shape per mode, or all shapes and then all "
          "slopes",
          cells.size() - 1, modes));
    const double x = number(cells.front());
    if (stations_ == 0 && x != 0.0)
      refuse(fmt::format("the first station is {:g} m; allowed: 0, the left end of the bridge", x));
    if (stations_ > 0 && !(x > last_x_))
      refuse(fmt::format("stations must increase strictly: {:g} m after {:g} m", x, last_x_));
    last_x_ = x;
    if (++stations_ > most_shape_stations)
      refuse(fmt::format("too many stations; allowed: at most {}", most_shape_stations));
    if (std::max(tracks_, 1) != track_) return;
    const bool slopes = cells.size() > 1 + modes;
    if (!modes_.x.empty() && slopes != has_slopes_) refuse("slopes must be given at all stations or at none");
    has_slopes_ = slopes;
    modes_.x.push_back(x);
    modes_.shape.resize(modes);
    modes_.slope.resize(modes);
    for (std::size_t i = 0; i < modes; ++i) {
      modes_.shape[i].push_back(number(cells[1 + i]));
      if (slopes) modes_.slope[i].push_back(number(cells[1 + modes + i]));
    }
  }

  void check_complete() const {
    for (const auto& [numbers, line] :
         {std::pair(&frequency_, "frequency is missing: the frequencies of the modes in Hz"),
          {&mass_, "modal_mass is missing: the masses of the modes in kg"},
          {&ratio_, "damping_ratio is missing: the damping ratios of the modes"}})
      if (numbers->empty()) refuse_file(fmt::format("the line {}", line));
    const int tracks = std::max(tracks_, 1);
    if (track_ > tracks)
      refuse_file(fmt::format("bridge_track is {}; the file has {} track{}", track_, tracks, tracks == 1 ? "" : "s"));
    if (modes_.x.size() < 2) refuse_file(fmt::format("{} stations; allowed: at least 2", modes_.x.size()));
    const auto is_nonzero = [](const std::vector<double>& shape) {
      return std::any_of(shape.begin(), shape.end(), [](double value) { return value != 0.0; });
    };
    if (std::none_of(modes_.shape.begin(), modes_.shape.end(), is_nonzero))
      refuse_file("all shapes are zero along the track");
  }

  /// Sorts the modes by frequency and scales the shapes to a modal mass of 1 kg.
  void normalise() {
    const std::size_t modes = frequency_.size();
    std::vector<std::size_t> order(modes);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return frequency_[a] < frequency_[b]; });
    beam::GivenModes sorted;
    sorted.source = path_;
    sorted.x = modes_.x;
    for (const beam::GivenModes::Output& output : modes_.outputs)
      sorted.outputs.push_back({output.name, output.unit, {}});
    for (const std::size_t i : order) {
      const double root = std::sqrt(mass_[i]);
      sorted.omega.push_back(2.0 * std::numbers::pi * frequency_[i]);
      sorted.ratio.push_back(ratio_[i]);
      std::vector<double> slope = has_slopes_ ? modes_.slope[i] : beam::spline_slopes(modes_.x, modes_.shape[i]);
      for (std::vector<double>* values : {&modes_.shape[i], &slope})
        for (double& value : *values) value /= root;
      sorted.shape.push_back(modes_.shape[i]);
      sorted.slope.push_back(std::move(slope));
      for (std::size_t k = 0; k < sorted.outputs.size(); ++k)
        sorted.outputs[k].of_mode.push_back(modes_.outputs[k].of_mode[i] / root);
    }
    modes_ = std::move(sorted);
  }

  std::string path_;
  int track_, tracks_ = 0, line_ = 0;
  std::vector<double> frequency_, mass_, ratio_;  // Hz, kg, 1
  beam::GivenModes modes_;                        // shapes, slopes and outputs as in the file
  bool has_slopes_ = false;
  double last_x_ = 0.0;
  std::size_t stations_ = 0;  // number of stations of the current track so far
};

}  // namespace

beam::GivenModes read_given_modes(const std::string& path, int track) {
  if (!options::is_mounted(path) && results::is_hdf5(path)) {
    const std::string text = results::modes_as_text(path);
    options::record_text(path, text);
    std::istringstream stream(text);
    return ModesParser(path, track).read(stream);
  }
  std::istringstream stream(options::read_text(path, {"", "a file of modes", most_characters, true}));
  return ModesParser(path, track).read(stream);
}

}  // namespace traverse::scene
