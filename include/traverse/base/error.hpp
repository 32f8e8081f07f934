// Errors as exceptions. The exit status of the program is the error's `status`.
#pragma once

#include <stdexcept>
#include <string>

namespace traverse {

/// Any failure that ends a run with a message of one line.
class Error : public std::runtime_error {
 public:
  Error(const std::string& message, int status) : std::runtime_error(message), status_(status) {}
  int status() const noexcept { return status_; }

 private:
  int status_;
};

/// The scene as written cannot be run. The message names the option, its value and what is allowed.
class InputError : public Error {
 public:
  explicit InputError(const std::string& message) : Error(message, 2) {}
};

/// The equations could not be solved. The message says where and what to change.
class SolverError : public Error {
 public:
  explicit SolverError(const std::string& message) : Error(message, 3) {}
};

/// A file could not be written or read.
class FileError : public Error {
 public:
  explicit FileError(const std::string& message) : Error(message, 4) {}
};

}  // namespace traverse
