// Writes a model of any size to standard output, to measure with: points of a rolling terrain of
// two by two kilometres, in centimetres, in random order, as binary PLY.
// Run: build/release/bin/generate_scan 10000000 > scan.ply

#include <charconv>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "bspc/point_set.h"
#include "formats/model_writer.h"

namespace {

constexpr std::size_t kPiece = 1U << 16;

float centimetres(double metres) { return static_cast<float>(std::round(metres * 100) / 100); }

void appendPoint(std::mt19937_64& random, std::vector<float>& xyz) {
  const double x = static_cast<double>(random() % 200000) / 100;
  const double y = static_cast<double>(random() % 200000) / 100;
  const double roughness = static_cast<double>(random() % 8) / 100;
  xyz.push_back(centimetres(x));
  xyz.push_back(centimetres(y));
  xyz.push_back(centimetres(20 * std::sin(x / 50) + 15 * std::cos(y / 70) + roughness));
}

void generate(std::uint64_t points) {
  using bspc::formats::Format;
  bspc::formats::ModelLayout layout;
  layout.points = points;
  bspc::formats::ModelWriter writer(std::cout, Format::Ply, layout);
  std::mt19937_64 random(1);
  std::vector<float> xyz;
  for (std::uint64_t written = 0; written < points; written += xyz.size() / 3) {
    xyz.clear();
    while (xyz.size() < 3 * kPiece && written + xyz.size() / 3 < points) appendPoint(random, xyz);
    writer.append(bspc::PointSetView(xyz.data(), xyz.size() / 3));
  }
  writer.finish();
}

}  // namespace

int main(int argc, char** argv) {
  const std::string text = argc == 2 ? argv[1] : "";
  std::uint64_t points = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), points).ptr;
  if (text.empty() || end != text.data() + text.size()) {
    std::cerr << "Usage: generate_scan POINTS > scan.ply\n";
    return 2;
  }
  try {
    generate(points);
  } catch (const std::exception& error) {
    std::cerr << "generate_scan: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
