#pragma once

#include <cstdint>

#include "bspc/stream_encoder.h"

namespace bspc::streaming {

/// encodeStream() with exactly `pointBytes` of memory for points and what coding them takes,
/// however few: so that tests need not have many points for some of them not to fit.
EncodeReport encodeStreamWithin(std::uint64_t pointBytes, PointReader& points, ByteSink& sink,
                                const StreamOptions& options);

}  // namespace bspc::streaming
