#include "container/grid_record.h"

#include <cstring>
#include <limits>
#include <string>

#include "bspc/error.h"

namespace bspc::container {

namespace {

constexpr unsigned kTypeMask = 15;
constexpr unsigned kFormShift = 4;
constexpr unsigned kSharedStep = 1U << 6;
constexpr unsigned kHasBase = 1U << 7;

// How a double is stored: kZero, the 1 … 8 leading bytes of its bit pattern, or as a float.
constexpr unsigned kZero = 0;
constexpr unsigned kAsFloat = 9;

std::uint64_t bitsOf(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

double fromBits(std::uint64_t bits) {
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

unsigned doubleCode(double value) {
  const std::uint64_t bits = bitsOf(value);
  if (bits == 0) return kZero;
  unsigned bytes = 8;
  while (((bits >> (8 * (8 - bytes))) & 255) == 0) --bytes;
  const bool inRange =
      value >= -std::numeric_limits<float>::max() && value <= std::numeric_limits<float>::max();
  const bool isFloat = inRange && bitsOf(double{static_cast<float>(value)}) == bits;
  return bytes > 4 && isFloat ? kAsFloat : bytes;
}

void writeDouble(ByteWriter& out, double value, unsigned code) {
  if (code == kAsFloat) {
    const auto narrow = static_cast<float>(value);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &narrow, sizeof bits);
    out.unsignedLittle(bits, 4);
  } else if (code != kZero) {
    out.unsignedLittle(bitsOf(value) >> (8 * (8 - code)), code);
  }
}

double readDouble(ByteReader& in, unsigned code) {
  if (code == kZero) return 0;
  if (code == kAsFloat) {
    const auto bits = static_cast<std::uint32_t>(in.unsignedLittle(4));
    float narrow = 0;
    std::memcpy(&narrow, &bits, sizeof narrow);
    return double{narrow};
  }
  if (code > kAsFloat) in.fail("a number of the grid has an unknown encoding");
  return fromBits(in.unsignedLittle(code) << (8 * (8 - code)));
}

/// A positive integer as odd part and power of two.
struct Odd {
  std::uint64_t odd = 1;
  int exponent = 0;
};

Odd oddPart(std::int64_t value) {
  Odd result{static_cast<std::uint64_t>(value), 0};
  while (result.odd % 2 == 0) {
    result.odd /= 2;
    ++result.exponent;
  }
  return result;
}

void writeRatio(ByteWriter& out, const Grid::Axis& axis) {
  const Odd p = oddPart(axis.numerator);
  const Odd q = oddPart(axis.denominator);
  out.varint(p.odd);
  out.varint(q.odd);
  out.signedVarint(p.exponent - q.exponent);
}

void readRatio(ByteReader& in, Grid::Axis& axis) {
  const std::uint64_t p = in.varint();
  const std::uint64_t q = in.varint();
  const std::int64_t exponent = in.signedVarint();
  const auto scaled = [&in](std::uint64_t odd, std::int64_t shift) {
    constexpr std::uint64_t kTop = std::uint64_t{1} << 62;
    if (odd % 2 == 0 || odd > kTop || shift > 62 || odd > (kTop >> shift)) {
      in.fail("a step of the grid is out of range");
    }
    return static_cast<std::int64_t>(odd << shift);
  };
  axis.numerator = scaled(p, exponent > 0 ? exponent : 0);
  axis.denominator = scaled(q, exponent < 0 ? (exponent < -62 ? 63 : -exponent) : 0);
}

bool equalSteps(const Grid& grid) {
  for (int k = 1; k < 3; ++k) {
    const Grid::Axis& a = grid.axes[0];
    const Grid::Axis& b = grid.axes[static_cast<std::size_t>(k)];
    const bool equal = grid.form == Grid::Form::Rational
                           ? a.numerator == b.numerator && a.denominator == b.denominator
                           : bitsOf(a.step) == bitsOf(b.step);
    if (!equal) return false;
  }
  return true;
}

void writeAffine(ByteWriter& out, const Grid& grid, std::size_t steps) {
  std::vector<double> values;
  for (const Grid::Axis& axis : grid.axes) values.push_back(axis.origin);
  for (std::size_t k = 0; k < steps; ++k) values.push_back(grid.axes[k].step);
  for (std::size_t i = 0; i < values.size(); i += 2) {
    out.u8(doubleCode(values[i]) | (doubleCode(values[i + 1]) << 4));
  }
  for (const double value : values) writeDouble(out, value, doubleCode(value));
}

void readAffine(ByteReader& in, Grid& grid, std::size_t steps) {
  std::vector<unsigned> codes;
  for (std::size_t i = 0; i < 3 + steps; i += 2) {
    const unsigned pair = in.u8();
    codes.push_back(pair & 15);
    codes.push_back(pair >> 4);
  }
  for (std::size_t k = 0; k < 3; ++k) grid.axes[k].origin = readDouble(in, codes[k]);
  for (std::size_t k = 0; k < steps; ++k) grid.axes[k].step = readDouble(in, codes[3 + k]);
}

}  // namespace

void writeGrid(ByteWriter& out, const Grid& grid) {
  const bool shared = grid.form != Grid::Form::FloatBits && equalSteps(grid);
  bool hasBase = false;
  for (const Grid::Axis& axis : grid.axes) hasBase = hasBase || axis.base != 0;
  out.u8(static_cast<unsigned>(grid.scalarType) | (static_cast<unsigned>(grid.form) << kFormShift) |
         (shared ? kSharedStep : 0) | (hasBase ? kHasBase : 0));
  if (hasBase) {
    for (const Grid::Axis& axis : grid.axes) out.signedVarint(axis.base);
  }
  const std::size_t steps = shared ? 1 : 3;
  if (grid.form == Grid::Form::FloatBits) return;
  if (grid.form == Grid::Form::Affine) {
    writeAffine(out, grid, steps);
  } else {
    for (std::size_t k = 0; k < steps; ++k) writeRatio(out, grid.axes[k]);
  }
}

Grid readGrid(ByteReader& in) {
  const unsigned kind = in.u8();
  const unsigned type = kind & kTypeMask;
  const unsigned form = (kind >> kFormShift) & 3;
  if (type >= kPositionTypeCount || form > static_cast<unsigned>(Grid::Form::FloatBits)) {
    throw Error(ErrorCode::Unsupported, "the grid has scalar type " + std::to_string(type) +
                                            " and form " + std::to_string(form) +
                                            ", which this version does not know; use a newer one");
  }
  Grid grid;
  grid.scalarType = static_cast<ScalarType>(type);
  grid.form = static_cast<Grid::Form>(form);
  if ((kind & kHasBase) != 0) {
    for (Grid::Axis& axis : grid.axes) axis.base = in.signedVarint();
  }
  const std::size_t steps = (kind & kSharedStep) != 0 ? 1 : 3;
  if (grid.form == Grid::Form::FloatBits) {
    if ((kind & kSharedStep) != 0) in.fail("a grid of float bits with a step");
  } else if (grid.form == Grid::Form::Affine) {
    readAffine(in, grid, steps);
  } else {
    for (std::size_t k = 0; k < steps; ++k) readRatio(in, grid.axes[k]);
  }
  for (std::size_t k = steps; k < 3; ++k) {
    grid.axes[k].numerator = grid.axes[0].numerator;
    grid.axes[k].denominator = grid.axes[0].denominator;
    grid.axes[k].step = grid.axes[0].step;
  }
  try {
    grid.validate();
  } catch (const Error& error) {
    in.fail(error.what());
  }
  return grid;
}

}  // namespace bspc::container
