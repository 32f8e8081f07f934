// Draws the side view of bridge and train, or the plane view of a mechanism, by mapping coordinates to rows and columns
// of characters. UTF-8, colour and width follow from the locale, TERM, NO_COLOR and the size of the terminal window.
#include "drawing.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <langinfo.h>
#include <locale.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace traverse::check {
namespace {

constexpr int max_drawing_rows = 18;   // rows of a mechanism
constexpr double height_of_row = 2.0;  // ratio to the width of a column
constexpr int number_gap = 2;          // columns between the numbers of the ruler

constexpr Symbol body_symbol{'#', "█", "body"}, wheel_symbol{'o', "●", "wheel"}, force_symbol{'v', "↓", "force"},
    joint{'+', "◆", "joint"}, spring_symbol{'z', "≈", "spring"}, rope_symbol{'!', "│", "rope"}, link{'.', "·", ""},
    ground{'_', "▁", "ground"}, front{'[', "▐", ""}, rear{']', "▌", ""}, car{'=', "█", "vehicle"},
    deck{'=', "━", "beam"}, rail{'-', "─", "rail"}, sleeper{':', "┴", "sleepers"}, hinge{'+', "◦", "hinge"},
    span_end{'|', "┃", "spans end"}, bed{'~', "≋", "bed"};
constexpr Symbol supports[] = {{' ', " ", ""},        {'O', "○", "roller"}, {'^', "▲", "pinned"},
                               {'#', "█", "clamped"}, {'H', "╫", "guided"}, {' ', " ", ""}};

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void include(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double size() const { return high - low; }
};

/// The extent of a vehicle's bodies along x.
Extent extent_of(const scene::Scene& scene, std::size_t i) {
  Extent extent;
  const double origin = scene.train.positions[i];
  for (const multibody::Body& one : scene.vehicles[static_cast<std::size_t>(scene.train.vehicles[i])].mechanism.bodies)
    extent.include(origin + one.position.x());
  return extent;
}

class SideView {
 public:
  SideView(const scene::Scene& scene, const OutputStyle& style)
      : scene_(scene), beam_(*scene.beam), canvas_(style.width - 2, rows, style.utf8) {
    extent_.include(beam_.start);
    extent_.include(beam_.end());
    if (beam_.track) {
      extent_.include(beam_.start - beam_.track->approach);
      extent_.include(beam_.end() + beam_.track->approach);
    }
    for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i) {
      const Extent one = extent_of(scene, i);
      extent_.include(one.low);
      extent_.include(one.high);
    }
    for (const double x : scene.load.positions) extent_.include(x);
  }

  std::vector<std::string> draw() {
    draw_train();
    draw_beam();
    draw_foundation();
    draw_ruler();
    std::vector<std::string> lines = canvas_.lines();
    std::erase(lines, "");
    for (std::string& line : lines) line.insert(0, "  ");
    lines.push_back("  " + canvas_.legend());
    lines.push_back(
        fmt::format("  to scale along x, a character is {:.3g} m", extent_.size() / (canvas_.columns() - 1)));
    return lines;
  }

 private:
  enum Row { vehicles, wheels, rails, decks, bearings, springs, beds, ruler, rows };

  int column(double x) const {
    return static_cast<int>(std::lround((x - extent_.low) / extent_.size() * (canvas_.columns() - 1)));
  }
  void fill(int row, double from, double to, const Symbol& symbol) {
    for (int i = column(from); i <= column(to); ++i) canvas_.put(i, row, symbol);
  }
  void draw_train() {
    for (std::size_t i = 0; i < scene_.train.vehicles.size(); ++i) {
      const Extent one = extent_of(scene_, i);
      fill(vehicles, one.low, one.high, car);
      if (column(one.high) > column(one.low) + 1) {
        canvas_.put(column(one.low), vehicles, front);
        canvas_.put(column(one.high), vehicles, rear);
      }
    }
    for (const double x : scene_.load.positions) canvas_.put(column(x), wheels, force_symbol);
    for (const double x : scene::wheels_at_start(scene_)) canvas_.put(column(x), wheels, wheel_symbol);
  }
  void draw_beam() {
    if (beam_.track) {
      fill(rails, beam_.start - beam_.track->approach, beam_.end() + beam_.track->approach, rail);
      fill(decks, beam_.start - beam_.track->approach, beam_.end() + beam_.track->approach, sleeper);
    }
    fill(decks, beam_.start, beam_.end(), deck);
    double x = beam_.start;
    for (std::size_t i = 0; i < beam_.supports.size(); ++i) {
      const bool inner = i > 0 && i + 1 < beam_.supports.size();
      const beam::Joint joint_type = inner ? beam_.joint(static_cast<int>(i)) : beam::Joint::continuous;
      // joints closer than a character are not drawn
      if (joint_type != beam::Joint::continuous && spans_are_visible())
        canvas_.put(column(x), decks, joint_type == beam::Joint::hinge ? hinge : span_end);
      const Symbol& support = supports[static_cast<std::size_t>(beam_.supports[i])];
      if (support.ascii != ' ') canvas_.put(column(x), bearings, support);
      if (i < beam_.spans.size()) x += beam_.spans[i];
    }
    for (const double at : beam_.hinges) canvas_.put(column(at), decks, hinge);
    for (const beam::Crack& at : beam_.cracks) canvas_.put(column(at.x), decks, hinge);
  }
  void draw_foundation() {
    for_points(beam_.foundation, [&](const beam::FoundationKind&, const auto& points) {
      for (const beam::PointFoundation& point : points) canvas_.put(column(point.x), springs, spring_symbol);
    });
    for_beds(beam_.foundation,
             [&](const beam::FoundationKind&, const beam::Bed&) { fill(beds, beam_.start, beam_.end(), bed); });
  }
  /// Stations of span ends, where the line has space for their numbers.
  void draw_ruler() {
    double x = beam_.start;
    int free = 0;
    const std::string last = fmt::format("{:g} m", beam_.end());
    const int end = std::min(column(beam_.end()), canvas_.columns() - static_cast<int>(last.size()));
    for (const double span : beam_.spans) {
      const std::string number = fmt::format("{:g}", x);
      const int size = static_cast<int>(number.size());
      if (column(x) >= free && column(x) + size + number_gap <= end) {
        canvas_.text(column(x), ruler, number);
        free = column(x) + size + number_gap;
      }
      x += span;
    }
    canvas_.text(std::max(end, 0), ruler, last);
  }
  bool spans_are_visible() const {
    return column(beam_.start + *std::min_element(beam_.spans.begin(), beam_.spans.end())) > column(beam_.start) + 1;
  }

  const scene::Scene& scene_;
  const beam::BeamModel& beam_;
  Canvas canvas_;
  Extent extent_;
};

/// Bodies with their joints and springs in their plane.
class Plane {
 public:
  Plane(const scene::Scene& scene, const OutputStyle& style)
      : scene_(scene), columns_(style.width - 2), utf8_(style.utf8) {
    each([&](const train::Vehicle& vehicle, double origin) {
      const auto include = [&](const Eigen::Vector2d& point) {
        x_.include(origin + point.x());
        y_.include(point.y());
      };
      for (const multibody::Body& one : vehicle.mechanism.bodies) include(one.position.head<2>());
      for (const multibody::Joint& one : vehicle.mechanism.joints) {
        include(one.type->needs.ends ? one.from : one.point);
        if (one.type->needs.ends) include(one.to);
      }
      for (const multibody::Spring& one : vehicle.mechanism.springs) {
        include(one.from);
        include(one.to);
      }
      for (const multibody::Rope& one : vehicle.mechanism.ropes)
        for (const Eigen::Vector2d& point : one.points) include(point);
      if (!vehicle.wheels.empty()) y_.include(0.0);
    });
    column_width_ = std::max(x_.size() / (columns_ - 1), y_.size() / (max_drawing_rows - 1) / height_of_row);
    if (!(column_width_ > 0.0)) column_width_ = 1.0;
  }

  std::vector<std::string> draw() {
    const int wide = static_cast<int>(std::lround(x_.size() / column_width_)) + 1;
    const int tall = static_cast<int>(std::lround(y_.size() / column_width_ / height_of_row)) + 1;
    Canvas canvas(std::min(wide, columns_), std::min(tall, max_drawing_rows), utf8_);
    each([&](const train::Vehicle& vehicle, double origin) { draw(vehicle, origin, canvas); });
    std::vector<std::string> lines = canvas.lines();
    for (std::string& line : lines) line.insert(0, "  ");
    lines.push_back("  " + canvas.legend());
    lines.push_back(fmt::format("  to scale, a character is {:.3g} m wide and {:.3g} m high, x from {:g} to {:g} m",
                                column_width_, column_width_ * height_of_row, x_.low, x_.high));
    return lines;
  }

 private:
  template <class Visit>
  void each(Visit visit) const {
    for (std::size_t i = 0; i < scene_.train.vehicles.size(); ++i)
      visit(scene_.vehicles[static_cast<std::size_t>(scene_.train.vehicles[i])], scene_.train.positions[i]);
  }
  std::pair<int, int> place(double origin, const Eigen::Vector2d& point) const {
    return {static_cast<int>(std::lround((origin + point.x() - x_.low) / column_width_)),
            static_cast<int>(std::lround((y_.high - point.y()) / column_width_ / height_of_row))};
  }
  void line(double origin, const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Symbol& symbol,
            Canvas& canvas) const {
    const auto a = place(origin, from), b = place(origin, to);
    const int steps = std::max(std::abs(a.first - b.first), std::abs(a.second - b.second));
    for (int i = 0; i <= steps; ++i) {
      const auto [column, row] = place(origin, from + (to - from) * (steps > 0 ? static_cast<double>(i) / steps : 0.0));
      canvas.put(column, row, symbol);
    }
  }
  void draw(const train::Vehicle& vehicle, double origin, Canvas& canvas) const {
    const multibody::MechanismModel& m = vehicle.mechanism;
    const auto put = [&](const Eigen::Vector2d& point, const Symbol& symbol) {
      const auto [column, row] = place(origin, point);
      canvas.put(column, row, symbol);
    };
    const auto draw_link = [&](int body_index, const Eigen::Vector2d& point) {
      if (body_index != multibody::ground)
        line(origin, m.bodies[static_cast<std::size_t>(body_index)].position.head<2>(), point, link, canvas);
    };
    if (!vehicle.wheels.empty())
      for (int column = 0; column < canvas.columns(); ++column) {
        const auto [ignored, row] = place(origin, {0.0, 0.0});
        if (canvas.empty(column, std::min(row, canvas.rows() - 1))) canvas.put(column, row, ground);
      }
    for (const multibody::Joint& one : m.joints) {
      const bool ends = one.type->needs.ends;
      draw_link(one.bodies[0], ends ? one.from : one.point);
      draw_link(one.bodies[1], ends ? one.to : one.point);
      if (ends) line(origin, one.from, one.to, link, canvas);
    }
    for (const multibody::Spring& one : m.springs) line(origin, one.from, one.to, spring_symbol, canvas);
    for (const multibody::Rope& one : m.ropes)
      for (std::size_t i = 0; i + 1 < one.points.size(); ++i)
        line(origin, one.points[i], one.points[i + 1], rope_symbol, canvas);
    for (const multibody::Joint& one : m.joints) put(one.type->needs.ends ? one.from : one.point, joint);
    for (const multibody::Body& one : m.bodies) put(one.position.head<2>(), body_symbol);
    for (const train::Wheel& one : vehicle.wheels)
      put(m.bodies[static_cast<std::size_t>(one.body)].position.head<2>(), wheel_symbol);
  }

  const scene::Scene& scene_;
  int columns_;
  bool utf8_;
  Extent x_, y_;
  double column_width_ = 1.0;  // m, width of a column
};

constexpr int min_width = 40, max_width = 160;

/// Whether the user's locale is UTF-8. The program itself keeps the C locale, whose numbers have decimal points.
bool is_utf8() {
  locale_t user_locale = newlocale(LC_CTYPE_MASK, "", nullptr);
  if (user_locale == nullptr) return false;
  const bool utf8 = std::string_view(nl_langinfo_l(CODESET, user_locale)) == "UTF-8";
  freelocale(user_locale);
  return utf8;
}

bool is_dumb() {
  const char* terminal = std::getenv("TERM");
  return terminal == nullptr || std::string_view(terminal) == "dumb";
}

}  // namespace

std::vector<std::string> drawing_of(const scene::Scene& scene, const OutputStyle& style) {
  return scene.beam ? SideView(scene, style).draw() : Plane(scene, style).draw();
}

OutputStyle output_style() {
  OutputStyle style;
  // Open MPI's mpirun runs ranks in a pseudo terminal, whatever its own output is.
  const bool under_mpirun = std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
  if (isatty(STDOUT_FILENO) != 1 || under_mpirun) return style;
  style.utf8 = is_utf8();
  style.colour = std::getenv("NO_COLOR") == nullptr && !is_dumb();
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
    style.width = std::clamp(static_cast<int>(size.ws_col) - 1, min_width, max_width);
  return style;
}

Canvas::Canvas(int columns, int rows, bool utf8)
    : columns_(columns), utf8_(utf8), cells_(static_cast<std::size_t>(columns * rows), " ") {}

void Canvas::put(int column, int row, const Symbol& symbol) {
  if (!inside(column, row)) return;
  const std::string shown = utf8_ ? std::string(symbol.utf8) : std::string(1, symbol.ascii);
  cells_[static_cast<std::size_t>(row * columns_ + column)] = shown;
  if (symbol.meaning.empty()) return;
  const std::string entry = fmt::format("{} {}", shown, symbol.meaning);
  if (std::find(legend_.begin(), legend_.end(), entry) == legend_.end()) legend_.push_back(entry);
}

void Canvas::text(int column, int row, std::string_view ascii) {
  for (const char c : ascii) {
    if (inside(column, row)) cells_[static_cast<std::size_t>(row * columns_ + column)] = std::string(1, c);
    ++column;
  }
}

std::vector<std::string> Canvas::lines() const {
  std::vector<std::string> lines;
  for (int row = 0; row < rows(); ++row) {
    std::string line;
    for (int column = 0; column < columns_; ++column) line += cell(column, row);
    line.resize(line.find_last_not_of(' ') + 1);
    lines.push_back(line);
  }
  return lines;
}

std::string Canvas::legend() const { return fmt::format("{}", fmt::join(legend_, ", ")); }

}  // namespace traverse::check
