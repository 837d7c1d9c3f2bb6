#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmark_support.h"
#include "bspc/encoder.h"
#include "bspc/span.h"

namespace bspc::bench {

/// Something that turns points into bytes and back, in memory. Both throw std::exception.
struct Codec {
  std::string name;
  bool usesThreads = false;  ///< whether it takes heed of the number of threads
  std::function<Bytes(const Coordinates& xyz, unsigned threads)> encode;
  std::function<Coordinates(const Bytes& bytes, unsigned threads)> decode;
};

/// .bspc; the number of threads stands instead of that in the options.
Codec bspcCodec(const std::string& name, const EncodeOptions& options);

enum class DracoMethod { KdTree, Sequential };

/// Draco's coder of point clouds at a speed of 0 (smallest) to 10. It takes whole numbers as they
/// are.
Codec dracoCodec(DracoMethod method, int speed);

/// VTK's XML polydata, raw and appended, with every compressor that VTK has; positions in single
/// precision where that holds them.
std::vector<Codec> vtpCodecs();

/// zstd and xz on the sorted points, each coordinate as its difference from the point before, in
/// planes of bytes.
std::vector<Codec> generalCodecs();

}  // namespace bspc::bench
