// SPDX-License-Identifier: MIT
// A whole file as bytes, or an InputError that says why not.
#pragma once

#include "tunica/core/error.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

namespace tunica::io {

/// The bytes of a regular file. InputError if it is missing, a folder, or cannot be read to its end.
[[nodiscard]] inline std::string read_file(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(name + ": no such file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(name + ": not a regular file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(name.c_str(), "rb"), &std::fclose);
  if (!file) throw InputError(name + ": cannot be opened: " + std::strerror(errno));
  const auto size = std::filesystem::file_size(path, error);
  if (error) throw InputError(name + ": has no size: " + error.message());
  std::string bytes(static_cast<std::size_t>(size), '\0');
  const std::size_t got = std::fread(bytes.data(), 1, bytes.size(), file.get());
  if (got != bytes.size())
    throw InputError(name + ": read " + std::to_string(got) + " of " + std::to_string(bytes.size()) +
                     " bytes");
  return bytes;
}

}  // namespace tunica::io
