#include "attributes/array_samples.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "attributes/ordered_words.h"

namespace bspc::test {

namespace {

using attributes::ArrayShape;
using attributes::ArrayValues;

template <class T>
void append(Bytes& bytes, T value) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof value);
}

/// An array whose tuple of a point is what `f` appends.
template <class F>
SampleArray arrayOf(const std::string& name, ScalarType type, std::uint32_t components,
                    const std::vector<GridPoint>& points, F&& f) {
  SampleArray array{name, ArrayShape{type, components, Semantic::None}, {}};
  for (std::size_t i = 0; i < points.size(); ++i) f(points[i], i, array.values.numbers);
  return array;
}

double wave(const GridPoint& p, double length) {
  return std::sin(p[0] / length) * std::cos(p[1] / length) + 0.25 * std::sin(p[2] / length);
}

/// A random bit pattern of each integer type.
template <class T>
SampleArray randomIntegers(const std::string& name, ScalarType type,
                           const std::vector<GridPoint>& points, std::mt19937_64& random) {
  return arrayOf(name, type, 2, points, [&](const GridPoint& p, std::size_t, Bytes& out) {
    append(out, static_cast<T>(random()));
    append(out, static_cast<T>(1000 * wave(p, 300)));
  });
}

}  // namespace

SampleArray sampleNormals(const std::vector<GridPoint>& points) {
  GridPoint upper{};
  for (const GridPoint& p : points) {
    for (unsigned k = 0; k < 3; ++k) upper[k] = std::max(upper[k], p[k]);
  }
  SampleArray array = arrayOf("normals", ScalarType::Float32, 3, points,
                              [&](const GridPoint& p, std::size_t, Bytes& out) {
                                std::array<double, 3> d{};
                                double length = 0;
                                for (unsigned k = 0; k < 3; ++k) {
                                  d[k] = static_cast<double>(p[k]) - upper[k] / 2.0 + 0.25;
                                  length += d[k] * d[k];
                                }
                                for (const double x : d)
                                  append(out, static_cast<float>(x / std::sqrt(length)));
                              });
  array.shape.semantic = Semantic::Normals;
  return array;
}

std::vector<SampleArray> sampleArrays(const std::vector<GridPoint>& points, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<SampleArray> arrays;
  arrays.push_back(arrayOf(
      "colours", ScalarType::UInt8, 3, points, [&](const GridPoint& p, std::size_t, Bytes& out) {
        const double w = wave(p, 200);
        append(out, static_cast<std::uint8_t>(120 + 80 * w));
        append(out, static_cast<std::uint8_t>(static_cast<unsigned>(100 + 60 * w) + random() % 4));
        append(out, static_cast<std::uint8_t>(random() % 8));
      }));
  arrays.push_back(
      arrayOf("colours of 16 bits", ScalarType::UInt16, 3, points,
              [&](const GridPoint& p, std::size_t, Bytes& out) {
                for (unsigned c = 0; c < 3; ++c) {
                  append(out, static_cast<std::uint16_t>(
                                  257 * static_cast<unsigned>(99 + 70 * wave(p, 99.0 + c))));
                }
              }));
  arrays.push_back(arrayOf("labels", ScalarType::Int8, 1, points,
                           [](const GridPoint& p, std::size_t, Bytes& out) {
                             append(out, static_cast<std::int8_t>(wave(p, 400) > 0.2    ? -3
                                                                  : wave(p, 400) < -0.3 ? 9
                                                                                        : 2));
                           }));
  arrays.push_back(randomIntegers<std::int16_t>("int16", ScalarType::Int16, points, random));
  arrays.push_back(randomIntegers<std::int32_t>("int32", ScalarType::Int32, points, random));
  arrays.push_back(randomIntegers<std::uint32_t>("uint32", ScalarType::UInt32, points, random));
  arrays.push_back(randomIntegers<std::int64_t>("int64", ScalarType::Int64, points, random));
  arrays.push_back(randomIntegers<std::uint64_t>("uint64", ScalarType::UInt64, points, random));
  arrays.push_back(arrayOf("smooth float32", ScalarType::Float32, 1, points,
                           [](const GridPoint& p, std::size_t, Bytes& out) {
                             append(out, static_cast<float>(wave(p, 500)));
                           }));
  arrays.push_back(arrayOf("time", ScalarType::Float64, 1, points,
                           [](const GridPoint&, std::size_t i, Bytes& out) {
                             const std::size_t pulse = i / 3;
                             append(out, 245370.417 + static_cast<double>(pulse) * 0.0001);
                           }));
  arrays.push_back(arrayOf("special floats", ScalarType::Float32, 2, points,
                           [&](const GridPoint& p, std::size_t, Bytes& out) {
                             const std::array<float, 6> odd{std::numeric_limits<float>::quiet_NaN(),
                                                            -std::numeric_limits<float>::infinity(),
                                                            std::numeric_limits<float>::max(),
                                                            -0.0F,
                                                            1e-45F,
                                                            0.0F};
                             append(out, odd[random() % odd.size()]);
                             const auto bits = static_cast<std::uint32_t>(random());
                             append(out, random() % 16 == 0 ? bits : 0x3F800000U + p[0]);
                           }));
  arrays.push_back(arrayOf("special doubles", ScalarType::Float64, 3, points,
                           [&](const GridPoint&, std::size_t, Bytes& out) {
                             append(out, static_cast<std::uint64_t>(random()));
                             append(out, std::numeric_limits<double>::max());
                             append(out, random() % 3 == 0 ? -0.0 : 0.0);
                           }));
  arrays.push_back(arrayOf("constant", ScalarType::Float64, 4, points,
                           [](const GridPoint&, std::size_t, Bytes& out) {
                             for (unsigned c = 0; c < 4; ++c) append(out, 1.5 * c);
                           }));
  arrays.push_back(
      arrayOf("bits", ScalarType::Bit, 2, points, [&](const GridPoint& p, std::size_t, Bytes& out) {
        append(out, static_cast<std::uint8_t>(wave(p, 300) > 0 ? 1 : 0));
        append(out, static_cast<std::uint8_t>(random() % 2));
      }));
  arrays.push_back(arrayOf(
      "many components", ScalarType::UInt16, 9, points,
      [&](const GridPoint& p, std::size_t, Bytes& out) {
        for (unsigned c = 0; c < 9; ++c) {
          append(out, static_cast<std::uint16_t>(std::uint64_t{p[c % 3]} * (c + 1) + random() % 3));
        }
      }));
  arrays.push_back(sampleNormals(points));
  SampleArray names{"few strings", ArrayShape{ScalarType::String, 2, Semantic::None}, {}};
  SampleArray texts{"many strings", ArrayShape{ScalarType::String, 1, Semantic::None}, {}};
  for (const GridPoint& point : points) {
    names.values.strings.emplace_back(wave(point, 300) > 0 ? "hill" : "");
    names.values.strings.emplace_back("class " + std::to_string(random() % 5));
    texts.values.strings.emplace_back(std::to_string(random()) + std::string(random() % 9, 'x'));
  }
  arrays.push_back(std::move(names));
  arrays.push_back(std::move(texts));
  return arrays;
}

ArrayValues reordered(const SampleArray& array, const std::vector<std::uint32_t>& order) {
  ArrayValues result;
  const std::size_t components = array.shape.components;
  const std::size_t size = array.shape.type == ScalarType::String
                               ? 0
                               : attributes::numberSize(array.shape.type) * components;
  for (const std::uint32_t i : order) {
    const auto first = array.values.numbers.begin() + static_cast<std::ptrdiff_t>(i * size);
    result.numbers.insert(result.numbers.end(), first, first + static_cast<std::ptrdiff_t>(size));
    if (size > 0) continue;
    for (std::size_t c = 0; c < components; ++c) {
      result.strings.push_back(array.values.strings[i * components + c]);
    }
  }
  return result;
}

ArrayValues firstTuples(const SampleArray& array, std::size_t tuples) {
  std::vector<std::uint32_t> order(tuples);
  for (std::size_t i = 0; i < tuples; ++i) order[i] = static_cast<std::uint32_t>(i);
  return reordered(array, order);
}

}  // namespace bspc::test
