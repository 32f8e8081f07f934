// Reads the options of a search, find_...: the option whose values are searched, the condition that they shall meet,
// and the first values of the search.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "scene_parts.hpp"
#include "vary_reader.hpp"

namespace traverse::scene {
namespace {

using options::Options;

constexpr double points_by_default = 13.0;
constexpr double most_points = 2000.0;
constexpr double points_in_width = 2.0;  // first speeds in the half-power width of a resonance
constexpr double undamped_width = 0.01;  // relative to the speed, if no damping ratio is given
constexpr double wide_range = 4.0;       // ratio of the ends from which on the first values form a geometric series

/// The quantities of a study's columns that a search can have.
constexpr const char* kept_peaks[] = {"peak_deflection", "peak_acceleration",    "peak_moment",
                                      "amplification",   "greatest_wheel_force", "longest_loss"};

bool is_speed_option(const std::string& option) { return option.ends_with("_speed"); }

std::string names_of_quantities(const Scene& scene) {
  std::string names;
  for (const options::VerdictLimit& limit : scene.limits)
    if (options::limit_quantity(limit.quantity)->finder == options::LimitFinder::run) names += limit.quantity + ", ";
  for (const char* peak : kept_peaks) names += fmt::format("{}{}", peak, peak == std::end(kept_peaks)[-1] ? "" : ", ");
  return names;
}

/// The first values of a search between `from` and `to`, at least three.
std::vector<double> first_values(double from, double to, double points) {
  const bool geometric = from > 0.0 && to / from > wide_range;
  const int last = static_cast<int>(std::clamp(std::ceil(points), 3.0, most_points)) - 1;
  std::vector<double> values;
  for (int i = 0; i <= last; ++i) {
    const double part = static_cast<double>(i) / last;
    values.push_back(geometric ? from * std::pow(to / from, part) : from + (to - from) * part);
  }
  values.back() = to;
  return values;
}

/// Without find_points, the number of speeds that no resonance fits between.
double points_for(const Options& o, const Scene& scene, const StudyDimension& searched) {
  if (o.has("find_points")) return o.integer("find_points");
  if (!is_speed_option(searched.name())) return points_by_default;
  const double damping = least_damping(scene), width = damping > 0.0 ? 2.0 * damping : undamped_width;
  return 1.0 + points_in_width * std::log(searched.values.back() / searched.values.front()) / width;
}

}  // namespace

bool describes_search(const Options& o) { return o.has("find_option"); }

StudyDimension searched_dimension(const Options& o) {
  const std::string option = o.text("find_option");
  o.check_known("find_option", option);
  const VaryReader reader(o, option);
  if (reader.whole()) o.refuse("find_option", option + " has whole numbers; vary it by study_vary_" + option);
  StudyDimension searched{{option}, std::string(reader.unit().empty() ? "1" : reader.unit()), false, "list", {}, 0};
  reader.add_others("find_also", searched);
  for (const std::string& one : searched.options)
    if (const std::string why = why_not_varied(o, one); !why.empty())
      o.refuse(one == option ? "find_option" : "find_also", fmt::format("{} cannot be varied: {}", one, why));
  for (const std::string& word : o.texts("find_between")) {
    searched.values.push_back(reader.number("find_between", word));
    reader.check("find_between", searched.values.back());
  }
  if (!(searched.values[0] < searched.values[1]))
    o.refuse("find_between", "the second value is not above the first; allowed: the least, then the greatest value");
  return searched;
}

void read_search(const Options& o, Study& study) {
  if (!describes_search(o)) return;
  options::Find find;
  const std::string option = o.text("find_option");
  const auto of_option = [&](const std::string& name) {
    const auto found = std::find_if(study.dimensions.begin(), study.dimensions.end(), [&](const StudyDimension& d) {
      return std::find(d.options.begin(), d.options.end(), name) != d.options.end();
    });
    if (found == study.dimensions.end())
      o.refuse("find_for_each",
               fmt::format("'{}' is not varied; allowed: options of study_vary and of the sweep", name));
    return static_cast<std::size_t>(found - study.dimensions.begin());
  };
  find.dimension = of_option(option);
  const std::size_t own = study.dimensions[find.dimension].axis;
  if (o.has("find_for_each")) {
    for (const std::string& name : o.texts("find_for_each"))
      find.for_each.push_back(study.dimensions[of_option(name)].axis);
  } else if (is_speed_option(option)) {
    for (const StudyDimension& d : study.dimensions)
      if (d.axis != own && d.law == "list" && d.name() != "track_seed") find.for_each.push_back(d.axis);
  }
  std::sort(find.for_each.begin(), find.for_each.end());
  find.for_each.erase(std::unique(find.for_each.begin(), find.for_each.end()), find.for_each.end());
  if (std::find(find.for_each.begin(), find.for_each.end(), own) != find.for_each.end())
    o.refuse("find_for_each", option + " is the option of the search");
  for (const char* other : {"study_refine", "sweep_refine"})
    if (o.has(other) && o.number(other) > 0.0)
      o.refuse(other, "not with a search (find_option), which adds runs itself");
  find.accuracy = o.number("find_accuracy");
  study.over.clear();
  study.find = find;
}

void finish_search(const Options& o, Scene& scene) {
  if (!scene.study->find) return;
  options::Find& find = *scene.study->find;
  StudyDimension& searched = scene.study->dimensions[find.dimension];
  searched.values = first_values(searched.values.front(), searched.values.back(), points_for(o, scene, searched));
  scene.study->axes[searched.axis].length = searched.values.size();
  const std::string keep = o.text("find_keep");
  if (o.has("find_quantity")) {
    find.quantity = o.text("find_quantity");
    find.value = o.number("find_equals");
  } else if (keep != "limits") {
    find.quantity = keep;
  }
  const auto limited = [&](const options::VerdictLimit& limit) {
    return limit.quantity == find.quantity &&
           options::limit_quantity(limit.quantity)->finder == options::LimitFinder::run;
  };
  const bool has_limit = std::any_of(scene.limits.begin(), scene.limits.end(), limited);
  const bool is_peak = std::find(std::begin(kept_peaks), std::end(kept_peaks), find.quantity) != std::end(kept_peaks);
  if (find.value ? !has_limit && !is_peak : !find.quantity.empty() && !has_limit)
    o.refuse(find.value ? "find_quantity" : "find_keep",
             fmt::format("'{}' is not a quantity of this search; allowed: {}", find.quantity,
                         find.value ? names_of_quantities(scene) : "limits, or the quantity of one of the limits"));
  if (!find.value && !scene.has_run_limits())
    o.refuse("find_option", "no limits of runs are given (limits FILE); without limits: find_quantity and find_equals");
  std::erase_if(scene.limits, [&](const options::VerdictLimit& limit) {  // runs do not evaluate the others
    return options::limit_quantity(limit.quantity)->finder != options::LimitFinder::run ||
           (!find.quantity.empty() && limit.quantity != find.quantity);
  });
}

}  // namespace traverse::scene
