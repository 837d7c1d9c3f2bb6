#include "attributes/array_coder.h"

#include <algorithm>
#include <string>
#include <utility>

#include "attributes/number_coder.h"
#include "attributes/quantised_numbers.h"
#include "attributes/sphere_normals.h"
#include "attributes/string_coder.h"
#include "bspc/error.h"

namespace bspc::attributes {

namespace {

std::uint64_t expectedCount(const ArrayShape& shape, std::size_t tuples) {
  return std::uint64_t{shape.components} * tuples;
}

void expectValues(const ArrayShape& shape, const ArrayValues& values, std::size_t tuples) {
  const bool isString = shape.type == ScalarType::String;
  const std::uint64_t wanted = expectedCount(shape, tuples);
  const std::uint64_t given =
      isString ? values.strings.size() : values.numbers.size() / numberSize(shape.type);
  if (shape.components == 0 || given != wanted ||
      (!isString && values.numbers.size() % numberSize(shape.type) != 0)) {
    throw Error(ErrorCode::InvalidArgument,
                "an array of " + std::to_string(shape.components) + " components has " +
                    std::to_string(given) + " values for " + std::to_string(tuples) + " points");
  }
}

bool wantsSphere(const ArrayShape& shape, const ArrayWishes& wishes) {
  return wishes.maxAngle > 0 && shape.semantic == Semantic::Normals && shape.components == 3 &&
         isFloatingPoint(shape.type);
}

void decodeNumberArray(const ArrayShape& shape, container::ByteReader& in, TilePoints& points,
                       MemoryBudget& budget, Bytes& numbers) {
  container::ByteReader ahead = in;
  const ArrayMethod method = readMethod(ahead);
  if (method == ArrayMethod::Quantised) {
    in = ahead;
    decodeQuantised(shape, in, points, budget, numbers);
  } else if (method == ArrayMethod::Sphere) {
    in = ahead;
    decodeSphere(shape, in, points, budget, numbers);
  } else {
    decodeNumbers({shape.type, shape.components, 0}, in, points, budget, numbers);
  }
}

/// Bits are 0 or 1, whatever a damaged payload says.
void expectBits(const container::ByteReader& in, const Bytes& numbers, std::size_t first) {
  const auto start = numbers.begin() + static_cast<std::ptrdiff_t>(first);
  if (std::any_of(start, numbers.end(), [](std::uint8_t b) { return b > 1; })) {
    in.fail("a bit is neither 0 nor 1");
  }
}

}  // namespace

EncodedArray encodeArray(const ArrayShape& shape, ArrayValues& values, TilePoints& points,
                         const ArrayWishes& wishes) {
  expectValues(shape, values, points.size());
  if (points.added() == 0) return {};
  if (shape.type == ScalarType::String) {
    return encodeStrings(shape, values.strings, points, wishes.effort);
  }
  EncodedArray lossy;
  if (wantsSphere(shape, wishes)) {
    lossy = encodeSphere(shape, values, points, wishes);
  } else if (wishes.maxError > 0 && isFloatingPoint(shape.type)) {
    lossy = encodeQuantised(shape, values, points, wishes);
  }
  if (!lossy.payload.empty()) return lossy;
  Bytes payload =
      encodeNumbers({shape.type, shape.components, 0}, values.numbers, points, wishes.effort);
  const bool usesInputOrder = followsInput(payload);
  return {std::move(payload), 0, usesInputOrder};
}

void decodeArray(const ArrayShape& shape, ByteView payload, TilePoints& points,
                 std::uint64_t maxBytes, ArrayValues& values) {
  expectValues(shape, values, points.known());
  container::ByteReader in(payload, "an array's payload", container::ByteReader::kNoOffset);
  if (points.added() == 0) return in.expectEnd();
  MemoryBudget budget(maxBytes);
  if (shape.type == ScalarType::String) {
    if (readMethod(in) != ArrayMethod::Strings) in.fail("the method is not one for strings");
    decodeStrings(shape, in, points, budget, values.strings);
    return in.expectEnd();
  }
  const std::size_t tupleSize = numberSize(shape.type) * shape.components;
  budget.take(points.size(), tupleSize);
  values.numbers.resize(points.size() * tupleSize);
  decodeNumberArray(shape, in, points, budget, values.numbers);
  in.expectEnd();
  if (shape.type == ScalarType::Bit) {
    expectBits(in, values.numbers, points.known() * tupleSize);
  }
}

}  // namespace bspc::attributes
