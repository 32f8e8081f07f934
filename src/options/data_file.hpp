// Numbers in columns: text files with blanks, commas or semicolons between numbers and # before comments.
#pragma once

#include <string>
#include <vector>

namespace traverse::options {

/// Whether the first column has to increase from row to row.
enum class Order { unsorted, rising };

/// The file by columns, each of the same length. Throws InputError naming file and line when a line does not hold
/// as many numbers as the first one, fewer than `least` or more than `most`, or something that is no finite number or
/// no quantity.
std::vector<std::vector<double>> read_columns(const std::string& path, std::size_t least, std::size_t most,
                                              Order order = Order::unsorted);

/// Products and powers of SI units stay far from overflow and underflow between these magnitudes; 0 is a quantity, too.
inline constexpr double least_quantity = 1e-50, greatest_quantity = 1e50;
bool is_quantity(double number);

/// A finite number that fills the whole word; false otherwise.
bool parse_number(const std::string& word, double& number);
/// The same of a speed in m/s, which may be written in km/h: "300 km/h".
bool parse_speed(std::string word, double& number);

}  // namespace traverse::options
