#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "bspc/grid.h"
#include "bspc/limits.h"
#include "bspc/mesh.h"
#include "bspc/method.h"
#include "bspc/span.h"

namespace bspc::geometry {

namespace predictive {
struct Features;
}

/// Called with the number of points that are done; throws to stop.
using PointProgress = std::function<void(std::uint64_t donePoints)>;

/// What a coarse layer of a tile consists of; stands in the index.
struct LayerSummary {
  std::uint64_t representatives = 0;
  std::uint32_t spread = 0;  ///< greatest distance of a point to its representative, per axis
};

/// What a caller may ask of a method; each heeds what concerns it.
struct CodingWishes {
  unsigned effort = 2;                ///< 1 (quickest) … 9 (smallest)
  std::uint64_t stopPoints = 0;       ///< lossy: cells of so many points or fewer stay undivided
  std::optional<unsigned> stopLevel;  ///< lossy: cells of this level stay undivided
  /// Faces over the points of the tile, an oriented surface: what method surface goes along.
  const Cells* faces = nullptr;
  /// Of method predictive: other features than the effort's, to measure what each is worth.
  const predictive::Features* features = nullptr;
};

/// A tile to be coded: its points, in grid steps from the lower corner of its tight box.
struct TileInput {
  Span<const GridPoint> points;
  GridPoint lower{};   ///< subtracted from each point
  GridPoint extent{};  ///< greatest coordinate after that
  unsigned layers = 1;
  CodingWishes wishes;
};

struct EncodedTile {
  std::vector<Bytes> layers;         ///< TileInput::layers payloads, coarse to fine
  std::vector<LayerSummary> coarse;  ///< of all layers but the last
  std::vector<std::uint32_t> order;  ///< order[j]: input index of the j-th decoded point
  /// Where the points stand after a lossy coding, relative to TileInput::lower, in decoded order;
  /// empty if every point stands where it was.
  std::vector<GridPoint> decoded;
  unsigned version = 0;  ///< of the method that the payloads need
  /// Representatives are points of the tile, so that values of points can be coded in layers too.
  bool nestsPoints = false;
  /// If so: indices of decoded points layer after layer; empty if that is how they are decoded.
  std::vector<std::uint32_t> layerOrder;
  /// The faces that the payload holds, over decoded points.
  Cells faces;
};

/// A tile to be decoded. Nothing in it can be trusted but that the payloads are the bytes that
/// were written, if their checksums are not forged.
struct TileToDecode {
  unsigned version = 0;  ///< of the method
  std::uint64_t points = 0;
  GridPoint extent{};
  unsigned layers = 1;                ///< how many the tile has in all
  std::vector<ByteView> payloads;     ///< the first of them, at least one
  std::optional<unsigned> cellLevel;  ///< fill cellIds with cells of this layer
  bool wantCounts = false;
  std::uint64_t maxPoints = 0;  ///< more output than this is Error(LimitExceeded)
  std::uint64_t maxBytes = 0;   ///< memory of all that is allocated
  std::uint32_t maxDepth = 0;
};

struct DecodedTile {
  std::vector<GridPoint> points;  ///< grid steps from the tile's lower corner
  std::vector<std::uint64_t> counts;
  std::vector<std::uint64_t> cellIds;
  std::vector<std::uint32_t> layerOrder;  ///< see EncodedTile, of the points that there are
};

/// One way to code the positions of a tile. Methods are stateless and may run on several tiles at
/// a time. encode() and decode() are to drive one template with a SymbolWriter or a SymbolReader
/// (entropy/symbol_coder.h).
class GeometryMethod {
 public:
  virtual ~GeometryMethod() = default;

  virtual Method id() const = 0;
  /// The newest version that encode() writes; decode() takes every version up to it.
  virtual unsigned version() const = 0;
  /// Bits that the grid of a tile may have along each axis.
  virtual unsigned maxBits() const { return 32; }
  /// Points that a tile may have.
  virtual std::uint64_t maxPoints() const { return 0xFFFFFFFF; }
  /// Whether stopPoints and stopLevel mean anything to it.
  virtual bool canStop() const { return false; }

  virtual EncodedTile encode(const TileInput& tile, const PointProgress& progress) const = 0;

  /// Decodes the layers given. Throws Error(Corrupt, LimitExceeded); any bytes are safe.
  virtual DecodedTile decode(const TileToDecode& tile, const PointProgress& progress) const = 0;
};

/// The method of that id; null if this version does not have it.
const GeometryMethod* findGeometryMethod(Method id);

}  // namespace bspc::geometry
