#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/grid.h"
#include "bspc/io.h"
#include "bspc/limits.h"
#include "bspc/mesh.h"
#include "bspc/method.h"
#include "bspc/progress.h"

namespace bspc {

/// One layer of a file, over all tiles (docs/format.md, "Layers").
struct LayerInfo {
  std::uint64_t points = 0;  ///< representatives up to this layer; the last layer: all points
  std::uint32_t spread = 0;  ///< along each axis, no point is farther than this many grid steps
                             ///< from its representative; 0 in the last layer
  std::uint64_t bytes = 0;   ///< payload of this layer alone
};

struct TileInfo {
  Method method = Method::Kd;
  unsigned methodVersion = 0;
  std::uint64_t points = 0;
  GridPoint lower{};  ///< tight box of the tile's points, inclusive
  GridPoint upper{};
};

/// An array of a file.
struct ArrayInfo : ArrayDescription {
  std::uint64_t bytes = 0;  ///< payload over all tiles
  /// The coarsest level from which on there are values: 0 if every layer has some, the last one if
  /// layers carry no arrays (those of methods whose representatives are no points of the set).
  unsigned firstLevel = 0;
};

/// The mesh of a file.
struct MeshInfo {
  std::uint64_t vertices = 0;  ///< vertex cells
  std::uint64_t lines = 0;
  std::uint64_t faces = 0;
  std::uint64_t bytes = 0;        ///< of the file: cells and their arrays
  std::vector<ArrayInfo> arrays;  ///< beside the cells, one tuple a cell; their sizes are not known
  bool missing = false;           ///< the file was cut short before them

  bool empty() const { return vertices == 0 && lines == 0 && faces == 0; }
};

/// What a file says about itself; known without decoding any points.
struct FileInfo {
  unsigned versionMajor = 0;
  unsigned versionMinor = 0;
  bool streaming = false;
  Grid grid;
  std::uint64_t points = 0;
  std::uint64_t fileBytes = 0;
  std::uint64_t geometryBytes = 0;  ///< payload of all layers and tiles
  GridPoint lower{};                ///< box of all points, inclusive; zeros if there are none
  GridPoint upper{};
  std::vector<LayerInfo> layers;
  std::vector<TileInfo> tiles;
  std::vector<ArrayInfo> arrays;  ///< beside the positions, one tuple a point
  Metadata metadata;
  bool keepsOrder = false;       ///< points come back in the order of the input
  std::uint64_t orderBytes = 0;  ///< payload of that order, or of one that helps to code arrays
  MeshInfo mesh;
  /// Layers that are whole in this file; less than layers.size() only in a truncated file that
  /// was opened with allowPartial.
  unsigned wholeLayers = 0;
};

struct OpenOptions {
  DecodeLimits limits;
  /// Accept a file that ends early, and decode its longest whole prefix.
  bool allowPartial = false;
};

/// A part of space in the units of the data; its faces belong to it.
struct Box {
  std::array<double, 3> lower{};
  std::array<double, 3> upper{};
};

/// Consecutive tiles of a file, by their index in FileInfo::tiles.
struct TileRange {
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};

/// What a decoding reads.
struct QueryCost {
  std::uint64_t tiles = 0;
  std::uint64_t points = 0;  ///< in those tiles up to the level; those outside a box count
  std::uint64_t bytes = 0;   ///< of the file, its head and index among them
  unsigned level = 0;
};

struct DecodeOptions {
  /// Decode layers 0 … level only; empty: all that are there.
  std::optional<unsigned> level;
  /// At most so many points: the finest level that fits, thinned where even the coarsest does not.
  std::optional<std::uint64_t> maxPoints;
  bool wantCounts = false;  ///< fill DecodedPoints::counts
  /// Fill DecodedPoints::cellIds with the BSP cell of this level that each point lies in; a level
  /// finer than the decoded one is an error.
  std::optional<unsigned> cellLevel;
  /// Names of the arrays to decode; the others are not read from disk. Empty: all. A name that the
  /// file does not have is an error (InvalidArgument).
  std::optional<std::vector<std::string>> arrays;
  /// Only the points (of a coarse level: the representatives) whose coordinates lie in the box;
  /// only tiles that touch it are read.
  std::optional<Box> box;
  /// Only these tiles, for callers that share a file out among themselves; a range that the file
  /// does not have is an error (InvalidArgument). maxPoints is then a bound on these tiles alone.
  std::optional<TileRange> tiles;
  /// decode() only: the cells of the mesh too, if all points are decoded (no box, all tiles, the
  /// last layer). A part of the points has no cells.
  bool mesh = true;
  unsigned threads = 0;  ///< 0: as many as the machine has; the result does not depend on it
  ProgressCallback progress;
};

/// Decoded points, in the coder's order, or in that of the input where the file keeps it.
struct DecodedPoints {
  std::vector<GridPoint> points;
  /// The lower 32 bits of exact float64 coordinates (Grid::Form::FloatBits), one a point; empty for
  /// other grids, and at levels without values of arrays.
  std::vector<GridPoint> lowHalves;
  /// The chosen arrays in the order of FileInfo::arrays, one tuple a point; at a level without
  /// values (ArrayInfo::firstLevel) an array is left out.
  std::vector<ArrayValues> arrays;
  /// How many points each stands for (1 for all in the last layer); only if asked for.
  std::vector<std::uint64_t> counts;
  /// Only if asked for. Ids are 0-based and consecutive over the file.
  std::vector<std::uint64_t> cellIds;
  MeshCells mesh;                       ///< see DecodeOptions::mesh
  std::vector<ArrayValues> cellArrays;  ///< in the order of MeshInfo::arrays, one tuple a cell
  unsigned level = 0;                   ///< the finest layer that was used
  bool complete = true;                 ///< every point of the original is there
};

/// restorePositions() with all that was decoded, exact floats among it.
template <class T>
void restorePositions(const Grid& grid, const DecodedPoints& points, T* xyz) {
  restorePositions(grid, Span<const GridPoint>(points.points),
                   Span<const GridPoint>(points.lowHalves), xyz);
}

/// An open .bspc file: reads head and index at once, the rest on demand.
class Decoder {
 public:
  /// Reads head and index. Throws Error (NotBspc, Truncated, Corrupt, Unsupported, LimitExceeded).
  explicit Decoder(std::shared_ptr<ByteSource> source, const OpenOptions& options = {});
  ~Decoder();
  Decoder(Decoder&&) noexcept;
  Decoder& operator=(Decoder&&) noexcept;

  const FileInfo& info() const;

  /// Called with the points of one tile after the other. Ids of cells count through the file.
  using TileVisitor = std::function<void(DecodedPoints&& points)>;

  /// Decodes points. Every block that is read is checked against its checksum, a whole tile also
  /// against the checksum of its decoded content. May be called again with other options.
  DecodedPoints decode(const DecodeOptions& options = {});

  /// The same, tile by tile, so that memory stays bounded however large the file is. Thinning to
  /// maxPoints then is done in each tile for its share.
  void decodeTiles(const DecodeOptions& options, const TileVisitor& visit);

  /// What decode() would read, from the index alone.
  QueryCost cost(const DecodeOptions& options) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether a file with these first bytes claims to be .bspc (8 bytes are enough).
bool isBspc(ByteView firstBytes);

}  // namespace bspc
