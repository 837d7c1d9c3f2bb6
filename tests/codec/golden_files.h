#pragma once

#include <string>
#include <vector>

#include "bspc/encoder.h"

namespace bspc::test {

/// A file whose bytes are fixed: made here from integers alone, kept in Testing/Data/golden.
struct GoldenFile {
  std::string name;  ///< without ending
  std::vector<double> xyz;
  ScalarType type = ScalarType::Float64;
  EncodeOptions options;
};

std::vector<GoldenFile> goldenFiles();

/// The bytes that this build's encoder makes of it, and the points in the order of the decoder.
Bytes encodeGolden(const GoldenFile& file, std::vector<double>* decodedOrder);

}  // namespace bspc::test
