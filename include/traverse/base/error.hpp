// Errors as exceptions. The exit status of the program is the error's `status`.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace traverse {

/// The text as one line of valid UTF-8. A line break is replaced by the two characters \n, a tab by \t, any other
/// control character and any byte outside a valid UTF-8 character by \x and its two hexadecimal digits.
std::string printable(std::string_view text);

/// A failure that ends a run with a message of one line. Text from the user is made printable in the message.
class Error : public std::runtime_error {
 public:
  Error(const std::string& message, int status) : std::runtime_error(printable(message)), status_(status) {}
  int status() const noexcept { return status_; }

 private:
  int status_;
};

/// The input is invalid. The message names the option, its value and the allowed values.
class InputError : public Error {
 public:
  explicit InputError(const std::string& message) : Error(message, 2) {}
};

/// The equations could not be solved. The message describes the place of the failure and the necessary change.
class SolverError : public Error {
 public:
  explicit SolverError(const std::string& message) : Error(message, 3) {}
};

/// A step failed, or its result is not a valid motion. A shorter step may succeed.
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
