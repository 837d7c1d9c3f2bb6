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

}  // namespace

PointParts::PointParts(const tiling::DyadicBox& box, std::uint64_t partPoints,
                       std::size_t recordBytes)
    : code_(box, kLevels),
      partPoints_(partPoints),
      recordBytes_(recordBytes),
      bytesPerPoint_(sizeof(GridPoint) + recordBytes),
      counts_(code_.cells()) {}

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
      bufferBytes / bytesPerPoint_ / std::max<std::size_t>(parts_.size(), 1);
  blockPoints_ = static_cast<std::size_t>(std::clamp(share, kLeastBlockPoints, kMostBlockPoints));
}

void PointParts::keepTogether(std::unique_ptr<ScratchStorage> storage) {
  together_ = true;
  counts_ = {};
  storage_ = std::move(storage);
  parts_.resize(1);
  blockPoints_ = kMostBlockPoints;
}

void PointParts::store(Span<const GridPoint> points, ByteView records) {
  const std::uint8_t* record = records.data();
  for (const GridPoint& p : points) {
    Part& part = together_ ? parts_[0] : parts_[groups_.groupOf[code_(p)]];
    if (together_) ++part.points;
    add(part, p, record);
    record += recordBytes_;
  }
}

void PointParts::add(Part& part, const GridPoint& point, const std::uint8_t* record) {
  if (part.waiting.empty()) part.waiting.reserve(blockPoints_ * bytesPerPoint_);
  const std::size_t at = part.waiting.size();
  part.waiting.resize(at + bytesPerPoint_);
  std::memcpy(part.waiting.data() + at, point.data(), sizeof point);
  if (recordBytes_ > 0) {
    std::memcpy(part.waiting.data() + at + sizeof point, record, recordBytes_);
  }
  if (part.waiting.size() == blockPoints_ * bytesPerPoint_) write(part);
}

void PointParts::flush() {
  for (Part& part : parts_) {
    if (!part.waiting.empty()) write(part);
    part.waiting = {};
  }
}

void PointParts::write(Part& part) {
  part.blocks.push_back(storage_->size());
  storage_->append(part.waiting);
  part.waiting.clear();
}

PartPoints PointParts::load(std::size_t part, std::uint64_t first, std::uint64_t count) const {
  PartPoints loaded;
  loaded.points.resize(static_cast<std::size_t>(count));
  loaded.records.resize(static_cast<std::size_t>(count) * recordBytes_);
  Bytes block;
  std::size_t done = 0;
  while (done < count) {
    const std::uint64_t at = first + done;
    const std::uint64_t inBlock = at % blockPoints_;
    const auto piece = static_cast<std::size_t>(std::min(count - done, blockPoints_ - inBlock));
    block.resize(piece * bytesPerPoint_);
    storage_->read(
        parts_[part].blocks[static_cast<std::size_t>(at / blockPoints_)] + inBlock * bytesPerPoint_,
        block);
    for (std::size_t i = 0; i < piece; ++i) {
      const std::uint8_t* from = block.data() + i * bytesPerPoint_;
      std::memcpy(loaded.points[done + i].data(), from, sizeof(GridPoint));
      if (recordBytes_ == 0) continue;
      std::memcpy(loaded.records.data() + (done + i) * recordBytes_, from + sizeof(GridPoint),
                  recordBytes_);
    }
    done += piece;
  }
  return loaded;
}

}  // namespace bspc::streaming
