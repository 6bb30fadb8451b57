// SPDX-License-Identifier: MIT
// Where voxels touch by an edge or a corner alone, and the filling of voxels until none does.
#pragma once

#include "tunica/image/image.hpp"
#include "tunica/meshing/voxel_octants.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tunica::meshing {

/// What becomes of hexahedra that touch by an edge or a corner alone. kept: they share its nodes.
/// separated: each side has nodes of its own, so that no force or flow passes there. filled: one more voxel
/// is taken where they touch, the one of the greatest value, until the border is a surface everywhere.
enum class VoxelContacts { kept, separated, filled };

struct [[nodiscard]] VoxelContactReport {
  std::size_t edges = 0;          // that two voxels alone share, diagonally
  std::size_t corners = 0;        // where voxels touch that no face or such edge joins there
  std::size_t pinches = 0;        // where the outside is parted so
  std::vector<Vec3> places;       // middles of the edges and corners, at most most_places of each
  std::size_t split_nodes = 0;    // nodes made by separating
  std::size_t filled_voxels = 0;  // taken by filling
  std::size_t left_edges = 0;     // still shared: their voxels hang together beside both ends

  static constexpr std::size_t most_places = 1000;
};

namespace detail {

/// The corners of the voxels of an image: voxel v spans corners v .. v+1 along each axis; mid-planes lie
/// between samples, and the first and the last sample bound the image.
class VoxelLattice {
 public:
  template <class T>
  explicit VoxelLattice(const image::Image<T>& image) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto& x = image.axes[a];
      n_[a] = x.size();
      corner_[a].push_back(x.front());
      for (std::size_t i = 1; i < x.size(); ++i) corner_[a].push_back(0.5 * (x[i - 1] + x[i]));
      corner_[a].push_back(x.back());
    }
    none_.assign(n_[0], 0);
  }

  [[nodiscard]] std::size_t size(std::size_t a) const { return n_[a]; }
  [[nodiscard]] double at(std::size_t a, std::size_t corner) const { return corner_[a][corner]; }
  [[nodiscard]] Vec3 point(std::size_t i, std::size_t j, std::size_t k) const {
    return {corner_[0][i], corner_[1][j], corner_[2][k]};
  }

  /// Calls visit(i, set) for the corners (i, j, k) of a row with any inside voxel: the set of octants.
  template <class Visit>
  void row(const std::uint8_t* inside, std::size_t j, std::size_t k, Visit&& visit) const {
    std::array<const std::uint8_t*, 4> at{};
    for (std::size_t o = 0; o < 4; ++o) {
      const std::size_t v = j + (o & 1), w = k + (o >> 1);  // one more than the voxel's
      at[o] = v == 0 || w == 0 || v > n_[1] || w > n_[2] ? none_.data()
                                                         : inside + n_[0] * (v - 1 + n_[1] * (w - 1));
    }
    unsigned low = 0;
    for (std::size_t i = 0; i <= n_[0]; ++i) {
      unsigned high = 0;
      if (i < n_[0])
        high = unsigned(at[0][i] != 0) | unsigned(at[1][i] != 0) << 2 | unsigned(at[2][i] != 0) << 4 |
               unsigned(at[3][i] != 0) << 6;
      if ((low | high) != 0) visit(i, low | high << 1);
      low = high;
    }
  }

 private:
  std::array<std::size_t, 3> n_{};
  std::array<std::vector<double>, 3> corner_;
  std::vector<std::uint8_t> none_;
};

/// Counts the contacts of one corner; edges are counted at their lower ends.
inline void count_contacts(const VoxelLattice& lattice, std::array<std::size_t, 3> at, unsigned set,
                           VoxelContactReport& report) {
  const Octants& o = octants[set];
  const Vec3 x = lattice.point(at[0], at[1], at[2]);
  const auto note = [&](std::size_t count, const Vec3& place) {
    if (count <= VoxelContactReport::most_places) report.places.push_back(place);
  };
  for (std::size_t a = 0; a < 3; ++a)
    if ((o.edges >> (2 * a + 1) & 1U) != 0) {
      Vec3 middle = x;
      const auto e = static_cast<Eigen::Index>(a);
      middle[e] = 0.5 * (middle[e] + lattice.at(a, at[a] + 1));
      note(++report.edges, middle);
    }
  if (o.edges != 0) return;
  if (o.parts > 1) note(++report.corners, x);
  if (o.outside_parts > 1 && o.parts == 1) note(++report.pinches, x);
}

/// The octants round the first edge that two voxels alone share, or all of them if there is none.
[[nodiscard]] inline unsigned beside(unsigned set) {
  const unsigned edges = octants[set].edges;
  if (edges == 0) return 255;
  unsigned side = 0;
  while ((edges >> side & 1U) == 0) ++side;
  const unsigned a = side / 2;
  unsigned around = 0;
  for (unsigned o = 0; o < 8; ++o)
    if ((o >> a & 1U) == side % 2) around |= 1U << o;
  return around;
}

/// Takes voxels until the border is a surface everywhere; returns how many. Voxels beyond the image are
/// never taken, so at its border contacts can stay only if all voxels of the image are inside there.
template <class T>
std::size_t fill_contacts(const image::Image<T>& image, const VoxelLattice& lattice,
                          std::vector<std::uint8_t>& inside) {
  const std::size_t nx = lattice.size(0), ny = lattice.size(1), nz = lattice.size(2);
  std::size_t filled = 0;
  for (std::size_t before = 1; before != 0;) {
    before = 0;
    for (std::size_t k = 0; k <= nz; ++k)
      for (std::size_t j = 0; j <= ny; ++j)
        lattice.row(inside.data(), j, k, [&](std::size_t i, unsigned set) {
          if (surface_at(set)) return;
          std::size_t best = inside.size();
          const unsigned wanted = ~set & beside(set);
          for (unsigned o = 0; o < 8; ++o) {
            const std::size_t u = i + (o & 1), v = j + (o >> 1 & 1), w = k + (o >> 2);
            if ((wanted >> o & 1U) == 0 || u == 0 || v == 0 || w == 0 || u > nx || v > ny || w > nz) continue;
            const std::size_t voxel = u - 1 + nx * (v - 1 + ny * (w - 1));
            if (inside[voxel] == 0 && (best == inside.size() || image.values[voxel] > image.values[best]))
              best = voxel;
          }
          if (best == inside.size()) return;
          inside[best] = 1;
          ++before, ++filled;
        });
  }
  return filled;
}

}  // namespace detail

}  // namespace tunica::meshing
