#pragma once

#include <memory>
#include <string>

#include "bspc/decoder.h"

namespace bspc::vtk {

/// Opens the file of that name. Throws Error (Io where the file cannot be opened).
Decoder openFile(const std::string& fileName, const OpenOptions& options);

/// Opens bytes in memory, which must outlive the decoder. Throws Error.
Decoder openBytes(const std::string& bytes, const OpenOptions& options);

/// Whether the file can be read and begins as a .bspc file does.
bool beginsAsBspc(const std::string& fileName);

}  // namespace bspc::vtk
