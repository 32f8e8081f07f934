// Numbers and speeds in the words of options, tables and other text files.
#pragma once

#include <string>
#include <string_view>

namespace traverse::options {

inline constexpr const char* decimal_point = "a comma separates numbers, decimals need a point";

/// Magnitudes between which products and powers of SI quantities do not overflow or underflow; 0 is a quantity, too.
inline constexpr double least_quantity = 1e-50, greatest_quantity = 1e50;
/// Whether the number is 0 or its magnitude is between these two.
bool is_quantity(double number);

/// Converts a word that is a finite number as a whole; false for any other word. Magnitudes below least_quantity are 0.
bool parse_number(std::string_view word, double& number);
/// The same with a comma as decimal sign; 12 is a number in both.
bool parse_number_with_comma(std::string_view word, double& number);
/// Converts a speed in m/s, or in km/h as in "300 km/h"; false for any other word.
bool parse_speed(std::string_view word, double& number);

}  // namespace traverse::options
