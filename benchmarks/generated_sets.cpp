#include "generated_sets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <utility>

namespace bspc::bench {

namespace {

constexpr double kPi = 3.14159265358979323846;

class Random {
 public:
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// About a normal distribution of deviation 1.
  double bell() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }
  std::uint64_t below(std::uint64_t n) { return engine_() % n; }

 private:
  std::mt19937_64 engine_{1};
};

/// The nearest whole number that is at least 1.
std::uint64_t countOf(double length) {
  return static_cast<std::uint64_t>(std::max(1.0, std::round(length)));
}

void append(Coordinates& xyz, double x, double y, double z) {
  for (const double c : {x, y, z}) xyz.push_back(static_cast<std::int32_t>(std::lround(c)));
}

/// Moves the lowest coordinates to 0.
Coordinates fromZero(Coordinates xyz) {
  for (std::size_t k = 0; k < 3; ++k) {
    std::int32_t least = INT32_MAX;
    for (std::size_t i = k; i < xyz.size(); i += 3) least = std::min(least, xyz[i]);
    for (std::size_t i = k; i < xyz.size(); i += 3) xyz[i] -= least;
  }
  return xyz;
}

/// Rows of latitude, neighbours 16 steps apart, noise of two steps along the ray.
Coordinates surface(std::uint64_t count) {
  constexpr double kSpacing = 16;
  Random random;
  Coordinates xyz;
  const double radius = kSpacing * std::sqrt(static_cast<double>(count) / (4 * kPi));
  const auto rows = countOf(kPi * radius / kSpacing);
  for (std::uint64_t row = 0; row < rows; ++row) {
    const double theta = kPi * (static_cast<double>(row) + 0.5) / static_cast<double>(rows);
    const double ring = std::sin(theta);
    const auto shots = countOf(2 * kPi * radius * ring / kSpacing);
    for (std::uint64_t shot = 0; shot < shots; ++shot) {
      const double phi = 2 * kPi * (static_cast<double>(shot) + 0.3 * random.uniform()) /
                         static_cast<double>(shots);
      const double bumps = 1 + 0.08 * std::sin(5 * phi) * ring + 0.01 * std::sin(40 * theta);
      const double r = radius * bumps + 2 * random.bell();
      append(xyz, r * ring * std::cos(phi), r * ring * std::sin(phi), r * std::cos(theta));
    }
  }
  return xyz;
}

/// Zigzag lines over hills, half a metre between shots, trees on a part of it.
Coordinates lines(std::uint64_t count) {
  constexpr double kShot = 50;  // centimetres
  Random random;
  Coordinates xyz;
  const auto shots = countOf(std::sqrt(static_cast<double>(count)));
  for (std::uint64_t line = 0; xyz.size() < 3 * count; ++line) {
    for (std::uint64_t shot = 0; shot < shots && xyz.size() < 3 * count; ++shot) {
      if (random.below(50) == 0) continue;  // no echo
      const std::uint64_t across = line % 2 == 0 ? shot : shots - 1 - shot;
      const double x = kShot * static_cast<double>(across) + 2 * random.bell();
      const double y = kShot * (static_cast<double>(line) +
                                static_cast<double>(shot) / static_cast<double>(shots)) +
                       3 * random.bell();
      const double ground = 900 * std::sin(x / 3100) * std::cos(y / 2300) +
                            250 * std::sin(x / 700 + y / 1100) + 3 * random.bell();
      const bool isWood = std::sin(x / 9000) + std::cos(y / 7000) > 0.6;
      const double canopy = isWood && random.below(3) == 0 ? 300 + 800 * random.uniform() : 0;
      append(xyz, x, y, ground + canopy);
    }
  }
  return xyz;
}

/// The depth that a camera sees along a ray with z = 1: a wall, a floor and a ball; 0 for a hole.
double depthAlong(double x, double y, Random& random) {
  constexpr std::array<double, 3> kCentre{0.25, 0.1, 2.1};
  constexpr double kRadius = 0.45;
  double depth = 3.2 + 0.25 * x;
  if (y > 0) depth = std::min(depth, 1.1 / y);
  const double a = x * x + y * y + 1;
  const double b = x * kCentre[0] + y * kCentre[1] + kCentre[2];
  const double m = kCentre[0] * kCentre[0] + kCentre[1] * kCentre[1] + kCentre[2] * kCentre[2];
  const double root = b * b - a * (m - kRadius * kRadius);
  if (root > 0) depth = std::min(depth, (b - std::sqrt(root)) / a);
  const bool isEdge = std::abs(root) < 0.01;
  if (random.below(isEdge ? 8 : 60) == 0) return 0;  // holes, mostly along edges
  return depth + 0.002 * depth * random.bell();
}

/// Frames of at most 640 by 480, each of a camera that stands a metre beside the last.
Coordinates depth(std::uint64_t count) {
  constexpr std::uint64_t kFrame = std::uint64_t{640} * 480;
  Random random;
  Coordinates xyz;
  const double pixels = static_cast<double>(std::min(count, kFrame));
  const std::uint64_t width = countOf(std::sqrt(pixels * 4 / 3));
  const std::uint64_t height = countOf(std::sqrt(pixels * 3 / 4));
  const double focal = 0.9 * static_cast<double>(width);
  for (std::uint64_t frame = 0; xyz.size() < 3 * count; ++frame) {
    for (std::uint64_t i = 0; i < width * height && xyz.size() < 3 * count; ++i) {
      const std::uint64_t row = i / width;
      const std::uint64_t column = i % width;
      const double x = (static_cast<double>(column) + 0.5 - static_cast<double>(width) / 2) / focal;
      const double y = (static_cast<double>(row) + 0.5 - static_cast<double>(height) / 2) / focal;
      const double z = std::round(1000 * depthAlong(x, y, random));
      if (z > 0) append(xyz, x * z + 1000 * static_cast<double>(frame), y * z, z);
    }
  }
  return xyz;
}

/// One half of a flange, in millimetres, as a mesher covers it: plate, hub, bolt holes.
void halfFlange(double step, const std::function<void(double, double, double)>& add) {
  constexpr double kLength = 64;
  Random random;
  const auto jitter = [&random, step] { return step * (0.6 * random.uniform() - 0.3); };
  const auto along = [&](double length) { return std::max(1, static_cast<int>(length / step)); };
  for (const double z : {0.0, 4.0}) {
    for (int i = 0; i <= along(kLength); ++i) {
      for (int j = -along(48); j <= along(48); ++j) {
        // Points on the plane of symmetry and on the rim stay on them.
        const bool isInside = i > 0 && i < along(kLength) && std::abs(j) < along(48);
        const double x = i * step + (isInside ? jitter() : 0);
        const double y = j * step + (isInside ? jitter() : 0);
        if (std::hypot(x, y) <= 18 || std::hypot(x - 52, std::abs(y) - 36) <= 4) continue;
        add(x, y, z);
      }
    }
  }
  const auto ring = [&](double cx, double cy, double radius, double from, double to, bool whole) {
    const int steps = along((whole ? 2 : 1) * kPi * radius);
    const int levels = along(to - from);
    for (int i = 0; i <= steps; ++i) {
      for (int k = 0; k <= levels; ++k) {
        const bool isInside = i > 0 && i < steps && k > 0 && k < levels;
        const double turn = isInside ? jitter() / radius : 0;
        const double angle = (whole ? 2 : 1) * kPi * i / steps - kPi / 2 + turn;
        const double z = from + k * step + (isInside ? jitter() : 0);
        add(cx + radius * std::cos(angle), cy + radius * std::sin(angle), z);
      }
    }
  };
  ring(0, 0, 16, 4, 36, false);
  ring(0, 0, 12, 4, 36, false);
  ring(52, 36, 4, 0, 4, true);
  ring(52, -36, 4, 0, 4, true);
}

Coordinates cad(std::uint64_t count) {
  using Point = std::array<std::int32_t, 3>;
  // What half of it has at steps of one millimetre; the number goes with the square of the step.
  std::uint64_t unit = 0;
  halfFlange(1, [&](double, double, double) { ++unit; });
  const double step = std::sqrt(2 * static_cast<double>(unit) / static_cast<double>(count));
  std::vector<Point> points;
  halfFlange(step, [&](double x, double y, double z) {
    Coordinates p;
    append(p, 256 * x, 256 * y, 256 * z);
    points.push_back({p[0], p[1], p[2]});
    points.push_back({-p[0], p[1], p[2]});
  });
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  Coordinates xyz;
  for (const Point& p : points) xyz.insert(xyz.end(), p.begin(), p.end());
  return xyz;
}

Coordinates uniformlyRandom(std::uint64_t count) {
  constexpr double kVolume = 4096;  // of a point
  Random random;
  Coordinates xyz;
  const double side = std::cbrt(kVolume * static_cast<double>(count));
  for (std::uint64_t i = 0; i < count; ++i) {
    const double x = side * random.uniform();
    const double y = side * random.uniform();
    append(xyz, x, y, side * random.uniform());
  }
  return xyz;
}

using Generator = Coordinates (*)(std::uint64_t);

const std::vector<std::pair<std::string, Generator>>& generators() {
  static const std::vector<std::pair<std::string, Generator>> all{{"surface", surface},
                                                                  {"lines", lines},
                                                                  {"depth", depth},
                                                                  {"cad", cad},
                                                                  {"random", uniformlyRandom}};
  return all;
}

}  // namespace

std::vector<std::string> generatedKinds() {
  std::vector<std::string> kinds;
  for (const auto& generator : generators()) kinds.push_back(generator.first);
  return kinds;
}

Coordinates generatedPoints(const std::string& kind, std::uint64_t count) {
  for (const auto& generator : generators()) {
    if (generator.first == kind) return fromZero(generator.second(count));
  }
  throw std::invalid_argument("there is no kind of generated points called " + kind);
}

}  // namespace bspc::bench
