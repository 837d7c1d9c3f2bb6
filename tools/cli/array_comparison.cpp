#include "cli/array_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <list>
#include <numeric>

namespace bspc::cli {

namespace {

std::size_t tupleBytes(const ArrayView& array) {
  return array.components * arrayValueSize(array.type);
}

const std::uint8_t* tupleOf(const ArrayView& array, std::uint64_t index) {
  const std::size_t stride = array.strideBytes > 0 ? array.strideBytes : tupleBytes(array);
  return static_cast<const std::uint8_t*>(array.data) + index * stride;
}

int compareStrings(const std::uint8_t* a, const std::uint8_t* b, std::size_t count) {
  const auto* left = reinterpret_cast<const std::string*>(a);
  const auto* right = reinterpret_cast<const std::string*>(b);
  for (std::size_t k = 0; k < count; ++k) {
    if (const int order = left[k].compare(right[k]); order != 0) return order;
  }
  return 0;
}

double valueOf(const ArrayView& array, const std::uint8_t* tuple, std::size_t component) {
  if (array.type == ScalarType::Float64) {
    double value = 0;
    std::memcpy(&value, tuple + component * sizeof(value), sizeof(value));
    return value;
  }
  float value = 0;
  std::memcpy(&value, tuple + component * sizeof(value), sizeof(value));
  return value;
}

/// By bits, or by value where values may differ.
int compareTuples(const ArrayView& a, std::uint64_t i, const ArrayView& b, std::uint64_t j,
                  bool byValue) {
  const std::uint8_t* const left = tupleOf(a, i);
  const std::uint8_t* const right = tupleOf(b, j);
  if (a.type == ScalarType::String) return compareStrings(left, right, a.components);
  if (!byValue) return std::memcmp(left, right, tupleBytes(a));
  for (std::size_t k = 0; k < a.components; ++k) {
    const double x = valueOf(a, left, k);
    const double y = valueOf(b, right, k);
    if (x < y) return -1;
    if (y < x) return 1;
  }
  return 0;
}

double angleBetween(const ArrayView& a, std::uint64_t i, const ArrayView& b, std::uint64_t j) {
  double dot = 0;
  double crossed = 0;
  std::array<double, 3> u{};
  std::array<double, 3> v{};
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = valueOf(a, tupleOf(a, i), k);
    v[k] = valueOf(b, tupleOf(b, j), k);
    dot += u[k] * v[k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double c = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    crossed += c * c;
  }
  constexpr double kDegrees = 57.295779513082323;
  return std::atan2(std::sqrt(crossed), dot) * kDegrees;
}

/// How far two tuples are apart; 0 only if they are the same bit for bit.
double distance(const ArrayView& a, std::uint64_t i, const ArrayView& b, std::uint64_t j) {
  if (compareTuples(a, i, b, j, false) == 0) return 0;
  if (!isFloatingPoint(a.type)) return HUGE_VAL;
  if (b.semantic == Semantic::Normals && b.components == 3) return angleBetween(a, i, b, j);
  double greatest = 0;
  for (std::size_t k = 0; k < a.components; ++k) {
    const double x = valueOf(a, tupleOf(a, i), k);
    const double y = valueOf(b, tupleOf(b, j), k);
    const bool isSame = x == y || (std::isnan(x) && std::isnan(y));
    greatest = std::max(greatest, isSame ? 0 : std::fabs(x - y));
    if (std::isnan(x) != std::isnan(y)) greatest = HUGE_VAL;
  }
  // −0 for 0 and other NaNs are not the same bits.
  return greatest > 0 || b.tolerance > 0 ? greatest : HUGE_VAL;
}

/// Orders points by place, arrays without tolerance, then the others.
class TableOrder {
 public:
  TableOrder(const PointTable& left, const PointTable& right) : left_(left), right_(right) {}

  int compare(std::uint64_t i, std::uint64_t j, bool exactOnly) const {
    const GridPoint& p = left_.points[i];
    const GridPoint& q = right_.points[j];
    if (p != q) return p < q ? -1 : 1;
    for (const bool byValue : {false, true}) {
      if (byValue && exactOnly) break;
      for (std::size_t a = 0; a < left_.arrays.size(); ++a) {
        if ((tolerance(a) > 0) != byValue) continue;
        const int order = compareTuples(left_.arrays[a], i, right_.arrays[a], j, byValue);
        if (order != 0) return order;
      }
    }
    return 0;
  }

 private:
  double tolerance(std::size_t a) const {
    return std::max(left_.arrays[a].tolerance, right_.arrays[a].tolerance);
  }

  const PointTable& left_;
  const PointTable& right_;
};

std::vector<std::uint64_t> sortedPoints(const PointTable& table) {
  std::vector<std::uint64_t> order(table.points.size());
  std::iota(order.begin(), order.end(), std::uint64_t{0});
  const TableOrder same(table, table);
  std::sort(order.begin(), order.end(),
            [&](std::uint64_t i, std::uint64_t j) { return same.compare(i, j, false) < 0; });
  return order;
}

/// Whether every array of the two points is within its tolerance.
bool agree(const PointTable& given, std::uint64_t i, const PointTable& restored, std::uint64_t j) {
  for (std::size_t a = 0; a < given.arrays.size(); ++a) {
    const ArrayView& array = restored.arrays[a];
    if (distance(given.arrays[a], i, array, j) > array.tolerance) return false;
  }
  return true;
}

/// The partner of each restored point when both tables are put in one order. Points that are the
/// same but for values with a tolerance may be mixed up by that; each then takes the first left
/// one that agrees with it.
std::vector<std::uint64_t> matchedPoints(const PointTable& given, const PointTable& restored) {
  const std::vector<std::uint64_t> from = sortedPoints(given);
  const std::vector<std::uint64_t> to = sortedPoints(restored);
  const TableOrder across(given, restored);
  std::vector<std::uint64_t> partners(to.size());
  for (std::size_t first = 0; first < to.size();) {
    std::size_t end = first + 1;
    while (end < to.size() && across.compare(from[first], to[end], true) == 0 &&
           across.compare(from[end], to[first], true) == 0) {
      ++end;
    }
    std::list<std::uint64_t> left(from.begin() + static_cast<std::ptrdiff_t>(first),
                                  from.begin() + static_cast<std::ptrdiff_t>(end));
    for (std::size_t r = first; r < end; ++r) {
      // In order they agree nearly always, so the first is tried first.
      auto found = std::find_if(left.begin(), left.end(),
                                [&](std::uint64_t g) { return agree(given, g, restored, to[r]); });
      if (found == left.end()) found = left.begin();
      partners[to[r]] = *found;
      left.erase(found);
    }
    first = end;
  }
  return partners;
}

}  // namespace

ArrayComparison compareArrays(const PointTable& given, const PointTable& restored,
                              const std::optional<std::vector<std::uint64_t>>& partners) {
  const std::vector<std::uint64_t> partnerOf =
      partners ? *partners : matchedPoints(given, restored);
  ArrayComparison result;
  result.greatestErrors.resize(given.arrays.size());
  for (std::uint64_t j = 0; j < partnerOf.size(); ++j) {
    for (std::size_t a = 0; a < given.arrays.size(); ++a) {
      const ArrayView& array = restored.arrays[a];
      const double error = distance(given.arrays[a], partnerOf[j], array, j);
      result.greatestErrors[a] = std::max(result.greatestErrors[a], error);
      if (error > array.tolerance && !result.mismatch) result.mismatch = {partnerOf[j], a};
    }
  }
  return result;
}

}  // namespace bspc::cli
