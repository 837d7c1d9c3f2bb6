#pragma once

#include <cstdint>
#include <memory>

#include "bspc/stream_encoder.h"
#include "streaming/record_layout.h"
#include "streaming/stored_coordinates.h"

namespace bspc::streaming {

/// The finite points of a stream in scratch storage, with what belongs to them.
class StoredSet {
 public:
  /// `records` must outlive this.
  StoredSet(const ScratchFactory& scratch, ScalarType type, const RecordLayout& records,
            bool dropNonFinite);

  /// Takes a piece of the stream: positions, and the tuples of each array from `firstTuple` on.
  /// Throws Error(NonFinite) unless such points are dropped.
  void append(ByteView positions, Span<const ArrayValues> values, std::size_t firstTuple = 0);

  StoredCoordinates coordinates() const { return {*positions_, type_, size_}; }
  /// The records of the points first … first + count − 1, one after the other.
  Bytes records(std::uint64_t first, std::size_t count) const;
  std::uint64_t size() const { return size_; }
  std::uint64_t dropped() const { return dropped_; }
  ScalarType type() const { return type_; }

 private:
  const RecordLayout& layout_;
  std::unique_ptr<ScratchStorage> positions_;
  std::unique_ptr<ScratchStorage> records_;  ///< null if records have no bytes
  ScalarType type_;
  bool dropNonFinite_;
  std::uint64_t size_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace bspc::streaming
