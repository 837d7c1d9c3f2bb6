#include "grid/points_in_memory.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <type_traits>

#include "grid/axis_map.h"

namespace bspc::lattice {

namespace {

/// Points handled together; with three coordinates each they fill whole vectors.
constexpr std::size_t kTogether = 4;
constexpr std::size_t kBlock = 3 * kTogether;

template <class T>
using Block = std::array<T, kBlock>;

/// The coordinates of kTogether points, wherever they stand.
template <class T>
Block<T> loadBlock(const unsigned char* from, std::size_t stride) {
  Block<T> block;
  if (stride == 3 * sizeof(T)) {
    std::memcpy(block.data(), from, sizeof block);
  } else {
    for (std::size_t j = 0; j < kTogether; ++j) {
      std::memcpy(&block[3 * j], from + j * stride, 3 * sizeof(T));
    }
  }
  return block;
}

/// Calls visit(block) for all points; the last block is filled up with copies of the last point.
template <class T, class Visit>
void forBlocks(const PointSetView& points, Visit visit) {
  const auto* at = static_cast<const unsigned char*>(points.data());
  const std::size_t stride = points.strideBytes();
  std::uint64_t left = points.size();
  for (; left >= kTogether; left -= kTogether, at += kTogether * stride) {
    visit(loadBlock<T>(at, stride));
  }
  if (left == 0) return;
  Block<T> block;
  for (std::size_t j = 0; j < kTogether; ++j) {
    std::memcpy(&block[3 * j], at + std::min<std::size_t>(j, left - 1) * stride, 3 * sizeof(T));
  }
  visit(block);
}

/// Calls visit with the points' data as numbers of their type, which need not be aligned.
template <class Visit>
auto withNumbers(const PointSetView& points, Visit visit) {
  const void* data = points.data();
  switch (points.type()) {
    case ScalarType::Float64:
      return visit(static_cast<const double*>(data));
    case ScalarType::Int8:
      return visit(static_cast<const std::int8_t*>(data));
    case ScalarType::UInt8:
      return visit(static_cast<const std::uint8_t*>(data));
    case ScalarType::Int16:
      return visit(static_cast<const std::int16_t*>(data));
    case ScalarType::UInt16:
      return visit(static_cast<const std::uint16_t*>(data));
    case ScalarType::Int32:
      return visit(static_cast<const std::int32_t*>(data));
    case ScalarType::UInt32:
      return visit(static_cast<const std::uint32_t*>(data));
    case ScalarType::Int64:
      return visit(static_cast<const std::int64_t*>(data));
    case ScalarType::UInt64:
      return visit(static_cast<const std::uint64_t*>(data));
    default:
      return visit(static_cast<const float*>(data));  // PointSetView has no other types
  }
}

template <class Pointer>
using TypeOf = std::remove_cv_t<std::remove_pointer_t<Pointer>>;

template <class T>
bool finiteAs(const PointSetView& points) {
  Block<T> sums{};
  forBlocks<T>(points, [&sums](const Block<T>& block) {
    for (std::size_t i = 0; i < kBlock; ++i) sums[i] += block[i] * 0;  // NaN from either
  });
  return std::all_of(sums.begin(), sums.end(), [](T sum) { return sum == 0; });
}

template <class T>
Ranges rangesAs(const PointSetView& points) {
  Block<T> low;
  std::memcpy(low.data(), points.data(), 3 * sizeof(T));
  for (std::size_t i = 3; i < kBlock; ++i) low[i] = low[i % 3];
  Block<T> high = low;
  forBlocks<T>(points, [&low, &high](const Block<T>& block) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      low[i] = block[i] < low[i] ? block[i] : low[i];
      high[i] = block[i] > high[i] ? block[i] : high[i];
    }
  });
  Ranges ranges;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = axis; i < kBlock; i += 3) {
      low[axis] = std::min(low[axis], low[i]);
      high[axis] = std::max(high[axis], high[i]);
    }
    // Adding zero makes −0 to +0.
    ranges[axis] = {static_cast<double>(low[axis]) + 0.0, static_cast<double>(high[axis]) + 0.0};
  }
  return ranges;
}

/// Whether `value` is a whole number within ±2^53, and which.
template <class T>
bool toWhole(T value, std::int64_t& whole) {
  if constexpr (std::is_floating_point_v<T>) {
    if (!(std::fabs(value) < static_cast<T>(kMaxMultiple))) return false;
    whole = static_cast<std::int64_t>(value);
    return static_cast<T>(whole) == value;
  } else {
    constexpr auto kMost = static_cast<std::int64_t>(kMaxMultiple);
    whole = static_cast<std::int64_t>(value);
    return sizeof(T) < 8 || (-kMost < whole && whole < kMost);
  }
}

template <class T>
std::optional<std::uint64_t> divisorAs(const PointSetView& points, std::size_t axis) {
  const auto* at = static_cast<const unsigned char*>(points.data()) + axis * sizeof(T);
  const std::size_t stride = points.strideBytes();
  ExactDivisor divisor;
  bool any = false;
  for (std::uint64_t i = 0; i < points.size(); ++i, at += stride) {
    T value{};
    std::memcpy(&value, at, sizeof value);
    std::int64_t whole = 0;
    if (!toWhole(value, whole)) return std::nullopt;
    const auto magnitude = static_cast<std::uint64_t>(whole < 0 ? -whole : whole);
    if (any && divisor.divides(magnitude)) continue;
    if (magnitude == 0) continue;
    divisor = ExactDivisor(any ? std::gcd(divisor.value(), magnitude) : magnitude);
    any = true;
    if (std::is_integral_v<T> && divisor.value() == 1) break;
  }
  return any ? divisor.value() : 0;
}

template <class T>
void indicesAs(const PointSetView& points, std::uint64_t first, std::size_t count,
               const std::array<WholeAxis, 3>& axes, GridPoint* out) {
  const std::array<WholeAxis, 3> axis = axes;  // copies live in registers
  const bool undivided =
      axis[0].step.value() == 1 && axis[1].step.value() == 1 && axis[2].step.value() == 1;
  const std::size_t stride = points.strideBytes();
  const auto* at = static_cast<const unsigned char*>(points.data()) + first * stride;
  const auto above = [&axis](T value, std::size_t k) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(value) - axis[k].lowest);
  };
  for (std::size_t i = 0; i < count; ++i, at += stride) {
    std::array<T, 3> xyz;
    std::memcpy(xyz.data(), at, sizeof xyz);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t difference = above(xyz[k], k);
      out[i][k] =
          static_cast<std::uint32_t>(undivided ? difference : axis[k].step.quotient(difference));
    }
  }
}

}  // namespace

bool allFinite(const PointSetView& points) {
  if (points.type() == ScalarType::Float32) return finiteAs<float>(points);
  if (points.type() == ScalarType::Float64) return finiteAs<double>(points);
  return true;
}

Ranges rangesInMemory(const PointSetView& points) {
  return withNumbers(
      points, [&](const auto* numbers) { return rangesAs<TypeOf<decltype(numbers)>>(points); });
}

std::optional<std::uint64_t> wholeDivisor(const PointSetView& points, std::size_t axis) {
  return withNumbers(points, [&](const auto* numbers) {
    return divisorAs<TypeOf<decltype(numbers)>>(points, axis);
  });
}

void wholeIndices(const PointSetView& points, std::uint64_t first, std::size_t count,
                  const std::array<WholeAxis, 3>& axes, GridPoint* out) {
  withNumbers(points, [&](const auto* numbers) {
    indicesAs<TypeOf<decltype(numbers)>>(points, first, count, axes, out);
  });
}

}  // namespace bspc::lattice
