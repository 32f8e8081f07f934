// A YAML file is one document. YAML::Load drops those behind the first one in silence, and YAML::LoadAll finds no end
// behind a document that begins with what belongs to no document ("]", ",").
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace traverse::options {

/// The document of a text, null where it is empty. InputError where something follows it: `said` stands in front of
/// what it says, behind file and line. YAML::Exception where it is not well formed.
YAML::Node one_document(const std::string& text, const std::string& file, const std::string& said = "");

}  // namespace traverse::options
