// SPDX-License-Identifier: MIT
#include "tunica/image/phantom.hpp"

#include "tunica/image/components.hpp"
#include "tunica/image/phantom_labels.hpp"
#include "tunica/image/phantom_truth.hpp"
#include "tunica/image/sampling.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

using namespace tunica;
using namespace tunica::image;

TEST_SUITE("unit") {
  TEST_CASE("image: gradients of the phantom agree with differences") {
    const Phantom p;
    double worst_level = 0, worst_value = 0;
    const double h = 1e-4;
    for (std::uint64_t k = 0; k < 2000; ++k) {
      const auto u = [&](std::uint64_t c) {
        return static_cast<double>(splitmix64(3 * k + c) >> 11) * 0x1p-53;
      };
      const Vec3 x(196 + 57 * u(0), 87 + 100 * u(1), 1 + 48 * u(2));
      const LevelJet l = p.level(x);
      const Vec3 g = p.gradient(x);
      for (int a = 0; a < 3; ++a) {
        const Vec3 d = h * Vec3::Unit(a);
        worst_level = std::max(
            worst_level, std::abs((p.level(x + d).value - p.level(x - d).value) / (2 * h) - l.gradient[a]) /
                             (1 + l.gradient.norm()));
        worst_value = std::max(worst_value,
                               std::abs((p.value(x + d) - p.value(x - d)) / (2 * h) - g[a]) / (1 + g.norm()));
      }
    }
    MESSAGE("gradient against central differences: level ", worst_level, ", intensity ", worst_value);
    CHECK(worst_level < 1e-6);
    CHECK(worst_value < 1e-5);
  }

  TEST_CASE("image: the phantom has the measured radii at its ports") {
    const Phantom p;
    for (const Port& port : Phantom::ports()) {
      CHECK(port.normal.norm() == doctest::Approx(1).epsilon(1e-14));
      const Vec3 e1 = port.normal.cross(Vec3::UnitZ()).normalized(), e2 = port.normal.cross(e1);
      for (int r = 0; r < 32; ++r) {
        const double a = 0.19634954084936207 * r;
        const Vec3 on = port.point + port.radius * (std::cos(a) * e1 + std::sin(a) * e2);
        CHECK(std::abs(p.level(on).value) < 2e-3);  // the axes are straight there but for exp(-10)
        CHECK(std::abs(p.value(on) - Phantom::surface) < 1.1);
      }
    }
    CHECK((Phantom::ports()[1].point - Vec3(207.554, 94.976, 33.243)).norm() < 0.3);  // as measured
    CHECK((Phantom::ports()[2].point - Vec3(237.629, 95.025, 31.872)).norm() < 0.3);
  }

  TEST_CASE("image: distances to the surface of the phantom are those of its normals") {
    const Phantom p;
    double worst = 0;
    int tried = 0;
    for (std::uint64_t k = 0; k < 4000; ++k) {
      const auto u = [&](std::uint64_t c) {
        return static_cast<double>(splitmix64(4 * k + c) >> 11) * 0x1p-53;
      };
      const Vec3 x(200 + 45 * u(0), 95 + 70 * u(1), 10 + 30 * u(2));
      if (std::abs(p.level(x).value) > 0.6) continue;
      const SurfacePoint s = nearest_on_surface(p, x);
      const Vec3 n = p.level(s.point).gradient.normalized();
      ++tried;
      worst = std::max(worst, std::abs(p.level(s.point).value));
      worst = std::max(worst, (x - s.point - s.distance * n).norm());  // x lies on the normal of its foot
    }
    MESSAGE(tried, " points, worst residual of the foot ", worst, " mm");
    CHECK(tried > 100);
    CHECK(worst < 1e-9);
  }

  TEST_CASE("image: volume of the phantom converges and agrees with counting") {
    const Phantom p;
    const double coarse = lumen_volume(p, 2), fine = lumen_volume(p, 4);
    const auto ports = Phantom::ports();
    double counted = 0;
    const double h = 0.35;
    for (double z = 8; z < 46; z += h)
      for (double y = 88; y < 172; y += h)
        for (double x = 198; x < 246; x += h) {
          const Vec3 at(x, y, z);
          bool behind = true;
          for (const Port& port : ports) behind = behind && port.normal.dot(at - port.point) < 0;
          if (behind && p.level(at).value <= 0) counted += h * h * h;
        }
    MESSAGE("volume ", fine, " mm3, with half the points ", coarse, ", counted at 0.35 mm ", counted);
    CHECK(std::abs(coarse - fine) < 1e-5 * fine);
    CHECK(std::abs(counted - fine) < 1e-3 * fine);
  }

  TEST_CASE("image: the sampled phantom is one vessel with one inlet and two outlets") {
    const auto image = sample<short>(Phantom{}, {});
    const Band range = data_range(image);
    CHECK(range.lowest >= 200);
    CHECK(range.highest <= 2400);
    CHECK(range.highest > 2300);
    const Region r = segment(image, {.iso = Phantom::surface});
    MESSAGE("range ", range.lowest, "..", range.highest, ", voxels inside ", r.voxels);
    CHECK(r.voxels == at_or_above(image, Phantom::surface).count());  // one component
    CHECK(r.touches == std::array<bool, 6>{false, false, true, true, false, false});
    const auto fine = sample(Phantom{}, Sampling{}.refined(2));
    CHECK(fine.size(1) == 235);
    CHECK(fine.values[fine.offset({20, 40, 12})] ==
          static_cast<float>(Phantom{}.value(fine.position({20, 40, 12}))));
  }

  TEST_CASE("image: noise is seeded and has the variance asked for and blur keeps the mean") {
    struct Flat {
      double value(const Vec3&) const { return 100; }
    };
    Sampling s{.size = {40, 40, 40}, .noise = 5, .seed = 7};
    const auto a = sample<double>(Flat{}, s), b = sample<double>(Flat{}, s);
    CHECK(a.values == b.values);
    s.seed = 8;
    CHECK(sample<double>(Flat{}, s).values != a.values);
    double mean = 0, variance = 0;
    for (const double v : a.values) mean += v / 64000;
    for (const double v : a.values) variance += (v - mean) * (v - mean) / 64000;
    CHECK(mean == doctest::Approx(100).epsilon(1e-3));
    CHECK(std::sqrt(variance) == doctest::Approx(5).epsilon(2e-2));
    CHECK(splitmix64(0) == 0xe220a8397b1dcdafu);  // first number of the generator from seed 0
    s.noise = 0, s.blur = 2;
    for (const double v : sample<double>(Flat{}, s).values) REQUIRE(std::abs(v - 100) < 1e-12);
    struct Line {
      double value(const Vec3& x) const { return x[1]; }
    };
    const auto line = sample<double>(Line{}, s);
    CHECK(std::abs(line({20, 20, 20}) - line.position({20, 20, 20})[1]) < 1e-12);  // a line is kept
  }

  TEST_CASE("image: labels of the phantom have its volumes and a wall of the thickness") {
    const PhantomLabels coarse{.spacing = 1, .thickness = 2};
    const auto labels = coarse();
    std::array<double, 4> volume{};
    for (const auto v : labels.values) volume.at(static_cast<std::size_t>(v)) += 1;  // [mm3]
    // lumen and thrombus together are the phantom's inside
    double inside = 0;
    const Phantom phantom;
    for (const double z : labels.axes[2])
      for (const double y : labels.axes[1])
        for (const double x : labels.axes[0]) inside += phantom.level({x, y, z}).value <= 0;
    CHECK(volume[1] + volume[2] == inside);
    CHECK(volume[2] > 0.05 * inside);
    CHECK(volume[3] > 0.3 * inside);
    const Vec3 on = phantom.axis(0, 100).centre;
    CHECK(coarse.label(on) == PhantomLabel::lumen);
    CHECK(coarse.label(Vec3(200, 95, 5)) == PhantomLabel::outside);
  }
}
