#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/input_buffer.h"
#include "formats/ply_header.h"
#include "formats/text_scanner.h"

namespace bspc::formats {

/// Reads what follows the header to the end of the file. Appends to `positions` three numbers a
/// vertex of the type header.positionType and passes over everything else. Both throw FormatError.
void readAsciiPlyBody(TextScanner& text, const PlyHeader& header,
                      std::vector<std::uint8_t>& positions);
void readBinaryPlyBody(InputBuffer& in, const PlyHeader& header,
                       std::vector<std::uint8_t>& positions);

/// "vertex 41,230 of 50,000"; `index` counts from 0.
std::string plyPlace(const PlyElement& element, std::uint64_t index);

/// Which coordinate each property of the vertices is: 0 to 2, or 3 for none.
std::vector<std::size_t> plyAxes(const PlyHeader& header);

}  // namespace bspc::formats
