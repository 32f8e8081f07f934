// The names of all spectra for help texts and messages, from their table.
#pragma once

#include "base/text.hpp"
#include "traverse/track/spectrum.hpp"

namespace traverse::track {

/// "iso8608_A to iso8608_E (roads), ...".
inline constexpr base::StaticText names_of_spectra = [] {
  base::StaticText text;
  base::add_joined(text, spectra, ", ", [](base::StaticText& to, const SpectrumRow& row) {
    to.add(row.name);
    if (row.grades.size() > 1)
      for (const std::string_view part :
           {row.grades.substr(0, 1), std::string_view(" to "), row.name, row.grades.substr(row.grades.size() - 1)})
        to.add(part);
    for (const std::string_view part : {std::string_view(" ("), row.surface, std::string_view(")")}) to.add(part);
  });
  return text;
}();

}  // namespace traverse::track
