// Lines about a scene and its model for the terminal and the results file. Details carry a mark; the terminal prints
// them with -verbose only.
#pragma once

#include <string>
#include <string_view>

namespace traverse::base {

inline constexpr char detail_mark = '\t';

/// A line that describes the model and requires no action of the user.
inline std::string detail(const std::string& text) { return detail_mark + text; }
inline bool is_detail(std::string_view note) { return note.starts_with(detail_mark); }
/// The text of a note without a mark.
inline std::string text_of_note(std::string_view note) { return std::string(note.substr(is_detail(note) ? 1 : 0)); }

}  // namespace traverse::base
