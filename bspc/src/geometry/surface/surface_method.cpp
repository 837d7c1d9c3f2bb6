#include "geometry/surface/surface_method.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>

#include "bspc/error.h"
#include "connectivity/numbers.h"
#include "geometry/cell_output.h"
#include "geometry/surface/coordinate_coder.h"
#include "geometry/surface/vertex_predictor.h"
#include "geometry/surface/vertex_rings.h"

namespace bspc::geometry {

namespace {

using connectivity::SurfaceFaces;
using surface::VertexRings;

constexpr std::uint64_t kMostPoints = std::numeric_limits<std::uint32_t>::max() - 16;
/// Points between two calls of the progress callback.
constexpr std::uint64_t kProgressStep = 1024;

std::uint64_t bytesFor(const SurfaceFaces& faces) {
  const std::uint64_t corners = faces.faces.indices.size();
  return 8 * corners + VertexRings::bytesFor(faces.vertices, corners) +
         surface::VertexPredictor::bytesFor(faces.vertices);
}

/// Codes points that are no vertices of the surface, each from the one before.
template <class Coder>
class LonePoints {
 public:
  LonePoints(Coder& coder, const GridPoint& extent) : coder_(coder), extent_(extent) {}

  GridPoint code(const GridPoint& place) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t step = std::int64_t{place[k]} - std::int64_t{last_[k]};
      const std::uint64_t value =
          last_[k] + static_cast<std::uint64_t>(steps_[k].codeSigned(coder_, step));
      if (value > extent_[k]) throw Error(ErrorCode::Corrupt, "a point lies outside its tile");
      last_[k] = static_cast<std::uint32_t>(value);
    }
    return last_;
  }

 private:
  Coder& coder_;
  GridPoint extent_;
  GridPoint last_{};
  std::array<connectivity::AdaptiveNumber, 3> steps_;
};

/// Codes the vertices of the surface and then the points that are none. `place(i)` is the truth of
/// an encoder for point i; `put(i, place)` takes what is coded.
template <class Coder, class Place, class Put>
void codePlaces(Coder& coder, const SurfaceFaces& faces, std::uint64_t points,
                const GridPoint& extent, Place place, Put put) {
  if (faces.vertices > 0) {
    surface::CoordinateCoder<Coder> coordinates(coder, extent);
    const VertexRings rings(faces);
    surface::VertexPredictor predictor(rings, extent);
    for (const std::uint32_t v : sequenceOf(rings)) {
      const GridPoint coded = coordinates.code(predictor.predict(v), place(v));
      predictor.learn(v, coded);
      put(v, coded);
    }
  }
  LonePoints<Coder> lone(coder, extent);
  for (std::uint64_t i = faces.vertices; i < points; ++i) put(i, lone.code(place(i)));
}

/// What stands for all points in the coarse layers: there is nothing between all and nothing.
GridPoint middleOf(const GridPoint& extent) {
  return {extent[0] / 2, extent[1] / 2, extent[2] / 2};
}
std::uint32_t spreadOf(const GridPoint& extent) {
  const std::uint32_t longest = *std::max_element(extent.begin(), extent.end());
  return longest - longest / 2;
}

}  // namespace

std::uint64_t SurfaceMethod::maxPoints() const { return kMostPoints; }

EncodedTile SurfaceMethod::encode(const TileInput& tile, const PointProgress& progress) const {
  const std::uint64_t count = tile.points.size();
  if (count > kMostPoints) {
    throw Error(ErrorCode::Unsupported,
                "method surface codes at most 4,294,967,279 points in one tile, and this set has " +
                    std::to_string(count));
  }
  EncodedTile result;
  for (unsigned l = 0; l + 1 < tile.layers; ++l) {
    result.layers.emplace_back();
    result.coarse.push_back({1, spreadOf(tile.extent)});
  }
  entropy::SymbolWriter coder;
  const Cells none;
  SurfaceFaces faces =
      connectivity::encodeSurface(coder, tile.wishes.faces != nullptr ? *tile.wishes.faces : none,
                                  static_cast<std::uint32_t>(count));
  result.order = std::move(faces.given);
  std::vector<bool> used(tile.points.size(), false);
  for (const std::uint32_t i : result.order) used[i] = true;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!used[i]) result.order.push_back(i);
  }
  const auto place = [&](std::uint64_t i) {
    GridPoint p = tile.points[result.order[static_cast<std::size_t>(i)]];
    for (std::size_t k = 0; k < 3; ++k) p[k] -= tile.lower[k];
    return p;
  };
  std::uint64_t done = 0;
  codePlaces(coder, faces, count, tile.extent, place, [&](std::uint64_t, const GridPoint&) {
    if (++done % kProgressStep == 0 && progress) progress(done);
  });
  result.layers.push_back(coder.finish());
  result.faces = std::move(faces.faces);
  return result;
}

DecodedTile SurfaceMethod::decode(const TileToDecode& tile, const PointProgress& progress) const {
  if (tile.points > kMostPoints) {
    throw Error(ErrorCode::Corrupt, "a tile of method surface claims " +
                                        std::to_string(tile.points) +
                                        " points, more than the method allows");
  }
  DecodedTile result;
  CellOutput output(tile, progress, result);
  for (std::size_t l = 0; l < tile.payloads.size() && l + 1 < tile.layers; ++l) {
    if (!tile.payloads[l].empty()) {
      throw Error(ErrorCode::Corrupt, "a coarse layer of method surface is not empty");
    }
  }
  if (tile.payloads.size() < tile.layers) {
    output.representative(middleOf(tile.extent), tile.points, 0);
    return result;
  }
  entropy::SymbolReader coder(tile.payloads.back());
  const SurfaceFaces faces = connectivity::decodeSurface(
      coder, static_cast<std::uint32_t>(tile.points), [&](std::uint64_t bytes) {
        output.hold(bytes);
        if (progress) progress(0);
      });
  output.hold(bytesFor(faces) + std::uint64_t{faces.vertices} * sizeof(GridPoint));
  std::vector<GridPoint> vertices(faces.vertices);
  std::uint64_t next = 0;
  std::uint64_t done = 0;
  const auto put = [&](std::uint64_t i, const GridPoint& place) {
    if (++done % kProgressStep == 0 && progress) progress(done);
    if (i < faces.vertices) {
      vertices[static_cast<std::size_t>(i)] = place;
      if (++next < faces.vertices) return;
      for (const GridPoint& vertex : vertices) output.leaf(vertex, 1, 0);
    } else {
      output.leaf(place, 1, 0);
    }
  };
  codePlaces(
      coder, faces, tile.points, tile.extent, [](std::uint64_t) { return GridPoint{}; }, put);
  coder.finish();
  return result;
}

Cells facesOfSurface(ByteView payload, std::uint64_t points, std::uint64_t maxBytes,
                     const std::function<void()>& working) {
  if (points > kMostPoints) {
    throw Error(ErrorCode::Corrupt, "a mesh of more than 2^32 points cannot have cells");
  }
  entropy::SymbolReader coder(payload);
  return connectivity::decodeSurface(coder, static_cast<std::uint32_t>(points),
                                     [&](std::uint64_t bytes) {
                                       if (working) working();
                                       if (bytes <= maxBytes) return;
                                       throw Error(ErrorCode::LimitExceeded,
                                                   "decoding the cells needs more memory than the "
                                                   "limit; raise it if the file is to be trusted");
                                     })
      .faces;
}

}  // namespace bspc::geometry
