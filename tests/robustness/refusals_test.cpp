// The exact messages of refused input, over all rooms that refuse: refusals.txt has the input and the message of each.
#include <gtest/gtest.h>
#include <mpi.h>

#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "options/input_texts.hpp"
#include "options/read_file.hpp"
#include "support/folders.hpp"
#include "traverse/app/run.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/input.hpp"

namespace traverse::test {
namespace {

using options::Entries;

/// The entries of a base, followed by those of words as on the command line; ~NAME leaves an entry out.
Entries with_words(const Entries& base, const std::vector<std::string>& words) {
  std::vector<std::string> given, left_out;
  for (const std::string& word : words)
    if (word.starts_with("~"))
      left_out.push_back(word.substr(1));
    else
      given.push_back(word);
  Entries all;
  for (const options::Entry& entry : base)
    if (std::find(left_out.begin(), left_out.end(), entry.name) == left_out.end()) all.set(entry);
  for (options::Entry& entry : options::parse_words(given, "command line", 0)) all.set(std::move(entry));
  return all;
}

/// The scenes, tables and cases of the file; each case has the line of its input.
class Refusals {
 public:
  /// The text of the file with the message of now below each case.
  std::string with_messages(std::istream& file) {
    std::string all;
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with("    ")) continue;  // the stored message
      all += line + "\n";
      std::vector<std::string> words = options::split_words(line, "");
      if (line.starts_with("table ")) {
        const std::size_t text = line.find(" = ");
        std::string& table = tables_[line.substr(6, text - 6)] = line.substr(text + 3);
        std::replace(table.begin(), table.end(), '|', '\n');
      } else if (words.empty()) {
        continue;
      } else if (words.front() == "scene") {
        scenes_[words[1]] = entries_of({words.begin() + 3, words.end()});
      } else {
        all += "    " + message_of(words) + "\n";
      }
    }
    return all;
  }

 private:
  /// The entries of words that begin with the names of scenes.
  Entries entries_of(std::vector<std::string> words) const {
    Entries base;
    for (; !words.empty() && scenes_.contains(words.front()); words.erase(words.begin()))
      for (const options::Entry& entry : scenes_.at(words.front())) base.set(entry);
    return with_words(base, words);
  }

  std::string message_of(const std::vector<std::string>& words) const {
    const options::TablesInMemory tables(tables_);
    try {
      scene::Scene scene = scene::read_scene(options::Options(options::complete(entries_of(words), "scene")));
      scene.describe = true;
      scene.output.file.clear();
      app::run(MPI_COMM_SELF, scene);
    } catch (const InputError& error) {
      return error.what();
    } catch (const std::exception& error) {
      return std::string("another error: ") + error.what();
    }
    return "not refused";
  }

  std::map<std::string, Entries> scenes_;
  std::map<std::string, std::string> tables_;
};

TEST(RefusalMessages, AreTheStoredOnes) {
  std::ifstream file(source_folder() + "/tests/robustness/refusals.txt");
  std::stringstream stored;
  stored << file.rdbuf();
  const std::string now = Refusals().with_messages(stored);
  std::ofstream("refusals.txt") << now;
  EXPECT_EQ(stored.str(), now) << "if all changes are wanted: the messages of now are in refusals.txt of this folder";
}

}  // namespace
}  // namespace traverse::test
