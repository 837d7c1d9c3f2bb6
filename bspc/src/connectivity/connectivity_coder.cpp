#include "connectivity/connectivity_coder.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

#include "bspc/error.h"
#include "connectivity/face_order.h"
#include "connectivity/face_truth.h"
#include "connectivity/faces_section.h"
#include "connectivity/mesh_preparation.h"
#include "connectivity/vertex_cells.h"
#include "saturating.h"

namespace bspc::connectivity {

namespace {

using entropy::SymbolReader;
using entropy::SymbolWriter;

constexpr unsigned kVersionBits = 4;
constexpr unsigned kFromPlaces = 0;   ///< all faces are coded over known vertices
constexpr unsigned kWithSurface = 1;  ///< regular faces are known from the points on
constexpr std::uint64_t kMostNumbers = std::numeric_limits<std::uint32_t>::max() - 16;
/// Steps that differ by more than this along two axes count as differing by this.
constexpr double kMostAnisotropy = 1048576;

/// Places of points for measuring distances: from the corner of their box, in steps of the finest
/// axis.
std::vector<Position> placesOf(const MeshPoints& points) {
  const double finest = *std::min_element(points.steps.begin(), points.steps.end());
  std::array<double, 3> scale{};
  for (std::size_t k = 0; k < 3; ++k)
    scale[k] = std::min(points.steps[k] / finest, kMostAnisotropy);
  std::vector<Position> places(points.points.size());
  GridPoint corner = points.points.empty() ? GridPoint{} : points.points[0];
  for (const GridPoint& p : points.points) {
    for (std::size_t k = 0; k < 3; ++k) corner[k] = std::min(corner[k], p[k]);
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      places[i][k] = static_cast<double>(points.points[i][k] - corner[k]) * scale[k];
    }
  }
  return places;
}

std::vector<Position> placesOf(const std::vector<Position>& points, const Welding& welding) {
  std::vector<Position> places(welding.vertices());
  for (std::uint32_t v = 0; v < places.size(); ++v) places[v] = points[welding.members(v)[0]];
  return places;
}

/// What stands in front of everything.
struct MeshHead {
  unsigned version = kFromPlaces;
  std::uint64_t vertices = 0;
  std::uint64_t lines = 0;
  bool faces = false;
  bool keepOrder = false;

  template <class Coder>
  void code(Coder& coder) {
    version = coder.raw(version, kVersionBits);
    if (version > kWithSurface) {
      throw Error(ErrorCode::Unsupported, "the cells are coded by version " +
                                              std::to_string(version) +
                                              " of their method, which this one does not know");
    }
    vertices = codeNumber(coder, vertices);
    lines = codeNumber(coder, lines);
    faces = coder.raw(faces ? 1 : 0, 1) != 0;
    keepOrder = coder.raw(keepOrder ? 1 : 0, 1) != 0;
  }
};

/// What stands before the faces if regular ones are known.
struct SurfaceHead {
  std::uint64_t irregular = 0;
  bool flips = false;

  template <class Coder>
  void code(Coder& coder) {
    irregular = codeNumber(coder, irregular);
    flips = coder.raw(flips ? 1 : 0, 1) != 0;
  }
};

/// Codes which faces of a known surface were turned around, in their order.
template <class Coder>
class FlipBits {
 public:
  explicit FlipBits(Coder& coder) : coder_(coder) {}

  bool code(bool flipped) { return last_ = coder_.bit(model_[last_ ? 1 : 0], flipped); }

 private:
  Coder& coder_;
  std::array<entropy::AdaptiveBit, 2> model_;
  bool last_ = false;
};

void checkCells(const Cells& cells, std::uint64_t points, const char* sort) {
  if (cells.indices.size() > kMostNumbers) {
    throw Error(ErrorCode::Unsupported, std::string("the mesh has more than 2^32 corners of ") +
                                            sort + "; store it in parts");
  }
  for (const std::uint32_t i : cells.indices) {
    if (i < points) continue;
    throw Error(ErrorCode::InvalidArgument, std::string("one of the ") + sort + " has the point " +
                                                std::to_string(i) + ", and there are " +
                                                std::to_string(points));
  }
}

class MeshEncoder {
 public:
  MeshEncoder(const MeshPoints& points, const MeshCells& cells, const CodingWishes& wishes,
              const Cells* surface)
      : points_(points),
        cells_(cells),
        wishes_(wishes),
        surface_(surface),
        places_(placesOf(points)) {}

  EncodedMesh encode() {
    MeshHead head{surface_ != nullptr ? kWithSurface : kFromPlaces, cells_.vertices.size(),
                  cells_.lines.size(), !cells_.faces.empty(), wishes_.keepOrder};
    head.code(coder_);
    if (head.faces && surface_ != nullptr) {
      encodeAroundSurface();
    } else if (head.faces) {
      PreparedFaces prepared = prepare();
      while (!encodeFaces(prepared)) {
        coder_ = SymbolWriter();
        head.code(coder_);
      }
    }
    if (head.lines > 0) encodeLines();
    if (head.vertices > 0) encodeVertices();
    result_.payload = coder_.finish();
    return std::move(result_);
  }

 private:
  static void noCheck() {}

  /// About how many bits there are beside the regular faces.
  static std::size_t priceOf(const PreparedFaces& faces) {
    return 40 * faces.irregular.size() + 3 * faces.borderEdges;
  }

  /// Decides whether points at the same place are one vertex, and prepares the faces so.
  PreparedFaces prepare() {
    PreparedFaces prepared = prepareFaces(cells_.faces);
    Welding welding(points_.points);
    if (welding.trivial()) return prepared;
    Cells welded = cells_.faces;
    for (std::uint32_t& i : welded.indices) i = welding.vertexOf(i);
    PreparedFaces preparedWelded = prepareFaces(welded);
    if (priceOf(preparedWelded) >= priceOf(prepared)) return prepared;
    welding_.emplace(std::move(welding));
    return preparedWelded;
  }

  /// False if the front did not reach all regular faces: those that it did not are irregular then,
  /// and everything has to be coded anew.
  bool encodeFaces(PreparedFaces& prepared) {
    sortIrregular(prepared);
    FacesHead head;
    head.regular = prepared.regular.size();
    head.irregular = prepared.irregular.size();
    head.welded = welding_.has_value();
    head.flips = prepared.anyFlipped;
    for (const std::uint32_t i : prepared.regular) {
      head.triangles = head.triangles && prepared.faces[i].size() == 3;
    }
    head.surestFirst = wishes_.effort > 4;
    head.neighbours = wishes_.effort > 7 ? 16 : wishes_.effort > 4 ? 12 : 6;
    head.code(coder_);

    const std::vector<Position> places =
        welding_ ? placesOf(places_, *welding_) : std::vector<Position>();
    const Span<const Position> positions = welding_ ? places : places_;
    FaceTruth truth(prepared.faces, prepared.flipped, prepared.regular, positions.size());
    Cells irregular;
    for (const std::uint32_t i : prepared.irregular) irregular.add(prepared.faces[i]);
    FacesSection<SymbolWriter, FaceTruth> section(coder_, head, positions);
    section.codeVertices(truth, irregular, [](std::size_t) {});
    if (truth.order().size() < prepared.regular.size()) {
      keepRegular(prepared, truth.order());
      return false;
    }
    if (welding_) encodeCorners(section.front(), prepared, truth);
    finishFaces(prepared, truth);
    return true;
  }

  /// What a decoder does not know of the faces from its points on.
  void encodeAroundSurface() {
    PreparedFaces prepared = prepareFaces(cells_.faces);
    sortIrregular(prepared);
    FaceTruth truth(prepared.faces, prepared.flipped, prepared.regular, points_.points.size());
    SurfaceHead head{prepared.irregular.size(), prepared.anyFlipped};
    head.code(coder_);
    FlipBits<SymbolWriter> flips(coder_);
    for (std::size_t i = 0; i < surface_->size(); ++i) {
      truth.take({(*surface_)[i][0], (*surface_)[i][1]});
      if (head.flips) flips.code(truth.flipped());
    }
    if (head.irregular > 0) {
      Cells irregular;
      for (const std::uint32_t i : prepared.irregular) irregular.add(prepared.faces[i]);
      const VertexIndex index(places_);
      PlainCells<SymbolWriter>(coder_, places_, index, PlainCells<SymbolWriter>::Shape::Face)
          .code(head.irregular, irregular, noCheck);
    }
    finishFaces(prepared, truth);
  }

  void finishFaces(const PreparedFaces& prepared, const FaceTruth& truth) {
    std::vector<std::uint32_t> order = truth.order();
    order.insert(order.end(), prepared.irregular.begin(), prepared.irregular.end());
    std::vector<std::uint32_t> starts(order.size(), 0);
    result_.decoded.faces = codedFaces(order, truth.firstCorners(), prepared.flipped, starts);
    if (!wishes_.keepOrder) {
      result_.faceOrder = std::move(order);
      return;
    }
    std::vector<std::uint32_t> places(order.size());
    for (std::uint32_t k = 0; k < order.size(); ++k) places[order[k]] = k;
    FaceOrder<SymbolWriter>(coder_, result_.decoded.faces).code(places, starts, noCheck);
    result_.decoded.faces = renumbered(cells_.faces);
  }

  /// The faces as a decoder has them that knows no order. `order`: the faces as they were coded;
  /// `firstCorners`: of the regular ones, where that began; `starts` gets for each face that was
  /// given which corner of the coded one it begins with.
  Cells codedFaces(const std::vector<std::uint32_t>& order,
                   const std::vector<std::uint32_t>& firstCorners,
                   const std::vector<std::uint8_t>& flipped,
                   std::vector<std::uint32_t>& starts) const {
    const Cells given = renumbered(cells_.faces);
    Cells coded;
    std::vector<std::uint32_t> face;
    for (std::uint32_t k = 0; k < order.size(); ++k) {
      const std::uint32_t i = order[k];
      face.assign(given[i].begin(), given[i].end());
      if (k < firstCorners.size()) {
        // Turned around and back again, a face that was begun at its corner j ends there.
        const auto size = static_cast<std::uint32_t>(face.size());
        const std::uint32_t begun = firstCorners[k] - given.first(i);
        const std::uint32_t first = flipped[i] != 0 ? size - begun : begun;
        std::rotate(face.begin(), face.begin() + first % size, face.end());
        starts[i] = (size - first) % size;
      }
      coded.add(face);
    }
    return coded;
  }

  /// Irregular faces keep their sense, and are coded by their vertices.
  static void sortIrregular(PreparedFaces& prepared) {
    for (const std::uint32_t i : prepared.irregular) {
      if (prepared.flipped[i] != 0) {
        std::reverse(prepared.faces.indices.begin() + prepared.faces.first(i),
                     prepared.faces.indices.begin() + prepared.faces.ends[i]);
      }
      prepared.flipped[i] = 0;
    }
    std::sort(prepared.irregular.begin(), prepared.irregular.end(),
              [&](std::uint32_t a, std::uint32_t b) {
                const Span<const std::uint32_t> x = prepared.faces[a];
                const Span<const std::uint32_t> y = prepared.faces[b];
                if (std::equal(x.begin(), x.end(), y.begin(), y.end())) return a < b;
                return std::lexicographical_compare(x.begin(), x.end(), y.begin(), y.end());
              });
  }

  /// Which points the corners of welded vertices are.
  void encodeCorners(const AdvancingFront& front, const PreparedFaces& prepared,
                     const FaceTruth& truth) {
    Cells faces = cells_.faces;
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
      if (prepared.flipped[i] == 0) continue;
      std::reverse(faces.indices.begin() + faces.first(i), faces.indices.begin() + faces.ends[i]);
    }
    CornerSplit<SymbolWriter> split(coder_, *welding_, wishes_.mayRenumber);
    std::vector<std::uint32_t> points;
    for (std::size_t k = 0; k < truth.order().size(); ++k) {
      const std::uint32_t i = truth.order()[k];
      const Span<const std::uint32_t> face = faces[i];
      const std::size_t start = truth.firstCorners()[k] - faces.first(i);
      for (std::size_t j = 0; j < face.size(); ++j)
        points.push_back(face[(start + j) % face.size()]);
    }
    split.codeFront(front, points, noCheck);
    for (const std::uint32_t i : prepared.irregular) {
      for (const std::uint32_t point : faces[i]) split.codeAlone(welding_->vertexOf(point), point);
    }
    if (wishes_.mayRenumber) renumber(split.renumbering());
  }

  void renumber(std::vector<std::uint32_t> order) {
    numberOf_.resize(order.size());
    bool changed = false;
    for (std::uint32_t j = 0; j < order.size(); ++j) {
      numberOf_[order[j]] = j;
      changed = changed || order[j] != j;
    }
    if (changed) {
      result_.pointOrder = std::move(order);
    } else {
      numberOf_.clear();
    }
  }

  Cells renumbered(const Cells& cells) const {
    Cells result = cells;
    if (numberOf_.empty()) return result;
    for (std::uint32_t& i : result.indices) i = numberOf_[i];
    return result;
  }

  void encodeLines() {
    Cells& lines = result_.decoded.lines;
    lines = renumbered(cells_.lines);
    const VertexIndex index(places_);
    PlainCells<SymbolWriter>(coder_, places_, index, PlainCells<SymbolWriter>::Shape::Line)
        .code(lines.size(), lines, noCheck);
  }

  void encodeVertices() {
    const Cells given = renumbered(cells_.vertices);
    Cells& sorted = result_.decoded.vertices;
    if (wishes_.keepOrder) {
      sorted = given;
      VertexCells<SymbolWriter>(coder_, points_.points.size()).code(sorted.size(), sorted, noCheck);
      return;
    }
    std::vector<std::uint32_t> order(given.size());
    std::iota(order.begin(), order.end(), 0U);
    std::vector<std::vector<std::uint32_t>> cells(given.size());
    for (std::uint32_t i = 0; i < given.size(); ++i) {
      cells[i].assign(given[i].begin(), given[i].end());
      std::sort(cells[i].begin(), cells[i].end());
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return cells[a] != cells[b] ? cells[a] < cells[b] : a < b;
    });
    for (const std::uint32_t i : order) sorted.add(cells[i]);
    VertexCells<SymbolWriter>(coder_, points_.points.size()).code(sorted.size(), sorted, noCheck);
    result_.vertexOrder = std::move(order);
  }

  const MeshPoints& points_;
  const MeshCells& cells_;
  CodingWishes wishes_;
  const Cells* surface_;
  std::vector<Position> places_;
  std::optional<Welding> welding_;
  std::vector<std::uint32_t> numberOf_;  ///< of each point, if they were renumbered
  SymbolWriter coder_;
  EncodedMesh result_;
};

class MeshDecoder {
 public:
  MeshDecoder(const MeshPoints& points, ByteView payload, std::uint64_t maxBytes,
              const std::function<Cells(std::uint64_t)>& surface,
              const std::function<void(std::uint64_t)>& working)
      : points_(points),
        maxBytes_(maxBytes),
        surface_(surface),
        working_(working),
        coder_(payload) {
    check(0);
    places_ = placesOf(points);
  }

  MeshCells decode() {
    MeshHead head;
    head.code(coder_);
    checkCells(head.vertices, head.lines);
    if (head.faces) {
      if (head.version == kWithSurface) {
        decodeAroundSurface();
      } else {
        decodeFaces();
      }
      if (head.keepOrder) decodeOrder();
    }
    if (head.lines > 0) {
      const VertexIndex index(places_);
      PlainCells<SymbolReader>(coder_, places_, index, PlainCells<SymbolReader>::Shape::Line)
          .code(head.lines, cells_.lines, [&] { check(0); });
    }
    if (head.vertices > 0) {
      VertexCells<SymbolReader>(coder_, points_.points.size())
          .code(head.vertices, cells_.vertices, [&] { check(0); });
    }
    coder_.finish();
    return std::move(cells_);
  }

 private:
  /// Of positions, their index, and what the front knows of each vertex.
  static constexpr std::uint64_t kBytesPerPoint = 160;
  static constexpr std::uint64_t kBytesPerCell = sizeof(std::uint32_t);
  static constexpr std::uint64_t kTooManyCells = std::uint64_t{1} << 60;
  /// Of the edges, and the places, that the order is coded by.
  static constexpr std::uint64_t kOrderBytesPerCorner = 40;
  static constexpr std::uint64_t kOrderBytesPerFace = 40;

  /// Throws if there is no room for so many cells, before the first of them is decoded: those that
  /// have no points take hardly any bytes of a file.
  void checkCells(std::uint64_t some, std::uint64_t others) const {
    const std::uint64_t cells = saturatingAdd(some, others);
    check(cells < kTooManyCells ? cells * kBytesPerCell : maxBytes_ + 1);
  }

  /// Throws unless what is known of the points, the cells, and `bytes` more are within the limits.
  /// `inFront`: faces that are coded and not yet among the cells.
  void check(std::uint64_t bytes, std::uint64_t inFront = 0) const {
    if (working_) {
      working_(cells_.vertices.size() + cells_.lines.size() + cells_.faces.size() + inFront);
    }
    bytes = saturatingAdd(bytes, points_.points.size() * kBytesPerPoint);
    for (const Cells* cells : {&cells_.vertices, &cells_.lines, &cells_.faces}) {
      if (cells->indices.size() > kMostNumbers) {
        throw Error(ErrorCode::Corrupt, "the mesh has more corners than its format allows");
      }
      // While an array grows, the old one and one of twice its size stand side by side.
      bytes = saturatingAdd(
          bytes, 12 * (std::uint64_t{cells->indices.capacity()} + cells->ends.capacity()));
    }
    if (bytes <= maxBytes_) return;
    throw Error(ErrorCode::LimitExceeded,
                "decoding the cells needs more memory than the limit of " +
                    std::to_string(maxBytes_) +
                    " bytes; raise the limit if the file is to be trusted");
  }

  void decodeFaces() {
    FacesHead head;
    head.code(coder_);
    checkCells(head.regular, head.irregular);
    std::optional<Welding> welding;
    if (head.welded) welding.emplace(points_.points);
    const std::vector<Position> places =
        welding ? placesOf(places_, *welding) : std::vector<Position>();
    UnknownFaces truth;
    Cells irregular;
    FacesSection<SymbolReader, UnknownFaces> section(coder_, head, welding ? places : places_);
    section.codeVertices(truth, irregular,
                         [&](std::size_t bytes) { check(3 * bytes, section.front().faces()); });
    const Span<const std::uint32_t> corners = section.front().allCorners();
    // The faces themselves, the points of their corners, and the front until they are there.
    check(section.front().bytes() + 12 * (corners.size() + irregular.indices.size()));
    std::vector<std::uint32_t> points(corners.begin(), corners.end());
    if (welding) {
      CornerSplit<SymbolReader> split(coder_, *welding, false);
      split.codeFront(section.front(), points,
                      [&] { check(section.front().bytes(), section.front().faces()); });
      for (std::uint32_t& point : irregular.indices) point = split.codeAlone(point, 0);
    }
    section.appendRegular(points, cells_.faces);
    for (std::size_t i = 0; i < irregular.size(); ++i) cells_.faces.add(irregular[i]);
  }

  void decodeAroundSurface() {
    if (!surface_) throw Error(ErrorCode::Corrupt, "the faces are those of no surface");
    cells_.faces = surface_(maxBytes_ - points_.points.size() * kBytesPerPoint);
    check(0);
    SurfaceHead head;
    head.code(coder_);
    FlipBits<SymbolReader> flips(coder_);
    for (std::size_t i = 0; head.flips && i < cells_.faces.size(); ++i) {
      if (!flips.code(false)) continue;
      std::reverse(cells_.faces.indices.begin() + cells_.faces.first(i),
                   cells_.faces.indices.begin() + cells_.faces.ends[i]);
    }
    checkCells(head.irregular, 0);
    if (head.irregular == 0) return;
    const VertexIndex index(places_);
    PlainCells<SymbolReader>(coder_, places_, index, PlainCells<SymbolReader>::Shape::Face)
        .code(head.irregular, cells_.faces, [&] { check(0); });
  }

  void decodeOrder() {
    check(kOrderBytesPerCorner * cells_.faces.indices.size() +
          kOrderBytesPerFace * cells_.faces.size());
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> starts;
    FaceOrder<SymbolReader>(coder_, cells_.faces).code(order, starts, [&] { check(0); });
    Cells ordered;
    std::vector<std::uint32_t> face;
    for (std::size_t t = 0; t < order.size(); ++t) {
      const Span<const std::uint32_t> coded = cells_.faces[order[t]];
      face.assign(coded.begin(), coded.end());
      std::rotate(face.begin(), face.begin() + starts[t], face.end());
      ordered.add(face);
    }
    cells_.faces = std::move(ordered);
  }

  const MeshPoints& points_;
  std::uint64_t maxBytes_;
  const std::function<Cells(std::uint64_t)>& surface_;
  const std::function<void(std::uint64_t)>& working_;
  SymbolReader coder_;
  std::vector<Position> places_;
  MeshCells cells_;
};

}  // namespace

EncodedMesh encodeMesh(const MeshPoints& points, const MeshCells& cells, const CodingWishes& wishes,
                       const Cells* surface) {
  if (points.points.size() > kMostNumbers) {
    throw Error(ErrorCode::Unsupported,
                "the mesh has more than 2^32 points; store it in parts, or without cells");
  }
  checkCells(cells.vertices, points.points.size(), "vertex cells");
  checkCells(cells.lines, points.points.size(), "lines");
  checkCells(cells.faces, points.points.size(), "faces");
  return MeshEncoder(points, cells, wishes, surface).encode();
}

MeshCells decodeMesh(const MeshPoints& points, ByteView payload, std::uint64_t maxBytes,
                     const std::function<Cells(std::uint64_t)>& surface,
                     const std::function<void(std::uint64_t)>& working) {
  if (points.points.size() > kMostNumbers) {
    throw Error(ErrorCode::Corrupt, "a mesh of more than 2^32 points cannot have cells");
  }
  return MeshDecoder(points, payload, maxBytes, surface, working).decode();
}

}  // namespace bspc::connectivity
