// SPDX-License-Identifier: MIT
// A time series as a PVD file: it is whole after every step, so that it can be watched while it grows.
#pragma once

#include "tunica/core/text.hpp"
#include "tunica/io/atomic_file.hpp"
#include "tunica/io/vtk_xml.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tunica::io {

class Pvd {
 public:
  explicit Pvd(std::filesystem::path path) : path_(std::move(path)) {}

  /// Adds a file, named relative to the PVD file, at its time [s], and writes the series atomically.
  void add(double time, const std::string& file) {
    times_.push_back(time);
    files_.push_back(file);
    write();
  }

  void write() const {
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        "<Collection>\n";
    for (std::size_t i = 0; i < files_.size(); ++i)
      text += "<DataSet timestep=\"" + number_text(times_[i]) + "\" part=\"0\" file=\"" +
              detail::xml_text(files_[i]) + "\"/>\n";
    write_file(path_, text + "</Collection>\n</VTKFile>\n");
  }

  [[nodiscard]] std::size_t size() const { return files_.size(); }

  /// The entries, for a checkpoint: after a restart the series goes on where it was.
  template <class Archive>
  void archive(Archive& a) {
    a("pvd times", times_);
    a("pvd files", files_);
  }

 private:
  std::filesystem::path path_;
  std::vector<double> times_;
  std::vector<std::string> files_;
};

}  // namespace tunica::io
