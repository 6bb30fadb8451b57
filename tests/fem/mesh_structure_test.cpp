// SPDX-License-Identifier: MIT
// Which nodes share a cell, chunks of cells in colours, and packs between lanes and rows.
#include "tunica/core/error.hpp"
#include "tunica/fem/cell_chunks.hpp"
#include "tunica/fem/lane_transpose.hpp"
#include "tunica/fem/node_graph.hpp"
#include "tunica/meshing/box.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

using namespace tunica;

namespace {

constexpr std::size_t at(std::ptrdiff_t i) {
  return static_cast<std::size_t>(i);
}

/// Each pair of nodes of each cell.
template <int Nodes>
std::vector<std::set<Index>> neighbours(const Connectivity<Nodes>& cells, Index node_count) {
  std::vector<std::set<Index>> of(at(node_count));
  for (Index n = 0; n < node_count; ++n) of[at(n)].insert(n);
  for (Eigen::Index e = 0; e < cells.cols(); ++e)
    for (int a = 0; a < Nodes; ++a)
      for (int b = 0; b < Nodes; ++b) of[at(cells(a, e))].insert(cells(b, e));
  return of;
}

/// The chunks as they come.
template <int Nodes>
std::vector<std::pair<Index, Index>> chunks_of(const fem::CellChunks& chunks) {
  std::vector<std::pair<Index, Index>> list;
  chunks.for_each([&](Index begin, Index end) { list.emplace_back(begin, end); });
  return list;
}

template <class S, int Count>
void check_lanes() {
  using T = typename Lanes<S>::type;
  constexpr int lanes = Lanes<S>::count, stride = Count + 3;
  std::array<S, Count> pack{}, back{};
  std::array<T, at(lanes * stride)> rows{};
  rows.fill(T(-7));
  for (int k = 0; k < Count; ++k)
    if constexpr (lanes == 1)
      pack[at(k)] = T(k);
    else
      for (int l = 0; l < lanes; ++l) pack[at(k)].set(l, T(100 * l + k));
  fem::lanes_to_rows<Count>(pack.data(), rows.data(), stride);
  bool right = true;
  for (int l = 0; l < lanes; ++l)
    for (int k = 0; k < stride; ++k)  // what lies between the rows is left alone
      right = right && rows[at(l * stride + k)] == (k < Count ? T(100 * l + k) : T(-7));
  CHECK(right);
  fem::rows_to_lanes<Count>(rows.data(), stride, back.data());
  for (int k = 0; k < Count; ++k)
    for (int l = 0; l < lanes; ++l)
      if constexpr (lanes == 1)
        right = right && back[at(k)] == pack[at(k)];
      else
        right = right && back[at(k)][l] == pack[at(k)][l];
  CHECK(right);
}

template <class S>
void check_triples() {
  if constexpr (fem::has_wide_registers<S>) {
    constexpr int lanes = Lanes<S>::count;
    std::vector<double> values(3 * 40 + 1);
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = static_cast<double>(k);
    const auto node = [](int l) { return (7 * l + 3) % 40; };
    S to[3];
    fem::triples_to_lanes(values.data(), node, to);
    for (int l = 0; l < lanes; ++l)
      for (int c = 0; c < 3; ++c) CHECK(to[c][l] == 3 * node(l) + c);
  }
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("fem: a node graph is the pairs of nodes of the cells and its upper half theirs") {
    const auto hexes = meshing::box_hexes({.cells = {3, 2, 4}});
    const auto check = [](const auto& cells, Index count) {
      const auto expected = neighbours(cells, count);
      auto graph = fem::node_graph(cells, count);
      REQUIRE(graph.start.size() == at(count) + 1);
      for (Index n = 0; n < count; ++n) {
        const std::vector<Index> list(graph.neighbour.begin() + graph.start[at(n)],
                                      graph.neighbour.begin() + graph.start[at(n) + 1]);
        CHECK(list == std::vector<Index>(expected[at(n)].begin(), expected[at(n)].end()));
        CHECK(graph.degree(n) == static_cast<Index>(expected[at(n)].size()));
        for (const Index m : list) CHECK(graph.neighbour[at(graph.find(m, n))] == m);
      }
      fem::keep_upper(graph);
      for (Index n = 0; n < count; ++n) {
        const std::vector<Index> list(graph.neighbour.begin() + graph.start[at(n)],
                                      graph.neighbour.begin() + graph.start[at(n) + 1]);
        CHECK(list == std::vector<Index>(expected[at(n)].find(n), expected[at(n)].end()));
      }
    };
    check(hexes.cells, hexes.node_count());
    check(hexes.cells, hexes.node_count() + 2);  // nodes of no cell have themselves
    const auto tets = meshing::box_tets({.cells = {2, 2, 2}});
    check(tets.cells, tets.node_count());
    check(Connectivity<4>(4, 0), 3);
    Connectivity<4> folded(4, 1);  // a cell that has a node twice
    folded << 0, 1, 1, 2;
    check(folded, 3);
  }

  TEST_CASE("fem: a cell with a node that is not there is refused by its numbers") {
    auto mesh = meshing::box_tets({.cells = {2, 1, 1}});
    mesh.cells(2, 5) = mesh.node_count();
    const auto refused = [&](const char* sentence) {
      CHECK_THROWS_WITH_AS((void)fem::node_graph(mesh.cells, mesh.node_count()), sentence, MeshError);
    };
    refused("cell 5 names node 12; the mesh has 12");
    mesh.cells(0, 3) = -1;
    refused("cell 3 names node -1; the mesh has 12");
  }

  TEST_CASE("fem: chunks take each cell once and those of a colour share no node") {
    for (const int n : {1, 3, 14}) {
      const auto mesh = meshing::box_tets({.cells = {n, n, n}});
      for (const Index lanes : {1, 4, 16}) {
        const fem::CellChunks chunks(mesh.cells, mesh.node_count(), lanes);
        const auto list = chunks_of<4>(chunks);
        std::vector<int> taken(at(mesh.cell_count()), 0);
        int odd = 0;
        for (const auto& [begin, end] : list) {
          for (Index e = begin; e < end; ++e) ++taken[at(e)];
          CHECK(begin % lanes == 0);
          odd += (end - begin) % lanes != 0;
        }
        CHECK(std::all_of(taken.begin(), taken.end(), [](int t) { return t == 1; }));
        CHECK(odd <= 1);  // the last one may be shorter
        if (list.size() < 3) continue;

        // Two threads in a colour: no node may be written by both. The list of each node's writers in the
        // order of visits is the same as on one thread.
        const auto writers = [&] {
          std::vector<std::vector<Index>> of(at(mesh.node_count()));
          chunks.for_each([&](Index begin, Index end) {
            for (Index e = begin; e < end; ++e)
              for (int a = 0; a < 4; ++a) of[at(mesh.cells(a, e))].push_back(e);
          });
          return of;
        };
        const auto one = writers();
        thread_count() = 2;
        const auto two = writers();
        thread_count() = 1;
        CHECK(one == two);
      }
    }
  }

  TEST_CASE("fem: chunks that find no free colour have one of their own") {
    // A fan: all cells share node 0, so that no two chunks may run at once.
    const Index count = 5000;
    Connectivity<3> fan(3, count);
    for (Index e = 0; e < count; ++e) fan.col(e) << 0, e + 1, e + 2;
    const fem::CellChunks chunks(fan, count + 2);
    thread_count() = 2;
    std::mutex busy;
    bool alone = true;
    Index last = -1;
    bool ascending = true;
    chunks.for_each([&](Index begin, Index end) {
      alone = alone && busy.try_lock();
      ascending = ascending && begin > last;
      last = end - 1;
      busy.unlock();
    });
    thread_count() = 1;
    CHECK(alone);
    CHECK(ascending);
    CHECK(last == count - 1);
    int calls = 0;
    fem::CellChunks(Connectivity<4>(4, 0), 3).for_each([&](Index, Index) { ++calls; });
    CHECK(calls == 0);
  }

  TEST_CASE("fem: packs come to rows and back with any count and stride") {
    check_lanes<double, 5>();
    check_lanes<Pack<double>, 1>(), check_lanes<Pack<double>, 2>(), check_lanes<Pack<double>, 9>();
    check_lanes<Pack<double, 8>, 7>(), check_lanes<Pack<double, 16>, 24>();
    check_lanes<Pack<float>, 3>(), check_lanes<Pack<float>, 9>(), check_lanes<Pack<float, 16>, 20>();
    check_lanes<Pack<double, 4, 1>, 6>();  // numbers in place of registers
  }

  TEST_CASE("fem: triples of nodes come to lanes where registers are wide") {
    check_triples<Pack<double>>(), check_triples<Pack<double, 8>>(), check_triples<Pack<double, 16>>();
#if defined(__AVX__) && !defined(TUNICA_PLAIN_PACKS)
    static_assert(fem::has_wide_registers<Pack<double>>);
#endif
    static_assert(!fem::has_wide_registers<double> && !fem::has_wide_registers<Pack<float>>);
  }
}
