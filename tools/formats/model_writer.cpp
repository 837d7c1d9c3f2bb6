#include "formats/model_writer.h"

#include <string>
#include <utility>

#include "formats/obj_writer.h"
#include "formats/off_writer.h"
#include "formats/ply_writer.h"
#include "formats/position_text.h"
#include "formats/wording.h"
#include "formats/xyz_writer.h"

namespace bspc::formats {

namespace {

void requireLayout(const ModelView& piece, const ModelLayout& layout) {
  const bool typeFits = piece.points.empty() || piece.points.type() == layout.type;
  if (!typeFits || piece.columns.size() != layout.columns.size()) {
    throw FormatError("a piece of the model has other types or columns than the model");
  }
  for (const PointColumn& column : piece.columns) {
    if (column.values.size() == piece.points.size()) continue;
    throw FormatError("column " + quoted(column.name) + " has " + grouped(column.values.size()) +
                      " values for " + grouped(piece.points.size()) + " points");
  }
}

}  // namespace

ModelWriter::ModelWriter(std::ostream& out, Format format, ModelLayout layout,
                         const ProgressCallback& progress)
    : format_(format), layout_(std::move(layout)), out_(out, progress) {
  switch (format_) {
    case Format::Ply:
      writePlyHeader(out_.text(), layout_);
      break;
    case Format::Obj:
      writeObjHeader(out_.text(), layout_);
      break;
    case Format::Off:
      writeOffHeader(out_.text(), layout_);
      break;
    case Format::Xyz:
      writeXyzHeader(out_.text(), layout_);
      break;
    case Format::Csv:
      writeCsvHeader(out_.text(), layout_);
      break;
    case Format::Las:
    case Format::Pcd:
      throw FormatError("LAS and PCD files are read only; write PLY, OBJ, OFF, XYZ or CSV");
  }
}

void ModelWriter::append(const ModelView& piece) {
  if (piece.points.empty() && piece.columns.empty()) return;
  requireLayout(piece, layout_);
  switch (format_) {
    case Format::Ply:
      writePlyRecords(out_, layout_, piece);
      break;
    case Format::Obj:
      writePositionLines(out_, piece, "v ", ' ');
      break;
    case Format::Off:
    case Format::Xyz:
      writePositionLines(out_, piece, "", ' ');
      break;
    case Format::Csv:
      writePositionLines(out_, piece, "", ',');
      break;
    case Format::Las:
    case Format::Pcd:
      break;  // refused by the constructor
  }
  written_ += piece.points.size();
}

void ModelWriter::finish() {
  if (written_ != layout_.points) {
    throw FormatError("the model has " + grouped(written_) + " points instead of " +
                      grouped(layout_.points));
  }
  out_.finish();
}

}  // namespace bspc::formats
