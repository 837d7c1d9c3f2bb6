#pragma once

#include <string>
#include <vector>

#include "bspc/encoder.h"
#include "bspc/mesh.h"

namespace bspc::test {

/// A file whose bytes are fixed: made here from integers alone, kept in Testing/Data/golden.
struct GoldenFile {
  std::string name;  ///< without ending
  std::vector<double> xyz;
  ScalarType type = ScalarType::Float64;
  EncodeOptions options;
  std::vector<ArrayValues> arrays;  ///< in the order of the points
  MeshCells cells;                  ///< faces only
};

std::vector<GoldenFile> goldenFiles();

/// What a decoder gives back.
struct DecodedOrder {
  std::vector<double> xyz;
  std::vector<std::string> tuples;    ///< of all arrays together, one a point
  std::vector<std::uint64_t> points;  ///< input index of each
  std::vector<std::uint64_t> cells;   ///< likewise
};

/// The bytes that this build's encoder makes of it, and its points in the order of the decoder.
Bytes encodeGolden(const GoldenFile& file, DecodedOrder* decoded);

}  // namespace bspc::test
