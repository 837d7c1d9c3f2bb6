#pragma once

#include <cstdint>
#include <vector>

#include "bspc/stream_encoder.h"
#include "grid/coordinates.h"

namespace bspc::streaming {

/// Coordinates in scratch storage: three packed numbers a point. Reads a block at a time.
class StoredCoordinates final : public lattice::Coordinates {
 public:
  /// `storage` must outlive this and hold `size` points.
  StoredCoordinates(ByteSource& storage, ScalarType type, std::uint64_t size)
      : Coordinates(type, size), storage_(storage), pointBytes_(3 * scalarSize(type)) {}

  void gather(std::size_t axis, std::uint64_t first, std::size_t count, double* out,
              std::uint64_t hop) const override;

 private:
  static constexpr std::uint64_t kBlockPoints = std::uint64_t{1} << 15;

  /// The points first … first + count − 1, which lie in one block, as a view of it.
  PointSetView blockOf(std::uint64_t first, std::size_t count) const;

  ByteSource& storage_;
  std::size_t pointBytes_;
  mutable Bytes block_;
  mutable std::uint64_t blockFirst_ = 0;
  mutable std::uint64_t blockCount_ = 0;
};

}  // namespace bspc::streaming
