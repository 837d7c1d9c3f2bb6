#include "mesh/mesh_encoder.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "arrays/array_checks.h"
#include "arrays/array_source.h"
#include "attributes/array_coder.h"
#include "bspc/error.h"
#include "connectivity/connectivity_coder.h"
#include "connectivity/mesh_preparation.h"
#include "container/checksum.h"
#include "grid/float_grid.h"

namespace bspc {

namespace {

constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

template <class Visit>
void forEachSort(const MeshCells& cells, Visit visit) {
  for (const Cells* sort : {&cells.vertices, &cells.lines, &cells.faces}) visit(*sort);
}

/// Input indices of all cells in the order in which they come back.
std::vector<std::uint64_t> orderOfAll(const MeshCells& cells,
                                      const connectivity::EncodedMesh& coded) {
  std::vector<std::uint64_t> order;
  order.reserve(cells.size());
  const std::vector<std::uint32_t> none;
  const auto append = [&](std::size_t count, const std::vector<std::uint32_t>& own) {
    const std::uint64_t start = order.size();
    for (std::size_t j = 0; j < count; ++j) order.push_back(start + (own.empty() ? j : own[j]));
  };
  append(cells.vertices.size(), coded.vertexOrder);
  append(cells.lines.size(), none);
  append(cells.faces.size(), coded.faceOrder);
  return order;
}

attributes::ArrayWishes wishesFor(const ArrayDescription& array, unsigned effort) {
  attributes::ArrayWishes wishes;
  wishes.effort = effort;
  if (array.semantic == Semantic::Normals && array.components == 3) {
    wishes.maxAngle = array.tolerance;
  } else {
    wishes.maxError = array.tolerance;
  }
  return wishes;
}

}  // namespace

MeshEncoder::MeshEncoder(const PointSetView& points, const EncodeOptions& options)
    : points_(points),
      options_(options),
      mesh_(points.mesh() != nullptr && !points.mesh()->empty() ? points.mesh() : nullptr) {
  const std::uint64_t cells = mesh_ == nullptr ? 0 : mesh_->size();
  checkCellArrays(points.cellArrays(), cells);
  if (mesh_ == nullptr) return;
  if (options.stopPoints > 0 || options.stopLevel) {
    throw Error(ErrorCode::InvalidArgument,
                "the cells of a mesh cannot be stored with a lossy stop, which moves points onto "
                "each other; leave the cells or the stop out");
  }
  forEachSort(*mesh_, [&](const Cells& sort) {
    if (!sort.empty() && sort.ends.back() != sort.indices.size()) {
      throw Error(ErrorCode::InvalidArgument, "the ends of the cells do not match their points");
    }
    for (const std::uint32_t i : sort.indices) {
      if (i < points.size()) continue;
      throw Error(ErrorCode::InvalidArgument, "a cell has the point " + std::to_string(i) +
                                                  ", and there are " +
                                                  std::to_string(points.size()));
    }
  });
}

container::MeshRecord MeshEncoder::record() const {
  container::MeshRecord record;
  if (mesh_ == nullptr) return record;
  record.counts = {mesh_->vertices.size(), mesh_->lines.size(), mesh_->faces.size()};
  record.blocks = 1;
  for (const ArrayView& array : points_.cellArrays()) record.arrays.push_back(array);
  return record;
}

std::vector<GridPoint> MeshEncoder::orderedPoints(const GridFit& fit,
                                                  const std::vector<std::uint64_t>& order) const {
  std::vector<GridPoint> points;
  points.reserve(order.size());
  if (fit.sourceIndex.empty()) {
    for (const std::uint64_t i : order) points.push_back(fit.points[i]);
    return points;
  }
  std::vector<std::uint32_t> fitted(points_.size(), kNowhere);
  for (std::size_t j = 0; j < fit.sourceIndex.size(); ++j) {
    fitted[fit.sourceIndex[j]] = static_cast<std::uint32_t>(j);
  }
  for (const std::uint64_t i : order) points.push_back(fit.points[fitted[i]]);
  return points;
}

MeshCells MeshEncoder::renumbered(const std::vector<std::uint64_t>& order) const {
  std::vector<std::uint32_t> numberOf(points_.size(), kNowhere);
  for (std::size_t j = 0; j < order.size(); ++j) {
    numberOf[order[j]] = static_cast<std::uint32_t>(j);
  }
  MeshCells cells = *mesh_;
  for (Cells* sort : {&cells.vertices, &cells.lines, &cells.faces}) {
    for (std::uint32_t& i : sort->indices) {
      if (numberOf[i] == kNowhere) {
        throw Error(ErrorCode::InvalidArgument,
                    "a cell has the point " + std::to_string(i) +
                        ", which is to be left out since it is not finite; repair the mesh first");
      }
      i = numberOf[i];
    }
  }
  return cells;
}

Cells MeshEncoder::surface(const std::vector<std::uint64_t>& order) const {
  const connectivity::PreparedFaces prepared = connectivity::prepareFaces(renumbered(order).faces);
  Cells regular;
  for (const std::uint32_t i : prepared.regular) regular.add(prepared.faces[i]);
  return regular;
}

Bytes MeshEncoder::encode(const GridFit& fit, unsigned effort, std::uint64_t tiles,
                          const Cells* surface, std::vector<std::uint64_t>& order,
                          EncodeReport& report) const {
  const std::vector<GridPoint> points = orderedPoints(fit, order);
  MeshCells cells = renumbered(order);
  connectivity::CodingWishes wishes;
  wishes.effort = effort;
  wishes.keepOrder = options_.keepOrder;
  // Arrays tell points at the same place apart.
  wishes.mayRenumber = !options_.keepOrder && !options_.originalIds && points_.arrays().empty() &&
                       !lattice::hasLowHalves(fit.grid);
  connectivity::EncodedMesh coded =
      connectivity::encodeMesh({points, stepsOf(fit.grid)}, cells, wishes, surface);
  if (!coded.pointOrder.empty()) {
    std::vector<std::uint64_t> exchanged;
    exchanged.reserve(order.size());
    for (const std::uint32_t j : coded.pointOrder) exchanged.push_back(order[j]);
    order = std::move(exchanged);
  }
  container::MeshBlock block;
  block.tiles = tiles;
  block.counts = {cells.vertices.size(), cells.lines.size(), cells.faces.size()};
  block.contentChecksum = container::cellsChecksum(coded.decoded);
  block.cells = std::move(coded.payload);
  report.meshBytes = block.cells.size();
  const std::vector<std::uint64_t> cellOrder = orderOfAll(cells, coded);
  if (!points_.cellArrays().empty()) {
    encodeArrays(cellCentres(points, coded.decoded), cellOrder, effort, block, report);
  }
  if (options_.wantOrder) report.cellOrder = cellOrder;
  return container::writeMeshBlock(block, record().arrays);
}

void MeshEncoder::encodeArrays(const std::vector<GridPoint>& centres,
                               const std::vector<std::uint64_t>& cellOrder, unsigned effort,
                               container::MeshBlock& block, EncodeReport& report) const {
  attributes::TilePoints places(centres);
  const ArraySource source(points_.cellArrays(), 0, false);
  for (std::size_t a = 0; a < source.size(); ++a) {
    const ArrayDescription description = source.description(a);
    attributes::ArrayValues values = source.gather(a, cellOrder);
    attributes::EncodedArray coded =
        attributes::encodeArray(source.shape(a), values, places, wishesFor(description, effort));
    report.cellArrays.push_back({description.name, coded.payload.size(), coded.greatestError});
    block.arrays.push_back({container::valuesChecksum(source.shape(a), values, centres.size()),
                            std::move(coded.payload)});
  }
}

std::vector<GridPoint> cellCentres(const std::vector<GridPoint>& points, const MeshCells& cells) {
  GridPoint corner{};
  if (!points.empty()) corner = points[0];
  for (const GridPoint& p : points) {
    for (std::size_t k = 0; k < 3; ++k) corner[k] = std::min(corner[k], p[k]);
  }
  std::vector<GridPoint> centres;
  centres.reserve(cells.size());
  forEachSort(cells, [&](const Cells& sort) {
    for (std::size_t i = 0; i < sort.size(); ++i) {
      const Span<const std::uint32_t> cell = sort[i];
      std::array<std::uint64_t, 3> sum{};
      for (const std::uint32_t v : cell) {
        for (std::size_t k = 0; k < 3; ++k) sum[k] += points[v][k] - corner[k];
      }
      GridPoint centre{};
      for (std::size_t k = 0; k < 3 && !cell.empty(); ++k) {
        centre[k] = static_cast<std::uint32_t>(sum[k] / cell.size());
      }
      centres.push_back(centre);
    }
  });
  return centres;
}

std::array<double, 3> stepsOf(const Grid& grid) {
  if (lattice::isFloatGrid(grid)) return {1, 1, 1};  // steps of floats have no one length
  return {grid.step(0), grid.step(1), grid.step(2)};
}

}  // namespace bspc
