// The manual page, and the bash completion of option names and of values that are words, from the option table.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>

#include "help_groups.hpp"
#include "traverse/base/version.hpp"

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
.SH COMMANDS
Each lists its words after \-h.
.TP
.B traverse check
checks a railway bridge by EN 1991-2 and writes a report.
.TP
.B traverse fault
packs a scene, versions and results without private names, to report a fault.
.TP
.B traverse serve
offers forms and results as a page on this machine.
.TP
.B traverse\-report
writes a report of results files.
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
traverse check \-\-span 28 m \-\-EI 260 GN.m2 \-\-mass 19 t/m \-\-type prestressed \-\-line\-speed 250 km/h
.fi
)troff";

using Words = std::set<std::string>;

/// The prefixes of options with a name that users choose.
constexpr const char* user_named[] = {"vehicle_NAME_PART_", "vehicle_NAME_", "train_NAME_", "track_NAME_",
                                      "study_vary_NAME_"};

/// The shell pattern of an option: "beam_EI", or "vehicle_*_mass" for a name that users choose.
std::string pattern_of(std::string name) {
  for (const std::string_view word : {"NAME_PART", "NAME"})
    if (const std::size_t at = name.find(word); at != std::string::npos) return name.replace(at, word.size(), "*");
  return name;
}

void add_words(std::string_view text, Words& words) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (end > begin) words.emplace(text.substr(begin, end - begin));
    begin = end + 1;
  }
}

constexpr std::string_view script =
    R"(# Completion of traverse's options in bash: source this file, or install it among the completions.
_traverse() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev= words= at rest
  ((COMP_CWORD > 0)) && prev=${COMP_WORDS[COMP_CWORD - 1]}
  COMPREPLY=()
  case $prev in
@VALUES@  esac
  if [ -n "$words" ]; then
    # shellcheck disable=SC2207  # words without blanks
    COMPREPLY=($(compgen -W "$words" -- "$cur"))
    return
  fi
  [[ $cur == -* ]] || return
  words='@NAMES@'
  # shellcheck disable=SC2207
  COMPREPLY=($(compgen -W "$words" -- "$cur"))
  # Names that users choose: the part of the name after each underscore.
@USER_NAMED@}
complete -F _traverse traverse
)";

constexpr std::string_view after_user_name = R"(  if [[ $cur == -{0}* ]]; then
    for ((at = {1}; at < ${{#cur}}; ++at)); do
      [ "${{cur:at:1}}" = _ ] || continue
      rest=${{cur:at + 1}}
      # shellcheck disable=SC2207
      COMPREPLY+=($(compgen -P "${{cur:0:at + 1}}" -W '{2}' -- "$rest"))
    done
  fi
)";

void replace(std::string& text, std::string_view what, const std::string& with) {
  text.replace(text.find(what), what.size(), with);
}

}  // namespace

std::string manual_page(const std::string& integrators) {
  std::string page(before_options);
  replace(page, "{version}", version());
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

std::string bash_completion(const std::vector<std::string>& ts_types) {
  Words names, files;
  std::map<std::string, Words> choices, ends;  // by pattern; by the text before NAME
  for (const HelpGroup& group : help_groups())
    for (const auto& [name, row] : group.options) {
      const std::string pattern = "-" + pattern_of(name);
      add_words(row->choices, choices[pattern]);
      if (row->kind == Kind::flag) add_words("true false", choices[pattern]);
      if (row->kind == Kind::file || names_table(*row)) files.insert(pattern);
      bool named = false;
      for (const std::string_view before : user_named) {
        if (named || !name.starts_with(before)) continue;
        named = true;
        ends[std::string(before.substr(0, before.find("NAME")))].insert(name.substr(before.size()));
      }
      if (!named && name.find("NAME") == std::string::npos) names.insert("-" + name);
    }
  choices["-ts_type"] = {ts_types.begin(), ts_types.end()};
  for (const HelpGroup& group : help_groups()) choices["-help"].insert(group.name);
  for (const char* more : {"integrators", "vehicles", "man", "bash"}) choices["-help"].insert(more);
  files.insert({"-options_file", "-output_file"});

  std::string values;
  for (const auto& [pattern, words] : choices)
    if (!words.empty() && pattern.find('*') == std::string::npos)
      values += fmt::format("    {}) words='{}' ;;\n", pattern, fmt::join(words, " "));
  for (const auto& [pattern, words] : choices)
    if (!words.empty() && pattern.find('*') != std::string::npos)
      values += fmt::format("    {}) words='{}' ;;\n", pattern, fmt::join(words, " "));
  values += fmt::format(
      "    {})\n      compopt -o filenames 2>/dev/null\n      mapfile -t COMPREPLY <<<\"$(compgen -f -- \"$cur\")\"\n"
      "      [ -n \"${{COMPREPLY[0]}}\" ] || COMPREPLY=()\n"
      "      return ;;\n",
      fmt::join(files, "|"));
  std::string after;
  for (const auto& [before, words] : ends)
    after += fmt::format(after_user_name, before, before.size() + 1, fmt::join(words, " "));

  std::string text(script);
  replace(text, "@VALUES@", values);
  replace(text, "@NAMES@", fmt::format("{}", fmt::join(names, " ")));
  replace(text, "@USER_NAMED@", after);
  return text;
}

}  // namespace traverse::options
