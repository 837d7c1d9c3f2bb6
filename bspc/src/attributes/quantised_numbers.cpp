#include "attributes/quantised_numbers.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "attributes/exception_list.h"
#include "attributes/float_bytes.h"
#include "attributes/number_coder.h"

namespace bspc::attributes {

namespace {

/// Multiples are below this in size, so that doubles hold them.
constexpr double kGreatestMultiple = 0x1p52;

/// What a multiple of the step is restored as.
double restored(std::int64_t multiple, double step, ScalarType type) {
  const double number = static_cast<double>(multiple) * step;
  return type == ScalarType::Float32 ? static_cast<double>(static_cast<float>(number)) : number;
}

/// The multiple nearest to a number, limited; 0 for NaN.
std::int64_t multipleOf(double number, double step) {
  const double multiple = std::floor(number / step + 0.5);
  if (!(std::fabs(multiple) <= kGreatestMultiple)) {
    return multiple > 0 ? (std::int64_t{1} << 52) : multiple < 0 ? -(std::int64_t{1} << 52) : 0;
  }
  return static_cast<std::int64_t>(multiple);
}

std::size_t bytesForRange(std::uint64_t range) {
  if (range <= 0xFF) return 1;
  if (range <= 0xFFFF) return 2;
  return range <= 0xFFFFFFFF ? 4 : 8;
}

/// New numbers as multiples, and those that multiples cannot restore.
struct Multiples {
  std::vector<std::int64_t> multiples;
  ExceptionList exceptions;
  std::size_t missed = 0;  ///< exceptions that are finite
  double greatestError = 0;
};

Multiples quantise(const ArrayShape& shape, const Bytes& numbers, std::size_t known, double step,
                   double maxError) {
  const std::size_t size = scalarSize(shape.type);
  const std::size_t first = known * shape.components;
  Multiples result;
  result.multiples.resize(numbers.size() / size - first);
  for (std::size_t i = 0; i < result.multiples.size(); ++i) {
    const std::uint8_t* bytes = numbers.data() + (first + i) * size;
    const double number = readFloat(bytes, shape.type);
    const std::int64_t multiple = multipleOf(number, step);
    const double error = std::fabs(restored(multiple, step, shape.type) - number);
    if (error <= maxError) {
      result.multiples[i] = multiple;
      result.greatestError = std::max(result.greatestError, error);
      continue;
    }
    result.exceptions.add(i, {bytes, size});
    if (std::isfinite(number)) ++result.missed;
    result.multiples[i] = i >= shape.components ? result.multiples[i - shape.components] : 0;
  }
  return result;
}

/// How multiples are stored: minus the least of them, in so many bytes.
struct Frame {
  double step = 1;
  std::int64_t base = 0;
  std::size_t size = 1;

  std::uint64_t greatest() const {
    return size == 8 ? ~std::uint64_t{0} : (std::uint64_t{1} << (8 * size)) - 1;
  }
};

/// The words of the known numbers, in front of room for those of the new ones.
Bytes knownWords(const ArrayShape& shape, const Bytes& numbers, std::size_t known,
                 const Frame& frame) {
  const std::size_t size = scalarSize(shape.type);
  Bytes words(numbers.size() / size * frame.size);
  for (std::size_t i = 0; i < known * shape.components; ++i) {
    const double number = readFloat(numbers.data() + i * size, shape.type);
    const std::int64_t multiple = multipleOf(number, frame.step);
    const std::uint64_t word = multiple <= frame.base
                                   ? 0
                                   : std::min(static_cast<std::uint64_t>(multiple) -
                                                  static_cast<std::uint64_t>(frame.base),
                                              frame.greatest());
    std::memcpy(words.data() + i * frame.size, &word, frame.size);
  }
  return words;
}

}  // namespace

EncodedArray encodeQuantised(const ArrayShape& shape, ArrayValues& values, TilePoints& points,
                             const ArrayWishes& wishes) {
  constexpr double kNarrower = 1 - 0x1p-10;  // where rounding pushes errors beyond the bound
  constexpr std::size_t kMostExceptions = 4;
  Frame frame;
  frame.step = 2 * wishes.maxError;
  if (!(frame.step >= std::numeric_limits<double>::min()) || !std::isfinite(frame.step)) return {};
  Multiples found = quantise(shape, values.numbers, points.known(), frame.step, wishes.maxError);
  if (found.missed > 0) {
    frame.step *= kNarrower;
    found = quantise(shape, values.numbers, points.known(), frame.step, wishes.maxError);
  }
  if (found.exceptions.places.size() > found.multiples.size() / kMostExceptions) return {};
  const auto [least, greatest] =
      std::minmax_element(found.multiples.begin(), found.multiples.end());
  frame.base = *least;
  frame.size =
      bytesForRange(static_cast<std::uint64_t>(*greatest) - static_cast<std::uint64_t>(*least));
  Bytes words = knownWords(shape, values.numbers, points.known(), frame);
  const std::size_t first = points.known() * shape.components;
  const std::size_t size = scalarSize(shape.type);
  for (std::size_t i = 0; i < found.multiples.size(); ++i) {
    const auto word =
        static_cast<std::uint64_t>(found.multiples[i]) - static_cast<std::uint64_t>(frame.base);
    std::memcpy(words.data() + (first + i) * frame.size, &word, frame.size);
    writeFloat(restored(found.multiples[i], frame.step, shape.type), shape.type,
               values.numbers.data() + (first + i) * size);
  }
  for (std::size_t e = 0; e < found.exceptions.places.size(); ++e) {
    std::memcpy(values.numbers.data() + (first + found.exceptions.places[e]) * size,
                found.exceptions.contents.data() + e * size, size);
  }
  container::ByteWriter out;
  writeMethod(ArrayMethod::Quantised, out);
  std::uint64_t stepBits = 0;
  std::memcpy(&stepBits, &frame.step, sizeof stepBits);
  out.unsignedLittle(stepBits, 8);
  out.signedVarint(frame.base);
  out.u8(static_cast<unsigned>(frame.size));
  found.exceptions.write(out);
  const NumberShape inner{unsignedType(frame.size), shape.components, 0};
  const Bytes coded = encodeNumbers(inner, words, points, wishes.effort);
  out.bytes(coded);
  return {out.take(), found.greatestError, followsInput(coded)};
}

void decodeQuantised(const ArrayShape& shape, container::ByteReader& in, TilePoints& points,
                     MemoryBudget& budget, Bytes& numbers) {
  if (!isFloatingPoint(shape.type)) in.fail("integers are said to be quantised");
  Frame frame;
  const std::uint64_t stepBits = in.unsignedLittle(8);
  std::memcpy(&frame.step, &stepBits, sizeof stepBits);
  if (!(frame.step > 0) || !std::isfinite(frame.step)) in.fail("the step is not a positive number");
  frame.base = in.signedVarint();
  constexpr std::int64_t kGreatestBase = std::int64_t{1} << 52;
  if (frame.base > kGreatestBase || frame.base < -kGreatestBase) {
    in.fail("the least multiple of the step is out of range");
  }
  frame.size = in.u8();
  if (frame.size != 1 && frame.size != 2 && frame.size != 4 && frame.size != 8) {
    in.fail("multiples of the step have " + std::to_string(frame.size) + " bytes");
  }
  const std::size_t size = scalarSize(shape.type);
  const std::size_t first = points.known() * shape.components;
  const std::size_t count = points.added() * shape.components;
  const ExceptionList exceptions = ExceptionList::read(in, count, size, budget);
  budget.take(numbers.size() / size, frame.size);
  Bytes words = knownWords(shape, numbers, points.known(), frame);
  const NumberShape inner{unsignedType(frame.size), shape.components, 0};
  decodeNumbers(inner, in, points, budget, words);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t word = 0;
    std::memcpy(&word, words.data() + (first + i) * frame.size, frame.size);
    const auto multiple = static_cast<std::int64_t>(static_cast<std::uint64_t>(frame.base) + word);
    writeFloat(restored(multiple, frame.step, shape.type), shape.type,
               numbers.data() + (first + i) * size);
  }
  for (std::size_t e = 0; e < exceptions.places.size(); ++e) {
    std::memcpy(numbers.data() + (first + exceptions.places[e]) * size,
                exceptions.contents.data() + e * size, size);
  }
}

}  // namespace bspc::attributes
