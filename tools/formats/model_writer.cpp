#include "formats/model_writer.h"

#include <string>
#include <utility>

#include "formats/las_writer.h"
#include "formats/obj_writer.h"
#include "formats/off_writer.h"
#include "formats/pcd_writer.h"
#include "formats/ply_writer.h"
#include "formats/wording.h"
#include "formats/xyz_writer.h"

namespace bspc::formats {

namespace {

/// A .bspc file may claim billions of components; more than this nobody reads.
void requireFewColumns(const std::vector<ArrayDescription>& arrays) {
  constexpr std::uint64_t kMostColumns = 65536;
  std::uint64_t columns = 0;
  for (const ArrayDescription& array : arrays) {
    columns += array.components;
    if (columns <= kMostColumns) continue;
    throw FormatError("the array " + quoted(array.name) + " brings more than " +
                      grouped(kMostColumns) + " columns to the file; leave it out");
  }
}

std::unique_ptr<PointWriter> makeWriter(Format format, const ModelLayout& layout) {
  requireFewColumns(layout.arrays);
  switch (format) {
    case Format::Ply:
      return plyWriter(layout);
    case Format::Obj:
      return objWriter(layout);
    case Format::Off:
      return offWriter(layout);
    case Format::Xyz:
      return xyzWriter(layout);
    case Format::Csv:
      return csvWriter(layout);
    case Format::Las:
      return lasWriter(layout);
    case Format::Pcd:
      return pcdWriter(layout);
  }
  throw FormatError("there is no writer for this format");
}

void requireLayout(const PointSetView& piece, const ModelLayout& layout) {
  const Span<const ArrayView> arrays = piece.arrays();
  bool fits =
      (piece.empty() || piece.type() == layout.type) && arrays.size() == layout.arrays.size();
  for (std::size_t a = 0; fits && a < arrays.size(); ++a) {
    fits = arrays[a].type == layout.arrays[a].type &&
           arrays[a].components == layout.arrays[a].components;
  }
  if (!fits) throw FormatError("a piece of the model has other types or arrays than the model");
  for (const ArrayView& array : arrays) {
    if (array.tuples == piece.size()) continue;
    throw FormatError("the array " + quoted(array.name) + " has " + grouped(array.tuples) +
                      " tuples for " + grouped(piece.size()) + " points");
  }
}

}  // namespace

ModelWriter::ModelWriter(std::ostream& out, Format format, ModelLayout layout,
                         const ProgressCallback& progress)
    : layout_(std::move(layout)), out_(out, progress), writer_(makeWriter(format, layout_)) {
  writer_->begin(out_);
}

void ModelWriter::append(const PointSetView& piece) {
  requireLayout(piece, layout_);
  if (piece.empty()) return;
  writer_->append(out_, piece);
  written_ += piece.size();
}

void ModelWriter::finish() {
  if (written_ != layout_.points) {
    throw FormatError("the model has " + grouped(written_) + " points instead of " +
                      grouped(layout_.points));
  }
  writer_->finish(out_);
  out_.finish();
}

}  // namespace bspc::formats
