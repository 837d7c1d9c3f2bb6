#include "formats/ply_writer.h"

#include <algorithm>
#include <string>
#include <vector>

#include "formats/array_columns.h"
#include "formats/las_records.h"
#include "formats/mesh_lines.h"
#include "formats/record_writer.h"

namespace bspc::formats {

namespace {

constexpr const char* kWrittenBy = "written by bspc";

const char* plyName(ScalarType type) {
  switch (type) {
    case ScalarType::Float32:
      return "float";
    case ScalarType::Float64:
      return "double";
    case ScalarType::Int8:
      return "char";
    case ScalarType::UInt8:
      return "uchar";
    case ScalarType::Int16:
      return "short";
    case ScalarType::UInt16:
      return "ushort";
    case ScalarType::Int32:
      return "int";
    case ScalarType::UInt32:
      return "uint";
    default:
      throw FormatError(std::string("a PLY file has no type ") + scalarName(type));
  }
}

/// The type that numbers go out as.
ScalarType plyType(ScalarType type) {
  const bool wide = type == ScalarType::Int64 || type == ScalarType::UInt64;
  return wide ? ScalarType::Float64 : type;
}

/// The text of the entry as lines that start with `keyword`.
void appendLines(std::string& text, const char* keyword, const std::string& lines) {
  std::size_t at = 0;
  while (at <= lines.size()) {
    const std::size_t end = std::min(lines.find('\n', at), lines.size());
    text += keyword;
    for (const char c : lines.substr(at, end - at)) text += c == '\r' ? ' ' : c;
    text += '\n';
    at = end + 1;
  }
}

class PlyWriter : public PointWriter {
 public:
  explicit PlyWriter(const ModelLayout& layout)
      : points_(layout.points),
        mesh_(layout.mesh),
        comments_(metadataEntry(layout.metadata, "ply.comment")),
        infos_(metadataEntry(layout.metadata, "ply.obj_info")) {
    requireNumbers(layout.arrays, "a PLY file");
    requireFacesOnly(layout.mesh, "a PLY file");
    if (mesh_ != nullptr) {
      for (std::size_t i = 0; i < mesh_->faces.size(); ++i) {
        largeFaces_ = largeFaces_ || mesh_->faces[i].size() > 255;
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      add({std::string(1, "xyz"[k]), RecordField::kPosition, k, plyType(layout.type), 0});
    }
    for (const ArrayColumn& column : columnsOf(layout.arrays)) {
      add({wordOf(column.name), column.array, column.component, plyType(column.type), 0});
    }
  }

  void begin(OutputBuffer& out) override {
    std::string& text = out.text();
    text += "ply\nformat binary_little_endian 1.0\n";
    if (comments_.find(kWrittenBy) == std::string::npos) {
      text += std::string("comment ") + kWrittenBy + '\n';
    }
    if (!comments_.empty()) appendLines(text, "comment ", comments_);
    if (!infos_.empty()) appendLines(text, "obj_info ", infos_);
    text += "element vertex " + std::to_string(points_) + '\n';
    for (const RecordField& field : fields_) {
      text += std::string("property ") + plyName(field.type) + ' ' + field.name + '\n';
    }
    if (mesh_ != nullptr && !mesh_->faces.empty()) {
      text += "element face " + std::to_string(mesh_->faces.size()) + "\nproperty list " +
              (largeFaces_ ? "uint" : "uchar") + " uint vertex_indices\n";
    }
    text += "end_header\n";
  }

  void append(OutputBuffer& out, const PointSetView& points) override {
    writeRecords(out, points, fields_, recordBytes_, "a PLY file");
  }

  void finish(OutputBuffer& out) override {
    if (mesh_ == nullptr) return;
    const auto append = [&out](std::uint64_t number, unsigned bytes) {
      for (unsigned b = 0; b < bytes; ++b) {
        out.text() += static_cast<char>(static_cast<unsigned char>(number >> (8 * b)));
      }
    };
    for (std::size_t i = 0; i < mesh_->faces.size(); ++i) {
      const Span<const std::uint32_t> face = mesh_->faces[i];
      append(face.size(), largeFaces_ ? 4 : 1);
      for (const std::uint32_t vertex : face) append(vertex, 4);
      out.advance(i, mesh_->faces.size());
    }
  }

 private:
  void add(RecordField field) {
    field.offset = recordBytes_;
    recordBytes_ += scalarSize(field.type);
    fields_.push_back(std::move(field));
  }

  std::uint64_t points_;
  const MeshCells* mesh_;
  bool largeFaces_ = false;
  std::string comments_;
  std::string infos_;
  std::vector<RecordField> fields_;
  std::size_t recordBytes_ = 0;
};

}  // namespace

std::unique_ptr<PointWriter> plyWriter(const ModelLayout& layout) {
  return std::make_unique<PlyWriter>(layout);
}

}  // namespace bspc::formats
