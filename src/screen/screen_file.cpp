// Creates the tables of a screen, writes rows, and reads those of an interrupted screen.
#include "screen/screen_file.hpp"

#include <fmt/format.h>

#include <numbers>

#include "results/study_reader.hpp"
#include "run/model_record.hpp"
#include "run/process.hpp"
#include "traverse/base/error.hpp"

namespace traverse::screen {
namespace {

using Dataset = results::Recorder::Dataset;

constexpr const char *digest_set = "/screen/row_digest", *digest_attribute = "problem_digest";

std::string set_of(const PairColumn& column) { return std::string("/screen/") + column.name; }

template <class Thing>
std::vector<std::string> names_of(const std::vector<Thing>& things) {
  std::vector<std::string> names;
  for (const Thing& thing : things) names.push_back(thing.name);
  return names;
}

template <class Thing, class Get>
std::vector<double> values_of(const std::vector<Thing>& things, Get get) {
  std::vector<double> values;
  for (const Thing& thing : things) values.push_back(get(thing));
  return values;
}

/// An unlimited speed is unknown (NaN) in the file.
double finite(double speed) { return std::isfinite(speed) ? speed : Verdict::unknown; }

std::vector<Dataset> coordinates(const Problem& problem) {
  const std::vector<Bridge>& stock = problem.stock;
  const std::vector<double>& speeds = problem.scene.screen->speeds;
  const auto length = [](const Bridge& b) {
    double sum = 0.0;
    for (const double span : b.spans) sum += span;
    return sum;
  };
  const std::size_t n = stock.size();
  return {{"/screen/speed", {speeds.size()}, speeds, "m/s"},
          {"/screen/bridge_length", {n}, values_of(stock, length), "m"},
          {"/screen/bridge_frequency", {n}, values_of(stock, first_frequency), "Hz"},
          {"/screen/bridge_damping", {n}, values_of(stock, [](const Bridge& b) { return b.damping; }), "1"},
          {"/screen/bridge_speed", {n}, values_of(stock, [](const Bridge& b) { return finite(b.speed); }), "m/s"},
          {"/screen/formation_speed",
           {problem.fleet.size()},
           values_of(problem.fleet, [](const Formation& f) { return finite(f.speed); }),
           "m/s"}};
}

/// The rows of a file, or why they do not belong to the problem.
std::map<std::size_t, std::vector<double>> rows_in(const Problem& problem, std::string& why) {
  std::map<std::size_t, std::vector<double>> rows;
  const results::StoredStudy stored = results::read_group(problem.scene.output.file, "/screen");
  if (stored.datasets.empty()) return rows;
  const auto digest = stored.texts.find(digest_attribute);
  if (digest == stored.texts.end() || digest->second != problem.digest) {
    why = "its bridges, trains, limits or options are others";
    return rows;
  }
  const std::size_t formations = problem.fleet.size();
  const auto finished = stored.datasets.find("row_digest");
  for (std::size_t b = 0; finished != stored.datasets.end() && b < finished->second.size(); ++b) {
    std::vector<double> row;
    for (const PairColumn& column : pair_columns) {
      const auto set = stored.datasets.find(column.name);
      if (set == stored.datasets.end() || set->second.size() < (b + 1) * formations) return rows;
      const auto first = set->second.begin() + static_cast<std::ptrdiff_t>(b * formations);
      row.insert(row.end(), first, first + static_cast<std::ptrdiff_t>(formations));
    }
    if (row_digest(row) == finished->second[b]) rows[b] = std::move(row);
  }
  return rows;
}

}  // namespace

Problem read_problem(const scene::Scene& scene) {
  const options::Screen& screen = *scene.screen;
  Problem problem{scene, {}, {}, {}, {}};
  problem.stock = read_stock(screen.stock, scene.limits, problem.notes);
  problem.fleet = read_fleet(screen.fleet, problem.notes);
  problem.digest =
      problem_digest(problem.stock, problem.fleet, screen.speeds, screen.modes, screen.parts, screen.samples);
  return problem;
}

std::map<std::size_t, std::vector<double>> stored_rows(MPI_Comm comm, const Problem& problem) {
  std::map<std::size_t, std::vector<double>> rows;
  if (!problem.scene.screen->resume) return rows;
  results::read_to_resume(comm, "screen_resume", problem.scene.output.file, "another screen", "all bridges are", [&] {
    std::string why;
    rows = rows_in(problem, why);
    return why;
  });
  return rows;
}

ScreenFile::ScreenFile(MPI_Comm comm, results::Place place, const Problem& problem,
                       const std::vector<std::string>& notes, std::map<std::size_t, std::vector<double>>& rows,
                       Totals& totals)
    : comm_(comm), formations_(problem.fleet.size()), recorder_([&] {
        results::Recorder made(comm, std::move(place), {}, run::attributes(comm, problem.scene), problem.scene.options);
        run::record_model(problem.scene, notes, made);
        made.names("/bridge", names_of(problem.stock));
        made.names("/formation", names_of(problem.fleet));
        std::vector<Dataset> sets;
        for (const PairColumn& column : pair_columns)
          sets.push_back({set_of(column), {problem.stock.size(), problem.fleet.size()}, {}, column.unit});
        sets.push_back({digest_set, {problem.stock.size()}, {}, "1"});
        made.empty_rows(sets);
        made.datasets(coordinates(problem));
        made.attributes("/screen", {{digest_attribute, problem.digest},
                                    {"modes", static_cast<long>(problem.scene.screen->modes)},
                                    {"decided_by", "0: no speed is permitted to both, 1: bound, 2: passages"}});
        for (auto& [bridge, row] : rows) {
          for (std::size_t c = 0; made.writes() && c < pair_width; ++c)
            made.put_row(bridge, {{set_of(pair_columns[c]),
                                   {row.begin() + static_cast<std::ptrdiff_t>(c * problem.fleet.size()),
                                    row.begin() + static_cast<std::ptrdiff_t>((c + 1) * problem.fleet.size())}}});
          made.put_row(bridge, {{digest_set, {row_digest(row)}}});
          totals.add(bridge, row);
          row = {};
        }
        made.publish();
        return made;
      }()) {}

void ScreenFile::write(std::size_t bridge, const std::vector<double>& row) {
  std::vector<std::pair<std::string, std::vector<double>>> values;
  for (std::size_t c = 0; c < pair_width; ++c) {
    const auto first = row.begin() + static_cast<std::ptrdiff_t>(c * formations_);
    values.emplace_back(set_of(pair_columns[c]),
                        std::vector<double>(first, first + static_cast<std::ptrdiff_t>(formations_)));
  }
  recorder_.put_row(bridge, values);
  recorder_.put_row(bridge, {{digest_set, {row_digest(row)}}});  // after the values are on the disk
}

void ScreenFile::put(std::size_t bridge, const std::vector<double>& row) {
  try {
    write(bridge, row);
  } catch (const FileError& error) {
    run::leave_together(comm_, error);
  }
}

void ScreenFile::finish(const Totals& totals, std::size_t bridges, double seconds, const std::string& ended,
                        const std::vector<results::Attribute>& further) {
  const auto other = [](const Governing& g) { return g.other(); };
  const auto ratio = [](const Governing& g) { return g.ratio(); };
  const std::vector<Governing>&b = totals.of_bridges(), &f = totals.of_formations();
  recorder_.change_beside();
  recorder_.datasets({{"/screen/governing_formation", {b.size()}, values_of(b, other), "1"},
                      {"/screen/bridge_ratio", {b.size()}, values_of(b, ratio), "1"},
                      {"/screen/governing_bridge", {f.size()}, values_of(f, other), "1"},
                      {"/screen/formation_ratio", {f.size()}, values_of(f, ratio), "1"}});
  const auto number = [](double value) { return static_cast<long>(value); };
  std::vector<results::Attribute> summary = {{"bridges_finished", static_cast<long>(bridges)},
                                             {"pairs_by_bound", number(totals.by_bound())},
                                             {"pairs_by_passages", number(totals.by_passages())},
                                             {"pairs_restricted", number(totals.restricted())},
                                             {"pairs_without_speed", number(totals.not_run())},
                                             {"wall_seconds", seconds},
                                             {"ended", ended}};
  summary.insert(summary.end(), further.begin(), further.end());
  recorder_.finish_with(summary, {"wall_seconds"});
}

}  // namespace traverse::screen
