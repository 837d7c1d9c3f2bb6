#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/mesh.h"
#include "bspc/span.h"
#include "formats/input_buffer.h"
#include "formats/ply_header.h"
#include "formats/text_scanner.h"

namespace bspc::formats {

/// Reads what follows a PLY header, in the order of the header. Throws FormatError.
class PlyBody {
 public:
  PlyBody() = default;
  virtual ~PlyBody() = default;
  PlyBody(const PlyBody&) = delete;
  PlyBody& operator=(const PlyBody&) = delete;

  /// Passes over all of an element that is not the vertices.
  virtual void skip(const PlyElement& element) = 0;
  /// The same, but appends the numbers of that list property, which are to be vertices, to `cells`.
  virtual void readLists(const PlyElement& element, std::size_t property, Cells& cells) = 0;
  /// Reads `count` vertices of which the first is number `first`, counted from 0. Writes three
  /// numbers each of the type header.positionType to `positions` and appends their tuples to
  /// `values`, which has an array for each of header.arrays or none; lists are passed over.
  virtual void readVertices(std::uint64_t first, std::size_t count, std::uint8_t* positions,
                            Span<ArrayValues> values) = 0;
  /// Throws if anything follows.
  virtual void requireEnd() = 0;
};

/// Input and header must outlive the body.
std::unique_ptr<PlyBody> asciiPlyBody(TextScanner& text, const PlyHeader& header);
std::unique_ptr<PlyBody> binaryPlyBody(InputBuffer& in, const PlyHeader& header);

/// "vertex 41,230 of 50,000"; `index` counts from 0.
std::string plyPlace(const PlyElement& element, std::uint64_t index);

/// Throws FormatError unless the number is one of a vertex.
std::uint32_t plyVertex(const PlyHeader& header, double number, const PlyElement& element,
                        std::uint64_t index);

/// Which coordinate each property of the vertices is: 0 to 2, or 3 for none.
std::vector<std::size_t> plyAxes(const PlyHeader& header);

}  // namespace bspc::formats
