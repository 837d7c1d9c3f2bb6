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

Places placesOf(ScalarType type, const Bytes& numbers, std::size_t known, unsigned bits,
                double maxAngle) {
  const OctahedralMap map(bits);
  const std::size_t tupleSize = kComponents * scalarSize(type);
  Places result;
  result.places.resize(numbers.size() / tupleSize - known);
  for (std::size_t i = 0; i < result.places.size(); ++i) {
    const Vector given = vectorAt(numbers, type, known + i);
    const Place place = map.place(given);
    const bool unit = isUnit(given);
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

std::size_t wordSize(unsigned bits) { return bits <= 8 ? 1 : bits <= 16 ? 2 : 4; }

/// The places of the known vectors, in front of room for those of the new ones.
Bytes knownPlaces(ScalarType type, const Bytes& numbers, std::size_t known, unsigned bits) {
  const OctahedralMap map(bits);
  const std::size_t size = wordSize(bits);
  Bytes words(numbers.size() / (kComponents * scalarSize(type)) * kPlaceComponents * size);
  for (std::size_t i = 0; i < known; ++i) {
    const Place place = map.place(vectorAt(numbers, type, i));
    for (std::size_t c = 0; c < kPlaceComponents; ++c) {
      std::memcpy(words.data() + (i * kPlaceComponents + c) * size, &place[c], size);
    }
  }
  return words;
}

}  // namespace

EncodedArray encodeSphere(const ArrayShape& shape, ArrayValues& values, TilePoints& points,
                          const ArrayWishes& wishes) {
  constexpr std::size_t kMostExceptions = 4;
  unsigned bits = OctahedralMap::kMinBits;
  Places found;
  for (; bits <= OctahedralMap::kMaxBits; ++bits) {
    // Places of so many bits leave angles of up to 240 degrees / 2^bits, in places more.
    constexpr double kLeast = 100;
    if (kLeast / static_cast<double>(std::uint32_t{1} << bits) > wishes.maxAngle) continue;
    found = placesOf(shape.type, values.numbers, points.known(), bits, wishes.maxAngle);
    if (found.missed == 0) break;
  }
  if (bits > OctahedralMap::kMaxBits ||
      found.exceptions.places.size() > found.places.size() / kMostExceptions) {
    return {};
  }
  const std::size_t size = wordSize(bits);
  const std::size_t tupleSize = kComponents * scalarSize(shape.type);
  const OctahedralMap map(bits);
  Bytes words = knownPlaces(shape.type, values.numbers, points.known(), bits);
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
  out.u8(bits);
  found.exceptions.write(out);
  const NumberShape inner{unsignedType(size), kPlaceComponents, bits};
  const Bytes coded = encodeNumbers(inner, words, points, wishes.effort);
  out.bytes(coded);
  return {out.take(), found.greatestAngle, followsInput(coded)};
}

void decodeSphere(const ArrayShape& shape, container::ByteReader& in, TilePoints& points,
                  MemoryBudget& budget, Bytes& numbers) {
  if (!isFloatingPoint(shape.type) || shape.components != kComponents) {
    in.fail("an array that has not three floating-point components is said to be of directions");
  }
  const unsigned bits = in.u8();
  if (bits < OctahedralMap::kMinBits || bits > OctahedralMap::kMaxBits) {
    in.fail("directions have " + std::to_string(bits) + " bits");
  }
  const std::size_t tupleSize = kComponents * scalarSize(shape.type);
  const ExceptionList exceptions = ExceptionList::read(in, points.added(), tupleSize);
  const std::size_t size = wordSize(bits);
  budget.take(points.size(), kPlaceComponents * size);
  Bytes words = knownPlaces(shape.type, numbers, points.known(), bits);
  const NumberShape inner{unsignedType(size), kPlaceComponents, bits};
  decodeNumbers(inner, in, points, budget, words);
  const OctahedralMap map(bits);
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
