// State as bytes. An object has one function `void keep(base::Bytes& bytes) { bytes(a_, b_); }` that names what belongs
// to its state: the same line writes it and reads it back, to the last bit. State that ranks share goes through Archive
// (archive.hpp).
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
  /// Empty, to be written.
  Bytes() = default;
  /// To be read from its beginning; what it reads from must outlive it.
  explicit Bytes(std::span<const char> from) : from_(from), reads_(true) {}

  bool reads() const { return reads_; }
  const std::string& written() const { return to_; }
  /// Whether all has been read.
  bool at_end() const { return from_.empty(); }

  /// FileError where there is less to read than asked for.
  template <class... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }

 private:
  template <class T>
  void one(T& value) {
    if constexpr (requires { value.keep(*this); }) {
      value.keep(*this);
    } else {
      static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>, "it needs a function keep(Bytes&)");
      raw(&value, sizeof(T));
    }
  }
  void one(bool& value) {
    unsigned char byte = value ? 1 : 0;
    raw(&byte, 1);
    if (byte > 1) damaged();  // no bool holds that
    value = byte == 1;
  }
  template <class T>
  void one(std::vector<T>& list) {
    auto size = list.size();
    one(size);
    if (reads_) {
      check_left(size);
      list.resize(size);
    }
    each(list.data(), size);
  }
  template <class T, std::size_t n>
  void one(std::array<T, n>& list) {
    each(list.data(), n);
  }
  template <class T, class U>
  void one(std::pair<T, U>& pair) {
    (*this)(pair.first, pair.second);
  }
  void one(std::string& text) {
    auto size = text.size();
    one(size);
    if (reads_) {
      check_left(size);
      text.resize(size);
    }
    raw(text.data(), size);
  }
  template <class T>
  void one(std::optional<T>& value) {
    bool there = value.has_value();
    one(there);
    if (reads_ && there != value.has_value()) {
      if constexpr (std::is_default_constructible_v<T>) {
        value = there ? std::optional<T>(std::in_place) : std::nullopt;
      } else {
        damaged();  // what a scene has is set up before
      }
    }
    if (there) one(*value);
  }
  template <class T, int rows, int columns, int options>
  void one(Eigen::Matrix<T, rows, columns, options>& matrix) {
    Eigen::Index m = matrix.rows(), n = matrix.cols();
    (*this)(m, n);
    if (reads_) {
      const auto most = static_cast<Eigen::Index>(from_.size());
      if (m < 0 || n < 0 || (n > 0 && m > most / n)) damaged();
      matrix.resize(m, n);
    }
    raw(matrix.data(), sizeof(T) * static_cast<std::size_t>(matrix.size()));
  }
  template <class T>
  void each(T* values, std::size_t count) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      raw(values, sizeof(T) * count);
    } else {
      for (std::size_t i = 0; i < count; ++i) one(values[i]);
    }
  }

  [[noreturn]] static void damaged() { throw FileError("the checkpoint does not fit this scene"); }
  void check_left(std::size_t least) const {
    if (least > from_.size()) damaged();
  }
  void raw(void* values, std::size_t size) {
    if (size == 0) return;
    if (!reads_) {
      to_.append(static_cast<const char*>(values), size);
      return;
    }
    check_left(size);
    std::memcpy(values, from_.data(), size);
    from_ = from_.subspan(size);
  }

  std::string to_;
  std::span<const char> from_;
  bool reads_ = false;
};

}  // namespace traverse::base
