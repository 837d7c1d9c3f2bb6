#pragma once

#include <string>

#include "formats/model.h"

namespace bspc::formats {

/// Writes what stands in front of the points of an XYZ file: a comment that names the columns, if
/// there are any beside x, y and z.
void writeXyzHeader(std::string& text, const ModelLayout& layout);

/// Writes the line of names of a CSV file.
void writeCsvHeader(std::string& text, const ModelLayout& layout);

}  // namespace bspc::formats
