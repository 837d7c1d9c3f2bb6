#include "cell_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace bspc::paper {

namespace {

using Colour = std::array<std::uint8_t, 3>;

/// Neighbouring cells, which have neighbouring numbers, get distant hues; brightness varies too.
Colour colourOf(std::uint64_t cell) {
  constexpr double kGolden = 0.61803398874989485;
  const double hue = 6 * std::fmod(static_cast<double>(cell) * kGolden, 1.0);
  const double value = 0.65 + 0.35 * std::fmod(static_cast<double>(cell) * 0.7548776662466927, 1.0);
  Colour colour;
  for (unsigned k = 0; k < 3; ++k) {
    const double turned = std::fmod(hue + 4.0 - 2.0 * k + 6.0, 6.0);
    const double part = std::clamp(std::abs(turned - 3.0) - 1.0, 0.0, 1.0);
    colour[k] = static_cast<std::uint8_t>(255 * value * (0.15 + 0.85 * part));
  }
  return colour;
}

template <class T>
void put(std::ofstream& out, T value) {
  std::array<char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), &value, sizeof(T));
  out.write(bytes.data(), bytes.size());
}

}  // namespace

void writeColoured(const std::string& path, const std::vector<ColouredCells>& sets) {
  std::ofstream out(path, std::ios::binary);
  std::size_t points = 0;
  for (const ColouredCells& set : sets) points += set.model->points.size();
  out << "ply\nformat binary_little_endian 1.0\ncomment points coloured by cell\nelement vertex "
      << points
      << "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
         "property uchar green\nproperty uchar blue\nproperty uint CellId\nend_header\n";
  float offset = 0;
  for (const ColouredCells& set : sets) {
    std::uint32_t widest = 0;
    for (std::size_t i = 0; i < set.model->points.size(); ++i) {
      const GridPoint& p = set.restored ? set.coding->restored[i] : set.model->points[i];
      widest = std::max(widest, p[0]);
      put(out, static_cast<float>(p[0]) + offset);
      put(out, static_cast<float>(p[1]));
      put(out, static_cast<float>(p[2]));
      for (const std::uint8_t c : colourOf(set.coding->cell[i])) put(out, c);
      put(out, static_cast<std::uint32_t>(set.coding->cell[i]));
    }
    offset += 1.1F * static_cast<float>(widest);
  }
  out.close();
  if (!out) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace bspc::paper
