// Deals bridges over the ranks and collects their rows.
#include "screen/screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>

#include "ensemble/parallel_cases.hpp"
#include "ensemble/result_gather.hpp"
#include "results/stage.hpp"
#include "results/terminal.hpp"
#include "run/process.hpp"
#include "screen/audit.hpp"
#include "traverse/base/error.hpp"

namespace traverse::screen {
namespace {

constexpr std::size_t most_listed = 10;  // bridges on the terminal

std::vector<Verdict> judge_all(const Problem& problem, const Bridge& bridge, const std::function<void()>& after_each) {
  const options::Screen& screen = *problem.scene.screen;
  const BridgeModel model(bridge, screen.modes, screen.parts, screen.speeds, screen.samples);
  Pairs pairs(model);
  std::vector<Verdict> verdicts;
  for (const Formation& formation : problem.fleet) {
    verdicts.push_back(pairs.judge(formation));
    after_each();
    if (run::caught_signal() != 0) return {};
  }
  return verdicts;
}

ensemble::RunFailure compute(MPI_Comm comm, const Problem& problem, const std::vector<std::size_t>& open,
                             ScreenFile& file, Totals& totals, std::size_t& finished) {
  const results::Stage stage("bridges of the screen");
  ensemble::ResultGather gather(comm, [&](const std::vector<double>& message) {
    const std::vector<double> row(message.begin() + 1, message.end());
    const auto bridge = static_cast<std::size_t>(message.front());
    file.put(bridge, row);
    totals.add(bridge, row);
    ++finished;
  });
  ensemble::SharedWork work;
  work.pieces.assign(open.size(), {1, 1.0});
  work.compute = [&](std::size_t piece, const std::function<void(double)>& reached) {
    double done = 0.0;
    const std::vector<Verdict> verdicts = judge_all(problem, problem.stock[open[piece]], [&] {
      done += 1.0;
      reached(done / static_cast<double>(problem.fleet.size()));
      gather.collect();
    });
    if (verdicts.empty()) return;  // a signal ends the screen
    std::vector<double> message = {static_cast<double>(open[piece])};
    const std::vector<double> row = row_of(verdicts);
    message.insert(message.end(), row.begin(), row.end());
    gather.send(std::move(message));
    gather.collect();
  };
  work.name = [&](std::size_t piece) { return "the bridge " + problem.stock[open[piece]].name; };
  ensemble::RunFailure failure = ensemble::run_cases_in_parallel(comm, work, problem.scene.quiet);
  gather.finish();
  return ensemble::first_of(comm, std::move(failure));
}

/// Collective. The bridges without a finished row, which only rank 0 knows.
std::vector<std::size_t> open_bridges(MPI_Comm comm, const Problem& problem,
                                      const std::map<std::size_t, std::vector<double>>& known) {
  std::vector<char> done(problem.stock.size(), 0);
  for (const auto& [bridge, row] : known) done[bridge] = 1;
  MPI_Bcast(done.data(), static_cast<int>(done.size()), MPI_CHAR, 0, comm);
  std::vector<std::size_t> open;
  for (std::size_t b = 0; b < done.size(); ++b)
    if (done[b] == 0) open.push_back(b);
  return open;
}

void print_results(const Problem& problem, const Totals& totals, double seconds) {
  const double pairs = totals.by_bound() + totals.by_passages();
  fmt::print("pairs    {:.0f} of {:.0f}: {:.0f} decided by the bound, {:.0f} by passages; {:.0f} restricted; {}\n",
             pairs, static_cast<double>(problem.stock.size() * problem.fleet.size()), totals.by_bound(),
             totals.by_passages(), totals.restricted(), results::duration_text(seconds));
  std::vector<std::size_t> order;
  for (std::size_t b = 0; b < problem.stock.size(); ++b)
    if (std::isfinite(totals.of_bridges()[b].ratio())) order.push_back(b);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return totals.of_bridges()[a].ratio() > totals.of_bridges()[b].ratio();
  });
  order.resize(std::min(order.size(), most_listed));
  std::vector<std::vector<std::string>> rows = {{"bridge", "response / limit", "governing formation"}};
  for (const std::size_t b : order) {
    const Governing& governing = totals.of_bridges()[b];
    rows.push_back({problem.stock[b].name,
                    fmt::format("{}{:.3f}", governing.exact() ? "" : "at most ", governing.ratio()),
                    problem.fleet[static_cast<std::size_t>(governing.other())].name});
  }
  if (!order.empty()) results::print_columns(std::move(rows));
}

}  // namespace

std::vector<std::string> description(const Problem& problem) {
  const options::Screen& screen = *problem.scene.screen;
  const double kmh = 3.6;
  std::vector<std::string> lines = {
      fmt::format("{} bridges under {} formations at up to {} speeds from {:g} to {:g} km/h", problem.stock.size(),
                  problem.fleet.size(), screen.speeds.size(), kmh * screen.speeds.front(), kmh * screen.speeds.back()),
      fmt::format(
          "moving forces on {} modes of bending of each bridge, exact in time; deck accelerations have no other filter "
          "than these modes",
          screen.modes)};
  lines.insert(lines.end(), problem.notes.begin(), problem.notes.end());
  return lines;
}

double memory_of(const Problem& problem) {
  constexpr double program = 7e7, a_row = 4.0 * sizeof(double) * pair_width;  // copies of a row, bytes a formation
  double bytes = program + a_row * static_cast<double>(problem.fleet.size());
  for (const Formation& formation : problem.fleet)
    bytes += static_cast<double>(sizeof(Formation) + 2 * sizeof(double) * formation.loads.size());
  return bytes + static_cast<double>(problem.stock.size() * sizeof(Bridge));
}

int run(MPI_Comm comm, results::Place place, const Problem& problem, const std::vector<std::string>& notes) {
  const auto begin = std::chrono::steady_clock::now();
  std::map<std::size_t, std::vector<double>> known = stored_rows(comm, problem);
  const std::vector<std::size_t> open = open_bridges(comm, problem, known);
  const run::DeferredSignals deferred;
  Totals totals(problem.stock.size(), problem.fleet.size());
  ScreenFile file(comm, std::move(place), problem, notes, known, totals);
  known.clear();
  std::size_t finished = problem.stock.size() - open.size();
  const ensemble::RunFailure failure = compute(comm, problem, open, file, totals, finished);
  const int signal = run::signal_on_any(comm);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::string ended = failure.failed() ? failure.message
                            : signal != 0    ? fmt::format("ended by signal {}", signal)
                                             : "reached its end";
  std::optional<Audit> checked;
  if (ended == "reached its end" && problem.scene.screen->audit > 0)
    checked = audit(comm, problem, problem.scene.screen->audit);
  try {
    file.finish(totals, finished, seconds, ended, checked ? checked->attributes() : std::vector<results::Attribute>());
  } catch (const FileError& error) {
    run::leave_together(comm, error);
  }
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0) {
    print_results(problem, totals, seconds);
    if (checked) fmt::print("{}\n", checked->text());
    if (!problem.scene.output.file.empty()) fmt::print("results  {}\n", problem.scene.output.file);
    if (ended != "reached its end")
      fmt::print("{}; screen_resume continues after {} of {} bridges\n", ended, finished, problem.stock.size());
  }
  if (failure.failed()) throw Error(failure.message, failure.status);
  return signal == 0 ? 0 : 128 + signal;
}

}  // namespace traverse::screen
