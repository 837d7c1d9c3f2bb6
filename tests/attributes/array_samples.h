#pragma once

#include <string>
#include <vector>

#include "attributes/array_coder.h"
#include "bspc/grid.h"

namespace bspc::test {

struct SampleArray {
  std::string name;
  attributes::ArrayShape shape;
  attributes::ArrayValues values;
};

/// Arrays of every type for the points: smooth, noisy, repeated, random, constant ones, and some
/// with NaN, infinities and negative zeros.
std::vector<SampleArray> sampleArrays(const std::vector<GridPoint>& points, std::uint64_t seed);

/// The directions from the middle of the points' box, as float32.
SampleArray sampleNormals(const std::vector<GridPoint>& points);

/// The tuples of the points order[0], order[1], …
attributes::ArrayValues reordered(const SampleArray& array,
                                  const std::vector<std::uint32_t>& order);

/// The first `tuples` tuples.
attributes::ArrayValues firstTuples(const SampleArray& array, std::size_t tuples);

}  // namespace bspc::test
