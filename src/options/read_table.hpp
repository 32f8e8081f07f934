// Tables of numbers that options name: the columns that a reader wants, chosen and converted to SI units.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "options/table_text.hpp"

namespace traverse::options {

class Options;

/// Whether the first column must increase from row to row.
enum class Order { unsorted, rising };

/// The columns that a reader wants.
struct WantedColumns {
  std::size_t least = 2, most = 2;
  Order order = Order::unsorted;
  std::string_view units =
      {};                      // SI units, "s, N", of the first column and the others; empty: those of the option's row
  bool units_of_names = true;  // values have the units that the names of their columns give
  bool two_rails = false;      // a third column is possible, if two have the names left and right: their mean is used
};

/// How a user reads a table: the options NAME_columns, NAME_unit, NAME_factor, NAME_shift and NAME_decimal.
struct TableChoice {
  std::string option;                     // NAME; empty: there is none
  std::vector<std::string> columns = {};  // names or numbers: of the first column and the others, or of the second one
  std::vector<std::string> units =
      {};               // of the first column and the others, or of the others; empty: SI or by the names
  double factor = 1.0;  // of all columns but the first
  double shift = 0.0;   // added to the first column, in its SI unit
  Decimal decimal = Decimal::found;
};

/// The columns of a file, all of the same length. note: receives a line on how the file is written, if it does not have
/// decimal points and SI units. InputError with file and line if a line has another number of cells than the others or
/// than wanted, or if a word is not a finite number or not a quantity.
std::vector<std::vector<double>> read_columns(const std::string& path, const WantedColumns& wanted,
                                              const TableChoice& choice, std::string& note);
/// The columns of the file that an option names, by the options beside it. The note is given to the options.
std::vector<std::vector<double>> read_columns(const Options& o, const std::string& name, WantedColumns wanted);

}  // namespace traverse::options
