#include "formats/model_io.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "formats/array_tuples.h"
#include "formats/input_buffer.h"
#include "formats/las_reader.h"
#include "formats/model_writer.h"
#include "formats/obj_reader.h"
#include "formats/off_reader.h"
#include "formats/pcd_reader.h"
#include "formats/ply_reader.h"
#include "formats/wording.h"
#include "formats/xyz_reader.h"

namespace bspc::formats {

std::optional<Format> formatFromPath(std::string_view path) {
  constexpr std::array<std::pair<std::string_view, Format>, 10> kEndings{{
      {"ply", Format::Ply},
      {"obj", Format::Obj},
      {"off", Format::Off},
      {"xyz", Format::Xyz},
      {"txt", Format::Xyz},
      {"asc", Format::Xyz},
      {"csv", Format::Csv},
      {"las", Format::Las},
      // Its content tells that it is compressed.
      {"laz", Format::Las},
      {"pcd", Format::Pcd},
  }};
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const std::string ending = lowerCase(path.substr(dot + 1));
  const auto* const found = std::find_if(kEndings.begin(), kEndings.end(),
                                         [&](const auto& entry) { return entry.first == ending; });
  if (found == kEndings.end()) return std::nullopt;
  return found->second;
}

std::unique_ptr<PointStream> openPointStream(std::istream& in, Format format,
                                             const ProgressCallback& progress) {
  InputBuffer input(in, progress);
  switch (format) {
    case Format::Ply:
      return openPly(std::move(input));
    case Format::Obj:
      return openObj(std::move(input));
    case Format::Off:
      return openOff(std::move(input));
    case Format::Xyz:
    case Format::Csv:
      return openXyz(std::move(input));
    case Format::Las:
      return openLas(std::move(input));
    case Format::Pcd:
      return openPcd(std::move(input));
  }
  throw FormatError("there is no reader for this format");
}

Model readModel(std::istream& in, Format format, const ProgressCallback& progress, bool keepMesh) {
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  const std::unique_ptr<PointStream> points = openPointStream(in, format, progress);
  if (keepMesh) points->keepMesh();
  const std::size_t pointBytes = 3 * scalarSize(points->info().type);
  Model model;
  model.values = emptyArrays(points->info().arrays);
  // One block more: the end shows only when less than a block comes.
  model.positions.reserve((points->reservable() + kBlock) * pointBytes);
  for (bool more = true; more;) {
    const std::size_t size = model.positions.size();
    model.positions.resize(size + kBlock * pointBytes);
    const std::size_t got = points->read(model.positions.data() + size, model.values, kBlock);
    model.positions.resize(size + got * pointBytes);
    more = got == kBlock;
  }
  static_cast<ModelInfo&>(model) = points->info();
  model.mesh = points->takeMesh();
  return model;
}

void writeModel(std::ostream& out, Format format, const PointSetView& points,
                const ProgressCallback& progress) {
  ModelLayout layout;
  layout.type = points.type();
  layout.points = points.size();
  for (const ArrayView& array : points.arrays()) layout.arrays.push_back(array);
  layout.mesh = points.mesh();
  ModelWriter writer(out, format, std::move(layout), progress);
  writer.append(points);
  writer.finish();
}

}  // namespace bspc::formats
