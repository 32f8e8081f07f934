// Axle forces and positions of the trains HSLM-A and HSLM-B (EN 1991-2, 6.4.6.1.1), of the reference wagons of EN
// 15528, annex A, and of lists in files.
#include "load_models.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace traverse::scene {
namespace {

constexpr double hslm_b_force = 170e3;   // N
constexpr double tonne_weight = 9810.0;  // N

/// EN 15528, annex A: the axle load in t and the distance of the two inner axles in m.
struct ReferenceWagon {
  std::string_view line;
  double axle_load, inner;
};
constexpr ReferenceWagon reference_wagons[] = {
    {"A1", 16.0, 6.20}, {"B1", 18.0, 7.80}, {"B2", 18.0, 4.65}, {"C2", 20.0, 5.90},
    {"C3", 20.0, 4.50}, {"C4", 20.0, 3.40}, {"D2", 22.5, 7.45}, {"D3", 22.5, 5.90},
    {"D4", 22.5, 4.65}, {"D5", 22.5, 3.62}, {"E4", 25.0, 5.90}, {"E5", 25.0, 4.75},
};
constexpr double bogie_wheelbase = 1.8, overhang = 1.5;  // m; overhang: distance from the buffers to the outer axle

}  // namespace

AxleList hslm_a(int train) {
  struct Type {
    int coaches;
    double length, bogie, force;  // m, m, kN
  };
  static constexpr std::array<Type, 10> types = {{{18, 18.0, 2.0, 170.0},
                                                  {17, 19.0, 3.5, 200.0},
                                                  {16, 20.0, 2.0, 180.0},
                                                  {15, 21.0, 3.0, 190.0},
                                                  {14, 22.0, 2.0, 170.0},
                                                  {13, 23.0, 2.0, 180.0},
                                                  {13, 24.0, 2.0, 190.0},
                                                  {12, 25.0, 2.5, 190.0},
                                                  {11, 26.0, 2.0, 210.0},
                                                  {11, 27.0, 2.0, 210.0}}};
  const auto [coaches, length, bogie, force] = types[static_cast<std::size_t>(train - 1)];
  constexpr std::array power_car = {0.0, 3.0, 14.0, 17.0};
  constexpr double coupling = 3.525;  // distance from a power car's last axle to the first axle of the end coach
  const double whole = 2.0 * power_car.back() + coupling + (coaches + 2) * length;
  std::vector<double> behind(power_car.begin(), power_car.end());
  behind.push_back(power_car.back() + coupling);
  behind.push_back(power_car.back() + coupling + bogie);
  const std::size_t mirrored = behind.size();
  for (int i = 1; i <= coaches + 1; ++i) {  // bogies between two coaches
    const double centre = power_car.back() + 0.5 * coupling + i * length;
    behind.push_back(centre - 0.5 * bogie);
    behind.push_back(centre + 0.5 * bogie);
  }
  for (std::size_t i = mirrored; i-- > 0;) behind.push_back(whole - behind[i]);
  for (double& x : behind) x = -x;
  return {std::vector<double>(behind.size(), force * 1e3), behind};
}

AxleList hslm_b(int forces, double distance) {
  AxleList axles{std::vector<double>(static_cast<std::size_t>(forces), hslm_b_force), {}};
  for (int i = 0; i < forces; ++i) axles.offsets.push_back(-i * distance);
  return axles;
}

AxleList en15528(std::string_view line, int wagons) {
  const auto wagon = std::find_if(std::begin(reference_wagons), std::end(reference_wagons),
                                  [&](const ReferenceWagon& one) { return one.line == line; });
  const double last = 2.0 * bogie_wheelbase + wagon->inner, length = last + 2.0 * overhang;
  AxleList axles;
  for (int i = 0; i < wagons; ++i)
    for (const double behind : {0.0, bogie_wheelbase, last - bogie_wheelbase, last})
      axles.offsets.push_back(-i * length - behind);
  axles.forces.assign(axles.offsets.size(), wagon->axle_load * tonne_weight);
  return axles;
}

AxleList axles_of(const Formation& formation) {
  AxleList axles{formation.loads, formation.distance};
  for (double& offset : axles.offsets) offset = 0.0 - offset;
  return axles;
}

AxleList axles_of(const std::vector<std::vector<double>>& columns, bool backward) {
  AxleList axles{columns[1], columns[0]};
  if (backward)
    for (double& offset : axles.offsets) offset = -offset;
  const double first = *std::max_element(axles.offsets.begin(), axles.offsets.end());
  for (double& offset : axles.offsets) offset -= first;
  return axles;
}

}  // namespace traverse::scene
