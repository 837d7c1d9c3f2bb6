#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "bspc/arrays.h"
#include "bspc/encoder.h"
#include "bspc/io.h"
#include "bspc/scalar_type.h"

namespace bspc {

/// Points that come one after the other, from a file larger than memory or from a computation.
class PointReader {
 public:
  virtual ~PointReader() = default;
  virtual ScalarType type() const = 0;
  /// The arrays beside the positions; known before the first read and the same from then on.
  virtual const std::vector<ArrayDescription>& arrays() const;
  /// Writes up to `count` points to `xyz`, three packed numbers of type() each, and appends their
  /// tuples to `values`, which has one array for each of arrays(); returns how many points, 0 only
  /// at the end.
  virtual std::size_t read(std::uint8_t* xyz, Span<ArrayValues> values, std::size_t count) = 0;
  /// Points still to come if that is known, else 0; nothing relies on it.
  virtual std::uint64_t expected() const { return 0; }
};

/// Storage for what does not fit into memory, such as a temporary file; gone when destroyed.
/// Implementations throw Error(Io).
class ScratchStorage : public ByteSource {
 public:
  virtual void append(ByteView bytes) = 0;
};
using ScratchFactory = std::function<std::unique_ptr<ScratchStorage>()>;

struct StreamOptions {
  EncodeOptions encoding;  ///< wantOrder is not possible
  /// The encoder's own memory, in bytes, is about this at most; at least 32 MiB are taken. A set
  /// that fits is coded as by encode().
  std::uint64_t memoryBytes = std::uint64_t{1} << 30;
  /// Makes storage for larger sets, which need their size in grid points, coordinates and twice
  /// their arrays together; without it they are Error(LimitExceeded), and with arrays of strings
  /// Error(Unsupported).
  ScratchFactory scratch;
};

/// Compresses points as they come. A set that does not fit into memory is kept in scratch storage
/// until its grid is known, then cut into parts that fit; its file has the streaming layout.
/// Throws Error as encode() does.
EncodeReport encodeStream(PointReader& points, ByteSink& sink, const StreamOptions& options);

}  // namespace bspc
