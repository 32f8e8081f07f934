// Tables: text files with columns of numbers, separated by blanks, commas or semicolons; # begins a comment.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace traverse::options {

/// Whether the first column must increase from row to row.
enum class Order { unsorted, rising };

/// The columns of the file, all of the same length. Throws InputError with file and line if a line and the first line
/// have different numbers of entries, if a line has fewer than `least` or more than `most` entries, if a comma is
/// probably a decimal sign, or if a word is not a finite number or not a quantity.
std::vector<std::vector<double>> read_columns(const std::string& path, std::size_t least, std::size_t most,
                                              Order order = Order::unsorted);

/// Whether a comma between two digits is probably a decimal sign, because blanks or semicolons separate the words of
/// the row, as in 0;0,25. line: without its comment.
bool has_decimal_comma(std::string_view line);

inline constexpr const char* decimal_point = "a comma separates numbers, decimals need a point";

/// Magnitudes between which products and powers of SI quantities do not overflow or underflow; 0 is a quantity, too.
inline constexpr double least_quantity = 1e-50, greatest_quantity = 1e50;
/// Whether the number is 0 or its magnitude is between these two.
bool is_quantity(double number);

/// Converts a word that is a finite number as a whole; false for any other word. Magnitudes below least_quantity are 0.
bool parse_number(const std::string& word, double& number);
/// Converts a speed in m/s, or in km/h as in "300 km/h"; false for any other word.
bool parse_speed(std::string word, double& number);

}  // namespace traverse::options
