#include "bspc/stream_encoder.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "arrays/array_checks.h"
#include "arrays/array_source.h"
#include "arrays/low_halves.h"
#include "bspc/error.h"
#include "coding_plan.h"
#include "container/container_writer.h"
#include "encoded_head.h"
#include "grid/float_grid.h"
#include "grid/grid_fit.h"
#include "progress_scale.h"
#include "set_encoder.h"
#include "shared_progress.h"
#include "streaming/point_parts.h"
#include "streaming/record_layout.h"
#include "streaming/stored_coordinates.h"
#include "streaming/stored_set.h"
#include "streaming/stream_coding.h"

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

/// Points of a stream that are in memory.
struct PointsInMemory {
  Bytes positions;
  std::vector<ArrayValues> values;
};

/// Reads a stream piece by piece.
class PieceReader {
 public:
  explicit PieceReader(PointReader& reader)
      : reader_(reader), pointBytes_(3 * scalarSize(reader.type())) {}

  std::size_t pointBytes() const { return pointBytes_; }
  /// Bytes of a point in memory with its tuples, but without the characters of strings.
  std::size_t rowBytes() const {
    std::size_t bytes = pointBytes_;
    for (const ArrayDescription& array : reader_.arrays()) {
      bytes += array.components * arrayValueSize(array.type);
    }
    return bytes;
  }
  /// Arrays without values.
  std::vector<ArrayValues> noValues() const {
    std::vector<ArrayValues> values(reader_.arrays().size());
    for (std::size_t a = 0; a < values.size(); ++a) {
      static_cast<ArrayDescription&>(values[a]) = reader_.arrays()[a];
    }
    return values;
  }
  /// Appends points; how many, 0 at the end.
  std::size_t append(PointsInMemory& points) {
    const std::size_t before = points.positions.size();
    points.positions.resize(before + kPiece * pointBytes_);
    const std::size_t got = reader_.read(points.positions.data() + before, points.values, kPiece);
    points.positions.resize(before + got * pointBytes_);
    for (const ArrayValues& array : points.values) {
      if (array.tuples() == points.positions.size() / pointBytes_) continue;
      throw Error(
          ErrorCode::InvalidArgument,
          "a reader of points gave other tuples of the array \"" + array.name + "\" than points");
    }
    return got;
  }

 private:
  PointReader& reader_;
  std::size_t pointBytes_;
};

/// The first points of the stream, as many as can be coded in memory.
struct FirstPoints {
  PointsInMemory points;
  bool ended = false;  ///< they are all
};

FirstPoints readFirst(PointReader& reader, std::uint64_t pointBytes, ProgressScale& progress) {
  PieceReader pieces(reader);
  const std::size_t tupleBytes = pieces.rowBytes() - pieces.pointBytes();
  // Values are copied once more where a tile is coded.
  const std::uint64_t most =
      pointBytes / (pieces.rowBytes() + tupleBytes + sizeof(GridPoint) + kCodingBytesPerPoint);
  FirstPoints first;
  first.points.values = pieces.noValues();
  // Address space alone: memory is taken as points come.
  const std::uint64_t expected = reader.expected() != 0 ? reader.expected() + kPiece : most;
  const auto reserved = static_cast<std::size_t>(std::min(most, expected));
  first.points.positions.reserve(reserved * pieces.pointBytes());
  for (ArrayValues& array : first.points.values) {
    if (array.type == ScalarType::String) continue;
    array.values.reserve(reserved * array.components * arrayValueSize(array.type));
  }
  while (first.points.positions.size() / pieces.pointBytes() < most) {
    progress.report(0);
    if (pieces.append(first.points) > 0) continue;
    first.ended = true;
    break;
  }
  return first;
}

void checkOptions(const StreamOptions& options) {
  if (!options.encoding.wantOrder) return;
  throw Error(ErrorCode::InvalidArgument,
              "the order of the points of a stream is not reported: it may not fit into memory");
}

class LargeSetEncoder {
 public:
  LargeSetEncoder(const StreamOptions& options, std::uint64_t pointBytes, ByteSink& sink,
                  ProgressScale& progress)
      : options_(options), pointBytes_(pointBytes), sink_(sink), progress_(progress) {}

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
    records_ =
        std::make_unique<streaming::RecordLayout>(reader.arrays(), options_.encoding.originalIds);
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
    set_ = std::make_unique<streaming::StoredSet>(options_.scratch, reader.type(), *records_,
                                                  options_.encoding.grid.dropNonFinite);
    PieceReader pieces(reader);
    const ByteView all = first.points.positions;
    const std::size_t step = kPiece * pieces.pointBytes();
    for (std::size_t at = 0; at < all.size(); at += step) {
      set_->append(all.subspan(at, std::min(step, all.size() - at)), first.points.values,
                   at / pieces.pointBytes());
      progress_.report(0);
    }
    first = {};
    for (;;) {
      PointsInMemory piece{{}, pieces.noValues()};
      progress_.report(0);
      if (pieces.append(piece) == 0) break;
      set_->append(piece.positions, piece.values);
    }
    progress_.report(kRead);
  }

  void chooseGrid() {
    if (set_->size() == 0) {
      report_.grid = lattice::emptyGrid(set_->type(), options_.encoding.grid);
      parts_ = std::make_unique<streaming::PointParts>(tiling::DyadicBox(), 1, 0);
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
    storeParts(coordinates, ranges, placed.exact);
    progress_.report(kCut);
  }

  void storeParts(const lattice::Coordinates& coordinates, const lattice::Ranges& ranges,
                  bool exact) {
    if (options_.encoding.keepOrder) {
      parts_->keepTogether(options_.scratch());
    } else {
      parts_->cut(options_.scratch(), pointBytes_ / 8);
    }
    lattice::quantise(
        coordinates, ranges, {report_.grid, exact},
        [&](std::uint64_t first, Span<const GridPoint> points) {
          parts_->store(points, recordsOf(coordinates, first, points.size()));
        },
        [this](double) { progress_.report(kGridKnown); });
    parts_->flush();
  }

  /// What is stored beside grid points: their low halves, if the grid has such, and their tuples.
  const Bytes& recordsOf(const lattice::Coordinates& coordinates, std::uint64_t first,
                         std::size_t count) {
    if (recordBytes() == 0) return piece_;
    const std::size_t tuples = records_->bytes();
    if (first < pieceFirst_ || first + count > pieceFirst_ + pieceCount_) {
      pieceFirst_ = first;
      pieceCount_ = static_cast<std::size_t>(std::min<std::uint64_t>(kPiece, set_->size() - first));
      tuples_ = set_->records(first, pieceCount_);
    }
    const std::uint8_t* from = tuples_.data() + (first - pieceFirst_) * tuples;
    if (!lattice::hasLowHalves(report_.grid)) {
      piece_.assign(from, from + count * tuples);
      return piece_;
    }
    std::vector<GridPoint> halves(count);
    lattice::lowHalves(coordinates, first, count, halves.data());
    piece_.resize(count * recordBytes());
    for (std::size_t i = 0; i < count; ++i) {
      std::uint8_t* to = piece_.data() + i * recordBytes();
      std::memcpy(to, halves[i].data(), sizeof(GridPoint));
      if (tuples > 0) std::memcpy(to + sizeof(GridPoint), from + i * tuples, tuples);
    }
    return piece_;
  }

  std::size_t hiddenBytes() const {
    return lattice::hasLowHalves(report_.grid) ? sizeof(GridPoint) : 0;
  }
  std::size_t recordBytes() const { return hiddenBytes() + records_->bytes(); }

  /// The arrays in the records of a part.
  std::vector<ArrayView> viewsOf(const streaming::PartPoints& part) const {
    const std::uint8_t* records = part.records.data();
    std::vector<ArrayView> views = records_->views(
        records == nullptr ? nullptr : records + hiddenBytes(), recordBytes(), part.points.size());
    if (hiddenBytes() == 0) return views;
    ArrayView halves = lowHalvesView({});
    halves.tuples = part.points.size();
    halves.data = records;
    halves.strideBytes = recordBytes();
    views.insert(views.begin(), halves);
    return views;
  }

  void countParts(const lattice::Coordinates& coordinates, const lattice::Ranges& ranges,
                  bool exact) {
    parts_ = std::make_unique<streaming::PointParts>(gridBox(ranges), partPoints(), recordBytes());
    report_.maxError = lattice::quantise(
        coordinates, ranges, {report_.grid, exact},
        [this](std::uint64_t, Span<const GridPoint> points) { parts_->count(points); },
        [this](double) { progress_.report(kGridKnown); });
  }

  std::uint64_t partPoints() const {
    // Records are copied once more where a tile is coded.
    const std::size_t bytes = sizeof(GridPoint) + 2 * recordBytes() + kCodingBytesPerPoint;
    return std::clamp(pointBytes_ / bytes, std::uint64_t{1}, std::uint64_t{1} << 31);
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
    const std::vector<ArrayView> noViews = viewsOf({});
    const std::size_t hidden = hiddenBytes() > 0 ? 1 : 0;
    container::ContainerWriter writer(
        sink_, Layout::Streaming,
        beginFile(ArraySource(noViews, hidden, false), options_.encoding, report_));
    ProgressScale coding(options_.encoding.progress, kCut, 1);
    SharedProgress progress(coding, report_.points);
    const std::uint64_t most = pointsAtATime(plan);
    for (std::size_t part = 0; part < parts_->parts(); ++part) {
      for (std::uint64_t first = 0; first < parts_->size(part); first += most) {
        const std::uint64_t count = std::min(most, parts_->size(part) - first);
        const streaming::PartPoints loaded = parts_->load(part, first, count);
        const std::vector<ArrayView> views = viewsOf(loaded);
        SetEncoder(plan, options_.encoding, ArraySource(views, hidden, false), progress, writer,
                   report_)
            .encode(loaded.points, {}, nullptr);
      }
    }
    writer.finish();
    report_.fileBytes = writer.bytesWritten();
    coding.report(1);
  }

  /// Whole tiles of them, where tiles are ranges of the input.
  std::uint64_t pointsAtATime(const CodingPlan& plan) const {
    const std::uint64_t most = partPoints();
    return plan.tilePoints < most ? most / plan.tilePoints * plan.tilePoints : most;
  }

  const StreamOptions& options_;
  std::uint64_t pointBytes_;
  ByteSink& sink_;
  ProgressScale& progress_;
  std::unique_ptr<streaming::RecordLayout> records_;
  std::unique_ptr<streaming::StoredSet> set_;
  Bytes tuples_;  ///< of the points pieceFirst_, …
  std::uint64_t pieceFirst_ = 0;
  std::size_t pieceCount_ = 0;
  Bytes piece_;
  std::unique_ptr<streaming::PointParts> parts_;
  EncodeReport report_;
};

}  // namespace

const std::vector<ArrayDescription>& PointReader::arrays() const {
  static const std::vector<ArrayDescription> none;
  return none;
}

EncodeReport encodeStream(PointReader& points, ByteSink& sink, const StreamOptions& options) {
  return streaming::encodeStreamWithin(memoryFor(options), points, sink, options);
}

EncodeReport streaming::encodeStreamWithin(std::uint64_t pointBytes, PointReader& points,
                                           ByteSink& sink, const StreamOptions& options) {
  checkOptions(options);
  checkDescriptions(points.arrays(), options.encoding);
  checkMetadata(options.encoding.metadata);
  planCoding(options.encoding, 0);  // wishes that cannot be met are refused before any work
  ProgressScale progress(options.encoding.progress, 0, 1);
  FirstPoints first = readFirst(points, pointBytes, progress);
  if (!first.ended) {
    return LargeSetEncoder(options, pointBytes, sink, progress).run(std::move(first), points);
  }
  const std::size_t size = 3 * scalarSize(points.type());
  PointSetView view(first.points.positions.data(), points.type(),
                    first.points.positions.size() / size, 0);
  for (const ArrayValues& array : first.points.values) view.addArray(array.view());
  return encode(view, sink, options.encoding);
}

}  // namespace bspc
