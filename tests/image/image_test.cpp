// SPDX-License-Identifier: MIT
#include "tunica/image/image.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace {

using namespace tunica;
using image::Image;

/// n + 1 coordinates from 0 to 1; uneven: steps that alternate 2 : 1.
std::vector<double> axis(int n, bool even) {
  std::vector<double> x{0};
  for (int i = 0; i < n; ++i) x.push_back(x.back() + (even || i % 2 == 0 ? 2.0 : 1.0));
  for (double& v : x) v /= x.back();
  return x;
}

template <class F>
Image<double> sample(int n, F&& f, bool even = false) {
  Image<double> image{{axis(n, even), axis(n + 1, even), axis(n + 2, even)}, {}};
  for (const double z : image.axes[2])
    for (const double y : image.axes[1])
      for (const double x : image.axes[0]) image.values.push_back(f(Vec3(x, y, z)));
  return image;
}

Vec3 point(std::mt19937& random) {
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  return {uniform(), uniform(), uniform()};
}

double wave(const Vec3& x) {
  return std::sin(2 * x[0]) * std::cos(3 * x[1]) * std::exp(x[2]);
}
Vec3 wave_gradient(const Vec3& x) {
  return {2 * std::cos(2 * x[0]) * std::cos(3 * x[1]) * std::exp(x[2]),
          -3 * std::sin(2 * x[0]) * std::sin(3 * x[1]) * std::exp(x[2]), wave(x)};
}

struct Errors {
  double value = 0, gradient = 0;
};

Errors errors(int n) {
  const auto image = sample(n, wave);
  std::mt19937 random(3);
  Errors e;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 x = point(random);
    e.value = std::max(e.value, std::abs(image.value(x) - wave(x)));
    e.gradient = std::max(e.gradient, (image.gradient(x) - wave_gradient(x)).norm());
  }
  return e;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("image: samples are stored x fastest and found by voxel") {
    const auto image = sample(3, [](const Vec3& x) { return x[0] + 10 * x[1] + 100 * x[2]; });
    CHECK(image.size(0) == 4);
    CHECK(image.size(1) == 5);
    CHECK(image.size(2) == 6);
    for (const image::Voxel v : {image::Voxel{0, 0, 0}, {3, 0, 0}, {1, 2, 3}, {3, 4, 5}}) {
      const Vec3 x = image.position(v);
      CHECK(image(v) == x[0] + 10 * x[1] + 100 * x[2]);
      CHECK(image.value(x) == doctest::Approx(image(v)).epsilon(1e-15));
      CHECK(image.contains(v));
    }
    CHECK(!image.contains({4, 0, 0}));
    CHECK(!image.contains({0, -1, 0}));
  }

  TEST_CASE("image: a trilinear field on an uneven grid is reproduced with its gradient") {
    const auto field = [](const Vec3& x) { return 1 + 2 * x[0] - 3 * x[1] + 5 * x[2]; };
    const auto image = sample(5, field);
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
      const Vec3 x = point(random);
      CHECK(std::abs(image.value(x) - field(x)) < 1e-13);
      CHECK((image.gradient(x) - Vec3(2, -3, 5)).norm() < 1e-11);
    }
  }

  TEST_CASE("image: outside the grid the nearest point of it answers") {
    const auto image = sample(4, wave);
    CHECK(image.value({-3, 0.4, 0.5}) == image.value({0, 0.4, 0.5}));
    CHECK(image.value({0.3, 7, 9}) == image.value({0.3, 1, 1}));
  }

  TEST_CASE("image: interpolation wants two samples along each axis") {
    const Image<double> slice{{std::vector<double>{0, 1}, {0, 1}, {0}}, {1, 2, 3, 4}};
    CHECK_THROWS(static_cast<void>(slice.value({0.5, 0.5, 0})));
  }
}

TEST_SUITE("convergence") {
  TEST_CASE("image: the trilinear value is of second order and its gradient of first on an uneven grid") {
    const Errors coarse = errors(10), fine = errors(40);
    const double value_order = std::log(coarse.value / fine.value) / std::log(4.0);
    const double gradient_order = std::log(coarse.gradient / fine.gradient) / std::log(4.0);
    MESSAGE("trilinear value: error ", coarse.value, " -> ", fine.value, ", order ", value_order);
    MESSAGE("trilinear gradient: error ", coarse.gradient, " -> ", fine.gradient, ", order ", gradient_order);
    CHECK(value_order > 1.8);
    CHECK(gradient_order > 0.8);
  }
}
