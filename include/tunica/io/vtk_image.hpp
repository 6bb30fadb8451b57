// SPDX-License-Identifier: MIT
// Strict reader of images from VTK legacy files: STRUCTURED_POINTS and RECTILINEAR_GRID.
#pragma once

#include "tunica/core/text.hpp"
#include "tunica/image/image.hpp"
#include "tunica/io/lengths.hpp"
#include "tunica/io/read_file.hpp"
#include "tunica/io/vtk_legacy.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tunica::io {

struct VtkImageOptions {
  std::string array{};  // name of the point array; empty: the first SCALARS, else the first of one component
  std::size_t most_voxels = std::size_t{1} << 31;  // larger images are refused before they are read
};

/// T is float by default: it holds every 8 and 16-bit sample exactly, in half the memory of double.
template <class T>
struct [[nodiscard]] VtkImage {
  image::Image<T> image;
  std::string array;                        // name of the array that was read
  ScalarType stored = ScalarType::float32;  // its type in the file
};

namespace detail {

template <class T>
class VtkImageParser {
 public:
  VtkImageParser(std::string name, std::string_view bytes, const VtkImageOptions& options)
      : file_(std::move(name), bytes), options_(options) {}

  [[nodiscard]] VtkImage<T> parse() {
    dataset();
    while (!file_.at.at_end()) {
      const auto word = file_.at.word();
      const std::string key = upper(word);
      if (key == "METADATA") {
        file_.skip_metadata();
      } else if (key == "FIELD") {
        fields();
      } else if (key == "POINT_DATA" || key == "CELL_DATA") {
        section(key);
      } else if (!(points_ || cells_ ? attribute(key) : geometry(key))) {
        at().fail("expected a keyword of the format, found " + in_quotes(word));
      }
    }
    if (!found_) missing();
    if (!rectilinear_) even_axes();  // last: an axis is only made where the file holds its samples
    for (std::size_t a = 0; a < 3; ++a) require_lengths(at().name(), "xyz"[a], axes_[a]);
    result_.image.axes = std::move(axes_);
    return std::move(result_);
  }

 private:
  Cursor& at() { return file_.at; }

  void dataset() {
    if (const auto word = at().word(); upper(word) != "DATASET")
      at().fail("expected DATASET, found " + in_quotes(word));
    const auto word = at().word();
    const std::string kind = upper(word);
    if (kind != "STRUCTURED_POINTS" && kind != "RECTILINEAR_GRID")
      at().fail("DATASET " + std::string(word.substr(0, 40)) +
                " where STRUCTURED_POINTS is expected (RECTILINEAR_GRID is read too)");
    rectilinear_ = kind == "RECTILINEAR_GRID";
    at().end_of_line();
  }

  [[nodiscard]] bool geometry(const std::string& key) {
    if (key == "DIMENSIONS") {
      dimensions();
    } else if (!rectilinear_ && (key == "SPACING" || key == "ASPECT_RATIO")) {
      spacing_ = triple(key);
      for (std::size_t a = 0; a < 3; ++a)
        if (!((*spacing_)[a] > 0))
          at().fail("spacing " + std::string(1, "xyz"[a]) + " is " + number_text((*spacing_)[a]) +
                    ((*spacing_)[a] < 0 ? ": it would turn all orientations inside out"
                                        : ": cells have no volume"));
    } else if (!rectilinear_ && key == "ORIGIN") {
      origin_ = triple(key);
    } else if (rectilinear_ && key.size() == 13 && key.substr(1) == "_COORDINATES" && key[0] >= 'X' &&
               key[0] <= 'Z') {
      coordinates(static_cast<std::size_t>(key[0] - 'X'), key);
    } else {
      return false;
    }
    return true;
  }

  void dimensions() {
    std::string text;
    for (auto& n : size_) {
      n = at().template number<std::size_t>("a dimension");
      text += (text.empty() ? "" : " x ") + std::to_string(n);
    }
    voxels_ = 1;
    for (const std::size_t n : size_) {
      if (n == 0) at().fail("a dimension is 0 (" + text + "): no voxels");
      if (n > options_.most_voxels / voxels_)  // by division: the product itself may overflow
        at().fail("the dimension product " + text + " overflows the limit of " +
                  std::to_string(options_.most_voxels) + " voxels");
      voxels_ *= n;
    }
    at().end_of_line();
  }

  [[nodiscard]] std::array<double, 3> triple(const std::string& key) {
    std::array<double, 3> v{};
    for (double& x : v) {
      x = at().template number<double>("a number of " + key);
      if (!std::isfinite(x)) at().fail(key + " is not finite");
    }
    at().end_of_line();
    return v;
  }

  void coordinates(std::size_t axis, const std::string& key) {
    const auto n = at().template number<std::size_t>("a count of " + key);
    if (n != size_[axis])
      at().fail(key + " " + std::to_string(n) + " != DIMENSIONS " + std::to_string(size_[axis]));
    const ScalarType type = file_.type(at().word());
    at().end_of_line();
    axes_[axis] = file_.template values<double>(type, n, key);
    for (std::size_t i = 1; i < n; ++i)
      if (!(axes_[axis][i] > axes_[axis][i - 1]))
        at().fail(key + " do not increase at index " + std::to_string(i));
  }

  void section(const std::string& key) {
    if (voxels_ == 0) at().fail(key + " before DIMENSIONS");
    if (rectilinear_ && (axes_[0].empty() || axes_[1].empty() || axes_[2].empty()))
      at().fail(key + " before the coordinates of every axis");
    points_ = key == "POINT_DATA", cells_ = !points_;
    tuples_ = points_ ? voxels_ : 1;
    if (cells_)
      for (const std::size_t n : size_) tuples_ *= n > 1 ? n - 1 : 1;
    const auto word = at().word();
    std::size_t n = 0;
    if (!parse_number(word, n) || n != tuples_)
      at().fail((points_ ? "DIMENSIONS product " : "number of cells ") + std::to_string(tuples_) +
                " != " + key + " " + std::string(word.substr(0, 40)));
    at().end_of_line();
  }

  void even_axes() {
    const auto h = spacing_.value_or(std::array<double, 3>{1, 1, 1});
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t i = 0; i < size_[a]; ++i)
        axes_[a].push_back(origin_[a] + static_cast<double>(i) * h[a]);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t i = 1; i < size_[a]; ++i)
        if (!(axes_[a][i] > axes_[a][i - 1]) || !std::isfinite(axes_[a][i]))
          throw InputError(at().name() + ": spacing " + std::string(1, "xyz"[a]) +
                           " is lost in the size of the coordinates");
  }

  [[nodiscard]] bool wanted(const std::string& name) const {
    return points_ && !found_ && (options_.array.empty() || options_.array == name);
  }
  void take(const std::string& name, ScalarType type) {
    result_.image.values = file_.template values<T>(type, tuples_, "scalar data");
    result_.array = name, result_.stored = type;
    found_ = true;
  }

  void scalars() {
    const std::string name(at().word_of_line());
    const std::string type_name(at().word_of_line());
    const bool candidate = wanted(name);
    const ScalarType type = candidate ? file_.type(type_name) : ScalarType{};
    const auto word = at().word_of_line();
    const auto components =
        word.empty() ? 1 : at().template number_of<unsigned>(word, "a number of components");
    if (components < 1 || components > 4)
      at().fail("expected 1 to 4 components, found " + std::to_string(components));
    if (!word.empty())
      at().end_of_line();
    else if (at().left() > 0)
      (void)at().line();
    constexpr std::string_view table = "LOOKUP_TABLE";
    if (!file_.binary) at().skip_space();
    if (upper(at().rest().substr(0, table.size())) == table) (void)at().line();
    if (candidate && components == 1) return take(name, type);
    if (candidate && !options_.array.empty())
      at().fail("array " + in_quotes(name) + " has " + std::to_string(components) +
                " components, 1 is expected");
    file_.skip(type_name, file_.product(tuples_, components));
  }

  [[nodiscard]] bool attribute(const std::string& key) {
    if (key == "SCALARS") {
      scalars();
    } else if (key == "LOOKUP_TABLE" || key == "COLOR_SCALARS") {
      (void)at().word_of_line();
      const auto n = at().template number<std::size_t>("a count of " + key);
      at().end_of_line();
      const std::size_t bytes = key == "LOOKUP_TABLE" ? file_.product(n, 4) : file_.product(tuples_, n);
      file_.binary ? file_.skip_bytes(bytes) : file_.skip_words(bytes);
    } else if (key == "TEXTURE_COORDINATES") {
      (void)at().word_of_line();
      const auto n = at().template number<std::size_t>("a dimension of " + key);
      plain(n);
    } else {
      constexpr std::array<std::pair<std::string_view, std::size_t>, 7> kinds{{{"VECTORS", 3},
                                                                               {"NORMALS", 3},
                                                                               {"TENSORS", 9},
                                                                               {"TENSORS6", 6},
                                                                               {"GLOBAL_IDS", 1},
                                                                               {"PEDIGREE_IDS", 1},
                                                                               {"EDGE_FLAGS", 1}}};
      for (const auto& [name, components] : kinds)
        if (name == key) {
          (void)at().word_of_line();
          plain(components);
          return true;
        }
      return false;
    }
    return true;
  }

  void plain(std::size_t components) {
    const std::string type_name(at().word_of_line());
    at().end_of_line();
    file_.skip(type_name, file_.product(tuples_, components));
  }

  void fields() {
    (void)at().word_of_line();
    const auto arrays = at().template number<std::size_t>("a number of arrays");
    at().end_of_line();
    for (std::size_t f = 0; f < arrays; ++f) {
      std::string name(at().word());
      if (upper(name) == "METADATA") {  // of the array before
        file_.skip_metadata();
        name = at().word();
      }
      if (name.empty())
        at().fail("expected array " + std::to_string(f) + " of a FIELD, found the end of the file");
      if (name == "NULL_ARRAY") continue;
      const auto components = at().template number<std::size_t>("a number of components");
      const auto tuples = at().template number<std::size_t>("a number of tuples");
      const std::string type_name(at().word_of_line());
      at().end_of_line();
      if (wanted(name) && components == 1 && tuples == tuples_ && scalar_type(type_name))
        take(name, file_.type(type_name));
      else
        file_.skip(type_name, file_.product(components, tuples));
    }
  }

  [[noreturn]] void missing() {
    at().fail(at().offset(), options_.array.empty() ? "no scalars for the points of the image"
                                                    : "no point array named " + in_quotes(options_.array));
  }

  LegacyFile file_;
  const VtkImageOptions& options_;
  VtkImage<T> result_;
  bool rectilinear_ = false, points_ = false, cells_ = false, found_ = false;
  std::array<std::size_t, 3> size_{};
  std::size_t voxels_ = 0, tuples_ = 0;
  std::optional<std::array<double, 3>> spacing_;
  std::array<double, 3> origin_{};
  std::array<std::vector<double>, 3> axes_;
};

}  // namespace detail

/// The image in the bytes of a VTK legacy file; `name` stands for the file in messages. InputError
/// names the place and what was found; nothing is returned unless the whole file was understood.
template <class T = float>
[[nodiscard]] VtkImage<T> parse_vtk_image(const std::string& name, std::string_view bytes,
                                          const VtkImageOptions& options = {}) {
  return detail::VtkImageParser<T>(name, bytes, options).parse();
}

template <class T = float>
[[nodiscard]] VtkImage<T> read_vtk_image(const std::filesystem::path& path,
                                         const VtkImageOptions& options = {}) {
  const std::string bytes = read_file(path);
  return parse_vtk_image<T>(path.string(), bytes, options);
}

}  // namespace tunica::io
