// What no text file holds is refused with its line; a byte-order mark in front is skipped. All readers alike.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "options/read_file.hpp"
#include "options/read_table.hpp"
#include "options/read_verdict_limits.hpp"
#include "scene/given_modes.hpp"
#include "support/message.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::options {
namespace {

using test::contains;
using test::message_of;
using namespace std::string_literals;

const std::string limits = "- {clause: a, quantity: deck_acceleration, value: 3.5}\n";
const std::string modes = "frequency, 5\nmodal_mass, 1000\ndamping_ratio, 0.01\n0, 0\n10, 1\n20, 0\n";

/// Each kind of text file, and what reads it.
struct Kind {
  std::string name, text;
  std::function<void(const std::string&)> read;
};
const std::vector<Kind> kinds = {
    {"t.csv", "0, 5e9\n20, 5e9\n",
     [](const std::string& path) {
       std::string note;
       read_columns(path, {}, {}, note);
     }},
    {"s.yml", "gravity: 9.81\nscene: {tail: 1}\n", [](const std::string& path) { read_options_file(path); }},
    {"s.opts", "-gravity 9.81\n-scene_tail 1\n", [](const std::string& path) { read_options_file(path); }},
    {"l.yml", limits + limits, [](const std::string& path) { read_verdict_limits(path); }},
    {"m.csv", modes, [](const std::string& path) { scene::read_given_modes(path, 1); }}};

TEST(TextFiles, HoldNoControlCharactersAndNoOtherEncoding) {
  const test::TemporaryFolder folder;
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(kind.name);
    const auto refused = [&](const std::string& text) {
      const std::string file = folder.write(kind.name, text);
      return message_of([&] { kind.read(file); });
    };
    EXPECT_NO_THROW(kind.read(folder.write(kind.name, kind.text)));
    EXPECT_NO_THROW(kind.read(folder.write(kind.name, "\xef\xbb\xbf" + kind.text)));
    const std::size_t second = kind.text.find('\n') + 2;
    const auto with = [&](const std::string& bytes) {
      return kind.text.substr(0, second) + bytes + kind.text.substr(second);
    };
    EXPECT_PRED2(contains, refused(with("\0"s)), kind.name + ":2: contains the control character 0x00 (NUL)");
    EXPECT_PRED2(contains, refused(with("\x1b")), kind.name + ":2: contains the control character 0x1b");
    EXPECT_PRED2(contains, refused(with("\xe4")), kind.name + ":2: byte 0xe4 is not valid UTF-8");
  }
  const std::string results = folder.write("r.h5", "\x89HDF\r\n\x1a\n");
  EXPECT_PRED2(contains, message_of([&] { read_options_file(results); }), "r.h5: is an HDF5 file");
}

TEST(TextFiles, AreNoPipesFoldersOrDevices) {
  const test::TemporaryFolder folder;
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(kind.name);
    const std::string pipe = folder.path(kind.name), folder_path = folder.path("folder_" + kind.name);
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_PRED2(contains, message_of([&] { kind.read(pipe); }), "is a pipe or a device, not a file");
    std::filesystem::create_directory(folder_path);
    EXPECT_PRED2(contains, message_of([&] { kind.read(folder_path); }), "is a folder, not a file");
    EXPECT_PRED2(contains, message_of([&] { kind.read(folder.path("none_" + kind.name)); }), "there is no such file");
  }
}

// The memory of this process: a regular file by its kind, whose first page cannot be read.
TEST(TextFiles, ThatCannotBeReadAreNoInternalError) {
  if (!std::filesystem::exists("/proc/self/mem")) GTEST_SKIP() << "needs /proc";
  for (const Kind& kind : kinds)
    EXPECT_PRED2(contains, message_of([&] { kind.read("/proc/self/mem"); }),
                 "the file cannot be read: Input/output error");
}

TEST(YamlFiles, AreOneDocument) {
  EXPECT_PRED2(contains, message_of([] { parse_verdict_limits(limits + "---\n" + limits, "l.yml"); }),
               "l.yml:2: limits: contains more than one YAML document");
  // YAML::LoadAll finds no end of these
  for (const std::string text : {", 1\n", "# head\n , 1\n"}) {
    EXPECT_PRED2(contains, message_of([&] { parse_verdict_limits(text, "l.yml"); }), "more than one YAML document");
    EXPECT_PRED2(contains, message_of([&] { parse_yaml(text, "s.yml"); }), "more than one YAML document");
  }
}

TEST(YamlFiles, HoldNoBlockThatHoldsItself) {
  for (const char* text : {"q: &q {a: *q}\n", "q: &q {<<: *q}\n", "q: &q {<<: [*q, *q]}\n", "q: &q {a: {b: *q}}\n"})
    EXPECT_PRED2(contains, message_of([&] { parse_yaml(text, "s.yml"); }),
                 "s.yml:1: blocks are nested more than 64 deep");
}

// Ten aliases of ten, and so on: 10^30 blocks of nothing.
TEST(YamlFiles, AreNoLongerThanTheirText) {
  std::string text = "$$a: &a {}\n";
  for (char next = 'b'; next <= 'z'; ++next) {
    text += "$$"s + next + ": &" + next + " {";
    for (int i = 0; i < 10; ++i)
      text += (i > 0 ? ", k" : "k") + std::to_string(i) + ": *" + static_cast<char>(next - 1);
    text += "}\n";
  }
  EXPECT_PRED2(contains, message_of([&] { parse_yaml(text + "beam: *z\n", "s.yml"); }),
               "the anchors expand to more than");
}

TEST(OptionsFiles, NameEachOtherInARowOrInACircle) {
  const test::TemporaryFolder folder;
  const auto name = [](int i) { return "f" + std::to_string(i) + ".yml"; };
  for (int i = 0; i < 70; ++i) folder.write(name(i), "options_file: " + name(i + 1) + "\n");
  folder.write(name(70), "gravity: 1\n");
  EXPECT_EQ(read_options_file(folder.path(name(40))).size(), 1u);
  EXPECT_PRED2(contains, message_of([&] { read_options_file(folder.path(name(0))); }), "more than 64 deep");
  folder.write(name(70), "options_file: " + name(68) + "\n");
  EXPECT_PRED2(contains, message_of([&] { read_options_file(folder.path(name(66))); }), "in a circle");
}

TEST(OptionsFiles, AreNotReadWithoutEnd) {
  const test::TemporaryFolder folder;
  for (char name = 'a'; name < 'm'; ++name) {
    const std::string next(1, static_cast<char>(name + 1));
    folder.write(name + ".yml"s, "options_file: [" + next + ".yml, " + next + ".yml]\n");
  }
  folder.write("m.yml", "scene: {}\n");
  EXPECT_PRED2(contains, message_of([&] { read_options_file(folder.path("a.yml")); }), "more than 1000 files");
}

}  // namespace
}  // namespace traverse::options
