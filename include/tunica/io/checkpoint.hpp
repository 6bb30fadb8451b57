// SPDX-License-Identifier: MIT
// Checkpoints: one archive() of a solver serves writing and reading. A file is whole, of this run and
// undamaged (checksum), or refused with a sentence.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/io/atomic_file.hpp"
#include "tunica/io/crc32.hpp"
#include "tunica/io/read_file.hpp"

#include <Eigen/Core>

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

namespace tunica::io {

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian");

namespace detail {

inline constexpr std::string_view checkpoint_magic = "tunica checkpoint\n";
inline constexpr std::uint32_t checkpoint_version = 1;

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

template <class T>
concept Dense = std::derived_from<T, Eigen::PlainObjectBase<T>>;

template <class T>
concept Sequence = !Dense<T> && !std::same_as<T, std::string> && requires(T & v, std::size_t n) {
  typename T::value_type;
  v.resize(n);
  v.begin();
  v.size();
};

template <class T>
concept NumberArray = Sequence<T> && Number<typename T::value_type> && requires(T& v) {
  v.data();
} && !std::same_as<typename T::value_type, bool>;

/// What an entry holds, as text: "double", "matrix of double", "sequence of sequence of int32".
template <class T>
[[nodiscard]] std::string type_text() {
  if constexpr (std::is_enum_v<T>) {
    return "enum " + type_text<std::underlying_type_t<T>>();
  } else if constexpr (std::same_as<T, bool>) {
    return "bool";
  } else if constexpr (std::is_floating_point_v<T>) {
    return "float" + std::to_string(8 * sizeof(T));
  } else if constexpr (std::is_integral_v<T>) {
    return (std::is_signed_v<T> ? "int" : "uint") + std::to_string(8 * sizeof(T));
  } else if constexpr (std::same_as<T, std::string>) {
    return "string";
  } else if constexpr (Dense<T>) {
    return "matrix of " + type_text<typename T::Scalar>();
  } else if constexpr (Sequence<T>) {
    return "sequence of " + type_text<typename T::value_type>();
  } else {
    return "object";
  }
}

}  // namespace detail

/// Collects named values, then saves them. Solvers give `template <class Archive> void archive(Archive& a)`,
/// which calls a("name", member) for numbers, enums, strings, sequences of these, dense Eigen matrices
/// and objects that have an archive() of their own.
class CheckpointWriter {
 public:
  static constexpr bool loading = false;

  template <class T>
  void operator()(std::string_view name, T& value) {
    text(name);
    text(detail::type_text<std::remove_const_t<T>>());
    put(value);
  }

  /// Writes the file atomically. The fingerprint tells input and options of the run, in readable words.
  void save(const std::filesystem::path& path, std::string_view fingerprint) const {
    std::string head(detail::checkpoint_magic);
    append(head, detail::checkpoint_version);
    append(head, static_cast<std::uint64_t>(fingerprint.size()));
    head += fingerprint;
    append(head, static_cast<std::uint64_t>(payload_.size()));
    std::string end;
    append(end, crc32(payload_, crc32(head)));
    AtomicFile file(path);
    file.write(head);
    file.write(payload_);
    file.write(end);
    file.commit();
  }

 private:
  template <class T>
  static void append(std::string& out, T v) {
    const std::size_t at = out.size();
    out.resize(at + sizeof v);
    std::memcpy(out.data() + at, &v, sizeof v);
  }
  void text(std::string_view t) {
    append(payload_, static_cast<std::uint64_t>(t.size()));
    payload_ += t;
  }
  template <class T>
  void raw(const T* data, std::size_t n) {
    if (n > 0) payload_.append(reinterpret_cast<const char*>(data), n * sizeof(T));
  }

  template <class T>
  void put(T& value) {
    using V = std::remove_const_t<T>;
    if constexpr (detail::Number<V>) {
      raw(&value, 1);
    } else if constexpr (std::same_as<V, std::string>) {
      text(value);
    } else if constexpr (detail::Dense<V>) {
      append(payload_, static_cast<std::uint64_t>(value.rows()));
      append(payload_, static_cast<std::uint64_t>(value.cols()));
      raw(value.data(), static_cast<std::size_t>(value.size()));
    } else if constexpr (detail::Sequence<V>) {
      append(payload_, static_cast<std::uint64_t>(value.size()));
      if constexpr (detail::NumberArray<V>) return raw(value.data(), value.size());
      for (auto&& element : value) {
        auto&& e = element;
        if constexpr (std::same_as<typename V::value_type, bool>)
          append(payload_, static_cast<bool>(e));
        else
          put(e);
      }
    } else {
      static_assert(
          requires { value.archive(*this); },
          "a checkpoint holds numbers, enums, strings, sequences, dense matrices and objects with archive()");
      value.archive(*this);
    }
  }

  std::string payload_;
};

/// Reads back in the same order; every name and type is checked, and finish() that nothing is left.
class CheckpointReader {
 public:
  static constexpr bool loading = true;

  CheckpointReader(const std::filesystem::path& path, std::string_view fingerprint)
      : name_(path.string()), bytes_(read_file(path)) {
    end_ = bytes_.size();
    const std::size_t least =
        detail::checkpoint_magic.size() + sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t);
    if (bytes_.compare(0, detail::checkpoint_magic.size(), detail::checkpoint_magic) != 0)
      throw InputError(name_ + ": not a checkpoint");
    if (bytes_.size() < least + sizeof(std::uint32_t)) fail("truncated: " + std::to_string(end_) + " bytes");
    end_ -= sizeof(std::uint32_t);
    std::uint32_t sum = 0;
    std::memcpy(&sum, bytes_.data() + end_, sizeof sum);
    if (crc32(std::string_view(bytes_).substr(0, end_)) != sum)
      fail("truncated or damaged: its checksum does not agree");
    at_ = detail::checkpoint_magic.size();
    if (const auto version = take<std::uint32_t>(); version != detail::checkpoint_version)
      fail("of version " + std::to_string(version) + "; this program reads " +
           std::to_string(detail::checkpoint_version));
    if (const std::string made = take_text(); made != fingerprint)
      fail("made from another input or with other options: it is of \"" + made + "\", this run is of \"" +
           std::string(fingerprint) + "\"");
    if (const auto length = take<std::uint64_t>(); length != end_ - at_)
      fail("expected " + std::to_string(length) + " bytes of values, found " + std::to_string(end_ - at_));
  }

  template <class T>
  void operator()(std::string_view name, T& value) {
    const std::string found = at_ < end_ ? take_text() : "the end";
    if (found != name) fail("expected \"" + std::string(name) + "\", found \"" + found + "\"");
    const std::string type = take_text(), expected = detail::type_text<T>();
    if (type != expected) fail("\"" + found + "\" is a " + type + " where " + expected + " is expected");
    entry_ = found;
    get(value);
  }

  /// InputError if values are left that nothing has read.
  void finish() {
    if (at_ != end_) fail("more values than this program reads, from \"" + take_text() + "\" on");
  }

 private:
  [[noreturn]] void fail(const std::string& why) const { throw InputError(name_ + ": checkpoint: " + why); }

  void require(std::uint64_t count, std::size_t size) const {
    if (count > (end_ - at_) / size)
      fail("\"" + entry_ + "\" claims " + std::to_string(count) + " elements, more than the file holds");
  }
  template <class T>
  [[nodiscard]] T take() {
    require(1, sizeof(T));
    T v;
    std::memcpy(&v, bytes_.data() + at_, sizeof v);
    at_ += sizeof v;
    return v;
  }
  [[nodiscard]] std::string take_text() {
    const auto n = take<std::uint64_t>();
    require(n, 1);
    const std::string t = bytes_.substr(at_, n);
    at_ += n;
    return t;
  }

  template <class T>
  void get(T& value) {
    if constexpr (detail::Number<T>) {
      value = take<T>();
    } else if constexpr (std::same_as<T, std::string>) {
      value = take_text();
    } else if constexpr (detail::Dense<T>) {
      const auto rows = take<std::uint64_t>(), cols = take<std::uint64_t>();
      const auto misfit = [](std::uint64_t n, int fixed) {
        return n > std::numeric_limits<std::int32_t>::max() ||
               (fixed != Eigen::Dynamic && n != static_cast<std::uint64_t>(fixed));
      };
      if (misfit(rows, T::RowsAtCompileTime) || misfit(cols, T::ColsAtCompileTime))
        fail("\"" + entry_ + "\" is " + std::to_string(rows) + " x " + std::to_string(cols) +
             ", which does not fit");
      require(rows * cols, sizeof(typename T::Scalar));
      value.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(cols));
      const std::size_t bytes = rows * cols * sizeof(typename T::Scalar);
      if (bytes > 0) std::memcpy(value.data(), bytes_.data() + at_, bytes);
      at_ += bytes;
    } else if constexpr (detail::Sequence<T>) {
      const auto n = take<std::uint64_t>();
      if constexpr (detail::NumberArray<T>) {
        using U = typename T::value_type;
        require(n, sizeof(U));
        value.resize(n);
        if (n > 0) std::memcpy(value.data(), bytes_.data() + at_, n * sizeof(U));
        at_ += n * sizeof(U);
        return;
      }
      require(n, 1);
      value.resize(n);
      for (std::size_t i = 0; i < n; ++i) {
        if constexpr (std::same_as<typename T::value_type, bool>)
          value[i] = take<bool>();
        else
          get(value[i]);
      }
    } else {
      static_assert(
          requires { value.archive(*this); },
          "a checkpoint holds numbers, enums, strings, sequences, dense matrices and objects with archive()");
      value.archive(*this);
    }
  }

  std::string name_, bytes_, entry_ = "the header";
  std::size_t at_ = 0, end_ = 0;
};

}  // namespace tunica::io
