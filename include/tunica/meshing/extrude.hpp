// SPDX-License-Identifier: MIT
// Hex8 layers by extruding a sheet of quadrilaterals outward: the thickness asked for measured normal to
// the sheet, flat ends, no inverted cell. Where cells would be too flat the thickness gives way.
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/expect.hpp"
#include "tunica/core/vec.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/mesh/quality.hpp"
#include "tunica/meshing/extrude_field.hpp"
#include "tunica/meshing/quad_diagonals.hpp"
#include "tunica/meshing/surface_foot.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// What became of the thickness; lengths in the unit of the nodes.
struct ExtrudeReport {
  Index thinned = 0;                       // nodes where it gave way by more than 1 %
  double least_share = 1, mean_share = 1;  // thickness over the thickness asked for, at the nodes
  double least_between = 1;                // the same at the middles of the outer faces and of their sides
  Vec3 thinnest = Vec3::Zero();            // inner node of it
  Vec3 thinned_centre = Vec3::Zero();      // mean of the nodes that gave way
  double deviation_rms = 0,
         deviation_max = 0;  // of the faces' thickness, relative, where it did not give way
  mesh::HexQuality quality;
};

/// Nodes: those of the sheet first, then the same for each layer outward. Cells: layer by layer in the order
/// of the sheet; nodes 0-3 are on the inner side.
struct [[nodiscard]] Extruded {
  mesh::HexMesh mesh;
  std::vector<double> share;  // thickness over that asked for, one a node of the sheet
  ExtrudeReport report;
};

namespace detail {

inline void add_extruded_patches(mesh::HexMesh& mesh, const mesh::QuadSurface& sheet,
                                 std::span<const SheetRim> rims, int layers) {
  const Index nodes = sheet.node_count(), quads = sheet.cell_count();
  Connectivity<4> inner(4, quads), outer(4, quads);
  for (Index q = 0; q < quads; ++q) {
    for (int k = 0; k < 4; ++k) {
      inner(3 - k, q) = sheet.cells(k, q);
      outer(k, q) = sheet.cells(k, q) + nodes * layers;
    }
  }
  mesh.patches.push_back({"inner", inner});
  mesh.patches.push_back({"outer", outer});
  std::vector<Index> all;
  std::vector<mesh::Patch<mesh::Quad4>> ends;
  for (const SheetRim& rim : rims) {
    std::vector<Index> faces;
    for (int l = 0; l < layers; ++l)
      for (std::size_t i = 0; i < rim.loop.size(); ++i) {
        const Index a = rim.loop[i] + nodes * l, b = rim.loop[(i + 1) % rim.loop.size()] + nodes * l;
        faces.insert(faces.end(), {a, b, b + nodes, a + nodes});
      }
    all.insert(all.end(), faces.begin(), faces.end());
    ends.push_back({rim.name, vec::quads(faces)});
  }
  mesh.patches.push_back({"ends", vec::quads(all)});
  for (auto& end : ends) mesh.patches.push_back(std::move(end));
}

/// Least distance from the sheet of the middles of the outermost faces and of their sides, over the thickness
/// asked for there.
template <class Field>
[[nodiscard]] double least_between(const mesh::QuadSurface& sheet, const Field& field) {
  const mesh::Surface triangles = triangles_of(sheet);
  const TriangleFinder finder(triangles);
  double least = 1;
  for (Index q = 0; q < sheet.cell_count(); ++q) {
    const auto end = [&](int k) {
      const Index n = sheet.cells(k % 4, q);
      return vec::along(vec::column(sheet.nodes, n), 1, field.offset(n));
    };
    const double thickness = field.wanted(q);
    const auto measure = [&](const Vec3& x) { least = std::min(least, finder.distance(x) / thickness); };
    measure(vec::between(vec::between(end(0), end(2), 0.5), vec::between(end(1), end(3), 0.5), 0.5));
    for (int k = 0; k < 4; ++k)
      if (sheet.cells(k, q) < sheet.cells((k + 1) % 4, q)) measure(vec::between(end(k), end(k + 1), 0.5));
  }
  return least;
}

}  // namespace detail

/// Extrudes the sheet to the side of its normals. Patches "inner" (towards the lumen), "outer", "ends", then
/// one with the name of each rim. MeshError where no direction sees all faces around a node: the sheet itself
/// is folded there.
template <Thickness T = double>
[[nodiscard]] Extruded extrude(const mesh::QuadSurface& sheet, std::span<const SheetRim> rims,
                               const ExtrudeOptions<T>& options) {
  TUNICA_EXPECT(options.layers > 0, "an extrusion has layers");
  detail::ExtrudeField<T> field(sheet, rims, options);
  field.solve();

  Extruded result;
  mesh::HexMesh& mesh = result.mesh;
  const Index nodes = sheet.node_count(), quads = sheet.cell_count(), layers = options.layers;
  mesh.nodes.resize(3, nodes * (layers + 1));
  for (Index l = 0; l <= layers; ++l)
    for (Index n = 0; n < nodes; ++n)
      vec::set_column(
          mesh.nodes, l * nodes + n,
          vec::along(vec::column(sheet.nodes, n), static_cast<double>(l) / layers, field.offset(n)));
  mesh.cells.resize(8, quads * layers);
  for (Index l = 0; l < layers; ++l)
    for (Index q = 0; q < quads; ++q)
      for (int k = 0; k < 8; ++k) mesh.cells(k, l * quads + q) = sheet.cells(k % 4, q) + (l + k / 4) * nodes;
  detail::add_extruded_patches(mesh, sheet, rims, options.layers);

  ExtrudeReport& report = result.report;
  for (Index n = 0; n < nodes; ++n) {
    const double share = field.share(n);
    result.share.push_back(share);
    report.mean_share += (share - 1) / nodes;
    if (share < report.least_share) report.least_share = share, report.thinnest = vec::column(sheet.nodes, n);
    if (share < 0.99) ++report.thinned, report.thinned_centre += vec::column(sheet.nodes, n);
  }
  if (report.thinned > 0) report.thinned_centre = vec::scaled(1.0 / report.thinned, report.thinned_centre);
  report.least_between = detail::least_between(sheet, field);
  Index faces = 0;
  for (Index q = 0; q < quads; ++q) {
    const auto deviation = field.deviation(q);
    if (!deviation) continue;
    ++faces;
    report.deviation_rms += *deviation * *deviation;
    report.deviation_max = std::max(report.deviation_max, std::abs(*deviation));
  }
  report.deviation_rms = faces > 0 ? std::sqrt(report.deviation_rms / faces) : 0;
  report.quality = mesh::quality(mesh);
  return result;
}

}  // namespace tunica::meshing
