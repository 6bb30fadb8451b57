// SPDX-License-Identifier: MIT
// Figures of a run as JSON, in the order in which they were set.
#pragma once

#include "tunica/core/types.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace tunica::examples {

/// A value of JSON: report["fill"]["tetrahedra"] = 9123; report["list"].push(...).
class Json {
 public:
  Json() = default;
  template <class T>
  requires std::is_arithmetic_v<T> Json(T v) {
    if constexpr (std::same_as<T, bool>) {
      text_ = v ? "true" : "false";
    } else if constexpr (std::is_integral_v<T>) {
      text_ = std::to_string(v);
    } else if (std::isfinite(v)) {
      std::array<char, 40> buffer{};
      text_.assign(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), v).ptr);
    } else {
      text_ = "null";  // JSON knows no NaN
    }
  }
  Json(std::string_view v) : text_(quote(v)) {}
  Json(const std::string& v) : text_(quote(v)) {}
  Json(const char* v) : text_(quote(v)) {}
  Json(const Vec3& v) { push(v[0]), push(v[1]), push(v[2]); }
  template <class T>
  Json(const std::vector<T>& v) : kind_(Kind::list) {
    for (const auto& e : v) push(e);
  }

  Json& operator[](const std::string& key) {
    kind_ = Kind::object;
    for (auto& [k, v] : members_)
      if (k == key) return v;
    return members_.emplace_back(key, Json{}).second;
  }
  void push(Json v) {
    kind_ = Kind::list;
    members_.emplace_back("", std::move(v));
  }

  [[nodiscard]] std::string text(int indent = 0) const {
    if (kind_ == Kind::scalar) return text_.empty() ? "null" : text_;
    bool flat = kind_ == Kind::list;
    for (const auto& [k, v] : members_) flat = flat && v.kind_ == Kind::scalar;
    std::string out = kind_ == Kind::list ? "[" : "{",
                gap = "\n" + std::string(static_cast<std::size_t>(indent) + 1, ' ');
    for (std::size_t i = 0; i < members_.size(); ++i) {
      out += (i > 0 ? "," : "") + (flat ? std::string(i > 0 ? " " : "") : gap);
      if (kind_ == Kind::object) out += quote(members_[i].first) + ": ";
      out += members_[i].second.text(indent + 1);
    }
    if (!flat && !members_.empty()) out += "\n" + std::string(static_cast<std::size_t>(indent), ' ');
    return out + (kind_ == Kind::list ? "]" : "}");
  }

 private:
  enum class Kind { scalar, list, object };

  [[nodiscard]] static std::string quote(std::string_view v) {
    std::string out = "\"";
    for (const char c : v) {
      if (c == '"' || c == '\\') {
        (out += '\\') += c;
      } else if (static_cast<unsigned char>(c) < 0x20) {
        std::array<char, 8> code{};
        std::snprintf(code.data(), code.size(), "\\u%04x", static_cast<unsigned>(c));
        out += code.data();
      } else {
        out += c;
      }
    }
    return out + "\"";
  }

  Kind kind_ = Kind::scalar;
  std::string text_;
  std::vector<std::pair<std::string, Json>> members_;
};

}  // namespace tunica::examples
