// SPDX-License-Identifier: MIT
// The scalar types of VTK's legacy files: their names, their sizes in a file, their C++ types.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace tunica::io {

enum class ScalarType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

struct ScalarName {
  std::string_view name;
  ScalarType type;
};

/// Names in a file. vtkIdType is written as a 32-bit int; long is that of 64-bit systems.
inline constexpr std::array<ScalarName, 14> scalar_names{{{"char", ScalarType::int8},
                                                          {"signed_char", ScalarType::int8},
                                                          {"unsigned_char", ScalarType::uint8},
                                                          {"short", ScalarType::int16},
                                                          {"unsigned_short", ScalarType::uint16},
                                                          {"int", ScalarType::int32},
                                                          {"unsigned_int", ScalarType::uint32},
                                                          {"long", ScalarType::int64},
                                                          {"unsigned_long", ScalarType::uint64},
                                                          {"float", ScalarType::float32},
                                                          {"double", ScalarType::float64},
                                                          {"vtktypeint64", ScalarType::int64},
                                                          {"vtktypeuint64", ScalarType::uint64},
                                                          {"vtkidtype", ScalarType::int32}}};

[[nodiscard]] inline std::optional<ScalarType> scalar_type(std::string_view lower_case_name) {
  for (const auto& s : scalar_names)
    if (s.name == lower_case_name) return s.type;
  return std::nullopt;
}

/// "char, signed_char, ..."
[[nodiscard]] inline std::string supported_types() {
  std::string text;
  for (const auto& s : scalar_names) text += (text.empty() ? "" : ", ") + std::string(s.name);
  return text;
}

/// Calls f(S{}) with the C++ type of a scalar type.
template <class F>
decltype(auto) with_scalar(ScalarType type, F&& f) {
  switch (type) {
    case ScalarType::int8: return f(std::int8_t{});
    case ScalarType::uint8: return f(std::uint8_t{});
    case ScalarType::int16: return f(std::int16_t{});
    case ScalarType::uint16: return f(std::uint16_t{});
    case ScalarType::int32: return f(std::int32_t{});
    case ScalarType::uint32: return f(std::uint32_t{});
    case ScalarType::int64: return f(std::int64_t{});
    case ScalarType::uint64: return f(std::uint64_t{});
    case ScalarType::float32: return f(float{});
    case ScalarType::float64: break;
  }
  return f(double{});
}

/// The scalar type of a C++ type.
template <class T>
[[nodiscard]] constexpr ScalarType scalar_type_of() {
  static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>, "VTK files hold numbers");
  if constexpr (std::is_floating_point_v<T>)
    return sizeof(T) == 4 ? ScalarType::float32 : ScalarType::float64;
  constexpr bool is_signed = std::is_signed_v<T>;
  switch (sizeof(T)) {
    case 1: return is_signed ? ScalarType::int8 : ScalarType::uint8;
    case 2: return is_signed ? ScalarType::int16 : ScalarType::uint16;
    case 4: return is_signed ? ScalarType::int32 : ScalarType::uint32;
    default: return is_signed ? ScalarType::int64 : ScalarType::uint64;
  }
}

/// Name in a legacy file.
[[nodiscard]] constexpr std::string_view legacy_name(ScalarType type) {
  switch (type) {
    case ScalarType::int64: return "vtktypeint64";
    case ScalarType::uint64: return "vtktypeuint64";
    case ScalarType::int8: return "char";
    default: break;
  }
  for (const auto& s : scalar_names)
    if (s.type == type) return s.name;
  return "double";
}

/// A number from (or to) the big-endian bytes of a legacy file.
template <class S>
[[nodiscard]] S swapped_if_little(S value) {
  if constexpr (sizeof(S) == 1 || std::endian::native == std::endian::big) {
    return value;
  } else {
    using Bits = std::conditional_t<sizeof(S) == 2, std::uint16_t,
                                    std::conditional_t<sizeof(S) == 4, std::uint32_t, std::uint64_t>>;
    auto bits = std::bit_cast<Bits>(value);
    if constexpr (sizeof(S) == 2) bits = __builtin_bswap16(bits);
    if constexpr (sizeof(S) == 4) bits = __builtin_bswap32(bits);
    if constexpr (sizeof(S) == 8) bits = __builtin_bswap64(bits);
    return std::bit_cast<S>(bits);
  }
}

template <class S>
[[nodiscard]] S big_endian(const char* bytes) {
  S value;
  std::memcpy(&value, bytes, sizeof(S));
  return swapped_if_little(value);
}

}  // namespace tunica::io
