// SPDX-License-Identifier: MIT
// As many points side by side as the machine's registers hold: a pack is one coordinate of each of them. On a
// machine without such registers a pack is one number.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace tunica::meshing::detail {

/// A place and one value that goes with it, as it lies in memory.
struct alignas(32) Place {
  double x = 0, y = 0, z = 0, w = 0;
};

/// Place number `slot` is `lane_stride * slot` doubles behind the first.
inline constexpr std::uint32_t lane_stride = 4;

/// Packs of Width numbers: +, -, * and / are those of V.
template <int Width>
struct Lanes;

template <int Width>
struct Places {
  typename Lanes<Width>::V x, y, z, w;
};

template <>
struct Lanes<1> {
  using V = double;

  [[nodiscard]] static V all(double x) { return x; }
  [[nodiscard]] static V root(V x) { return std::sqrt(x); }
  [[nodiscard]] static V larger(V a, V b) { return a > b ? a : b; }
  [[nodiscard]] static V smaller(V a, V b) { return a < b ? a : b; }
  [[nodiscard]] static double at(V x, int) { return x; }
  [[nodiscard]] static bool any_not_above(V x, double least) { return !(x > least); }
  [[nodiscard]] static Places<1> at(const Place* base, const std::uint32_t* offset);
  [[nodiscard]] static Places<1> next(const Place* p);
  static void put(Place* to, const Places<1>& p);
};

inline Places<1> Lanes<1>::next(const Place* p) {
  return {p->x, p->y, p->z, p->w};
}
inline Places<1> Lanes<1>::at(const Place* base, const std::uint32_t* offset) {
  return next(base + offset[0] / lane_stride);
}
inline void Lanes<1>::put(Place* to, const Places<1>& p) {
  *to = {p.x, p.y, p.z, p.w};
}

#if defined(__SSE2__)
template <>
struct Lanes<2> {
  using V = __m128d;

  [[nodiscard]] static V all(double x) { return _mm_set1_pd(x); }
  [[nodiscard]] static V root(V x) { return _mm_sqrt_pd(x); }
  [[nodiscard]] static V larger(V a, V b) { return _mm_max_pd(a, b); }
  [[nodiscard]] static V smaller(V a, V b) { return _mm_min_pd(a, b); }
  [[nodiscard]] static double at(V x, int lane) { return x[lane]; }
  [[nodiscard]] static bool any_not_above(V x, double least) {
    return _mm_movemask_pd(_mm_cmpngt_pd(x, all(least))) != 0;
  }
  [[nodiscard]] static Places<2> from(const double* p, const double* q);
  [[nodiscard]] static Places<2> at(const Place* base, const std::uint32_t* offset);
  [[nodiscard]] static Places<2> next(const Place* p);
  static void put(Place* to, const Places<2>& p);
};

inline Places<2> Lanes<2>::from(const double* p, const double* q) {
  const V a = _mm_load_pd(p), b = _mm_load_pd(q), c = _mm_load_pd(p + 2), d = _mm_load_pd(q + 2);
  return {_mm_unpacklo_pd(a, b), _mm_unpackhi_pd(a, b), _mm_unpacklo_pd(c, d), _mm_unpackhi_pd(c, d)};
}
inline Places<2> Lanes<2>::at(const Place* base, const std::uint32_t* offset) {
  return from(&base->x + offset[0], &base->x + offset[1]);
}
inline Places<2> Lanes<2>::next(const Place* p) {
  return from(&p[0].x, &p[1].x);
}
inline void Lanes<2>::put(Place* to, const Places<2>& p) {
  _mm_store_pd(&to[0].x, _mm_unpacklo_pd(p.x, p.y)), _mm_store_pd(&to[0].z, _mm_unpacklo_pd(p.z, p.w));
  _mm_store_pd(&to[1].x, _mm_unpackhi_pd(p.x, p.y)), _mm_store_pd(&to[1].z, _mm_unpackhi_pd(p.z, p.w));
}
#endif

#if defined(__AVX__)
template <>
struct Lanes<4> {
  using V = __m256d;

  [[nodiscard]] static V all(double x) { return _mm256_set1_pd(x); }
  [[nodiscard]] static V root(V x) { return _mm256_sqrt_pd(x); }
  [[nodiscard]] static V larger(V a, V b) { return _mm256_max_pd(a, b); }
  [[nodiscard]] static V smaller(V a, V b) { return _mm256_min_pd(a, b); }
  [[nodiscard]] static double at(V x, int lane) { return x[lane]; }
  [[nodiscard]] static bool any_not_above(V x, double least) {
    return _mm256_movemask_pd(_mm256_cmp_pd(x, all(least), _CMP_NGT_UQ)) != 0;
  }
  [[nodiscard]] static V halves(const double* low, const double* high) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(low)), _mm_load_pd(high), 1);
  }
  [[nodiscard]] static Places<4> from(const double* p, const double* q, const double* r, const double* s);
  [[nodiscard]] static Places<4> at(const Place* base, const std::uint32_t* offset);
  [[nodiscard]] static Places<4> next(const Place* p);
  static void put(Place* to, const Places<4>& p);
};

inline Places<4> Lanes<4>::from(const double* p, const double* q, const double* r, const double* s) {
  const V a = halves(p, r), b = halves(q, s), c = halves(p + 2, r + 2), d = halves(q + 2, s + 2);
  return {_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b), _mm256_unpacklo_pd(c, d),
          _mm256_unpackhi_pd(c, d)};
}
inline Places<4> Lanes<4>::at(const Place* base, const std::uint32_t* offset) {
  const double* p = &base->x;
  return from(p + offset[0], p + offset[1], p + offset[2], p + offset[3]);
}
inline Places<4> Lanes<4>::next(const Place* p) {
  return from(&p[0].x, &p[1].x, &p[2].x, &p[3].x);
}
inline void Lanes<4>::put(Place* to, const Places<4>& p) {
  const V a = _mm256_unpacklo_pd(p.x, p.y), b = _mm256_unpackhi_pd(p.x, p.y),
          c = _mm256_unpacklo_pd(p.z, p.w), d = _mm256_unpackhi_pd(p.z, p.w);
  _mm256_store_pd(&to[0].x, _mm256_permute2f128_pd(a, c, 0x20));
  _mm256_store_pd(&to[1].x, _mm256_permute2f128_pd(b, d, 0x20));
  _mm256_store_pd(&to[2].x, _mm256_permute2f128_pd(a, c, 0x31));
  _mm256_store_pd(&to[3].x, _mm256_permute2f128_pd(b, d, 0x31));
}
inline constexpr int widest = 4;
#elif defined(__SSE2__)
inline constexpr int widest = 2;
#else
inline constexpr int widest = 1;
#endif

}  // namespace tunica::meshing::detail
