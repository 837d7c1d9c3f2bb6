#pragma once

#include <string>
#include <vector>

#include "bspc/encoder.h"
#include "bspc/mesh.h"

namespace bspc::test {

/// A file whose bytes are fixed: made here from integers alone, kept in Testing/Data.
struct GoldenFile {
  std::string name;  ///< without ending
  std::vector<double> xyz;
  ScalarType type = ScalarType::Float64;
  EncodeOptions options;
  std::vector<ArrayValues> arrays;  ///< in the order of the points
  MeshCells cells;                  ///< faces only
  std::vector<ArrayValues> cellArrays;
};

std::vector<GoldenFile> goldenFiles();

/// The file of that name as today's encoder writes it: in Testing/Data/golden, or, if it has
/// written the same since version 1.0 of the format, in Testing/Data/frozen_1.0.
std::string goldenPath(const std::string& name);
Bytes readGolden(const std::string& path);

/// What a decoder gives back.
struct DecodedOrder {
  std::vector<double> xyz;
  std::vector<std::string> tuples;      ///< of all arrays together, one a point
  std::vector<std::string> cellTuples;  ///< likewise, one a cell
  std::vector<std::uint64_t> points;    ///< input index of each
  std::vector<std::uint64_t> cells;     ///< likewise
};

/// The bytes that this build's encoder makes of it, and its points in the order of the decoder.
Bytes encodeGolden(const GoldenFile& file, DecodedOrder* decoded);

}  // namespace bspc::test
