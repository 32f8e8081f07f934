// Errors as exceptions. The exit status of the program is the error's `status`.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace traverse {

/// The text on one line of valid UTF-8: a line break becomes the two characters \n, a tab \t, any other control
/// character and any byte that belongs to no UTF-8 character \x and its two hexadecimal digits.
std::string printable(std::string_view text);

/// Any failure that ends a run with a message of one line; what the user wrote is made printable in it.
class Error : public std::runtime_error {
 public:
  Error(const std::string& message, int status) : std::runtime_error(printable(message)), status_(status) {}
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

/// A step could not be taken, or what it led to is no motion: a shorter one may do.
class StepTooLong : public SolverError {
 public:
  using SolverError::SolverError;
};

/// A file could not be written or read.
class FileError : public Error {
 public:
  explicit FileError(const std::string& message) : Error(message, 4) {}
};

}  // namespace traverse
