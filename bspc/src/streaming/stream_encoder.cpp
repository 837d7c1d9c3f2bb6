#include "bspc/stream_encoder.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "bspc/error.h"
#include "coding_plan.h"
#include "container/container_writer.h"
#include "grid/grid_fit.h"
#include "progress_scale.h"
#include "set_encoder.h"
#include "shared_progress.h"
#include "streaming/point_parts.h"
#include "streaming/stored_coordinates.h"

namespace bspc {

namespace {

constexpr std::uint64_t kLeastMemory = std::uint64_t{32} << 20;
/// What coding takes beside a set of grid points, by point, and what threads and buffers take.
constexpr std::uint64_t kCodingBytesPerPoint = 12;
constexpr std::uint64_t kFixedBytes = std::uint64_t{24} << 20;
/// Points that are read at a time.
constexpr std::size_t kPiece = std::size_t{1} << 16;

// Shares of the work that are done after each stage.
constexpr double kRead = 0.2;
constexpr double kGridKnown = 0.4;
constexpr double kCut = 0.55;

std::uint64_t memoryFor(const StreamOptions& options) {
  return std::max(options.memoryBytes, kLeastMemory) - kFixedBytes;
}

/// The first points of the stream, as many as can be coded in memory; `ended` if they are all.
struct FirstPoints {
  Bytes bytes;
  bool ended = false;
};

FirstPoints readFirst(PointReader& reader, const StreamOptions& options, ProgressScale& progress) {
  const std::size_t pointBytes = 3 * scalarSize(reader.type());
  const std::uint64_t most =
      memoryFor(options) / (pointBytes + sizeof(GridPoint) + kCodingBytesPerPoint);
  FirstPoints first;
  // Address space alone: memory is taken as points come.
  const std::uint64_t expected = reader.expected() != 0 ? reader.expected() + kPiece : most;
  first.bytes.reserve(static_cast<std::size_t>(std::min(most, expected)) * pointBytes);
  while (first.bytes.size() / pointBytes < most) {
    progress.report(0);
    const std::size_t before = first.bytes.size();
    first.bytes.resize(before + kPiece * pointBytes);
    const std::size_t got = reader.read(first.bytes.data() + before, {}, kPiece);
    first.bytes.resize(before + got * pointBytes);
    if (got == 0) {
      first.ended = true;
      break;
    }
  }
  return first;
}

/// The finite points of a stream in scratch storage.
class StoredSet {
 public:
  StoredSet(std::unique_ptr<ScratchStorage> storage, ScalarType type, bool dropNonFinite)
      : storage_(std::move(storage)), type_(type), dropNonFinite_(dropNonFinite) {}

  void append(ByteView bytes) {
    const std::size_t pointBytes = 3 * scalarSize(type_);
    const PointSetView view(bytes.data(), type_, bytes.size() / pointBytes, 0);
    lattice::requireIntegersInDoubles(view, size_ + dropped_);
    const lattice::FinitePoints finite =
        lattice::finitePoints(view, dropNonFinite_, size_ + dropped_);
    dropped_ += finite.dropped;
    size_ += view.size() - finite.dropped;
    if (finite.dropped == 0) return storage_->append(bytes);
    Bytes kept;
    for (const std::uint64_t i : finite.kept) {
      const std::uint8_t* at = bytes.data() + static_cast<std::size_t>(i) * pointBytes;
      kept.insert(kept.end(), at, at + pointBytes);
    }
    storage_->append(kept);
  }

  streaming::StoredCoordinates coordinates() const { return {*storage_, type_, size_}; }
  std::uint64_t size() const { return size_; }
  std::uint64_t dropped() const { return dropped_; }
  ScalarType type() const { return type_; }

 private:
  std::unique_ptr<ScratchStorage> storage_;
  ScalarType type_;
  bool dropNonFinite_;
  std::uint64_t size_ = 0;
  std::uint64_t dropped_ = 0;
};

void checkOptions(const StreamOptions& options) {
  if (!options.encoding.wantOrder) return;
  throw Error(ErrorCode::InvalidArgument,
              "the order of the points of a stream is not reported: it may not fit into memory");
}

class LargeSetEncoder {
 public:
  LargeSetEncoder(const StreamOptions& options, ByteSink& sink, ProgressScale& progress)
      : options_(options), sink_(sink), progress_(progress) {}

  EncodeReport run(FirstPoints first, PointReader& reader) {
    if (!options_.scratch) {
      throw Error(ErrorCode::LimitExceeded,
                  "the points do not fit into the memory limit of " +
                      std::to_string(options_.memoryBytes) +
                      " bytes, and there is no scratch storage; raise the limit");
    }
    if (options_.encoding.stopPoints > 0 || options_.encoding.stopLevel) {
      throw Error(ErrorCode::InvalidArgument,
                  "a lossy coding needs all points in memory to tell its error; raise the memory "
                  "limit");
    }
    lattice::validate(options_.encoding.grid);
    store(std::move(first), reader);
    report_.points = set_->size();
    report_.dropped = set_->dropped();
    chooseGrid();
    set_.reset();
    code();
    return std::move(report_);
  }

 private:
  void store(FirstPoints first, PointReader& reader) {
    const std::size_t pointBytes = 3 * scalarSize(reader.type());
    set_ = std::make_unique<StoredSet>(options_.scratch(), reader.type(),
                                       options_.encoding.grid.dropNonFinite);
    for (std::size_t at = 0; at < first.bytes.size(); at += kPiece * pointBytes) {
      const std::size_t size = std::min(kPiece * pointBytes, first.bytes.size() - at);
      set_->append(ByteView(first.bytes).subspan(at, size));
      progress_.report(0);
    }
    first.bytes = {};
    Bytes piece(kPiece * pointBytes);
    for (;;) {
      progress_.report(0);
      piece.resize(kPiece * pointBytes);
      const std::size_t got = reader.read(piece.data(), {}, kPiece);
      if (got == 0) break;
      piece.resize(got * pointBytes);
      set_->append(piece);
    }
    progress_.report(kRead);
  }

  void chooseGrid() {
    if (set_->size() == 0) {
      report_.grid = lattice::emptyGrid(set_->type(), options_.encoding.grid);
      parts_ = std::make_unique<streaming::PointParts>(tiling::DyadicBox(), 1);
      parts_->cut(nullptr, 0);
      return;
    }
    const streaming::StoredCoordinates coordinates = set_->coordinates();
    const lattice::Ranges ranges = lattice::rangesOf(coordinates);
    const lattice::PlacedGrid placed =
        lattice::placedGrid(coordinates, ranges, options_.encoding.grid);
    report_.grid = placed.grid;
    progress_.report(kGridKnown);
    countParts(coordinates, ranges, placed.exact);
    if (lattice::needsDoubles(report_.grid, report_.maxError, options_.encoding.grid)) {
      report_.grid.scalarType = ScalarType::Float64;
      lattice::placeBases(report_.grid, ranges);
      countParts(coordinates, ranges, false);
    }
    report_.exact = report_.maxError == std::array<double, 3>{};
    parts_->cut(options_.scratch(), memoryFor(options_) / 8);
    lattice::quantise(
        coordinates, ranges, {report_.grid, placed.exact},
        [this](std::uint64_t, Span<const GridPoint> points) { parts_->store(points); },
        [this](double) { progress_.report(kGridKnown); });
    parts_->flush();
    progress_.report(kCut);
  }

  void countParts(const lattice::Coordinates& coordinates, const lattice::Ranges& ranges,
                  bool exact) {
    parts_ = std::make_unique<streaming::PointParts>(gridBox(ranges), partPoints());
    report_.maxError = lattice::quantise(
        coordinates, ranges, {report_.grid, exact},
        [this](std::uint64_t, Span<const GridPoint> points) { parts_->count(points); },
        [this](double) { progress_.report(kGridKnown); });
  }

  std::uint64_t partPoints() const {
    return std::min<std::uint64_t>(memoryFor(options_) / (sizeof(GridPoint) + kCodingBytesPerPoint),
                                   std::uint64_t{1} << 31);
  }

  tiling::DyadicBox gridBox(const lattice::Ranges& ranges) const {
    GridPoint upper{};
    for (std::size_t k = 0; k < 3; ++k) upper[k] = lattice::topIndex(report_.grid, k, ranges[k]);
    return tiling::dyadicBox({}, upper);
  }

  void code() {
    const CodingPlan plan = planCoding(options_.encoding, report_.points);
    report_.method = plan.method->id();
    report_.layout = Layout::Streaming;
    report_.layers = plan.layers;
    container::FileHead head;
    head.layers = plan.layers;
    head.grid = report_.grid;
    container::ContainerWriter writer(sink_, Layout::Streaming, std::move(head));
    ProgressScale coding(options_.encoding.progress, kCut, 1);
    SharedProgress progress(coding, report_.points);
    SetEncoder encoder(plan, options_.encoding, {}, progress, writer, report_);
    const std::uint64_t most = partPoints();
    for (std::size_t part = 0; part < parts_->parts(); ++part) {
      for (std::uint64_t first = 0; first < parts_->size(part); first += most) {
        const std::uint64_t count = std::min(most, parts_->size(part) - first);
        encoder.encode(parts_->load(part, first, count), {}, nullptr);
      }
    }
    writer.finish();
    report_.fileBytes = writer.bytesWritten();
    coding.report(1);
  }

  const StreamOptions& options_;
  ByteSink& sink_;
  ProgressScale& progress_;
  std::unique_ptr<StoredSet> set_;
  std::unique_ptr<streaming::PointParts> parts_;
  EncodeReport report_;
};

/// What is not wired up yet is refused rather than dropped.
void refuseArrays(const PointReader& points) {
  if (points.arrays().empty()) return;
  throw Error(ErrorCode::Unsupported, "the stream has the array \"" + points.arrays()[0].name +
                                          "\", and this version stores positions only; leave "
                                          "the arrays out to store the positions");
}

}  // namespace

const std::vector<ArrayDescription>& PointReader::arrays() const {
  static const std::vector<ArrayDescription> none;
  return none;
}

EncodeReport encodeStream(PointReader& points, ByteSink& sink, const StreamOptions& options) {
  checkOptions(options);
  refuseArrays(points);
  planCoding(options.encoding, 0);  // wishes that cannot be met are refused before any work
  ProgressScale progress(options.encoding.progress, 0, 1);
  FirstPoints first = readFirst(points, options, progress);
  if (!first.ended) return LargeSetEncoder(options, sink, progress).run(std::move(first), points);
  const std::size_t pointBytes = 3 * scalarSize(points.type());
  const PointSetView view(first.bytes.data(), points.type(), first.bytes.size() / pointBytes, 0);
  return encode(view, sink, options.encoding);
}

}  // namespace bspc
