#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/grid.h"
#include "bspc/io.h"
#include "bspc/method.h"
#include "bspc/point_set.h"
#include "bspc/progress.h"

namespace bspc {

/// Where the index of a file stands (docs/format.md, "Layouts").
enum class Layout {
  /// In front: every prefix of the file that ends on a layer decodes.
  Progressive,
  /// At the end: tiles are written as they come, memory stays bounded, pipes work.
  Streaming,
};

constexpr unsigned kMaxLayers = 32;

struct EncodeOptions {
  GridRequest grid;
  std::optional<Method> method;  ///< empty: the encoder's choice
  /// How much time smallness is worth, 1 (quickest) to 9 (smallest): 1 to 4 are method fast, 5 to
  /// 9 method predictive or, for meshes of one tile and one layer whose order need not be kept,
  /// method surface if that is smaller. Empty: 9 up to 20,000 points, 2 above. With another method
  /// it is an error.
  std::optional<unsigned> effort;
  /// If above 0, the effort is the greatest that should take no more than so many seconds on one
  /// core of 2020; an effort beside it is an error. An estimate by the number of points: the file
  /// does not depend on how quick the machine is.
  double seconds = 0;
  /// Most points of a tile; 0: as many as suit the method. Smaller tiles make smaller boxes cheaper
  /// to read and the file larger.
  std::uint64_t tilePoints = 0;
  unsigned threads = 0;  ///< 0: as many as the machine has; the file does not depend on it
  /// Lossy, for the methods bsp and kd (an error with others): cells of at most so many points
  /// stay undivided, and each of their points comes back as the middle of its cell.
  std::uint64_t stopPoints = 0;
  /// Likewise for the cells of this level: those that so many cuts have made.
  std::optional<unsigned> stopLevel;
  unsigned layers = 0;  ///< 1 … kMaxLayers; 0: by the number of points, 1 below 4,096
  Layout layout = Layout::Progressive;
  /// Store the order of the points too, so that decoding returns them (and their arrays) in the
  /// order of the input. Tiles are then consecutive ranges of it. Cells of a mesh keep their order
  /// too, and each the point that it begins with.
  bool keepOrder = false;
  /// Add an array "OriginalPointIds" (uint64, Semantic::Ids): each point's index in the input.
  bool originalIds = false;
  Metadata metadata;       ///< stored as it is
  bool wantOrder = false;  ///< fill EncodeReport::order
  ProgressCallback progress;
};

/// What an array takes in a file.
struct ArrayReport {
  std::string name;
  std::uint64_t bytes = 0;  ///< of its payload, over all tiles
  /// Greatest |restored − given| of a value, for normals the greatest angle in degrees; 0 if every
  /// value comes back bit for bit.
  double greatestError = 0;
};

/// What was written.
struct EncodeReport {
  Grid grid;
  Method method = Method::Kd;
  Layout layout = Layout::Progressive;
  std::uint64_t points = 0;
  std::uint64_t dropped = 0;  ///< non-finite points left out on request
  std::uint64_t tiles = 0;
  unsigned layers = 1;
  std::uint64_t fileBytes = 0;
  std::uint64_t geometryBytes = 0;  ///< of them, geometry payload
  std::uint64_t orderBytes = 0;     ///< of them, the order of the points
  std::vector<ArrayReport> arrays;
  bool exact = true;  ///< see GridFit; what a lossy coding adds counts
  std::array<double, 3> maxError{};
  /// Input index of the j-th point that a decoder returns; only if wantOrder.
  std::vector<std::uint64_t> order;
  std::uint64_t meshBytes = 0;          ///< payload of the cells, without their arrays
  std::vector<ArrayReport> cellArrays;  ///< beside the cells
  /// Input index of the j-th cell that a decoder returns, over all three sorts; only if wantOrder.
  std::vector<std::uint64_t> cellOrder;
};

/// Compresses a point set with its arrays and the cells of its mesh. Faces come back with the same
/// points in the same sense, but in an order of the coder's and from any of their points on, and
/// vertex cells with their points sorted, unless keepOrder is set; lines always as they were.
/// Points at the same place, which nothing but the faces tells apart, may be exchanged. Throws
/// Error; what was written to the sink by then is to be discarded.
EncodeReport encode(const PointSetView& points, ByteSink& sink, const EncodeOptions& options = {});

}  // namespace bspc
