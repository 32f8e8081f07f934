// The manual page, from the option table.
#include <fmt/format.h>

#include "help_groups.hpp"

namespace traverse::options {
namespace {

/// The text with all characters escaped that troff would interpret.
std::string literal(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if (out.empty() && (c == '.' || c == '\''))
      out += std::string("\\&") + c;
    else
      out += c;
  }
  return out;
}

constexpr std::string_view before_options = R"troff(.TH TRAVERSE 1 "" "traverse {version}" "User Commands"
.SH NAME
traverse \- computes how trains, lorries and mechanisms cross flexible beams
.SH SYNOPSIS
.B traverse
.RB [ \-options_file
.IR scene.yml ]...
.RB [ \-\fIoption\fR
.IR value ]...
.br
.B mpirun \-n
.I N
.B traverse
\&...
.br
.B traverse \-help
.RI [ group | option ]
.SH DESCRIPTION
A scene consists of a bridge, a track, trains and the requested analysis, all given by options. They are read from YAML
files, in which nested keys join with underscores (beam: {spans: [25.0, 30.0]} is \-beam_spans 25.0,30.0), from
classic options files of PETSc and from the command line; later options override earlier ones. SI units; x along the
track from the bridge's left end, y upward. In lists value*count repeats.
.PP
Results go to an HDF5 file; the terminal shows what was modelled, progress and a summary.
.SH OPTIONS
)troff";

constexpr std::string_view after_options = R"troff(.SH FILES
Files that a scene names are searched beside the file that names them, then in the working directory, then in
.IR share/traverse ,
where the scenes of
.I options
are installed.
.SH EXIT STATUS
0 if the run has reached its end, 128 plus the number of the signal that ended it, or another number after one line with
the reason.
.SH EXAMPLES
.nf
traverse \-options_file options/scenes/three_span_train.yml
traverse \-options_file options/scenes/three_span_train.yml \-train_speed 70 \-describe
traverse \-help beam
traverse\-report results/three_span_train.h5
.fi
)troff";

}  // namespace

std::string manual_page(const std::string& integrators) {
  std::string page(before_options);
  const std::string version = "{version}";
  page.replace(page.find(version), version.size(), TRAVERSE_VERSION);
  for (const HelpGroup& group : help_groups()) {
    page += fmt::format(".SS {}\n", literal(group.heading));
    for (const auto& [name, row] : group.options)
      page += fmt::format(".TP\n.B {}\n{}\n.br\n{}\n", literal("-" + name), literal(row->text),
                          literal(allowed_in_short(*row)));
  }
  page += ".SS Time integrators\n.nf\n";
  for (std::size_t begin = 0, end = 0; begin < integrators.size(); begin = end + 1) {
    end = std::min(integrators.find('\n', begin), integrators.size());
    page += literal(std::string_view(integrators).substr(begin, end - begin)) + "\n";
  }
  return page + ".fi\n" + std::string(after_options);
}

}  // namespace traverse::options
