// State as bytes. An object has one function `void keep(base::Bytes& bytes) { bytes(a_, b_); }` that lists the members
// of its state; the same line writes and reads them, exact to the last bit. State that is distributed over ranks uses
// Archive (archive.hpp).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "traverse/base/error.hpp"

namespace traverse::base {

class Bytes {
 public:
  /// An empty object for writing.
  Bytes() = default;
  /// Reads from the first byte of `from`, which must outlive this object.
  explicit Bytes(std::span<const char> from) : from_(from), reads_(true) {}

  bool reads() const { return reads_; }
  const std::string& written() const { return to_; }
  /// Whether all bytes have been read.
  bool at_end() const { return from_.empty(); }

  /// Throws FileError if fewer bytes are available than needed.
  template <class... Values>
  void operator()(Values&... values) {
    (transfer(values), ...);
  }

 private:
  template <class T>
  void transfer(T& value) {
    if constexpr (requires { value.keep(*this); }) {
      value.keep(*this);
    } else {
      static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>, "it needs a function keep(Bytes&)");
      transfer_raw(&value, sizeof(T));
    }
  }
  void transfer(bool& value) {
    unsigned char byte = value ? 1 : 0;
    transfer_raw(&byte, 1);
    if (byte > 1) damaged();  // not a value of a bool
    value = byte == 1;
  }
  template <class T>
  void transfer(std::vector<T>& list) {
    auto size = list.size();
    transfer(size);
    if (reads_) {
      check_available(size);
      list.resize(size);
    }
    transfer_each(list.data(), size);
  }
  template <class T, std::size_t n>
  void transfer(std::array<T, n>& list) {
    transfer_each(list.data(), n);
  }
  template <class T, class U>
  void transfer(std::pair<T, U>& pair) {
    (*this)(pair.first, pair.second);
  }
  void transfer(std::string& text) {
    auto size = text.size();
    transfer(size);
    if (reads_) {
      check_available(size);
      text.resize(size);
    }
    transfer_raw(text.data(), size);
  }
  template <class T>
  void transfer(std::optional<T>& value) {
    bool present = value.has_value();
    transfer(present);
    if (reads_ && present != value.has_value()) {
      if constexpr (std::is_default_constructible_v<T>) {
        value = present ? std::optional<T>(std::in_place) : std::nullopt;
      } else {
        damaged();  // the scene has created such a member, or not, before
      }
    }
    if (present) transfer(*value);
  }
  template <class T, int rows, int columns, int options>
  void transfer(Eigen::Matrix<T, rows, columns, options>& matrix) {
    Eigen::Index m = matrix.rows(), n = matrix.cols();
    (*this)(m, n);
    if (reads_) {
      const auto available = static_cast<Eigen::Index>(from_.size());
      if (m < 0 || n < 0 || (n > 0 && m > available / n)) damaged();
      matrix.resize(m, n);
    }
    transfer_raw(matrix.data(), sizeof(T) * static_cast<std::size_t>(matrix.size()));
  }
  template <class T>
  void transfer_each(T* values, std::size_t count) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      transfer_raw(values, sizeof(T) * count);
    } else {
      for (std::size_t i = 0; i < count; ++i) transfer(values[i]);
    }
  }

  [[noreturn]] static void damaged() { throw FileError("the checkpoint does not fit this scene"); }
  void check_available(std::size_t least) const {
    if (least > from_.size()) damaged();
  }
  void transfer_raw(void* values, std::size_t size) {
    if (size == 0) return;
    if (!reads_) {
      to_.append(static_cast<const char*>(values), size);
      return;
    }
    check_available(size);
    std::memcpy(values, from_.data(), size);
    from_ = from_.subspan(size);
  }

  std::string to_;
  std::span<const char> from_;
  bool reads_ = false;
};

}  // namespace traverse::base
