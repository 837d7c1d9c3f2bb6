// What faces cost, and how fast they are coded: run faces_benchmark FILE.off...
//
// Positions are put on 12 bits. For the efforts 2 and 9, the faces coded from the positions: bits a
// face and thousands of faces a second, processor time, medians of five. Then what it costs to keep
// the order of the faces, in bits a face; and method surface, which codes both: bytes and speeds. A
// model with polygons has a second line for the same cut into fans of triangles; bits there are
// those a face of the first line.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "connectivity/connectivity_coder.h"
#include "connectivity/mesh_preparation.h"
#include "geometry/geometry_method.h"
#include "grid/grid_fit.h"
#include "off_model.h"

namespace bspc {
namespace {

constexpr unsigned kBits = 12;
constexpr int kRepeats = 5;
constexpr std::uint64_t kMemory = std::uint64_t{1} << 34;

/// Thousands of faces a second.
double speedOf(std::size_t faces, const std::function<void()>& work) {
  std::vector<double> seconds;
  for (int i = 0; i < kRepeats; ++i) {
    const std::clock_t start = std::clock();
    work();
    seconds.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::sort(seconds.begin(), seconds.end());
  return static_cast<double>(faces) / std::max(seconds[kRepeats / 2], 1e-6) / 1000;
}

std::size_t measureEffort(const connectivity::MeshPoints& points, const MeshCells& cells,
                          unsigned effort, std::size_t faces) {
  connectivity::CodingWishes wishes;
  wishes.effort = effort;
  Bytes payload;
  const double encoding = speedOf(cells.faces.size(), [&] {
    payload = connectivity::encodeMesh(points, cells, wishes).payload;
  });
  const double decoding =
      speedOf(cells.faces.size(), [&] { connectivity::decodeMesh(points, payload, kMemory); });
  std::printf(" | %6.3f %5.0f %5.0f",
              8.0 * static_cast<double>(payload.size()) / static_cast<double>(faces), encoding,
              decoding);
  return payload.size();
}

void measureSurface(const std::vector<GridPoint>& points, const MeshCells& cells) {
  const connectivity::PreparedFaces prepared = connectivity::prepareFaces(cells.faces);
  Cells regular;
  for (const std::uint32_t i : prepared.regular) regular.add(prepared.faces[i]);
  geometry::TileInput tile;
  tile.points = points;
  tile.wishes.faces = &regular;
  for (const GridPoint& p : points) {
    for (std::size_t k = 0; k < 3; ++k) tile.extent[k] = std::max(tile.extent[k], p[k]);
  }
  const geometry::GeometryMethod& method = *geometry::findGeometryMethod(Method::Surface);
  geometry::EncodedTile coded;
  const double encoding = speedOf(cells.faces.size(), [&] { coded = method.encode(tile, {}); });
  geometry::TileToDecode decode;
  decode.points = points.size();
  decode.extent = tile.extent;
  decode.payloads.emplace_back(coded.layers[0]);
  decode.maxPoints = points.size();
  decode.maxBytes = kMemory;
  decode.maxDepth = std::numeric_limits<std::uint32_t>::max();
  const double decoding = speedOf(cells.faces.size(), [&] { method.decode(decode, {}); });
  std::printf(" | %8zu %5.0f %5.0f\n", coded.layers[0].size(), encoding, decoding);
}

void measure(const std::string& name, const bench::OffModel& model, std::size_t faces) {
  const PointSetView view(model.xyz.data(), static_cast<std::size_t>(model.points()));
  const GridFit fit = fitGrid(view, GridRequest::withBits(kBits), {});
  const connectivity::MeshPoints points{fit.points};
  std::printf("%-24s %8zu %9zu", name.c_str(), fit.points.size(), model.cells.faces.size());
  measureEffort(points, model.cells, 2, faces);
  const std::size_t any = measureEffort(points, model.cells, 9, faces);
  connectivity::CodingWishes kept;
  kept.keepOrder = true;
  const std::size_t ordered = connectivity::encodeMesh(points, model.cells, kept).payload.size();
  std::printf(" | %6.3f", 8.0 * static_cast<double>(ordered - any) / static_cast<double>(faces));
  measureSurface(fit.points, model.cells);
  std::fflush(stdout);
}

}  // namespace
}  // namespace bspc

int main(int argc, char** argv) {
  std::printf("%-24s %8s %9s | %18s | %18s | %6s | %20s\n", "mesh", "points", "faces",
              "effort 2 enc   dec", "effort 9 enc   dec", "order", "surface   enc   dec");
  int failures = 0;
  for (int i = 1; i < argc; ++i) {
    try {
      const bspc::bench::OffModel model = bspc::bench::readOff(argv[i]);
      const bspc::bench::OffModel cut = bspc::bench::inTriangles(model);
      const std::size_t faces = model.cells.faces.size();
      bspc::measure(bspc::bench::baseName(argv[i]), model, faces);
      if (cut.cells.faces.size() != faces) bspc::measure("  as fans", cut, faces);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: %s\n", argv[i], error.what());
      ++failures;
    }
  }
  return failures == 0 ? 0 : 1;
}
