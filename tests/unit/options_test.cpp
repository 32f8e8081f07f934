// Options files, the command line, typed reading and its messages.
#include "traverse/options/options.hpp"

#include <gtest/gtest.h>
#include <petscsys.h>

#include "options/read_file.hpp"
#include "support/message.hpp"
#include "support/temporary_folder.hpp"
#include "traverse/multibody/joint_type.hpp"
#include "traverse/options/analyses.hpp"
#include "traverse/options/input.hpp"

namespace traverse::options {
namespace {

using test::contains;
using test::message_of;

Input input_of(std::vector<std::string> words) {
  words.insert(words.begin(), "traverse");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  return read_input(static_cast<int>(argv.size()), argv.data());
}

std::string value_of(const Entries& entries, const std::string& name) {
  const Entry* entry = entries.find(name);
  return entry == nullptr ? "(none)" : entry->value;
}

TEST(Yaml, FlattensAsPetscDoes) {
  const auto entries = parse_yaml("beam:\n  spans: [25.0, 32.0*2]  # m\n  self_weight: true\ngravity: 9.81\n", "s.yml");
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[0].name, "beam_spans");
  EXPECT_EQ(entries[0].value, "25.0,32.0*2");
  EXPECT_EQ(entries[0].where(), "s.yml:2");
  EXPECT_EQ(entries[1].name, "beam_self_weight");
  EXPECT_EQ(entries[1].value, "true");
  EXPECT_EQ(entries[2].where(), "s.yml:4");
}

TEST(Yaml, EmptyFilesAndMergeKeys) {
  EXPECT_TRUE(parse_yaml("", "s.yml").empty());
  EXPECT_TRUE(parse_yaml("# nothing\n", "s.yml").empty());
  const auto entries = parse_yaml("$$wheel: &w {radius: 0.46}\na: {<<: *w, law: linear}\n", "s.yml");
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].name, "a_law");
  EXPECT_EQ(entries[1].name, "a_radius");
}

TEST(Yaml, ErrorsNameFileAndLine) {
  const auto refused = [](const std::string& text) { return message_of([&] { parse_yaml(text, "s.yml"); }); };
  EXPECT_PRED2(contains, refused("a: 1\nb: [1, 2\n"), "s.yml:3: ");
  EXPECT_PRED2(contains, refused("a: 1\n\tb: 2\n"), "s.yml:2: ");
  EXPECT_PRED2(contains, refused("just words\n"), "s.yml:1: ");
  EXPECT_PRED2(contains, refused("a: 1\nb: 2\na: 3\n"), "s.yml:3: a is given twice, first in line 1");
  EXPECT_PRED2(contains, refused("a: [[1, 2], [3]]\n"), "a list may contain numbers or words");
  EXPECT_PRED2(contains, refused("a b: 1\n"), "'a b' is not the name");
  EXPECT_PRED2(contains, refused("a: 1\n---\nb: 2\n"), "more than one YAML document");
}

TEST(Yaml, AnOptionOnceAFileHoweverItIsWritten) {
  const auto refused = [](const std::string& text) { return message_of([&] { parse_yaml(text, "s.yml"); }); };
  EXPECT_PRED2(contains, refused("beam: {mass: 1e4}\nbeam_mass: 3e4\n"),
               "s.yml:2: beam_mass is given twice, first in line 1");
  EXPECT_PRED2(contains, refused("a_b: {c: 1}\na: {b_c: 2}\n"), "a_b_c is given twice");
}

TEST(Yaml, TheBlocksOwnKeysWinOverMergedOnes) {
  for (const char* text : {"$$w: &w {r: 1, l: x}\na: {<<: *w, r: 2}\n", "$$w: &w {r: 1, l: x}\na: {r: 2, <<: *w}\n",
                           "$$w: &w {l: x}\n$$v: &v {r: 1, l: y}\na: {<<: [*w, *v], r: 2}\n"}) {
    SCOPED_TRACE(text);
    const auto entries = parse_yaml(text, "s.yml");
    ASSERT_EQ(entries.size(), 2u);
    for (const Entry& entry : entries) EXPECT_EQ(entry.value, entry.name == "a_r" ? "2" : "x");
  }
  EXPECT_PRED2(contains, message_of([] { parse_yaml("a: {<<: 3}\n", "s.yml"); }), "<< needs a block");
}

TEST(Yaml, EmptyListsAreMeantAndMissingValuesAreNot) {
  EXPECT_EQ(parse_yaml("a: []\n", "s.yml").front().value, "[]");
  const auto check = [](const char* text) { Options::from_yaml(text).check_values(); };
  check("train: {vehicles: []}\n");
  for (const char* text : {"train: {vehicles: }\n", "train: {vehicles: ''}\n", "train: {couplers: }\n"}) {
    SCOPED_TRACE(text);
    EXPECT_PRED2(contains, message_of([&] { check(text); }), "has no value");
    EXPECT_PRED2(contains, message_of([&] { check(text); }), "[] for none");
  }
}

TEST(Classic, NamesValuesAndComments) {
  const auto entries = parse_classic(
      "# a comment\n-train_speed 40 # m/s\n\n-beam_spans \"25, 30\"\n-log_view\n-gravity -5.0\n", "s.opt");
  ASSERT_EQ(entries.size(), 4u);
  EXPECT_EQ(entries[0].value, "40");
  EXPECT_EQ(entries[0].where(), "s.opt:2");
  EXPECT_EQ(entries[1].value, "25, 30");
  EXPECT_EQ(entries[2].value, "");
  EXPECT_EQ(entries[3].value, "-5.0");
  EXPECT_PRED2(contains, message_of([] { parse_classic("-a 1\nb 2\n", "s.opt"); }), "s.opt:2: ");
}

TEST(CommandLine, ThePositionDecides) {
  const test::TemporaryFolder folder;
  const std::string a = folder.write("a.yml", "train: {speed: 10}\ngravity: 1\n");
  const std::string b = folder.write("b.opt", "-train_speed 20\n");
  EXPECT_EQ(value_of(input_of({"-options_file", a, "-options_file", b}).entries, "train_speed"), "20");
  EXPECT_EQ(value_of(input_of({"-options_file", b, "-options_file", a}).entries, "train_speed"), "10");
  EXPECT_EQ(value_of(input_of({"-train_speed", "30", "-options_file", a}).entries, "train_speed"), "10");
  const Input last = input_of({"-options_file", a, "-train_speed", "30"});
  EXPECT_EQ(value_of(last.entries, "train_speed"), "30");
  EXPECT_EQ(last.entries.find("train_speed")->where(), "command line");
  EXPECT_EQ(last.entries.find("gravity")->where(), a + ":2");
  EXPECT_EQ(value_of(last.entries, "scene_name"), "a");
}

TEST(CommandLine, PetscSeesWhatItOwnsOutOfFilesToo) {
  const test::TemporaryFolder folder;
  const std::string a = folder.write("a.yml", "ts: {type: bdf, max_time: 0.1}\nlog_view:\ngravity: 1\n");
  const Input input = input_of({"-options_file", a, "-ts_max_time", "0.2", "-help", "-malloc_debug"});
  EXPECT_TRUE(input.help);
  EXPECT_EQ(input.petsc_words,
            (std::vector<std::string>{"traverse", "-skip_petscrc", "true", "-options_left", "false", "-ts_type", "bdf",
                                      "-ts_max_time", "0.2", "-log_view", "-malloc_debug"}));
}

TEST(CommandLine, RefusesWhatBelongsToNothing) {
  EXPECT_PRED2(contains, message_of([] { input_of({"scene.yml"}); }), "-options_file scene.yml");
  EXPECT_PRED2(contains, message_of([] { input_of({"runn", "scene.yml"}); }), "traverse run SCENE.yml");
  EXPECT_PRED2(contains, message_of([] {
                 input_of({"-beam_spans", "25,", "30"});
               }),
               "'30' is not the value of an option");
  EXPECT_PRED2(contains, message_of([] { input_of({"-options_file", "no/such.yml"}); }), "no/such.yml");
  EXPECT_PRED2(contains, message_of([] { input_of({"-options_file", "/"}); }), "folder");
  EXPECT_PRED2(contains, message_of([] { input_of({"-options_file"}); }), "name of a file");
}

TEST(CommandLine, FilesNameFurtherFiles) {
  const test::TemporaryFolder folder;
  folder.write("bridges/b.yml", "gravity: 1\ntrain: {speed: 5}\n");
  const std::string scene = folder.write("scenes/s.yml", "options_file: ../bridges/b.yml\ntrain: {speed: 6}\n");
  const Input input = input_of({"-options_file", scene});
  EXPECT_EQ(value_of(input.entries, "gravity"), "1");
  EXPECT_EQ(value_of(input.entries, "train_speed"), "6");
  const std::string loop = folder.write("loop.yml", "options_file: loop.yml\n");
  EXPECT_PRED2(contains, message_of([&] { input_of({"-options_file", loop}); }), "circle");
  const std::string lost = folder.write("lost.yml", "a: 1\noptions_file: nowhere.yml\n");
  EXPECT_PRED2(contains, message_of([&] { input_of({"-options_file", lost}); }), "lost.yml:2");
  for (const char* nothing : {"''", "", "[]", "' '"}) {
    const std::string empty = folder.write("empty.yml", std::string("a: 1\noptions_file: ") + nothing + "\n");
    if (std::string(nothing) == "[]") {
      EXPECT_EQ(input_of({"-options_file", empty}).entries.size(), 2u);
      continue;
    }
    EXPECT_PRED2(contains, message_of([&] { input_of({"-options_file", empty}); }), "empty.yml:2): has no value");
  }
}

TEST(CommandLine, WordsThatAreNoNames) {
  EXPECT_PRED2(contains, message_of([] { input_of({"-options_file", "-dash.yml"}); }), "write ./-dash.yml");
  EXPECT_PRED2(contains, message_of([] { input_of({"-ts_type=bdf"}); }), "a blank before the value");
}

TEST(CommandLine, MoreOptionsThanPetscsTableHolds) {
  std::string text = "vehicle:\n  v:\n";
  for (int i = 0; i < 600; ++i) text += "    p" + std::to_string(i) + ": {mass: 1}\n";
  const test::TemporaryFolder folder;
  Input input = input_of({"-options_file", folder.write("big.yml", text)});
  put_into_petsc(input);
  EXPECT_EQ(value_of(in_force(), "vehicle_v_p599_mass"), "1");
}

TEST(TypedReading, NumbersAndDefaults) {
  const Options o{{"gravity", "1.5e1"}, {"beam_EI", "+2e9"}};
  EXPECT_EQ(o.number("gravity"), 15.0);
  EXPECT_EQ(o.number("accuracy"), 1e-3);
  EXPECT_EQ(o.number("beam_EI"), 2e9);
  EXPECT_FALSE(o.optional_number("ts_dt").has_value());
  EXPECT_PRED2(contains, message_of([&] { o.number("beam_mass"); }), "beam_mass is missing");
}

TEST(TypedReading, ListsExpand) {
  const Options o{{"beam_spans", "32.0*3, 25"},
                  {"train_vehicles", "[loco, coach*15]"},
                  {"beam_elements_per_span", "8"},
                  {"support_types", "roller"}};
  EXPECT_EQ(o.numbers("beam_spans"), (std::vector<double>{32.0, 32.0, 32.0, 25.0}));
  EXPECT_EQ(o.texts("train_vehicles").size(), 16u);
  EXPECT_EQ(o.texts("train_vehicles")[1], "coach");
  EXPECT_EQ(o.integers("beam_elements_per_span", 4, "one per span"), (std::vector<int>(4, 8)));
  EXPECT_EQ(o.texts("support_types", 5, "one per end").size(), 5u);
  const Options many{{"beam_spans", "32.0*5150"}};
  EXPECT_EQ(many.numbers("beam_spans").size(), 5150u);
}

TEST(TypedReading, FlagsAloneAreTrue) {
  EXPECT_TRUE((Options{{"beam_self_weight", ""}}.flag("beam_self_weight")));
  EXPECT_TRUE((Options{{"beam_self_weight", "yes"}}.flag("beam_self_weight")));
  EXPECT_FALSE((Options{{"beam_self_weight", "false"}}.flag("beam_self_weight")));
  EXPECT_THROW((Options{{"beam_self_weight", "maybe"}}.flag("beam_self_weight")), InputError);
}

struct Bad {
  std::string name, value, expected;
};
class BadValue : public testing::TestWithParam<Bad> {};

TEST_P(BadValue, IsRefusedWithNameValueAndPlace) {
  const Options o = Options::from_yaml("gravity: 9.81\n" + GetParam().name + ": \"" + GetParam().value + "\"\n");
  const std::string message = message_of([&] { o.check_values(); });
  EXPECT_PRED2(contains, message, GetParam().name + (GetParam().value.empty() ? "" : " = " + GetParam().value));
  EXPECT_PRED2(contains, message, "scene.yml:2");
  EXPECT_PRED2(contains, message, GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    Values, BadValue,
    testing::Values(
        Bad{"train_speed", "fast", "'fast' is not a finite number"}, Bad{"train_speed", "nan", "not a finite number"},
        Bad{"train_speed", "1e999", "not a finite number"}, Bad{"train_speed", "3 mph", "not a finite number"},
        Bad{"train_speed", "-20000", "from -10000 to 10000 (m/s)"}, Bad{"scene_tail", "-1", "not below 0 (s)"},
        Bad{"beam_EI", "0", "above 1e-07 (N m2)"}, Bad{"beam_EI", "inf", "not a finite number"},
        Bad{"beam_EI", "nowhere.csv", "neither a number nor a file"},
        Bad{"beam_elements_per_span", "3.5", "whole numbers"}, Bad{"beam_elements_per_span", "0", "from 1"},
        Bad{"beam_spans", "25,,30", "empty entry"}, Bad{"beam_spans", "", "has no value"},
        Bad{"train_speed", "", "has no value"}, Bad{"beam_spans", "25*0", "whole number"},
        Bad{"beam_spans", "25*x", "whole number"}, Bad{"beam_spans", "25*99999999", "at most"},
        Bad{"support_types", "pinned,roler", "free, roller, pinned, clamped, guided"},
        Bad{"scene_analysis", "dynamic", "transient, modes, static"}, Bad{"beam_rayleigh", "0.1", "2 numbers"},
        Bad{"load_hslm_a", "11", "from 1 to 10"}, Bad{"accuracy", "2", "from 1e-10 to 0.1"}));

// What stands in the way of a number: a unit, a comma for a point, a list. Every speed may be in km/h.
TEST(Numbers, SayWhatStandsInTheWay) {
  const auto refused = [](const std::string& name, const std::string& value) {
    return message_of([&] { Options({{name, value}}).check_values(); });
  };
  EXPECT_PRED2(contains, refused("beam_spans", "28 m"), "give the number without its unit, in m");
  EXPECT_PRED2(contains, refused("beam_EI", "260 GN.m2"), "give the number without its unit, in N m2");
  EXPECT_PRED2(contains, refused("train_speed", "30 mph"), "give a speed in m/s, or in km/h as in 100 km/h");
  EXPECT_PRED2(contains, refused("load_speed", "144_km/h"), "or in km/h");
  EXPECT_PRED2(contains, refused("ts_dt", "1,5e-3"), "use a decimal point: 1.5e-3");
  EXPECT_PRED2(contains, refused("beam_EI", "1e10,2e10"), "expected one number, not a list");
  EXPECT_PRED2(contains, refused("beam_spans", "28,0"), "'0' is not allowed; allowed: ");
  for (const char* name : {"train_speed", "load_speed"}) {
    EXPECT_DOUBLE_EQ(Options({{name, "90 km/h"}}).number(name), 25.0);
    EXPECT_DOUBLE_EQ(Options({{name, "-90km/h"}}).number(name), -25.0);
  }
  EXPECT_PRED2(contains, message_of([] { Options::from_yaml("beam: {spans: 28,0, EI: 1e10}\n", "a.yml"); }),
               "a.yml:1: '0' is in the place of a name");
}

TEST(Names, MisspeltOnesGetAProposal) {
  const auto refused = [](const std::string& name) {
    return message_of([&] { Options({{name, "1"}}).check_names(); });
  };
  EXPECT_PRED2(contains, refused("train_spede"), "did you mean train_speed?");
  EXPECT_PRED2(contains, refused("beam_span"), "did you mean beam_spans?");
  EXPECT_PRED2(contains, refused("gravty"), "did you mean gravity?");
  EXPECT_PRED2(contains, refused("accuarcy"), "did you mean accuracy?");
  EXPECT_FALSE(contains(refused("zzzzzzzzzzzzzzz"), "did you mean"));
  // some of its words, or letters of the other size
  EXPECT_PRED2(contains, refused("ei"), "did you mean beam_EI?");
  EXPECT_PRED2(contains, refused("beam_ei"), "did you mean beam_EI?");
  EXPECT_PRED2(contains, refused("beam_damping"), "did you mean beam_damping_ratios?");
  EXPECT_PRED2(contains, refused("spans"), "did you mean beam_spans?");
  EXPECT_PRED2(contains, refused("passages"), "did you mean output_passages?");
  EXPECT_NO_THROW((Options{{"ts_type", "bdf"}, {"log_view", ""}}.check_names()));
  EXPECT_PRED2(contains, refused("snes_monitr"), "unknown option");
}

TEST(Names, HelpHoldsEveryOption) {
  const std::string help = help_text();
  for (const Row& row : fixed_rows()) {
    EXPECT_PRED2(contains, help, "-" + std::string(row.name));
    EXPECT_FALSE(row.text.empty());
  }
  EXPECT_PRED2(contains, help, "-vehicle_NAME_PART_stiffness");
}

TEST(Names, AnalysesAreTheChoicesOfTheirOption) {
  const Row& option = *find_row(fixed_rows(), "scene_analysis");
  std::string names;
  for (const AnalysisRow& row : analyses) {
    names += (names.empty() ? "" : " ") + std::string(row.name);
    EXPECT_PRED2(contains, std::string(option.text), std::string(row.name) + " (" + std::string(row.words) + ")");
    EXPECT_EQ(analysis_of(row.name), row.analysis);
  }
  EXPECT_EQ(option.choices, names);
  EXPECT_EQ(option.fallback, analyses[0].name);
}

TEST(Names, JointsAreThoseOfTheTableOfTheirTypes) {
  const Row& type = *find_row(part_rows(Part::joint), "type");
  const Row& coupler = *find_row(coupler_rows(), "type");
  for (const multibody::JointRow& joint : multibody::joint_rows()) {
    const std::string name(joint.name);
    for (const Row* row : {&type, &coupler}) EXPECT_PRED2(contains, " " + allowed(*row) + ",", " " + name + ",");
    EXPECT_PRED2(contains, help_text(), name + ": " + std::string(joint.text));
    for (const multibody::JointNumber& own : joint.numbers)
      EXPECT_NE(find_row(part_rows(Part::joint), own.name), nullptr) << own.name;
  }
}

TEST(Names, EveryDefaultIsAllowed) {
  for (const Row& row : fixed_rows()) {
    if (row.fallback.empty() || row.fallback.front() == '(' || row.name == "output_file") continue;
    const Options o{{std::string(row.name), std::string(row.fallback)}};
    EXPECT_NO_THROW(o.check_values()) << row.name;
  }
}

TEST(DataFile, FoundBesideTheFileThatNamesIt) {
  const test::TemporaryFolder folder;
  folder.write("data/ei.csv", "0 1\n1 2\n");
  const std::string scene = folder.write("scene.yml", "beam: {EI: data/ei.csv}\n");
  const Options o(input_of({"-options_file", scene}).entries);
  EXPECT_EQ(o.path("beam_EI"), folder.path("data/ei.csv"));
  EXPECT_FALSE(o.is_number("beam_EI"));
}

TEST(DataFile, BesideComesBeforeTheWorkingDirectory) {
  const test::TemporaryFolder folder;
  const std::string here = std::filesystem::current_path();
  const std::string beside = folder.write("sub/table.csv", "0 1\n"), above = folder.write("table.csv", "0 2\n");
  std::filesystem::current_path(folder.path(""));
  EXPECT_EQ(find_file("table.csv", "sub/scene.yml"), "sub/table.csv");
  EXPECT_EQ(find_file("table.csv", ""), "table.csv");
  EXPECT_EQ(find_file("sub/table.csv", "sub/scene.yml"), "sub/table.csv");  // there is none in sub/sub
  EXPECT_EQ(find_file(above, "sub/scene.yml"), above);
  EXPECT_EQ(find_file("none.csv", "sub/scene.yml"), "");
  std::filesystem::current_path(here);
}

}  // namespace
}  // namespace traverse::options
