// SPDX-License-Identifier: MIT
// Exceptions for bad input: they name the file or object, the place in it and what was found.
#pragma once

#include <stdexcept>
#include <string>

namespace tunica {

/// A file or option that cannot be used: "<what>: <place>: <found>".
struct InputError : std::runtime_error {
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
  InputError(const std::string& what, const std::string& place, const std::string& found)
      : std::runtime_error(joined(what, place, found)) {}

 private:
  static std::string joined(const std::string& what, const std::string& place, const std::string& found) {
    std::string text = what;
    text.append(": ").append(place).append(": ").append(found);
    return text;
  }
};

/// A geometry that cannot be meshed or used, with the place in world coordinates.
struct MeshError : std::runtime_error {
  explicit MeshError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace tunica
