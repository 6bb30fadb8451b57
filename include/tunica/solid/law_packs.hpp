// SPDX-License-Identifier: MIT
// Packs of cells under one law, and what that law reads at their points, a lane a cell.
#pragma once

#include "tunica/core/pack.hpp"
#include "tunica/core/tensor.hpp"
#include "tunica/fem/block_assembly.hpp"
#include "tunica/solid/cell_laws.hpp"

#include <cstddef>

namespace tunica::solid {

/// body(pack, law) for all cells in packs of W, each a run of cells under one law; lanes behind its `count`
/// repeat the last cell. A: the matrix that is added to, whose blocks are fetched ahead, or nullptr.
template <int W, class Assembly, class Material, int Points, class Matrix, class Body>
void for_each_law_pack(const Assembly& assembly, const CellLaws<Material, Points>& laws, const Matrix* A,
                       Body&& body) {
  const auto visit = [&](const fem::CellPack<W>& pack) {
    for (int first = 0; first < pack.count;) {
      const Material& law = laws.material(pack.cell[first]);
      fem::CellPack<W> run;
      run.count = 0;
      while (first < pack.count && &laws.material(pack.cell[first]) == &law)
        run.cell[run.count++] = pack.cell[first++];
      for (int l = run.count; l < W; ++l) run.cell[l] = run.cell[run.count - 1];
      body(run, law);
    }
  };
  if (A)
    assembly.template for_each_pack<W>(*A, visit);
  else
    assembly.template for_each_pack<W>(visit);
}

/// data[q]: what the law reads at point q, zeros where nothing was given; stored[q]: F_p, left alone where
/// there is no prestress.
template <class S, class Material, int Points>
void gather_points(const CellLaws<Material, Points>& laws, const fem::CellPack<Lanes<S>::count>& pack,
                   PointOf<typename CellLaws<Material, Points>::Law, S>* data, Tensor<S>* stored) {
  using Law = typename CellLaws<Material, Points>::Law;
  for (std::size_t q = 0; q < Points; ++q) {
    if constexpr (needs_point<Law>)
      for (std::size_t k = 0; k < point_size<Law>; ++k)
        for (int l = 0; l < Lanes<S>::count; ++l) {
          const auto* const given = laws.data(pack.cell[l]).points;
          data[q].m[k].set(l, given ? given[q].m[k] : 0.0);
        }
    if (!laws.prestress().empty())
      for (int k = 0; k < 9; ++k)
        for (int l = 0; l < Lanes<S>::count; ++l)
          stored[q].m[static_cast<std::size_t>(k)].set(l, laws.data(pack.cell[l]).prestress[q](k / 3, k % 3));
  }
}

}  // namespace tunica::solid
