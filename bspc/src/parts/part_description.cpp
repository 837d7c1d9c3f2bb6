#include "parts/part_description.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "bspc/error.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"
#include "container/grid_record.h"
#include "grid/float_grid.h"
#include "grid/grid_fit.h"
#include "grid/ratio.h"
#include "grid/step_choice.h"

namespace bspc::parts {

namespace {

constexpr unsigned kDoubleBytes = 8;

std::uint64_t bitsOf(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

double doubleOf(std::uint64_t bits) {
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

lattice::Ratio stepOf(const Grid::Axis& axis) {
  return lattice::makeRatio(static_cast<std::uint64_t>(axis.numerator),
                            static_cast<std::uint64_t>(axis.denominator));
}

}  // namespace

Bytes PartDescription::write() const {
  container::ByteWriter out;
  out.varint(points);
  if (points == 0) return out.take();
  out.u8(static_cast<unsigned>(type));
  for (const lattice::AxisRange& range : ranges) {
    out.unsignedLittle(bitsOf(range.min), kDoubleBytes);
    out.unsignedLittle(bitsOf(range.max), kDoubleBytes);
  }
  out.u8(lattice ? 1 : 0);
  if (lattice) container::writeGrid(out, *lattice);
  return out.take();
}

PartDescription PartDescription::read(ByteView message) {
  container::ByteReader in(message, "the description of a part", container::ByteReader::kNoOffset);
  PartDescription part;
  part.points = in.varint();
  if (part.points == 0) return part;
  const unsigned type = in.u8();
  if (type >= kPositionTypeCount)
    in.fail("positions have the unknown type " + std::to_string(type));
  part.type = static_cast<ScalarType>(type);
  for (lattice::AxisRange& range : part.ranges) {
    range.min = doubleOf(in.unsignedLittle(kDoubleBytes));
    range.max = doubleOf(in.unsignedLittle(kDoubleBytes));
    if (!(range.min <= range.max)) in.fail("a range of coordinates ends before it begins");
  }
  if (in.u8() != 0) part.lattice = container::readGrid(in);
  in.expectEnd();
  return part;
}

std::optional<Grid> commonLattice(const Grid& a, const Grid& b) {
  if (a.sameLattice(b)) return a;
  if (a.form != Grid::Form::Rational || b.form != Grid::Form::Rational) return std::nullopt;
  Grid common = a;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto step = lattice::commonDivisor(stepOf(a.axes[k]), stepOf(b.axes[k]));
    if (!step || !lattice::setRational(common.axes[k], *step)) return std::nullopt;
  }
  return common;
}

namespace {

/// What is known of the points of all parts together.
PartDescription together(const std::vector<PartDescription>& parts) {
  PartDescription all;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PartDescription& part = parts[i];
    if (part.points == 0) continue;
    if (all.points == 0) {
      all = part;
      continue;
    }
    if (part.type != all.type) {
      throw Error(ErrorCode::InvalidArgument,
                  "part " + std::to_string(i) + " has positions of type " + scalarName(part.type) +
                      " and others have " + scalarName(all.type) +
                      "; give all parts positions of one type");
    }
    all.points += part.points;
    for (std::size_t k = 0; k < 3; ++k) {
      all.ranges[k].min = std::min(all.ranges[k].min, part.ranges[k].min);
      all.ranges[k].max = std::max(all.ranges[k].max, part.ranges[k].max);
    }
    if (all.lattice) {
      all.lattice = part.lattice ? commonLattice(*all.lattice, *part.lattice) : std::nullopt;
    }
  }
  return all;
}

std::optional<Grid> placedLattice(const PartDescription& all) {
  if (!all.lattice) return std::nullopt;
  Grid grid = *all.lattice;
  grid.scalarType = all.type;
  try {
    lattice::placeBases(grid, all.ranges);
  } catch (const Error&) {
    return std::nullopt;  // fine enough for each part, too fine for all of them together
  }
  return grid;
}

Grid unplacedGrid(const PartDescription& all, const GridRequest& request) {
  const bool point = std::all_of(all.ranges.begin(), all.ranges.end(),
                                 [](const lattice::AxisRange& range) { return range.constant(); });
  if (request.kind == GridRequest::Kind::Reuse) {
    Grid grid = request.reuse;
    grid.scalarType = all.type;
    return grid;
  }
  if (request.kind == GridRequest::Kind::Precision) {
    return lattice::gridWithPrecision(ScalarType::Float64, all.ranges, request.precision);
  }
  if (request.kind == GridRequest::Kind::Bits && !point) {
    return lattice::gridWithBits(all.type, all.ranges, request.bits);
  }
  if (request.kind == GridRequest::Kind::ExactFloats && isFloatingPoint(all.type)) {
    return lattice::floatGrid(all.type);
  }
  if (isFloatingPoint(all.type)) return lattice::defaultGrid(all.type, all.ranges);
  Grid wholeNumbers;
  wholeNumbers.scalarType = all.type;
  return wholeNumbers;
}

}  // namespace

Grid agreedGrid(const std::vector<PartDescription>& parts, const GridRequest& request) {
  const PartDescription all = together(parts);
  if (all.points == 0) {
    return lattice::emptyGrid(parts.empty() ? ScalarType::Float32 : parts.front().type, request);
  }
  if (const auto grid = placedLattice(all)) return *grid;
  Grid grid = unplacedGrid(all, request);
  lattice::placeBases(grid, all.ranges);
  return grid;
}

}  // namespace bspc::parts
