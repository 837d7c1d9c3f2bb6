#include "bspc/part_encoder.h"

#include <memory>
#include <string>
#include <utility>

#include "bspc/error.h"
#include "coding_plan.h"
#include "container/block.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"
#include "container/container_reader.h"
#include "container/container_writer.h"
#include "grid/grid_fit.h"
#include "joined_head.h"
#include "parts/part_description.h"

namespace bspc {

namespace {

/// What frameParts() needs of a part.
struct PartSummary {
  Bytes head;     ///< the content of the head block
  Bytes records;  ///< of its tiles, as they stand in the index
  std::uint64_t tiles = 0;
  std::uint64_t points = 0;
  std::uint64_t bytes = 0;  ///< of its tiles in the file

  Bytes write() const {
    container::ByteWriter out;
    out.varint(head.size());
    out.bytes(head);
    out.varint(records.size());
    out.bytes(records);
    out.varint(tiles);
    out.varint(points);
    out.varint(bytes);
    return out.take();
  }

  static PartSummary read(ByteView message) {
    container::ByteReader in(message, "the summary of a part", container::ByteReader::kNoOffset);
    const auto block = [&in] {
      const ByteView view = in.bytes(in.varint());
      return Bytes(view.begin(), view.end());
    };
    PartSummary part;
    part.head = block();
    part.records = block();
    part.tiles = in.varint();
    part.points = in.varint();
    part.bytes = in.varint();
    in.expectEnd();
    return part;
  }
};

/// Takes a file in the streaming layout apart.
FilePart partOf(Bytes file) {
  MemorySource source(file);
  const std::uint64_t first =
      container::readBlock(source, container::kPreambleSize, container::kPreambleSize, "the head")
          .end;
  const container::ContainerReader reader(std::make_shared<MemorySource>(file), OpenOptions{});
  PartSummary summary;
  container::ByteWriter records;
  for (std::size_t tile = 0; tile < reader.tiles().size(); ++tile) {
    const container::TileRecord& record = reader.tiles()[tile];
    container::writeTileRecord(records, reader.layout(), record);
    summary.points += record.points;
    summary.bytes += reader.bytesOfRecord(tile);
    for (std::size_t column = 0; column < reader.layout().columns(); ++column) {
      summary.bytes += reader.bytesOfChunk(tile, column);
    }
  }
  summary.tiles = reader.tiles().size();
  summary.records = records.take();
  summary.head = container::writeHead(reader.head());
  FilePart part;
  part.summary = summary.write();
  file.resize(static_cast<std::size_t>(first + summary.bytes));
  file.erase(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(first));
  part.tiles = std::move(file);
  return part;
}

container::FileHead headOfPart(const PartSummary& part) {
  container::ByteReader in(part.head, "the head of a part", container::ByteReader::kNoOffset);
  return container::readHead(in, DecodeLimits{});
}

/// The head of all parts: they have the same but for their metadata. A part without points may
/// know nothing of the arrays of the others; its head counts only where no part has points.
class FrameHead {
 public:
  void take(std::size_t index, const PartSummary& part) {
    container::FileHead head = headOfPart(part);
    if (part.tiles == 0) {
      if (!any_) head_ = std::move(head);
      return;
    }
    metadata_.take(index, head.metadata);
    tables_.take(index, head);
    head.metadata = {};
    if (any_ && container::writeHead(head) != container::writeHead(head_)) {
      throw Error(ErrorCode::InvalidArgument,
                  "part " + std::to_string(index) +
                      " was encoded with other options than those before it, or its arrays stand "
                      "in another order; encode all parts with what agreeOnParts() returns");
    }
    any_ = true;
    head_ = std::move(head);
  }

  container::FileHead finish() {
    if (any_) head_.metadata = metadata_.metadata();
    return std::move(head_);
  }

 private:
  bool any_ = false;
  container::FileHead head_;
  JoinedTables tables_;
  JoinedMetadata metadata_;
};

}  // namespace

Bytes describePart(const PointSetView& points, const EncodeOptions& options) {
  lattice::validate(options.grid);
  lattice::requireIntegersInDoubles(points);
  const lattice::FinitePoints finite = lattice::finitePoints(points, options.grid.dropNonFinite);
  parts::PartDescription part;
  part.points = points.size() - finite.dropped;
  part.type = points.type();
  if (part.points == 0) return part.write();
  const lattice::ViewCoordinates coordinates(points, finite.kept);
  part.ranges = lattice::rangesOf(coordinates);
  if (options.grid.kind == GridRequest::Kind::Automatic) {
    const lattice::PlacedGrid placed = lattice::placedGrid(coordinates, part.ranges, options.grid);
    if (placed.exact) part.lattice = placed.grid;
  }
  return part.write();
}

EncodeOptions agreeOnParts(const std::vector<Bytes>& descriptions, const EncodeOptions& options) {
  if (options.originalIds) {
    throw Error(ErrorCode::InvalidArgument,
                "original ids are not possible for a file that several write together: no part "
                "knows how many points come before its own; leave them out");
  }
  std::vector<parts::PartDescription> parts;
  std::uint64_t points = 0;
  for (const Bytes& description : descriptions) {
    parts.push_back(parts::PartDescription::read(description));
    points += parts.back().points;
  }
  EncodeOptions agreed = options;
  const bool dropNonFinite = options.grid.dropNonFinite;
  agreed.grid = GridRequest::onGrid(agreedGrid(parts, options.grid));
  agreed.grid.keepBase = true;
  agreed.grid.dropNonFinite = dropNonFinite;
  agreed.layout = Layout::Streaming;
  const CodingPlan plan = planCoding(options, points);
  agreed.tilePoints = plan.tilePoints;
  agreed.layers = plan.layers;
  if (!options.method) {
    agreed.effort = plan.wishes.effort;
  }
  return agreed;
}

FilePart encodePart(const PointSetView& points, const EncodeOptions& agreed) {
  if (points.mesh() != nullptr && !points.mesh()->empty()) {
    throw Error(ErrorCode::Unsupported,
                "several processes cannot write the cells of a mesh together; write a file each "
                "and join them");
  }
  MemorySink sink;
  const EncodeReport report = encode(points, sink, agreed);
  FilePart part = partOf(sink.take());
  part.report = report;
  return part;
}

FileFrame frameParts(const std::vector<Bytes>& summaries) {
  FrameHead frameHead;
  std::vector<PartSummary> parts;
  for (const Bytes& summary : summaries) {
    parts.push_back(PartSummary::read(summary));
    frameHead.take(parts.size() - 1, parts.back());
  }
  FileFrame frame;
  frame.head = container::fileStart(frameHead.finish());
  frame.endOffset = frame.head.size();
  Bytes records;
  for (const PartSummary& part : parts) {
    frame.offsets.push_back(frame.endOffset);
    frame.endOffset += part.bytes;
    frame.tiles += part.tiles;
    frame.points += part.points;
    records.insert(records.end(), part.records.begin(), part.records.end());
  }
  container::ByteWriter index;
  index.varint(frame.tiles);
  index.bytes(records);
  frame.end = container::fileEnd(index.data(), frame.endOffset);
  return frame;
}

}  // namespace bspc
