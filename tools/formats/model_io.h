#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string_view>

#include "bspc/progress.h"
#include "formats/model.h"
#include "formats/point_stream.h"

namespace bspc::formats {

enum class Format : std::uint8_t { Ply, Obj, Off, Xyz, Csv, Las, Pcd };

/// The format that the ending of a file name says, in letters of any case; ".ply" alone will do.
std::optional<Format> formatFromPath(std::string_view path);

/// Opens a stream that is in binary mode, which need not be seekable and must outlive what is
/// returned, as a model to be read in pieces. Throws FormatError, or Error(Cancelled) once
/// `progress` asks to stop.
std::unique_ptr<PointStream> openPointStream(std::istream& in, Format format,
                                             const ProgressCallback& progress = {});

/// Reads a whole model with its arrays, and its cells if `keepMesh` is set; the rest is as with
/// openPointStream(), through which it reads.
Model readModel(std::istream& in, Format format, const ProgressCallback& progress = {},
                bool keepMesh = false);

/// Writes points with their arrays to a stream opened in binary mode. Throws FormatError if the
/// format cannot hold them or if the stream fails, Error(Cancelled) once `progress` asks to stop.
void writeModel(std::ostream& out, Format format, const PointSetView& points,
                const ProgressCallback& progress = {});

}  // namespace bspc::formats
