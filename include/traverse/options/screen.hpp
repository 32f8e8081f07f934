// The options of a screen: every formation of a fleet over every bridge of a stock.
#pragma once

#include <string>
#include <vector>

namespace traverse::options {

struct Screen {
  std::string stock, fleet;    // paths of the table of bridges, and of the table or folder of formations
  std::vector<double> speeds;  // m/s, ascending, with equal steps
  int modes = 3;               // of each bridge
  int parts = 10;              // of each span, between the stations
  double samples = 20.0;       // per period of the highest mode
  bool resume = false;         // bridges that are finished in the results file are not computed again
  int audit = 0;               // pairs that are checked by all passages
  /// A bridge and a formation whose scene is printed, and for one with vehicles the options file of the train; empty:
  /// none.
  std::vector<std::string> pair;
};

}  // namespace traverse::options
