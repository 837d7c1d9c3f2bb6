#include "attributes/sphere_normals.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "attributes/exception_list.h"
#include "attributes/float_bytes.h"
#include "attributes/number_coder.h"
#include "attributes/octahedral_map.h"

namespace bspc::attributes {

namespace {

using Vector = OctahedralMap::Vector;
using Place = OctahedralMap::Place;

constexpr std::uint32_t kComponents = 3;
constexpr std::uint32_t kPlaceComponents = 2;

Vector vectorAt(const Bytes& numbers, ScalarType type, std::size_t tuple) {
  const std::size_t size = scalarSize(type);
  Vector v{};
  for (std::size_t c = 0; c < kComponents; ++c) {
    v[c] = readFloat(numbers.data() + (tuple * kComponents + c) * size, type);
  }
  return v;
}

void storeVector(const Vector& v, ScalarType type, std::size_t tuple, Bytes& numbers) {
  const std::size_t size = scalarSize(type);
  for (std::size_t c = 0; c < kComponents; ++c) {
    writeFloat(v[c], type, numbers.data() + (tuple * kComponents + c) * size);
  }
}

/// A direction as it will be restored.
Vector rounded(const Vector& v, ScalarType type) {
  if (type != ScalarType::Float32) return v;
  Vector result{};
  for (std::size_t c = 0; c < kComponents; ++c) {
    result[c] = static_cast<double>(static_cast<float>(v[c]));
  }
  return result;
}

double degreesBetween(const Vector& a, const Vector& b) {
  constexpr double kDegrees = 57.29577951308232;
  const Vector cross{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                     a[0] * b[1] - a[1] * b[0]};
  const double sine = std::sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
  return kDegrees * std::atan2(sine, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

bool isUnit(const Vector& v) {
  constexpr double kTolerance = 1e-3;
  return std::fabs(std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - 1) <= kTolerance;
}

/// New vectors as places, and those that places cannot restore.
struct Places {
  std::vector<Place> places;
  ExceptionList exceptions;
  std::size_t missed = 0;  ///< exceptions of length one
  double greatestAngle = 0;
};

/// Of the places around a vector, the one of the least angle: the nearest in the square has up to
/// one and a half times that.
Place bestPlace(const OctahedralMap& map, const Vector& v) {
  const OctahedralChart chart(v);
  const Place middle = chart.place(map, v);
  Place best = chart.fromChart(map, middle);
  double greatest = -2;
  for (const std::uint32_t u : {middle[0] - 1, middle[0], middle[0] + 1}) {
    for (const std::uint32_t w : {middle[1] - 1, middle[1], middle[1] + 1}) {
      const Place place = chart.fromChart(map, {u, w});
      const Vector d = map.direction(place);
      const double product = d[0] * v[0] + d[1] * v[1] + d[2] * v[2];
      if (!(product > greatest)) continue;
      greatest = product;
      best = place;
    }
  }
  return best;
}

Places placesOf(ScalarType type, const Bytes& numbers, std::size_t known, std::uint32_t half,
                double maxAngle) {
  const OctahedralMap map(half);
  const std::size_t tupleSize = kComponents * scalarSize(type);
  Places result;
  result.places.resize(numbers.size() / tupleSize - known);
  for (std::size_t i = 0; i < result.places.size(); ++i) {
    const Vector given = vectorAt(numbers, type, known + i);
    const bool unit = isUnit(given);
    const Place place = unit ? bestPlace(map, given) : Place{};
    const double angle = unit ? degreesBetween(given, rounded(map.direction(place), type)) : 0.0;
    if (unit && angle <= maxAngle) {
      result.places[i] = place;
      result.greatestAngle = std::max(result.greatestAngle, angle);
      continue;
    }
    result.exceptions.add(i, {numbers.data() + (known + i) * tupleSize, tupleSize});
    if (unit) ++result.missed;
    result.places[i] = i > 0 ? result.places[i - 1] : map.place({});
  }
  return result;
}

std::size_t wordSize(std::uint32_t half) {
  const std::uint32_t last = 2 * half;
  return last <= 0xFF ? 1 : last <= 0xFFFF ? 2 : 4;
}

/// The places of the known vectors, in front of room for those of the new ones.
Bytes knownPlaces(ScalarType type, const Bytes& numbers, std::size_t known, std::uint32_t half) {
  const OctahedralMap map(half);
  const std::size_t size = wordSize(half);
  Bytes words(numbers.size() / (kComponents * scalarSize(type)) * kPlaceComponents * size);
  for (std::size_t i = 0; i < known; ++i) {
    const Place place = map.place(vectorAt(numbers, type, i));
    for (std::size_t c = 0; c < kPlaceComponents; ++c) {
      std::memcpy(words.data() + (i * kPlaceComponents + c) * size, &place[c], size);
    }
  }
  return words;
}

/// With so many places no angle is greater, but for rounding: in the middle of the octahedron's
/// faces, where they are farthest apart, they are triangles of side sqrt(6) / half.
std::uint32_t leastHalf(double maxAngle) {
  constexpr double kDegrees = 81.04;  // sqrt(2) in degrees: their distance from the corners
  const double half = std::ceil(kDegrees / maxAngle);
  constexpr std::uint32_t kTooMany = OctahedralMap::kMostHalf + 1;
  return half < static_cast<double>(kTooMany) ? static_cast<std::uint32_t>(half) : kTooMany;
}

}  // namespace

EncodedArray encodeSphere(const ArrayShape& shape, ArrayValues& values, TilePoints& points,
                          const ArrayWishes& wishes) {
  constexpr std::size_t kMostExceptions = 4;
  std::uint32_t half = leastHalf(wishes.maxAngle);
  Places found;
  for (; half <= OctahedralMap::kMostHalf; half += half / 4 + 1) {
    found = placesOf(shape.type, values.numbers, points.known(), half, wishes.maxAngle);
    if (found.missed == 0) break;
  }
  if (half > OctahedralMap::kMostHalf ||
      found.exceptions.places.size() > found.places.size() / kMostExceptions) {
    return {};
  }
  const std::size_t size = wordSize(half);
  const std::size_t tupleSize = kComponents * scalarSize(shape.type);
  const OctahedralMap map(half);
  Bytes words = knownPlaces(shape.type, values.numbers, points.known(), half);
  for (std::size_t i = 0; i < found.places.size(); ++i) {
    const std::size_t tuple = points.known() + i;
    for (std::size_t c = 0; c < kPlaceComponents; ++c) {
      std::memcpy(words.data() + (tuple * kPlaceComponents + c) * size, &found.places[i][c], size);
    }
    storeVector(map.direction(found.places[i]), shape.type, tuple, values.numbers);
  }
  for (std::size_t e = 0; e < found.exceptions.places.size(); ++e) {
    std::memcpy(values.numbers.data() + (points.known() + found.exceptions.places[e]) * tupleSize,
                found.exceptions.contents.data() + e * tupleSize, tupleSize);
  }
  container::ByteWriter out;
  writeMethod(ArrayMethod::Sphere, out);
  out.varint(half);
  found.exceptions.write(out);
  const NumberShape inner{unsignedType(size), kPlaceComponents, half};
  const Bytes coded = encodeNumbers(inner, words, points, wishes.effort);
  out.bytes(coded);
  return {out.take(), found.greatestAngle, followsInput(coded)};
}

void decodeSphere(const ArrayShape& shape, container::ByteReader& in, TilePoints& points,
                  MemoryBudget& budget, Bytes& numbers) {
  if (!isFloatingPoint(shape.type) || shape.components != kComponents) {
    in.fail("an array that has not three floating-point components is said to be of directions");
  }
  const std::uint64_t size64 = in.varint();
  if (size64 < 1 || size64 > OctahedralMap::kMostHalf) {
    in.fail("directions lie on an octahedron of size " + std::to_string(size64));
  }
  const auto half = static_cast<std::uint32_t>(size64);
  const std::size_t tupleSize = kComponents * scalarSize(shape.type);
  const ExceptionList exceptions = ExceptionList::read(in, points.added(), tupleSize, budget);
  const std::size_t size = wordSize(half);
  budget.take(points.size(), kPlaceComponents * size);
  Bytes words = knownPlaces(shape.type, numbers, points.known(), half);
  const NumberShape inner{unsignedType(size), kPlaceComponents, half};
  decodeNumbers(inner, in, points, budget, words);
  const OctahedralMap map(half);
  for (std::size_t tuple = points.known(); tuple < points.size(); ++tuple) {
    Place place{};
    for (std::size_t c = 0; c < kPlaceComponents; ++c) {
      std::memcpy(&place[c], words.data() + (tuple * kPlaceComponents + c) * size, size);
    }
    storeVector(map.direction(place), shape.type, tuple, numbers);
  }
  for (std::size_t e = 0; e < exceptions.places.size(); ++e) {
    std::memcpy(numbers.data() + (points.known() + exceptions.places[e]) * tupleSize,
                exceptions.contents.data() + e * tupleSize, tupleSize);
  }
}

}  // namespace bspc::attributes
