#include "streaming/stored_coordinates.h"

#include <algorithm>

namespace bspc::streaming {

PointSetView StoredCoordinates::blockOf(std::uint64_t first, std::size_t count) const {
  const std::uint64_t block = first / kBlockPoints * kBlockPoints;
  if (blockCount_ == 0 || block != blockFirst_) {
    blockFirst_ = block;
    blockCount_ = std::min(kBlockPoints, size() - block);
    block_.resize(static_cast<std::size_t>(blockCount_) * pointBytes_);
    storage_.read(block * pointBytes_, block_);
  }
  return {block_.data() + static_cast<std::size_t>(first - blockFirst_) * pointBytes_, type(),
          count, 0};
}

void StoredCoordinates::gather(std::size_t axis, std::uint64_t first, std::size_t count,
                               double* out, std::uint64_t hop) const {
  static const std::vector<std::uint64_t> kAll;
  // Points that lie far apart are read alone: a block for each would be a waste.
  if (hop > 1) {
    Bytes point(pointBytes_);
    for (std::size_t i = 0; i < count; ++i) {
      storage_.read((first + i * hop) * pointBytes_, point);
      const PointSetView view(point.data(), type(), 1, 0);
      lattice::ViewCoordinates(view, kAll).gather(axis, 0, 1, out + i, 1);
    }
    return;
  }
  while (count > 0) {
    const std::uint64_t left = kBlockPoints - first % kBlockPoints;
    const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(count, left));
    const PointSetView view = blockOf(first, piece);
    lattice::ViewCoordinates(view, kAll).gather(axis, 0, piece, out, 1);
    first += piece;
    out += piece;
    count -= piece;
  }
}

}  // namespace bspc::streaming
