#include "streaming/point_parts.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace bspc::streaming {

namespace {

/// Levels of the partition that are counted: 8 MiB of counts.
constexpr unsigned kLevels = 20;
/// Points are written in blocks of so many at the most, and not fewer than this.
constexpr std::uint64_t kMostBlockPoints = std::uint64_t{1} << 16;
constexpr std::uint64_t kLeastBlockPoints = 256;

ByteView bytesOf(const std::vector<GridPoint>& points) {
  return {reinterpret_cast<const std::uint8_t*>(points.data()), points.size() * sizeof(GridPoint)};
}

}  // namespace

PointParts::PointParts(const tiling::DyadicBox& box, std::uint64_t partPoints)
    : code_(box, kLevels), partPoints_(partPoints), counts_(code_.cells()) {}

void PointParts::count(Span<const GridPoint> points) {
  for (const GridPoint& p : points) ++counts_[code_(p)];
}

void PointParts::cut(std::unique_ptr<ScratchStorage> storage, std::uint64_t bufferBytes) {
  groups_ = tiling::groupCells(counts_, partPoints_);
  counts_ = {};
  storage_ = std::move(storage);
  parts_.resize(groups_.sizes.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) parts_[i].points = groups_.sizes[i];
  const std::uint64_t share =
      bufferBytes / sizeof(GridPoint) / std::max<std::size_t>(parts_.size(), 1);
  blockPoints_ = static_cast<std::size_t>(std::clamp(share, kLeastBlockPoints, kMostBlockPoints));
}

void PointParts::store(Span<const GridPoint> points) {
  for (const GridPoint& p : points) {
    Part& part = parts_[groups_.groupOf[code_(p)]];
    if (part.waiting.empty()) part.waiting.reserve(blockPoints_);
    part.waiting.push_back(p);
    if (part.waiting.size() == blockPoints_) write(part);
  }
}

void PointParts::flush() {
  for (Part& part : parts_) {
    if (!part.waiting.empty()) write(part);
    part.waiting = {};
  }
}

void PointParts::write(Part& part) {
  part.blocks.push_back(storage_->size());
  storage_->append(bytesOf(part.waiting));
  part.waiting.clear();
}

std::vector<GridPoint> PointParts::load(std::size_t part, std::uint64_t first,
                                        std::uint64_t count) const {
  std::vector<GridPoint> points(static_cast<std::size_t>(count));
  auto* to = reinterpret_cast<std::uint8_t*>(points.data());
  while (count > 0) {
    const std::uint64_t inBlock = first % blockPoints_;
    const std::uint64_t piece = std::min(count, blockPoints_ - inBlock);
    const auto bytes = static_cast<std::size_t>(piece) * sizeof(GridPoint);
    storage_->read(parts_[part].blocks[static_cast<std::size_t>(first / blockPoints_)] +
                       inBlock * sizeof(GridPoint),
                   Span<std::uint8_t>(to, bytes));
    to += bytes;
    first += piece;
    count -= piece;
  }
  return points;
}

}  // namespace bspc::streaming
