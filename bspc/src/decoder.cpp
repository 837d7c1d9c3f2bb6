#include "bspc/decoder.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "bspc/error.h"
#include "container/container_reader.h"
#include "decoded_tiles.h"
#include "grid/float_grid.h"
#include "mesh/mesh_decoder.h"
#include "parallel.h"
#include "point_selection.h"
#include "progress_scale.h"
#include "query.h"
#include "saturating.h"
#include "shared_progress.h"
#include "tile_decoder.h"

namespace bspc {

namespace {

void addTileInfo(FileInfo& info, const container::TileLayout& layout,
                 const container::TileRecord& tile) {
  TileInfo t;
  t.method = static_cast<Method>(tile.method);
  t.methodVersion = tile.version;
  t.points = tile.points;
  t.lower = tile.lower;
  for (std::size_t k = 0; k < 3; ++k) {
    t.upper[k] = tile.lower[k] + tile.extent[k];
    info.lower[k] = info.tiles.empty() ? t.lower[k] : std::min(info.lower[k], t.lower[k]);
    info.upper[k] = std::max(info.upper[k], t.upper[k]);
  }
  info.points = saturatingAdd(info.points, tile.points);
  for (std::size_t l = 0; l < info.layers.size(); ++l) {
    const bool last = l == tile.coarse.size();
    info.layers[l].points =
        saturatingAdd(info.layers[l].points, last ? tile.points : tile.coarse[l].representatives);
    if (!last) info.layers[l].spread = std::max(info.layers[l].spread, tile.coarse[l].spread);
    if (l < tile.lacking) continue;
    const std::uint64_t bytes = tile.chunkSizes[layout.column(static_cast<unsigned>(l), 0)];
    info.layers[l].bytes = saturatingAdd(info.layers[l].bytes, bytes);
    info.geometryBytes = saturatingAdd(info.geometryBytes, bytes);
  }
  for (std::size_t column = 0; column < layout.columns(); ++column) {
    const std::size_t part = layout.partOf(column);
    const std::uint64_t bytes = tile.chunkSizes[column];
    if (bytes == container::kNoChunk || part == container::kGeometryPart) continue;
    const std::size_t hidden = layout.arrays.size() - info.arrays.size();
    const std::size_t named = container::kFirstArrayPart + hidden;
    std::uint64_t& sum = part == container::kOrderPart ? info.orderBytes
                         : part < named                ? info.geometryBytes
                                                       : info.arrays[part - named].bytes;
    sum = saturatingAdd(sum, bytes);
  }
  info.tiles.push_back(t);
}

MeshInfo describeMesh(const container::ContainerReader& file) {
  const container::MeshRecord& mesh = file.head().mesh;
  MeshInfo info;
  info.vertices = mesh.counts.vertices;
  info.lines = mesh.counts.lines;
  info.faces = mesh.counts.faces;
  info.bytes = file.meshBytes();
  info.missing = file.meshMissing();
  for (const ArrayDescription& array : mesh.arrays) {
    ArrayInfo described;
    static_cast<ArrayDescription&>(described) = array;
    described.firstLevel = file.head().layers - 1;
    info.arrays.push_back(std::move(described));
  }
  return info;
}

/// Whether the corners of a box of float bits are finite: all points in it then are.
void requireFinite(const FileInfo& info) {
  if (!lattice::isFloatGrid(info.grid)) return;
  const lattice::OrderRange finite = lattice::finiteMultiples(info.grid.scalarType);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t base = info.grid.axes[k].base;
    if (base + info.lower[k] >= finite.first && base + info.upper[k] <= finite.last) continue;
    throw Error(ErrorCode::Corrupt,
                std::string("the box of the points holds NaN or infinities along ") + "xyz"[k]);
  }
}

FileInfo describe(const container::ContainerReader& file) {
  FileInfo info;
  info.versionMajor = container::kVersionMajor;
  info.versionMinor = file.versionMinor();
  info.streaming = file.head().streaming;
  info.grid = file.head().grid;
  info.fileBytes = file.fileBytes();
  info.layers.resize(file.head().layers);
  info.wholeLayers = file.wholeLayers();
  const unsigned firstLevel = firstArrayLevel(file);
  for (const ArrayDescription& array : file.head().arrays) {
    ArrayInfo described;
    static_cast<ArrayDescription&>(described) = array;
    described.firstLevel = firstLevel;
    info.arrays.push_back(std::move(described));
  }
  info.metadata = file.head().metadata;
  info.keepsOrder = file.head().keepsOrder;
  info.mesh = describeMesh(file);
  for (const container::TileRecord& tile : file.tiles()) addTileInfo(info, file.layout(), tile);
  if (info.points > 0) requireFinite(info);
  return info;
}

/// Of the texts and values, which FileInfo has once more.
std::uint64_t memoryOf(const Metadata& metadata) {
  std::uint64_t bytes = 0;
  for (const auto& [key, value] : metadata.entries) {
    bytes += 2 * sizeof(std::string) + key.capacity() + value.capacity();
  }
  for (const ArrayValues& array : metadata.fieldData) {
    bytes += array.values.capacity();
    for (const std::string& text : array.strings) bytes += sizeof(std::string) + text.capacity();
  }
  return 2 * bytes;
}

/// What is left of the limits once the file is open.
DecodeLimits limitsOfDecoding(const container::ContainerReader& file, DecodeLimits limits) {
  const std::uint64_t used =
      file.tiles().size() * container::memoryOfTile(file.layout()) + memoryOf(file.head().metadata);
  limits.memoryBytes -= std::min(limits.memoryBytes, used);
  return limits;
}

}  // namespace

class Decoder::Impl {
 public:
  Impl(std::shared_ptr<ByteSource> source, const OpenOptions& options)
      : file_(std::move(source), options),
        info_(describe(file_)),
        limits_(limitsOfDecoding(file_, options.limits)),
        tileDecoder_(file_, limits_) {}

  const FileInfo& info() const { return info_; }
  QueryCost cost(const DecodeOptions& options) const;
  DecodedPoints decode(const DecodeOptions& options);
  void decodeTiles(const DecodeOptions& options, const TileVisitor& visit);

 private:
  /// Tiles that are in memory for each of several threads: one in its hands, two that wait.
  static constexpr std::uint64_t kWaiting = 3;

  void decodeQuery(const Query& query, const DecodeOptions& options, ProgressScale scale,
                   const std::function<std::uint64_t()>& bytesInUse, const TileVisitor& visit);
  double shareOfPoints(const Query& query) const;
  unsigned threadsFor(const Query& query, const DecodeOptions& options) const;
  DecodedPoints place(const Query& query, std::size_t index, TileContent decoded) const;
  void addArrays(const Query& query, DecodedTileArrays values, DecodedPoints& points) const;

  container::ContainerReader file_;
  FileInfo info_;
  DecodeLimits limits_;
  TileDecoder tileDecoder_;
};

QueryCost Decoder::Impl::cost(const DecodeOptions& options) const {
  const Query query = planQuery(file_, options);
  return {query.tiles.size(), query.points, bytesRead(file_, query), query.level};
}

/// Moves the decoded tile of that index in the query to its place in the file, and leaves what the
/// query is about.
DecodedPoints Decoder::Impl::place(const Query& query, std::size_t index,
                                   TileContent decoded) const {
  DecodedPoints points;
  points.points = std::move(decoded.points.points);
  points.counts = std::move(decoded.points.counts);
  points.cellIds = std::move(decoded.points.cellIds);
  points.level = query.level;
  points.complete = query.complete;
  const GridPoint& lower = file_.tiles()[query.tiles[index]].lower;
  if (lower != GridPoint{}) {
    for (GridPoint& p : points.points) {
      for (std::size_t k = 0; k < 3; ++k) p[k] += lower[k];
    }
  }
  for (std::uint64_t& id : points.cellIds) id += query.firstCells[index];
  addArrays(query, std::move(decoded.values), points);
  if (query.filter) query.filter->apply(points);
  return points;
}

void Decoder::Impl::addArrays(const Query& query, DecodedTileArrays values,
                              DecodedPoints& points) const {
  const std::size_t hidden = file_.head().hiddenArrays();
  for (std::size_t i = 0; i < query.arrays.size(); ++i) {
    if (query.arrays[i] < hidden) {
      const Bytes& halves = values.arrays[i].numbers;
      points.lowHalves.resize(halves.size() / sizeof(GridPoint));
      if (!halves.empty()) std::memcpy(points.lowHalves.data(), halves.data(), halves.size());
      continue;
    }
    ArrayValues array;
    static_cast<ArrayDescription&>(array) = file_.head().arrays[query.arrays[i] - hidden];
    array.values = std::move(values.arrays[i].numbers);
    array.strings = std::move(values.arrays[i].strings);
    points.arrays.push_back(std::move(array));
  }
  if (!values.order.empty()) reorderPoints(points, values.order);
}

/// As many threads as are wished for and can have enough memory each: what is refused for a limit
/// is so on any number of them.
unsigned Decoder::Impl::threadsFor(const Query& query, const DecodeOptions& options) const {
  // What methods take for a point: their own cells, and the values of arrays some times over.
  constexpr std::uint64_t kMethods = 256;
  constexpr std::uint64_t kTimes = 4;
  std::uint64_t most = 1;
  for (const std::size_t i : query.tiles) {
    most = std::max(most, pointsUpTo(file_.tiles()[i], query.level));
  }
  const std::uint64_t each = kMethods + kTimes * bytesPerPoint(file_, query, options);
  const std::uint64_t tiles = limits_.memoryBytes / each / most / kWaiting;
  return static_cast<unsigned>(std::min<std::uint64_t>(
      {threadCount(options.threads), std::max<std::uint64_t>(query.tiles.size(), 1),
       std::max<std::uint64_t>(tiles, 1)}));
}

/// Decodes the tiles of a query, on several threads, and hands them on in order.
void Decoder::Impl::decodeQuery(const Query& query, const DecodeOptions& options,
                                ProgressScale scale,
                                const std::function<std::uint64_t()>& bytesInUse,
                                const TileVisitor& visit) {
  SharedProgress progress(scale, query.points);
  progress.report();
  const unsigned threads = threadsFor(query, options);
  // Twice as many results as threads wait at the most, each with its share of the memory.
  const std::uint64_t shares = threads == 1 ? 1 : kWaiting * threads;
  const auto produce = [&](std::size_t i) {
    const std::uint64_t used = bytesInUse();
    const std::uint64_t free = limits_.memoryBytes > used ? limits_.memoryBytes - used : 0;
    return place(
        query, i,
        tileDecoder_.decode(query.tiles[i], query, options, free / shares, progress.piece()));
  };
  OrderedParallel<DecodedPoints>(query.tiles.size(), threads, produce)
      .run([&](std::size_t /*i*/, DecodedPoints points) { visit(std::move(points)); },
           [&progress] { progress.report(); });
  scale.report(1);
}

/// What decoding the points is of the work, if the cells follow.
double Decoder::Impl::shareOfPoints(const Query& query) const {
  const container::CellCounts& cells = file_.head().mesh.counts;
  const auto points = static_cast<double>(query.points);
  return points / (points + static_cast<double>(cells.vertices) + static_cast<double>(cells.lines) +
                   static_cast<double>(cells.faces) + 1);
}

DecodedPoints Decoder::Impl::decode(const DecodeOptions& options) {
  const Query query = planQuery(file_, options);
  for (const std::size_t i : query.tiles) {
    if (query.level >= file_.tiles()[i].lacking) tileDecoder_.methodOf(i);
  }
  if (!query.filter && !query.thin) {
    requireRoom(query.points, bytesPerPoint(file_, query, options), limits_.points,
                limits_.memoryBytes);
  }
  const bool withMesh =
      options.mesh && query.complete && file_.head().mesh.blocks > 0 && !file_.meshMissing();
  const double share = withMesh ? shareOfPoints(query) : 1;
  DecodedTiles all(limits_, query.points);
  decodeQuery(
      query, options, ProgressScale(options.progress, 0, share), [&all] { return all.bytes(); },
      [&all](DecodedPoints&& points) { all.append(std::move(points)); });
  DecodedPoints result = all.take();
  if (query.tiles.empty()) {
    addArrays(query,
              DecodedTileArrays{std::vector<attributes::ArrayValues>(query.arrays.size()), {}},
              result);
  }
  result.level = query.level;
  result.complete = query.complete;
  if (query.thin && result.points.size() > *options.maxPoints) {
    thinTo(*options.maxPoints, result);
  }
  if (withMesh) {
    ProgressScale scale(options.progress, share, 1);
    const std::uint64_t used = all.bytes();
    decodeMesh(
        file_, limits_.memoryBytes > used ? limits_.memoryBytes - used : 0,
        [&scale](double done) { scale.report(done); }, result);
    scale.report(1);
  }
  return result;
}

void Decoder::Impl::decodeTiles(const DecodeOptions& options, const TileVisitor& visit) {
  const Query query = planQuery(file_, options);
  double before = 0;
  std::uint64_t kept = 0;
  decodeQuery(
      query, options, ProgressScale(options.progress, 0, 1), [] { return std::uint64_t{0}; },
      [&](DecodedPoints&& points) {
        if (query.thin) {
          // Shares are rounded down to where the tile ends, so that they add up to the budget.
          before += static_cast<double>(points.points.size()) / static_cast<double>(query.points);
          const auto due = static_cast<std::uint64_t>(std::min(before, 1.0) *
                                                      static_cast<double>(*options.maxPoints));
          thinTo(due > kept ? due - kept : 0, points);
          kept += points.points.size();
        }
        visit(std::move(points));
      });
}

Decoder::Decoder(std::shared_ptr<ByteSource> source, const OpenOptions& options)
    : impl_(std::make_unique<Impl>(std::move(source), options)) {}
Decoder::~Decoder() = default;
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;

const FileInfo& Decoder::info() const { return impl_->info(); }

DecodedPoints Decoder::decode(const DecodeOptions& options) { return impl_->decode(options); }

void Decoder::decodeTiles(const DecodeOptions& options, const TileVisitor& visit) {
  impl_->decodeTiles(options, visit);
}

QueryCost Decoder::cost(const DecodeOptions& options) const { return impl_->cost(options); }

bool isBspc(ByteView firstBytes) {
  return firstBytes.size() >= container::kSignature.size() &&
         std::equal(container::kSignature.begin(), container::kSignature.end(), firstBytes.begin());
}

}  // namespace bspc
