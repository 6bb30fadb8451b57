// SPDX-License-Identifier: MIT
// The finite difference mesh of an image: a box-shaped hexahedron round each voxel kept. [PEREZ08, 3.2.2]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/box.hpp"
#include "tunica/meshing/contour.hpp"
#include "tunica/meshing/voxel_contacts.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

struct VoxelOptions {
  VoxelContacts contacts = VoxelContacts::separated;
};

struct [[nodiscard]] VoxelFill {
  mesh::HexMesh mesh;  // patches: "wall", then "border x0" ... where the voxels reach the image's border
  VoxelContactReport contacts;
};

namespace detail {

/// Builds the mesh slab by slab: corners of two layers of the lattice are numbered at a time.
class VoxelMesher {
 public:
  VoxelMesher(const VoxelLattice& lattice, const std::uint8_t* inside, VoxelContacts contacts,
              VoxelContactReport& report)
      : lattice_(lattice),
        inside_(inside),
        separated_(contacts == VoxelContacts::separated),
        report_(report) {
    for (auto& layer : layers_) layer.resize((lattice.size(0) + 1) * (lattice.size(1) + 1));
  }

  [[nodiscard]] mesh::HexMesh run() {
    number(0);
    for (std::size_t k = 0; k < lattice_.size(2); ++k) {
      number(k + 1);
      for (std::size_t j = 0; j < lattice_.size(1); ++j) hexes(j, k);
    }
    mesh::HexMesh mesh;
    mesh.nodes.resize(3, static_cast<Eigen::Index>(nodes_.size() / 3));
    std::copy(nodes_.begin(), nodes_.end(), mesh.nodes.data());
    mesh.cells.resize(8, static_cast<Eigen::Index>(cells_.size() / 8));
    std::copy(cells_.begin(), cells_.end(), mesh.cells.data());
    for (std::size_t p = 0; p < faces_.size(); ++p)
      if (p == 0 || !faces_[p].empty())
        mesh.patches.push_back({p == 0 ? "wall" : border_names[p - 1], vec::quads(faces_[p])});
    return mesh;
  }

 private:
  /// Number of a corner's first node and, where it is split, its octants.
  struct Corner {
    Index node;
    std::uint8_t set;
  };

  void number(std::size_t k) {
    auto& layer = layers_[k % 2];
    for (std::size_t j = 0; j <= lattice_.size(1); ++j)
      lattice_.row(inside_, j, k, [&](std::size_t i, unsigned set) {
        Corner& corner = layer[i + (lattice_.size(0) + 1) * j];
        corner = {static_cast<Index>(nodes_.size() / 3), 0};
        int copies = 1;
        if (!surface_at(set)) {
          count_contacts(lattice_, {i, j, k}, set, report_);
          if (separated_ && octants[set].parts > 1) {
            copies = octants[set].parts, corner.set = static_cast<std::uint8_t>(set);
            report_.split_nodes += static_cast<std::size_t>(copies - 1);
          }
        }
        for (int n = 0; n < copies; ++n)
          nodes_.insert(nodes_.end(), {lattice_.at(0, i), lattice_.at(1, j), lattice_.at(2, k)});
        if (nodes_.size() / 3 > most)
          throw MeshError("the image has more voxels inside than a mesh can number");
      });
  }

  void hexes(std::size_t j, std::size_t k) {
    const std::size_t nx = lattice_.size(0), ny = lattice_.size(1), nz = lattice_.size(2);
    const std::uint8_t* row = inside_ + nx * (j + ny * k);
    const std::array<std::size_t, 3> stride{1, nx, nx * ny}, n{nx, ny, nz};
    for (std::size_t i = 0; i < nx; ++i) {
      if (row[i] == 0) continue;
      std::array<Index, 8> hex{};
      for (std::size_t c = 0; c < 8; ++c) {
        const auto& o = box_corners[c];
        const auto u = static_cast<std::size_t>(o[0]), v = static_cast<std::size_t>(o[1]),
                   w = static_cast<std::size_t>(o[2]);
        const Corner& corner = layers_[(k + w) % 2][i + u + (nx + 1) * (j + v)];
        // this voxel is the octant of the corner on the other side of each offset
        const std::size_t octant = (1 - u) | (1 - v) << 1 | (1 - w) << 2;
        hex[c] = corner.node + (corner.set != 0 ? octants[corner.set].part[octant] : 0);
      }
      cells_.insert(cells_.end(), hex.begin(), hex.end());
      const std::array<std::size_t, 3> at{i, j, k};
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t s = 0; s < 2; ++s) {
          const bool border = at[a] == (s == 0 ? 0 : n[a] - 1);
          if (!border && (s == 0 ? row[i - stride[a]] : row[i + stride[a]]) != 0) continue;
          auto& list = faces_[border ? 1 + 2 * a + s : 0];
          for (const int c : mesh::Hex8::faces[face_at[a][s]])
            list.push_back(hex[static_cast<std::size_t>(c)]);
        }
    }
  }

  /// Face of Hex8 at the low and the high end of each axis.
  static constexpr std::array<std::array<std::size_t, 2>, 3> face_at{{{5, 3}, {2, 4}, {0, 1}}};
  static constexpr std::size_t most = 2147483647;

  const VoxelLattice& lattice_;
  const std::uint8_t* inside_;
  bool separated_;
  VoxelContactReport& report_;
  std::array<std::vector<Corner>, 2> layers_;
  std::vector<double> nodes_;
  std::vector<Index> cells_;
  std::array<std::vector<Index>, 7> faces_;
};

/// Edges that two voxels share diagonally and whose nodes have not been split.
[[nodiscard]] inline std::size_t shared_edges(const VoxelLattice& lattice, const std::uint8_t* inside) {
  const std::size_t nx = lattice.size(0) + 1, ny = lattice.size(1) + 1;
  std::size_t count = 0;
  std::array<std::vector<std::uint8_t>, 2> sets;
  for (auto& layer : sets) layer.assign(nx * ny, 0);
  for (std::size_t k = 0; k <= lattice.size(2); ++k) {
    auto &low = sets[(k + 1) % 2], &high = sets[k % 2];
    std::fill(high.begin(), high.end(), std::uint8_t{0});
    for (std::size_t j = 0; j < ny; ++j)
      lattice.row(inside, j, k,
                  [&](std::size_t i, unsigned set) { high[i + nx * j] = static_cast<std::uint8_t>(set); });
    for (std::size_t c = 0; c < nx * ny; ++c)
      for (std::size_t a = 0; a < 3; ++a) {
        const unsigned upper = high[c];
        if ((octants[upper].edges >> (2 * a) & 1U) == 0) continue;
        const unsigned lower = a == 0 ? high[c - 1] : a == 1 ? high[c - nx] : low[c];
        // the two voxels of the edge, seen from its upper end on the low side of the axis
        const unsigned b = static_cast<unsigned>(a + 1) % 3, d = static_cast<unsigned>(a + 2) % 3;
        const bool even = (upper & 1U) != 0;
        const unsigned p = even ? 0 : 1U << b, q = even ? 1U << b | 1U << d : 1U << d;
        const auto joined = [&](unsigned set, unsigned side) {
          const auto& part = octants[set].part;
          return part[p | side << a] == part[q | side << a];
        };
        count += joined(upper, 0) && joined(lower, 1) ? 1 : 0;
      }
  }
  return count;
}

}  // namespace detail

/// A hexahedron round each voxel kept (one byte a voxel, 0 is dropped): it reaches half-way to the
/// neighbouring samples, and to the sample itself at the border of the image, whose volume is thus filled.
/// Nodes are shared. InputError if an axis has less than two samples, MeshError if no voxel is kept.
template <class T>
[[nodiscard]] VoxelFill voxel_hexahedra(const image::Image<T>& image, std::span<const std::uint8_t> kept,
                                        const VoxelOptions& options = {}) {
  TUNICA_EXPECT(kept.size() == image.values.size(), "the mask has one byte for each voxel");
  for (std::size_t a = 0; a < 3; ++a)
    if (image.axes[a].size() < 2)
      throw InputError("voxels have no thickness along an axis of the image that has one sample");
  if (std::all_of(kept.begin(), kept.end(), [](std::uint8_t v) { return v == 0; }))
    throw MeshError("no voxel is kept: there is nothing to mesh");
  const detail::VoxelLattice lattice(image);
  VoxelFill fill;
  std::vector<std::uint8_t> more;
  const std::uint8_t* inside = kept.data();
  if (options.contacts == VoxelContacts::filled) {
    more.assign(kept.begin(), kept.end());
    fill.contacts.filled_voxels = detail::fill_contacts(image, lattice, more);
    inside = more.data();
  }
  fill.mesh = detail::VoxelMesher(lattice, inside, options.contacts, fill.contacts).run();
  if (options.contacts == VoxelContacts::kept) fill.contacts.left_edges = fill.contacts.edges;
  if (options.contacts == VoxelContacts::separated && fill.contacts.edges > 0)
    fill.contacts.left_edges = detail::shared_edges(lattice, inside);
  return fill;
}

}  // namespace tunica::meshing
