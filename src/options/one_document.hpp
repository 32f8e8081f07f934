// Reads a YAML file that must contain one document. YAML::Load ignores further documents without a message, and
// YAML::LoadAll does not terminate if a document begins with a character that cannot begin one ("]", ",").
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace traverse::options {

/// The document of a text, null for an empty text. InputError if something follows it; the message is file, line,
/// `prefix` and the reason. YAML::Exception if the text is not well formed.
YAML::Node one_document(const std::string& text, const std::string& file, const std::string& prefix = "");

}  // namespace traverse::options
