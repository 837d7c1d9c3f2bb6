#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string_view>

#include "bspc/progress.h"
#include "formats/model.h"

namespace bspc::formats {

enum class Format : std::uint8_t { Ply, Obj, Off, Xyz, Csv };

/// The format that the ending of a file name says, in letters of any case; ".ply" alone will do.
std::optional<Format> formatFromPath(std::string_view path);

/// Reads a whole model from a stream opened in binary mode, which need not be seekable. Throws
/// FormatError, or Error(Cancelled) once `progress` asks to stop.
Model readModel(std::istream& in, Format format, const ProgressCallback& progress = {});

/// Writes a model to a stream opened in binary mode. Throws FormatError if the format cannot hold
/// it or if the stream fails, Error(Cancelled) once `progress` asks to stop.
void writeModel(std::ostream& out, Format format, const ModelView& model,
                const ProgressCallback& progress = {});

}  // namespace bspc::formats
