#include "formats/model_io.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "formats/input_buffer.h"
#include "formats/model_writer.h"
#include "formats/obj_reader.h"
#include "formats/off_reader.h"
#include "formats/ply_reader.h"
#include "formats/wording.h"
#include "formats/xyz_reader.h"

namespace bspc::formats {

std::optional<Format> formatFromPath(std::string_view path) {
  constexpr std::array<std::pair<std::string_view, Format>, 7> kEndings{{
      {"ply", Format::Ply},
      {"obj", Format::Obj},
      {"off", Format::Off},
      {"xyz", Format::Xyz},
      {"txt", Format::Xyz},
      {"asc", Format::Xyz},
      {"csv", Format::Csv},
  }};
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const std::string ending = lowerCase(path.substr(dot + 1));
  const auto* const found = std::find_if(kEndings.begin(), kEndings.end(),
                                         [&](const auto& entry) { return entry.first == ending; });
  if (found == kEndings.end()) return std::nullopt;
  return found->second;
}

Model readModel(std::istream& in, Format format, const ProgressCallback& progress) {
  InputBuffer input(in, progress);
  switch (format) {
    case Format::Ply:
      return readPly(input);
    case Format::Obj:
      return readObj(input);
    case Format::Off:
      return readOff(input);
    case Format::Xyz:
    case Format::Csv:
      return readXyz(input);
  }
  throw FormatError("there is no reader for this format");
}

void writeModel(std::ostream& out, Format format, const ModelView& model,
                const ProgressCallback& progress) {
  ModelLayout layout{model.points.type(), model.points.size(), {}};
  for (const PointColumn& column : model.columns) {
    const auto* const greatest = std::max_element(column.values.begin(), column.values.end());
    layout.columns.push_back({column.name, greatest == column.values.end() ? 0 : *greatest});
  }
  ModelWriter writer(out, format, std::move(layout), progress);
  writer.append(model);
  writer.finish();
}

}  // namespace bspc::formats
