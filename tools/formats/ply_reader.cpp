#include "formats/ply_reader.h"

#include "formats/ply_body.h"
#include "formats/ply_header.h"

namespace bspc::formats {

Model readPly(InputBuffer& in) {
  TextScanner text(in);
  PlyHeader header = readPlyHeader(text);
  Model model;
  model.type = header.positionType;
  const std::uint64_t least = header.vertices().leastBytes(header.encoding);
  model.positions.reserve(in.reservable(header.vertices().count, least) * 3 *
                          scalarSize(model.type));
  if (header.encoding == PlyEncoding::Ascii) {
    readAsciiPlyBody(text, header, model.positions);
  } else {
    readBinaryPlyBody(in, header, model.positions);
  }
  model.otherContent = otherPlyContent(header);
  model.comments = std::move(header.comments);
  return model;
}

}  // namespace bspc::formats
