// SPDX-License-Identifier: MIT
// A file that appears whole or not at all: written aside, synchronised, then renamed into its place.
#pragma once

#include "tunica/core/error.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace tunica::io {

/// Until commit() the old file, if any, stays as it is; without commit() nothing is left behind. A link stays
/// a link: what it leads to is replaced. A device or a pipe (/dev/stdout) cannot be: it is written to at
/// once. Every failure (no folder, no right, disk full) is an InputError that names the file.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path) : path_(std::move(path)), target_(path_) {
    std::error_code error;
    const auto status = std::filesystem::status(path_, error);
    if (std::filesystem::is_directory(status)) throw InputError(path_.string() + ": is a folder");
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    } else {
      if (auto real = std::filesystem::canonical(path_, error); !error) target_ = std::move(real);
      aside_ = target_;
      aside_ += ".part";  // the same name each time: what a killed run left is overwritten
      descriptor_ = ::open(aside_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    }
    if (descriptor_ < 0) fail("cannot be written");
    buffer_.reserve(block);
  }
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile() { discard(); }

  void write(std::string_view bytes) {
    if (buffer_.size() + bytes.size() > block) flush();
    if (bytes.size() > block)
      put(bytes);
    else
      buffer_.append(bytes);
  }

  /// Puts the file in its place; after it the name holds either all of this or, on failure, what it held.
  void commit() {
    flush();
    if (::fsync(descriptor_) != 0 && !aside_.empty()) fail("cannot be synchronised");
    if (::close(std::exchange(descriptor_, -1)) != 0) fail("cannot be closed");
    if (aside_.empty()) return;
    if (::rename(aside_.c_str(), target_.c_str()) != 0) fail("cannot be renamed into its place");
    aside_.clear();
    const auto folder = target_.parent_path();
    const int d = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (d < 0) return;  // a folder that cannot be opened cannot be synchronised; the file is there
    ::fsync(d);
    ::close(d);
  }

 private:
  static constexpr std::size_t block = 1u << 18;

  void flush() {
    put(buffer_);
    buffer_.clear();
  }
  void put(std::string_view bytes) {
    while (!bytes.empty()) {
      const auto n = ::write(descriptor_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) fail("cannot be written");
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
  }
  [[noreturn]] void fail(const std::string& what) {
    const int cause = errno;
    discard();
    throw InputError(path_.string() + ": " + what + ": " + std::strerror(cause));
  }
  void discard() {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
    if (!aside_.empty()) ::unlink(aside_.c_str());
    aside_.clear();
  }

  std::filesystem::path path_, target_, aside_;
  int descriptor_ = -1;
  std::string buffer_;
};

/// Writes a whole file at once.
inline void write_file(const std::filesystem::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

/// InputError if write_file would refuse the path now: for outputs that are written long after they are
/// named. Leaves nothing behind, and what is there as it is.
inline void expect_writable(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  const bool device = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
                      !std::filesystem::is_directory(status);
  if (!device)
    const AtomicFile probe(path);
  else if (::access(path.c_str(), W_OK) != 0)  // opened and closed a pipe would tell its reader of an end
    throw InputError(path.string() + ": cannot be written: " + std::strerror(errno));
}

}  // namespace tunica::io
